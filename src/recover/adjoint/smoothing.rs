//! The largest pressure of a contact, smoothed over a length.
//!
//! With the distance r of two points and k = max(0, 1 − r/length), the smoothed pressure at a point is Σ k λ / Σ k A
//! over all points with their forces λ and areas A: the mean pressure in a window whose weights fall to its rim. On a
//! finer mesh the weights within the facets count, too: the pressure with weights averaged over the neighbours of each
//! point, as those of a consistent mass matrix, tells how much that may change.

use std::collections::HashMap;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::{difference, length};
use contact_dd_partition::id::GroupId;
use contact_dd_partition::problem::{Catalog, SubdomainNode};
use contact_dd_partition::quantity::Quantity;

use super::contact_edges::neighbours;
use super::functional::Functional;
use super::solved::Solved;
use crate::bytes::Reals;

/// The part of the difference that averaged weights make which is added to the bar.
const OF_WINDOW: f64 = 0.5;

/// The points of a contact, along the axis in which they extend farthest.
struct Surface<'a> {
    catalog: &'a Catalog,
    /// The axis.
    axis: usize,
    /// The indices of the points in the catalog, in the order of their positions along the axis.
    order: Vec<usize>,
    /// The length over which pressures are smoothed (m).
    length: f64,
}

impl<'a> Surface<'a> {
    fn new(catalog: &'a Catalog, quantity: &Quantity) -> Self {
        let is_of = |place: &usize| catalog.points[*place].contact == quantity.of[0];
        let mut order: Vec<usize> = (0..catalog.points.len()).filter(is_of).collect();
        let along = |place: usize, axis: usize| catalog.points[place].position[axis];
        let extent = |axis: usize| {
            let all = order.iter().map(|&place| along(place, axis));
            let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            high - low
        };
        let axes = (0..3).map(|axis| (axis, extent(axis)));
        let axis = axes
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(0, |(axis, _)| axis);
        order.sort_by(|&a, &b| along(a, axis).total_cmp(&along(b, axis)).then(a.cmp(&b)));
        Self {
            catalog,
            axis,
            order,
            length: quantity.length,
        }
    }

    fn point(&self, place: usize) -> &'a ContactPoint<SubdomainNode> {
        &self.catalog.points[place]
    }

    /// The weights k of the points around one, by their indices in the catalog.
    fn around(&self, center: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let at = self.point(center).position;
        let low = at[self.axis] - self.length;
        let first =
            (self.order).partition_point(|&place| self.point(place).position[self.axis] < low);
        let near = move |&&place: &&usize| {
            self.point(place).position[self.axis] <= at[self.axis] + self.length
        };
        let weight = move |&place: &usize| {
            let distance = length(difference(self.point(place).position, at));
            (place, (1.0 - distance / self.length).max(0.0))
        };
        self.order[first..].iter().take_while(near).map(weight)
    }

    /// Σ k A around a point.
    fn area_around(&self, center: usize) -> f64 {
        self.around(center)
            .map(|(place, k)| k * self.point(place).area)
            .sum()
    }

    /// The smoothed pressure around a point with weights averaged over neighbours, ⅔ k + ⅓ of the mean of theirs.
    fn averaged(&self, forces: &[f64], center: usize) -> f64 {
        let mut own = vec![0.0; self.order.len()];
        let at: Vec<[f64; 3]> = (self.order.iter())
            .map(|&place| self.point(place).position)
            .collect();
        let number: HashMap<usize, usize> = (self.order.iter().enumerate())
            .map(|(i, &place)| (place, i))
            .collect();
        for (place, k) in self.around(center) {
            own[number[&place]] = k;
        }
        let mut beside = vec![(0.0, 0.0); own.len()];
        for (i, j) in neighbours(&at) {
            for (i, j) in [(i, j), (j, i)] {
                beside[i] = (beside[i].0 + own[j], beside[i].1 + 1.0);
            }
        }
        let (mut force, mut area) = (0.0, 0.0);
        for ((&place, k), (sum, count)) in self.order.iter().zip(own).zip(beside) {
            let k = match count > 0.0 {
                true => (2.0 * k + sum / count) / 3.0,
                false => k,
            };
            force += k * forces[place];
            area += k * self.point(place).area;
        }
        force / area
    }

    /// The largest smoothed pressure of forces, by indices in the catalog, and its point.
    fn largest(&self, forces: &[f64]) -> Option<(f64, usize)> {
        let pressure = |&center: &usize| {
            let force: f64 = self
                .around(center)
                .map(|(place, k)| k * forces[place])
                .sum();
            (force / self.area_around(center), center)
        };
        let all = self.order.iter().map(pressure);
        all.reduce(|a, b| if b.0 > a.0 { b } else { a })
    }
}

impl Functional {
    /// Finds the point with the largest smoothed pressure. Collective.
    pub(super) fn find_smoothed(&mut self, solved: Solved<'_>, quantity: &Quantity) {
        let context = &solved.fixed.context;
        let plan = context.plan;
        let surface = Surface::new(context.catalog, quantity);
        let places = |g: GroupId| &plan.tree.nodes[plan.groups[g].node].points;
        let mut forces = vec![0.0; context.catalog.points.len()];
        context.comm.gather(
            &plan.group_owners(),
            |g| {
                let of_group = &solved.solution.discrete.groups[&g].forces;
                Reals(of_group[..places(g).len()].to_vec())
            },
            |g, Reals(of_group)| {
                for (&place, force) in places(g).iter().zip(of_group) {
                    forces[place as usize] = force;
                }
            },
        );
        let is_root = context.comm.is_root();
        let mut largest = is_root.then(|| surface.largest(&forces)).flatten();
        if let Some((pressure, center)) = largest {
            self.beside = OF_WINDOW * (surface.averaged(&forces, center) - pressure).abs();
        }
        context.comm.broadcast(&mut largest);
        let Some((pressure, center)) = largest else {
            return;
        };
        (self.value, self.node) = (pressure, surface.point(center).tag());
        let area = surface.area_around(center);
        let mut shares = vec![0.0; context.catalog.points.len()];
        surface
            .around(center)
            .for_each(|(place, k)| shares[place] = k / area);
        for (&g, group) in context.groups {
            let mut weights = vec![0.0; group.conditions().count()];
            for (weight, &place) in weights.iter_mut().zip(places(g)) {
                *weight = shares[place as usize];
            }
            self.of_forces.insert(g, weights);
        }
    }
}
