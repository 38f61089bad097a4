//! Clusters of merged blocks, with the contacts within them.

use std::rc::Rc;

use contact_dd_partition::id::{OnPairs, OnTreeNodes};
use faer::Mat;

use crate::condense::blocks::{CondensedBlocks, ContactCluster};
use crate::contact::limits::Limits;
use crate::interface::rigid_modes::{RigidBasis, RigidModes};
use crate::plan::Plan;
use crate::schur::condensed::Condensed;

/// The clusters of this rank from the `merged` nodes; of those in contact, `modes` are their constraints in the rigid
/// motions of bodies that lie wholly in them, and `limits` are the bounds of the normal jumps.
pub fn take_clusters(
    plan: &Plan,
    modes: &OnPairs<RigidModes>,
    mut limits: OnPairs<Limits>,
    mut merged: OnTreeNodes<Condensed>,
    condensed: &mut CondensedBlocks,
) {
    for (c, cluster) in plan.clusters.each() {
        let Some(mut of_cluster) = merged.remove(&cluster.node) else {
            continue;
        };
        let Some(p) = plan.pair_of(c) else {
            condensed.linear.insert(c, of_cluster);
            continue;
        };
        let limits = limits.remove(&p).unwrap_or_default();
        of_cluster.fill_upper_triangle();
        if let Some(modes) = modes.get(&p) {
            make_stiffness_exact(&mut of_cluster, &limits.defining, modes);
        }
        let cluster = ContactCluster {
            condensed: Rc::new(of_cluster),
            limits,
        };
        condensed.contact.insert(p, cluster);
    }
}

/// Makes S exact along rigid motions of bodies that lie wholly in the cluster; `modes` are its constraints in these
/// motions, and the `defining` ones are its normal jumps.
fn make_stiffness_exact(cluster: &mut Condensed, defining: &[usize], modes: &RigidModes) {
    let m = defining.len();
    let Some(basis) = basis(defining, modes, &cluster.diagonal[..m]) else {
        return;
    };
    let s = &mut cluster.s;
    let mut h = s.submatrix(0, 0, m, m).to_owned();
    basis.remove_energy(&mut h);
    s.submatrix_mut(0, 0, m, m).copy_from(&h);
    for j in m..s.ncols() {
        let mut column: Vec<f64> = (0..m).map(|i| s[(i, j)]).collect();
        basis.remove_load(&mut column);
        for (i, value) in column.into_iter().enumerate() {
            s[(i, j)] = value;
            s[(j, i)] = value;
        }
    }
}

/// Makes the `load` on the normal jumps exact along these motions; `diagonal` is that of the matrix from which they are
/// condensed.
pub fn make_load_exact(load: &mut [f64], defining: &[usize], modes: &RigidModes, diagonal: &[f64]) {
    if let Some(basis) = basis(defining, modes, diagonal) {
        basis.set_load(load);
    }
}

/// The motions of `modes` by their normal jumps; `None` if there is none.
fn basis(defining: &[usize], modes: &RigidModes, diagonal: &[f64]) -> Option<RigidBasis> {
    let columns = modes.rows.ncols();
    if columns == 0 {
        return None;
    }
    let of_jumps = RigidModes {
        rows: Mat::from_fn(defining.len(), columns, |i, k| modes.rows[(defining[i], k)]),
        load: modes.load.clone(),
    };
    Some(RigidBasis::new(&of_jumps, diagonal))
}
