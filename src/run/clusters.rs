//! Clusters: what blocks were merged into, with the contacts of all that lies in them.

use std::collections::BTreeMap;

use faer::Mat;

use super::merge::CondensedBlocks;
use crate::comm::{Comm, Message};
use crate::contact::limits::Limits;
use crate::contact::pair::ContactPair;
use crate::plan::Plan;
use crate::rigid::energy::{RigidBasis, RigidDrive};
use crate::rigid::survey::Survey;
use crate::schur::condensed::Condensed;

/// Makes the clusters of this rank of what was `merged`, once the owners of those in contact know the
/// bounds on their approaches. Collective.
pub(super) fn take_clusters(
    comm: &Comm,
    plan: &Plan,
    survey: &Survey,
    mut merged: BTreeMap<usize, Condensed>,
    condensed: &mut CondensedBlocks,
) {
    let pairs = plan.pairs_by_cluster();
    let mut limits: BTreeMap<usize, Limits> = BTreeMap::new();
    comm.route(
        plan.ways_to_clusters(),
        |i| {
            let mut message = Message::default();
            if let Some(limits) = condensed.limits.get(&pairs[i]) {
                limits.pack(&mut message);
            }
            message
        },
        |i, message| {
            limits.insert(pairs[i], Limits::unpack(&mut message.read()));
        },
    );
    for (c, cluster) in plan.clusters.iter().enumerate() {
        let Some(mut of_cluster) = merged.remove(&cluster.node) else {
            continue;
        };
        let Some(p) = plan.contact_place(c) else {
            condensed.linear.insert(c, of_cluster);
            continue;
        };
        let of_pairs = cluster.pairs.iter().filter_map(|pair| limits.remove(pair));
        let limits = Limits::join(&of_pairs.collect::<Vec<_>>());
        of_cluster.fill_upper_triangle();
        if let Some(drive) = survey.inner_motions.get(&p) {
            settle_rigid_motions(&mut of_cluster, &limits.defining, drive);
        }
        let pair = ContactPair::new(of_cluster, limits);
        condensed.pairs.insert(p, pair);
    }
}

/// Makes S and the load on approaches exact along rigid motions of the bodies that lie wholly in the
/// cluster; `drive` is that of its conditions, of which the approaches are the `defining` ones.
fn settle_rigid_motions(cluster: &mut Condensed, defining: &[usize], drive: &RigidDrive) {
    let m = defining.len();
    let columns = drive.rows.ncols();
    if columns == 0 {
        return;
    }
    let of_approaches = RigidDrive {
        rows: Mat::from_fn(m, columns, |i, k| drive.rows[(defining[i], k)]),
        load: drive.load.clone(),
    };
    let basis = RigidBasis::new(&of_approaches, &cluster.stiffness[..m]);
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
    basis.set_load(&mut cluster.load[..m]);
}
