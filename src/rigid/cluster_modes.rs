//! Contact conditions against the rigid motions of the bodies that lie wholly in a cluster.

use std::collections::BTreeMap;

use faer::Mat;

use super::analysis::{FixingDof, RigidRow, Scene};
use super::energy::RigidModes;
use super::kinematics::{Kinematics, null_space};
use crate::context::Context;

/// How far a motion moves a condition, relative to others, that is none.
const ROUND_OFF: f64 = 1e-9;

impl Scene {
    /// The conditions with these numbers against the motions that supports leave to the bodies, and
    /// the load along these.
    pub fn against(&self, conditions: &[usize]) -> RigidModes {
        let kinematics = Kinematics::new(self.dim, &self.bodies);
        self.drive(&kinematics, conditions, &[], |_| true)
    }

    /// The same for the motions of some `bodies` alone, as far as they leave the `fixing_dofs` where they are:
    /// others may hold a body's neighbours, and then it costs energy to move its pin.
    fn drive(
        &self,
        kinematics: &Kinematics,
        conditions: &[usize],
        fixing_dofs: &[FixingDof],
        bodies: impl Fn(usize) -> bool,
    ) -> RigidModes {
        let rows: Vec<_> = conditions.iter().map(|&j| self.rows[j].clone()).collect();
        let mut b = kinematics.rows(&rows);
        // A motion along a side moves it nowhere but by round-off.
        for mut row in b.row_iter_mut() {
            let round_off = ROUND_OFF * row.amax();
            row.apply(|entry| *entry = if entry.abs() > round_off { *entry } else { 0.0 });
        }
        let columns: Vec<usize> = (0..self.bodies.len())
            .filter(|&body| bodies(body))
            .flat_map(|body| kinematics.unknowns(body))
            .collect();
        let (mut rows, mut load) = (b.select_columns(&columns), kinematics.load(&self.bodies));
        load = load.select_rows(&columns);
        let pinned = kinematics.rows(
            &fixing_dofs
                .iter()
                .filter_map(|fixing_dof| self.fixing_row(fixing_dof))
                .collect::<Vec<_>>(),
        );
        let pinned = pinned.select_columns(&columns);
        if pinned.iter().any(|&p| p != 0.0) {
            let kept = null_space(&pinned);
            (rows, load) = (rows * &kept, kept.transpose() * load);
        }
        RigidModes {
            rows: Mat::from_fn(rows.nrows(), rows.ncols(), |i, k| rows[(i, k)]),
            load: load.iter().copied().collect(),
        }
    }

    /// How motions move a pin.
    fn fixing_row(&self, fixing_dof: &FixingDof) -> Option<RigidRow> {
        self.bodies.iter().enumerate().find_map(|(b, body)| {
            let mut nodes = body.candidates.iter();
            let (.., x) =
                nodes.find(|(s, n, _)| (*s, *n) == (fixing_dof.subdomain, fixing_dof.node))?;
            let axis = std::array::from_fn(|k| f64::from(k == fixing_dof.component as usize));
            Some(RigidRow {
                bodies: vec![(b, body.frame.action(self.dim, x, &axis))],
                gap: 0.0,
                friction: None,
            })
        })
    }

    /// The numbers of the conditions of these groups.
    pub fn conditions_of(&self, groups: &[usize]) -> Vec<usize> {
        let of_group = |&g: &usize| {
            let first: usize = self.conditions[..g].iter().sum();
            first..first + self.conditions[g]
        };
        groups.iter().flat_map(of_group).collect()
    }
}

/// For every cluster in contact of this rank, its conditions against the motions of the bodies wholly
/// in it that leave the `fixing_dofs` where they are. Collective; `scene` counts on the root alone.
pub(super) fn cluster_modes(
    context: &Context<'_>,
    scene: &Scene,
    fixing_dofs: &[FixingDof],
) -> BTreeMap<usize, RigidModes> {
    let Context { catalog, plan, .. } = *context;
    let mut home: Vec<Option<usize>> = vec![None; catalog.bodies.len()];
    let mut elsewhere = vec![false; catalog.bodies.len()];
    let clusters = plan.clusters_of_blocks();
    for (subdomain, &cluster) in catalog.subdomains.iter().zip(&clusters) {
        let known = home[subdomain.body].get_or_insert(cluster);
        elsewhere[subdomain.body] |= *known != cluster;
    }
    let kinematics = Kinematics::new(scene.dim, &scene.bodies);
    let mut motions = BTreeMap::new();
    context.comm.scatter(
        &plan.contact_owners(),
        |p| {
            let cluster = plan.contact[p];
            let conditions = scene.conditions_of(&plan.clusters[cluster].groups);
            // Where the cluster leaves its nodes to the interface problem, bodies move these.
            let inside = !plan.leaves_its_nodes(plan.clusters[cluster].node);
            let within = |body: usize| inside && !elsewhere[body] && home[body] == Some(cluster);
            scene.drive(&kinematics, &conditions, fixing_dofs, within)
        },
        |p, drive| {
            motions.insert(p, drive);
        },
    );
    motions
}
