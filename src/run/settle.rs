//! Settling free motions: the solution's part along motions that nothing holds is taken out.

use std::collections::BTreeMap;

use contact_dd_partition::problem::{Catalog, Subdomain};

use super::read::OwnedBlock;
use crate::comm::{Comm, Message};
use crate::plan::Plan;
use crate::rigid::projection::MotionProducts;
use crate::rigid::survey::Survey;

/// Makes the displacement of all blocks, node by node, orthogonal to every free motion, in the
/// Euclidean sense over the nodes of the bodies that take part. Collective.
pub fn settle_free_motions(
    comm: &Comm,
    survey: &Survey,
    blocks: &BTreeMap<usize, OwnedBlock>,
    mut displacement: BTreeMap<usize, &mut Vec<f64>>,
    catalog: &Catalog,
    plan: &Plan,
) {
    let count = survey.motions.free.len();
    if count == 0 {
        return;
    }
    let dim = catalog.dim;
    let first_of = first_subdomains(catalog);
    let owners: Vec<usize> = plan
        .block_of
        .iter()
        .map(|&b| plan.blocks[b].owner)
        .collect();
    let mut total = MotionProducts::zeros(count);
    comm.gather(
        &owners,
        |s| {
            let mut products = MotionProducts::zeros(count);
            let b = plan.block_of[s];
            if let (Some(owned), Some(u)) = (blocks.get(&b), displacement.get(&b))
                && let Some(m) = owned.block.member(s)
            {
                let member = &owned.block.members[m];
                let elsewhere = counted_elsewhere(member, &first_of);
                for (local, &node) in owned.block.node_of[m].iter().enumerate() {
                    if !elsewhere[local] {
                        let moves = motions_at(survey, dim, member, &member.points[local]);
                        let start = node as usize * dim;
                        products.add_node(&moves, &u[start..start + dim]);
                    }
                }
            }
            Message {
                integers: Vec::new(),
                reals: [products.gram, products.displacement].concat(),
            }
        },
        |_, message| {
            let (gram, displacement) = message.reals.split_at(count * count);
            total.add(&MotionProducts {
                gram: gram.to_vec(),
                displacement: displacement.to_vec(),
            });
        },
    );
    let mut coefficients = Message::default();
    if comm.is_root() {
        coefficients.reals = total.coefficients();
    }
    comm.broadcast(&mut coefficients);
    for (b, u) in &mut displacement {
        let Some(owned) = blocks.get(b) else { continue };
        let mut settled = vec![false; owned.block.nodes()];
        for (member, node_of) in owned.block.members.iter().zip(&owned.block.node_of) {
            for (local, &node) in node_of.iter().enumerate() {
                if std::mem::replace(&mut settled[node as usize], true) {
                    continue;
                }
                let moves = motions_at(survey, dim, member, &member.points[local]);
                for (z, c) in moves.iter().zip(&coefficients.reals) {
                    let start = node as usize * dim;
                    for (u, z) in u[start..start + dim].iter_mut().zip(z) {
                        *u -= c * z;
                    }
                }
            }
        }
    }
}

/// The lowest subdomain at every node of Γ.
fn first_subdomains(catalog: &Catalog) -> Vec<usize> {
    let mut first = vec![usize::MAX; catalog.interface_nodes];
    for (s, nodes) in catalog.interface.iter().enumerate() {
        for &node in nodes {
            let first = &mut first[node as usize];
            *first = s.min(*first);
        }
    }
    first
}

/// Which nodes of a subdomain a lower one counts.
fn counted_elsewhere(member: &Subdomain, first_of: &[usize]) -> Vec<bool> {
    let mut elsewhere = vec![false; member.points.len()];
    for on in &member.interface {
        elsewhere[on.node as usize] = first_of[on.interface as usize] < member.index;
    }
    elsewhere
}

fn motions_at(survey: &Survey, dim: usize, member: &Subdomain, x: &[f64; 3]) -> Vec<[f64; 3]> {
    survey
        .motions
        .free
        .iter()
        .map(|motion| {
            motion
                .bodies
                .iter()
                .find(|(body, _)| *body == member.body)
                .map_or([0.0; 3], |(body, z)| {
                    survey.frames[*body].displacement(dim, x, z)
                })
        })
        .collect()
}
