//! Nodes whose obstacles and supports are contradictory.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;
use nalgebra::{DMatrix, DVector};

use crate::error::Failure;
use crate::fem::contact_group::{ContactGroup, GroupLoads};
use crate::rigid::nonnegative::residual;

/// Largest overlap of obstacles, relative to the gaps and prescribed displacements.
const OVERLAP: f64 = 1e-9;

/// ‖r‖ up to which constraints count as contradictory; it is 1 at most.
const CONTRADICTORY: f64 = 1e-6;

/// n·u ≤ g.
type HalfSpace = ([f64; 3], f64);

/// Checks that every node with several obstacles can satisfy them and its supports at once.
///
/// # Errors
/// The first node that can't, with its contacts.
pub fn check(group: &ContactGroup, loads: &GroupLoads, catalog: &Catalog) -> Result<(), Failure> {
    let mut at_node: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (j, point) in group.points.iter().enumerate() {
        let of_bodies = |(node, _): &&(u32, f64)| !group.nodes[*node as usize].is_auxiliary;
        let mut nodes = point.entries.iter().filter(of_bodies);
        let is_rigid = !point.law.is_tied() && !point.is_compliant();
        if let (Some((node, _)), None, true) = (nodes.next(), nodes.next(), is_rigid) {
            at_node.entry(*node).or_default().push(j);
        }
    }
    for (node, at) in at_node {
        let of_points = at
            .iter()
            .map(|&j| (j, group.points[j].normal()))
            .map(|(j, n)| (n, loads.gaps[j] - group.moved(j, n, loads)));
        let contact_node = &group.nodes[node as usize];
        let supports = contact_node.supports.iter().zip(&loads.held[node as usize]);
        let held = supports.flat_map(|(&(d, _), &value)| [(d, value), (d.map(|c| -c), -value)]);
        let all: Vec<HalfSpace> = of_points.chain(held).collect();
        if at.len() > 1 && !leave_a_place(&all) {
            let names = at.iter().map(|&j| group.points[j].contact as usize);
            let names: Vec<String> = names
                .map(|contact| format!("'{}'", catalog.contacts[contact].name))
                .collect();
            return Err(Failure::input(format!(
                "contact {}: supports and obstacles contradict each other at node {}; expected displacements \
                 that the obstacles leave room for",
                names.join(" and "),
                contact_node.tag
            )));
        }
    }
    Ok(())
}

/// True if some u lies in all half spaces. Otherwise, by Farkas' lemma, λ ≥ 0 exist with Σ λ n = 0 and Σ λ g < 0.
fn leave_a_place(half_spaces: &[HalfSpace]) -> bool {
    let scale = half_spaces
        .iter()
        .fold(0.0, |m, (_, g)| f64::max(m, g.abs()));
    if scale == 0.0 {
        return true;
    }
    let a = DMatrix::from_fn(4, half_spaces.len(), |i, j| match half_spaces[j] {
        (n, _) if i < 3 => n[i],
        (_, g) => g / scale + OVERLAP,
    });
    let b = DVector::from_vec(vec![0.0, 0.0, 0.0, -1.0]);
    residual(&a, &b).norm() > CONTRADICTORY
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(degrees: f64, gap: f64) -> HalfSpace {
        let (y, x) = degrees.to_radians().sin_cos();
        ([x, y, 0.0], gap)
    }

    #[test]
    fn walls_leave_a_place_unless_they_overlap() {
        for (walls, expected) in [
            (vec![along(0.0, -0.1), along(180.0, 0.2)], true),
            (vec![along(0.0, -0.1), along(180.0, 0.1)], true),
            (vec![along(0.0, -0.2), along(180.0, 0.1)], false),
            (vec![along(0.0, -0.2), along(90.0, -0.2)], true),
            (vec![along(0.0, 0.0), along(180.0, 0.0)], true),
            (vec![along(0.0, 1e-9), along(180.0, -1.0)], false),
            // Three walls around a point, each at a distance of 1 on either side.
            (
                vec![along(0.0, 1.0), along(120.0, 1.0), along(240.0, 1.0)],
                true,
            ),
            (
                vec![along(0.0, -1.0), along(120.0, 0.4), along(240.0, 0.4)],
                false,
            ),
            (
                vec![along(10.0, -1e30), along(130.0, 5e29), along(250.0, 6e29)],
                true,
            ),
        ] {
            assert_eq!(leave_a_place(&walls), expected, "{walls:?}");
        }
    }
}
