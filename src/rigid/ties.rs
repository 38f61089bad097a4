//! Ties in the rigid-body analysis: each is two opposite unilateral constraints.

use std::collections::BTreeMap;

use super::bodies::compressed;
use super::scene::{Friction, RigidRow, Scene};
use crate::vector::{axpy, largest};

/// Row of ties between the same bodies, relative to the largest one, that is round-off of others.
const ROUND_OFF: f64 = 1e-12;

impl Scene {
    /// The constraints of contacts, then the fewest constraints equivalent to the ties, each in both directions.
    pub(super) fn two_sided_rows(&self) -> Vec<RigidRow> {
        let mut place = 0;
        let places: Vec<usize> = (self.rows.iter())
            .map(|row| {
                place += usize::from(!row.is_tied);
                place.saturating_sub(1)
            })
            .collect();
        let renumbered = |row: &RigidRow| RigidRow {
            friction: row.friction.map(|friction| Friction {
                normal: places[friction.normal],
                ..friction
            }),
            ..row.clone()
        };
        let others = self.rows.iter().filter(|row| !row.is_tied);
        let mut rows: Vec<RigidRow> = others.map(renumbered).collect();
        for (bodies, of_bodies) in self.ties() {
            rows.extend(joined(&bodies, of_bodies));
        }
        rows
    }

    /// The constraints of ties by the bodies that they connect: actions body by body, the jump last.
    fn ties(&self) -> BTreeMap<Vec<usize>, Vec<Vec<f64>>> {
        let mut ties: BTreeMap<Vec<usize>, Vec<Vec<f64>>> = BTreeMap::new();
        for row in self.rows.iter().filter(|row| row.is_tied) {
            let mut of_bodies: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
            for (body, action) in &row.bodies {
                let sum = (of_bodies.entry(*body)).or_insert_with(|| vec![0.0; action.len()]);
                axpy(1.0, action, sum);
            }
            let bodies: Vec<usize> = of_bodies.keys().copied().collect();
            let actions = of_bodies.into_values().flatten().chain([row.gap]);
            ties.entry(bodies).or_default().push(actions.collect());
        }
        ties
    }
}

/// The ties between the same bodies, reduced to at most as many constraints as these have motions, each in both
/// directions.
fn joined(bodies: &[usize], of_bodies: Vec<Vec<f64>>) -> Vec<RigidRow> {
    let entries = of_bodies.first().map_or(0, Vec::len);
    let modes = (entries - 1) / bodies.len();
    let rows = compressed(of_bodies, entries);
    let size = |row: &[f64]| largest(&row[..entries - 1]);
    let nothing = ROUND_OFF * rows.iter().map(|row| size(row)).fold(0.0, f64::max);
    let both = rows
        .iter()
        .filter(|row| size(row) > nothing)
        .flat_map(|row| {
            [1.0, -1.0].map(|sign| {
                let actions = row[..entries - 1].chunks(modes);
                let turned = actions.map(|part| part.iter().map(|a| sign * a).collect());
                RigidRow {
                    bodies: bodies.iter().copied().zip(turned).collect(),
                    gap: sign * row[entries - 1],
                    friction: None,
                    is_tied: true,
                }
            })
        });
    both.collect()
}
