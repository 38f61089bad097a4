//! Contact across ties: nodes that a tie joins have one displacement, and contact points at them one normal and one
//! opposite side, those of a single body.
//!
//! At the end of each tied side a normal is that of the facets on this side alone, so that two sides of a curve would
//! interlock, and a mean over facets of the other side reaches to the seam only, so that of two conditions on one
//! displacement the tighter one would carry all force.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::parts::Contact;
use super::surface::CORNER;
use crate::contact_point::{ContactPoint, LocalFrame};
use crate::disjoint_sets::DisjointSets;
use crate::element::geometry::{advance, difference, dot, length};
use crate::mesh::Mesh;

/// Norm of the difference up to which unit vectors are equal, and relative error of a measured gap.
const SAME: f64 = 1e-6;

/// Gives contact points at nodes that ties join their mean normal and, where these have several opposite nodes, their
/// mean condition, both weighted by their areas; ties that are `absent` in a load step join nothing.
pub(super) fn join(contacts: &mut [Contact], mesh: &Mesh, absent: &HashSet<u32>) {
    let mut nodes = DisjointSets::new(mesh.points.len());
    let mut joined: HashSet<u32> = HashSet::new();
    for point in contacts.iter().flat_map(|contact| &contact.points) {
        let is_tie = point.law.is_tied() && !point.is_equation();
        if let ([(a, 1.0), (b, -1.0)], true, false) =
            (&point.entries[..], is_tie, absent.contains(&point.contact))
        {
            nodes.unite(*a, *b);
            joined.extend([a, b]);
        }
    }
    let number: HashMap<i64, u32> = (joined.iter())
        .map(|&node| (mesh.node_tags[node as usize], node))
        .collect();
    let mut seams: BTreeMap<u32, Vec<Place>> = BTreeMap::new();
    for (contact, of_contact) in contacts.iter().enumerate() {
        for (point, at) in of_contact.points.iter().enumerate() {
            if let (Some(&node), false) = (number.get(&at.tag()), at.law.is_tied()) {
                let seam = seams.entry(nodes.find(node)).or_default();
                seam.push(Place {
                    contact,
                    point,
                    node,
                });
            }
        }
    }
    for (root, seam) in seams {
        let points = seam.iter().map(|at| &contacts[at.contact].points[at.point]);
        let points: Vec<ContactPoint<u32>> = points.cloned().collect();
        let tags: HashSet<i64> = points.iter().map(ContactPoint::tag).collect();
        if tags.len() != points.len() || points.len() < 2 {
            continue;
        }
        let Some(normal) = mean_normal(&points) else {
            continue;
        };
        let is_mean = points.iter().any(|point| point.entries.len() > 2);
        for (at, own) in seam.iter().zip(&points) {
            let point = &mut contacts[at.contact].points[at.point];
            if length(difference(own.normal(), normal)) > SAME {
                press_along(point, normal, mesh);
            }
            if is_mean {
                let name = |node: u32| match nodes.find(node) == root {
                    true => at.node,
                    false => node,
                };
                take_mean(point, &points, name);
            }
        }
    }
}

/// A warning of every contact that crosses a tie at nodes which hang between others of that contact.
pub(super) fn hanging(contacts: &[Contact], mesh: &Mesh) -> Vec<String> {
    let mut warnings = Vec::new();
    for contact in contacts {
        let unilateral = contact.points.iter().filter(|point| !point.law.is_tied());
        let tags: HashSet<i64> = unilateral.map(ContactPoint::tag).collect();
        let has = |node: u32| tags.contains(&mesh.node_tags[node as usize]);
        for tie in contacts {
            let hangs = |point: &&ContactPoint<u32>| {
                let others = point.entries.iter();
                let mut others = others.filter(|&&(node, weight)| {
                    weight.abs() > SAME && mesh.node_tags[node as usize] != point.tag()
                });
                let is_between = others.clone().count() > 1 && others.all(|&(node, _)| has(node));
                point.law.is_tied() && is_between && tags.contains(&point.tag())
            };
            if let Some(point) = tie.points.iter().find(hangs) {
                warnings.push(format!(
                    "contact '{}': at node {} it crosses tie '{}' between nodes of the other side of the tie, so that the \
                     pressures of single nodes there are uneven, and with cohesion or a bound of its own friction is too \
                     weak; expected nodes that match",
                    contact.name,
                    point.tag(),
                    tie.name
                ));
            }
        }
    }
    warnings
}

