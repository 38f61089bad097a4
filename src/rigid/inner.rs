//! Contact conditions against the rigid motions of the bodies that lie wholly in a pair.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;
use faer::Mat;

use super::analysis::Scene;
use super::energy::RigidDrive;
use super::kinematics::Kinematics;
use crate::comm::{Comm, Message};
use crate::plan::Plan;

/// How far a motion moves a condition, relative to others, that is none.
const ROUND_OFF: f64 = 1e-9;

impl Scene {
    /// The conditions with these numbers against the motions that supports leave to the bodies, and
    /// the load along these.
    pub fn against(&self, conditions: &[usize]) -> RigidDrive {
        let kinematics = Kinematics::new(self.dim, &self.bodies);
        self.drive(&kinematics, conditions, |_| true)
    }

    fn drive(
        &self,
        kinematics: &Kinematics,
        conditions: &[usize],
        bodies: impl Fn(usize) -> bool,
    ) -> RigidDrive {
        let rows: Vec<_> = conditions.iter().map(|&j| self.rows[j].clone()).collect();
        let mut b = kinematics.rows(&rows);
        // A motion along a side moves it nowhere but by round-off.
        for mut row in b.row_iter_mut() {
            let round_off = ROUND_OFF * row.amax();
            row.apply(|entry| *entry = if entry.abs() > round_off { *entry } else { 0.0 });
        }
        let load = kinematics.load(&self.bodies);
        let columns: Vec<usize> = (0..self.bodies.len())
            .filter(|&body| bodies(body))
            .flat_map(|body| kinematics.unknowns(body))
            .collect();
        RigidDrive {
            rows: Mat::from_fn(rows.len(), columns.len(), |i, k| b[(i, columns[k])]),
            load: columns.iter().map(|&k| load[k]).collect(),
        }
    }

    /// The number of the first condition of every pair, and that of all.
    pub fn first_conditions(&self) -> Vec<usize> {
        let mut first = vec![0];
        for count in &self.conditions {
            first.push(first[first.len() - 1] + count);
        }
        first
    }
}

/// For every pair of this rank, its conditions against the motions of the bodies wholly in it.
/// Collective; `scene` counts on the root alone.
pub(super) fn inner_motions(
    comm: &Comm,
    scene: &Scene,
    catalog: &Catalog,
    plan: &Plan,
) -> BTreeMap<usize, RigidDrive> {
    let mut home: Vec<Option<usize>> = vec![None; catalog.bodies.len()];
    let mut scattered = vec![false; catalog.bodies.len()];
    for (subdomain, &block) in catalog.subdomains.iter().zip(&plan.block_of) {
        let known = home[subdomain.body].get_or_insert(block);
        scattered[subdomain.body] |= *known != block;
    }
    let first = scene.first_conditions();
    let kinematics = Kinematics::new(scene.dim, &scene.bodies);
    let mut motions = BTreeMap::new();
    comm.scatter(
        &plan.pair_owners(),
        |p| {
            let conditions: Vec<usize> = (first[p]..first[p + 1]).collect();
            let within = |body: usize| !scattered[body] && home[body] == Some(plan.pairs[p]);
            let drive = scene.drive(&kinematics, &conditions, within);
            let mut message = Message {
                integers: vec![drive.rows.nrows() as i64, drive.rows.ncols() as i64],
                reals: drive.load,
            };
            message.push_matrix(drive.rows.as_ref());
            message
        },
        |p, message| {
            let mut reader = message.read();
            let (rows, columns) = (reader.count(), reader.count());
            let load = reader.reals(columns);
            let rows = reader.matrix(rows, columns);
            motions.insert(p, RigidDrive { rows, load });
        },
    );
    motions
}
