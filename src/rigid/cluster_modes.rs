//! Contact constraints in the rigid-body motions of the bodies that lie wholly in a cluster.

use std::collections::BTreeMap;

use contact_dd_partition::disjoint_sets::DisjointSets;
use contact_dd_partition::id::{ClusterId, GroupId, OnPairs};
use faer::Mat;
use nalgebra::{DMatrix, DVector};

use super::kinematics::Kinematics;
use super::many_bodies::SparseRow;
use super::null_space::null_space;
use super::scene::{RigidRow, Scene};
use crate::context::Context;
use crate::fem::assembly::FixingDof;
use crate::interface::rigid_modes::RigidModes;

/// Jump of a constraint in a motion, relative to others, that counts as zero.
const ROUND_OFF: f64 = 1e-9;

impl Scene {
    /// The constraints with these numbers in the motions that supports leave to the bodies, and the load along these
    /// motions.
    pub fn against(&self, conditions: &[usize]) -> RigidModes {
        let kinematics = Kinematics::new(self.dim, &self.bodies);
        self.drive(&kinematics, conditions, &[], |_| true)
    }

    /// These constraints and the load for the motions of some `bodies` alone, restricted to those that leave the
    /// `fixing_dofs` in place: if other constraints hold a body's neighbours, moving its fixing dof costs energy.
    fn drive(
        &self,
        kinematics: &Kinematics,
        conditions: &[usize],
        fixing_dofs: &[FixingDof],
        bodies: impl Fn(usize) -> bool,
    ) -> RigidModes {
        let own: Vec<usize> = (0..self.bodies.len()).filter(|&b| bodies(b)).collect();
        let columns: Vec<usize> = own.iter().flat_map(|&b| kinematics.unknowns(b)).collect();
        let mut place = vec![None; kinematics.len];
        for (at, &column) in columns.iter().enumerate() {
            place[column] = Some(at);
        }
        let along = |row: &RigidRow| -> SparseRow {
            let sparse = kinematics.sparse_row(row);
            // The jump of a motion along a contact's surface is round-off.
            let largest = sparse.iter().fold(0.0, |m: f64, (_, x)| m.max(x.abs()));
            let significant = sparse.iter().filter(|(_, x)| x.abs() > ROUND_OFF * largest);
            let own = significant.filter_map(|&(i, x)| Some((place[i]?, x)));
            own.collect()
        };
        let mut rows = DMatrix::zeros(conditions.len(), columns.len());
        for (j, &condition) in conditions.iter().enumerate() {
            for (i, entry) in along(&self.rows[condition]) {
                rows[(j, i)] = entry;
            }
        }
        let load = kinematics.load(&self.bodies).select_rows(&columns);
        let pins = fixing_dofs.iter();
        let pins = pins.filter_map(|pin| self.fixing_row(pin, &own));
        // Ties restrict the motions as well.
        let ties = self.rows.iter().filter(|row| row.is_tied).cloned();
        let held: Vec<SparseRow> = pins.chain(ties).map(|row| along(&row)).collect();
        within(&rows, &load, &held)
    }

    /// Displacement of a fixing dof of one of `own` bodies in the motions.
    fn fixing_row(&self, fixing_dof: &FixingDof, own: &[usize]) -> Option<RigidRow> {
        own.iter().find_map(|&b| {
            let body = &self.bodies[b];
            let mut nodes = body.candidates.iter();
            let (.., x) =
                nodes.find(|(s, n, _)| (*s, *n) == (fixing_dof.subdomain, fixing_dof.node))?;
            let axis = std::array::from_fn(|k| f64::from(k == fixing_dof.component as usize));
            Some(RigidRow {
                bodies: vec![(b, body.frame.action(self.dim, x, &axis))],
                gap: 0.0,
                friction: None,
                is_tied: false,
            })
        })
    }

    /// The numbers of the constraints of these groups.
    pub fn conditions_of(&self, groups: &[GroupId]) -> Vec<usize> {
        let of_group = |&g: &GroupId| {
            let first: usize = self.conditions[..g.index()].iter().sum();
            first..first + self.conditions[g.index()]
        };
        groups.iter().flat_map(of_group).collect()
    }
}

