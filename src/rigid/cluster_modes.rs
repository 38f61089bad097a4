//! Contact constraints in the rigid-body motions of the bodies that lie wholly in a cluster.

use contact_dd_partition::id::{ClusterId, GroupId, OnPairs};
use faer::Mat;
use nalgebra::DMatrix;

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
        let against = |rows: &mut dyn Iterator<Item = RigidRow>| {
            let sparse: Vec<SparseRow> = rows.map(|row| kinematics.sparse_row(&row)).collect();
            let mut b = DMatrix::zeros(sparse.len(), columns.len());
            for (j, row) in sparse.iter().enumerate() {
                // The jump of a motion along a contact's surface is round-off.
                let largest = row
                    .iter()
                    .fold(0.0, |m: f64, (_, entry)| m.max(entry.abs()));
                for &(i, entry) in row {
                    if let Some(at) = place[i]
                        && entry.abs() > ROUND_OFF * largest
                    {
                        b[(j, at)] = entry;
                    }
                }
            }
            b
        };
        let mut rows = against(&mut conditions.iter().map(|&j| self.rows[j].clone()));
        let mut load = kinematics.load(&self.bodies).select_rows(&columns);
        let pins = fixing_dofs.iter();
        let pins = pins.filter_map(|pin| self.fixing_row(pin, &own));
        // Ties restrict the motions as well.
        let ties = self.rows.iter().filter(|row| row.is_tied).cloned();
        let pinned = against(&mut pins.chain(ties));
        if pinned.iter().any(|&p| p != 0.0) {
            let kept = null_space(&pinned);
            (rows, load) = (rows * &kept, kept.transpose() * load);
        }
        RigidModes {
            rows: Mat::from_fn(rows.nrows(), rows.ncols(), |i, k| rows[(i, k)]),
            load: load.iter().copied().collect(),
        }
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
