//! Stages: consecutive load steps with the same active bodies and contacts.

use std::borrow::Cow;
use std::collections::HashSet;
use std::ops::Range;

use super::{Absent, Catalog, SubdomainNode};
use crate::contact_point::{ContactPoint, Law};
use crate::element::geometry::dot;

/// The part of a problem that is active in consecutive load steps.
#[derive(Debug)]
pub struct Stage<'a> {
    /// The load steps; a single one for a problem without load steps.
    pub steps: Range<usize>,
    /// The problem without inactive contact points. Absent bodies stay in it, without loads.
    pub catalog: Cow<'a, Catalog>,
    /// The active contact points, by their indices in the catalog of the whole problem.
    pub points: Vec<usize>,
}

impl Catalog {
    /// The load steps of every stage.
    pub fn stages(&self) -> Vec<Range<usize>> {
        let mut stages: Vec<Range<usize>> = Vec::new();
        for k in 0..self.steps.len().max(1) {
            match stages.last_mut() {
                Some(stage) if self.steps[k].absent == self.steps[stage.start].absent => {
                    stage.end = k + 1;
                }
                _ => stages.push(k..k + 1),
            }
        }
        stages
    }

    /// True if load steps add or remove bodies or contacts.
    pub fn has_stages(&self) -> bool {
        self.steps
            .iter()
            .any(|step| step.absent != Default::default())
    }

    /// The names of the absent bodies and contacts in load step k; contacts of absent bodies needn't be listed.
    pub fn absent_in(&self, k: usize) -> Vec<String> {
        let Some(Absent { bodies, contacts }) = self.steps.get(k).map(|step| &step.absent) else {
            return Vec::new();
        };
        let bodies = bodies.iter().map(|&b| &self.bodies[b as usize].name);
        let contacts = contacts.iter().map(|&c| &self.contacts[c as usize].name);
        bodies.chain(contacts).cloned().collect()
    }

    /// True if a contact point is active in load step k.
    pub fn is_there(&self, point: &ContactPoint<SubdomainNode>, k: usize) -> bool {
        self.are_there(point.contact, &point.entries, k)
    }

    /// True if a contact and bodies with these nodes are active in load step k.
    fn are_there(&self, contact: u32, entries: &[(SubdomainNode, f64)], k: usize) -> bool {
        let Some(absent) = self.steps.get(k).map(|step| &step.absent) else {
            return true;
        };
        let mut bodies = entries
            .iter()
            .map(|(at, _)| self.subdomains[at.subdomain as usize].body);
        !absent.contacts.contains(&contact)
            && bodies.all(|body| !absent.bodies.contains(&(body as u32)))
    }

    /// The problem of the load steps of a stage. Jumps are relative to those at the activation of points, `since` by
    /// their indices in this catalog (m); to zero if it is empty.
    pub fn stage(&self, steps: Range<usize>, since: &[[f64; 3]]) -> Stage<'_> {
        let k = steps.start;
        let all = 0..self.points.len();
        let points: Vec<usize> = all.filter(|&j| self.is_there(&self.points[j], k)).collect();
        let is_whole = points.len() == self.points.len();
        let absent = self
            .steps
            .get(k)
            .map(|step| &step.absent.bodies[..])
            .unwrap_or_default();
        if is_whole && absent.is_empty() && since.is_empty() {
            return Stage {
                steps,
                catalog: Cow::Borrowed(self),
                points,
            };
        }
        let mut catalog = self.clone();
        for &body in absent {
            catalog.bodies[body as usize].is_absent = true;
        }
        catalog.keep_points(&points);
        for (point, &j) in catalog.points.iter_mut().zip(&points) {
            point.since = since.get(j).copied().unwrap_or_default();
            if !point.is_absolute {
                point.gap += dot(point.since, point.normal());
            }
        }
        // A contact activated later has its gap relative to the position at its activation, which probes don't know.
        let came = points
            .iter()
            .filter(|&&j| since.get(j).is_some_and(|since| *since != [0.0; 3]));
        let came: HashSet<u32> = came.map(|&j| self.points[j].contact).collect();
        catalog.probes.retain(|probe| {
            !came.contains(&probe.contact) && self.are_there(probe.contact, &probe.entries, k)
        });
        Stage {
            steps,
            catalog: Cow::Owned(catalog),
            points,
        }
    }

    /// Removes all contact points except these, whose indices ascend.
    fn keep_points(&mut self, points: &[usize]) {
        self.points = points.iter().map(|&j| self.points[j].clone()).collect();
        self.point_nodes = (points.iter())
            .map(|&j| self.point_nodes[j].clone())
            .collect();
        let mut first = 0;
        for count in &mut self.groups {
            let end = first + *count;
            *count = points.partition_point(|&j| j < end) - points.partition_point(|&j| j < first);
            first = end;
        }
    }
}

impl Stage<'_> {
    /// The stage with only these of its contact points, whose indices in the catalog of the whole problem ascend.
    #[must_use]
    pub fn with_points(&self, points: &[usize]) -> Self {
        let kept: Vec<usize> = (self.points.iter().enumerate())
            .filter(|(_, place)| points.binary_search(place).is_ok())
            .map(|(j, _)| j)
            .collect();
        let mut catalog = Catalog::clone(&self.catalog);
        catalog.keep_points(&kept);
        Self {
            steps: self.steps.clone(),
            catalog: Cow::Owned(catalog),
            points: kept.into_iter().map(|j| self.points[j]).collect(),
        }
    }

    /// The stage without friction.
    #[must_use]
    pub fn frictionless(&self) -> Self {
        let mut catalog = Catalog::clone(&self.catalog);
        for point in &mut catalog.points {
            if point.law.has_friction() {
                point.law = Law::Frictionless;
            }
        }
        Self {
            steps: self.steps.clone(),
            catalog: Cow::Owned(catalog),
            points: self.points.clone(),
        }
    }
}