/// A contact point at a seam: the indices of its contact and of itself, and its node.
struct Place {
    contact: usize,
    point: usize,
    node: u32,
}

/// The mean normal of points by their areas; `None` where they are at a corner.
fn mean_normal(points: &[ContactPoint<u32>]) -> Option<[f64; 3]> {
    let weigh = |sum, point: &ContactPoint<u32>| advance(sum, point.area, point.normal());
    let sum = points.iter().fold([0.0; 3], weigh);
    let size = length(sum);
    let normal = sum.map(|c| c / size);
    let is_smooth = |point: &ContactPoint<u32>| dot(point.normal(), normal) > (0.5 * CORNER).cos();
    (size > 0.0 && points.iter().all(is_smooth)).then_some(normal)
}

/// Gives a point another normal, and measures the gap of two nodes along it unless the scene gives the gap.
pub(super) fn press_along(point: &mut ContactPoint<u32>, normal: [f64; 3], mesh: &Mesh) {
    if let [(a, _), (b, _)] = point.entries[..] {
        let offset = difference(mesh.points[b as usize], mesh.points[a as usize]);
        if (point.gap - dot(offset, point.normal())).abs() <= SAME * length(offset) {
            point.gap = dot(offset, normal);
        }
    }
    point.frame = LocalFrame::new(normal);
}

/// Gives a point the mean of the conditions of `all` points at a seam, whose nodes there are its own by `name`.
fn take_mean(
    point: &mut ContactPoint<u32>,
    all: &[ContactPoint<u32>],
    mut name: impl FnMut(u32) -> u32,
) {
    let total: f64 = all.iter().map(|of| of.area).sum();
    let mut entries: Vec<(u32, f64)> = point.entries.iter().map(|&(n, _)| (n, 0.0)).collect();
    point.gap = 0.0;
    point.is_gap_given = all.iter().all(|of| of.is_gap_given);
    point.force_point = [0.0; 3];
    for of in all {
        let share = of.area / total;
        point.gap += share * of.gap;
        point.force_point = advance(point.force_point, share, of.force_point);
        for &(node, weight) in &of.entries {
            let node = name(node);
            match entries.iter_mut().find(|(known, _)| *known == node) {
                Some((_, sum)) => *sum += share * weight,
                None => entries.push((node, share * weight)),
            }
        }
    }
    point.entries = entries;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two tied nodes whose sides end at an angle, opposite a node and two nodes.
    #[test]
    fn points_at_a_tie_have_one_normal_and_one_condition() {
        let mesh = Mesh {
            dim: 2,
            points: vec![[0.0; 3]; 5],
            node_tags: (1..=5).collect(),
            ..Mesh::default()
        };
        let at = |node: u32, opposite: &[(u32, f64)], [x, y]: [f64; 2], area: f64| {
            let mut entries = vec![(node, 1.0)];
            entries.extend(opposite);
            ContactPoint {
                gap: f64::from(node),
                area,
                ..ContactPoint::new(entries, [x, y, 0.0], [0.0; 3], i64::from(node) + 1)
            }
        };
        let mut tie = at(0, &[(1, -1.0)], [1.0, 0.0], 1.0);
        tie.law = crate::contact_point::Law::Tied;
        let points = vec![
            at(0, &[(2, -1.0)], [-0.28, -0.96], 1.0),
            at(1, &[(3, -0.25), (4, -0.75)], [0.0, -1.0], 3.0),
        ];
        let contact = |points| Contact {
            name: String::new(),
            points,
            probes: Vec::new(),
            prescribed: Vec::new(),
        };
        let mut contacts = [contact(vec![tie]), contact(points)];
        let before = contacts.clone();
        join(&mut contacts, &mesh, &HashSet::from([0]));
        assert_eq!(contacts, before);
        join(&mut contacts, &mesh, &HashSet::new());
        assert_eq!(contacts[0], before[0]);
        let size = 0.28_f64.hypot(3.96);
        for (node, point) in (0..).zip(&contacts[1].points) {
            let [x, y, _] = point.normal();
            let expected = [-0.28 / size, -3.96 / size];
            let off = (x - expected[0]).hypot(y - expected[1]);
            assert!(off < 1e-15, "{x} {y} {expected:?}");
            assert_eq!(point.gap, 0.75);
            let mut entries = point.entries.clone();
            entries.sort_by_key(|&(node, _)| node);
            let opposite = [(2, -0.25), (3, -0.1875), (4, -0.5625)];
            assert_eq!(entries, [&[(node, 1.0)][..], &opposite].concat());
        }
    }
}