/// The jumps `rows` in motions that are 0 along those `held`, and the `load` along these. Motions that nothing holds stay
/// apart; those held together are combined into as few as have jumps: of a motion without any, round-off would be all that
/// tells its load.
fn within(rows: &DMatrix<f64>, load: &DVector<f64>, held: &[SparseRow]) -> RigidModes {
    let n = rows.ncols();
    let mut sets = DisjointSets::new(n);
    for row in held {
        for pair in row.windows(2) {
            sets.unite(pair[0].0 as u32, pair[1].0 as u32);
        }
    }
    let mut of_sets: BTreeMap<u32, (Vec<usize>, Vec<&SparseRow>)> = BTreeMap::new();
    for i in 0..n {
        of_sets.entry(sets.find(i as u32)).or_default().0.push(i);
    }
    for row in held {
        if let Some(&(first, _)) = row.first() {
            let of_set = of_sets.entry(sets.find(first as u32)).or_default();
            of_set.1.push(row);
        }
    }
    let mut motions: Vec<(Vec<f64>, f64)> = Vec::new();
    for (columns, held) in of_sets.values() {
        let (own, own_load) = (rows.select_columns(columns), load.select_rows(columns));
        if held.is_empty() {
            let kept = own.column_iter().zip(own_load.iter());
            motions.extend(kept.map(|(jumps, &load)| (jumps.iter().copied().collect(), load)));
            continue;
        }
        let mut b = DMatrix::zeros(held.len(), columns.len());
        for (j, (i, entry)) in held
            .iter()
            .enumerate()
            .flat_map(|(j, row)| row.iter().map(move |of| (j, of)))
        {
            if let Ok(at) = columns.binary_search(i) {
                b[(j, at)] = *entry;
            }
        }
        let kept = null_space(&b);
        if kept.is_empty() {
            continue;
        }
        let jumps = jumps_of(&own, &kept);
        let moving = &kept * null_space(&null_space(&jumps).transpose());
        let (jumps, load) = (jumps_of(&own, &moving), moving.transpose() * own_load);
        let of_set = jumps.column_iter().zip(load.iter());
        motions.extend(of_set.map(|(jumps, &load)| (jumps.iter().copied().collect(), load)));
    }
    RigidModes {
        rows: Mat::from_fn(rows.nrows(), motions.len(), |i, k| motions[k].0[i]),
        load: motions.iter().map(|(_, load)| *load).collect(),
    }
}

/// The jumps in `motions`, without the round-off of those that cancel.
fn jumps_of(rows: &DMatrix<f64>, motions: &DMatrix<f64>) -> DMatrix<f64> {
    let (jumps, sizes) = (rows * motions, rows.abs() * motions.abs());
    jumps.zip_map(&sizes, |jump, size| match jump.abs() > ROUND_OFF * size {
        true => jump,
        false => 0.0,
    })
}

/// Constraints of every cluster in contact of this rank in the motions of the bodies wholly in it that leave the
/// `fixing_dofs` in place. Collective; `scene` is used on the root only.
pub(super) fn cluster_modes(
    context: &Context<'_>,
    scene: &Scene,
    fixing_dofs: &[FixingDof],
) -> OnPairs<RigidModes> {
    let Context { catalog, plan, .. } = *context;
    let mut home: Vec<Option<ClusterId>> = vec![None; catalog.bodies.len()];
    let mut elsewhere = vec![false; catalog.bodies.len()];
    let clusters = plan.clusters_of_blocks();
    for (subdomain, &cluster) in catalog.subdomains.iter().zip(&clusters) {
        let known = home[subdomain.body].get_or_insert(cluster);
        elsewhere[subdomain.body] |= *known != cluster;
    }
    let kinematics = Kinematics::new(scene.dim, &scene.bodies);
    context.comm.scattered(&plan.pair_owners(), |p| {
        let cluster = plan.pairs[p];
        let conditions = scene.conditions_of(&plan.clusters[cluster].groups);
        // A cluster that leaves its nodes to the interface problem has no such motions: bodies move these nodes.
        let inside = !plan.leaves_its_nodes(plan.clusters[cluster].node);
        let within = |body: usize| inside && !elsewhere[body] && home[body] == Some(cluster);
        scene.drive(&kinematics, &conditions, fixing_dofs, within)
    })
}
