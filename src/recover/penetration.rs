//! Penetration at the nodes of the master side, which carry no contact constraint.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::Probe;
use contact_dd_partition::id::OnBlocks;
use contact_dd_partition::problem::SubdomainNode;

use crate::context::Context;
use crate::fem::resultants::{ContactResultant, Probed};
use crate::vector::largest;

/// Gap, relative to the largest displacement, up to which nodes count as touching.
const TOUCHING: f64 = 0.01;

/// Evaluates displacements, node by node on every block, at the probes of all contacts, and records the penetrations on
/// the root. Collective.
pub fn probe(
    context: &Context<'_>,
    displacement: &OnBlocks<Vec<f64>>,
    contacts: &mut [ContactResultant],
) {
    let &Context {
        comm,
        catalog,
        plan,
        ..
    } = context;
    if catalog.probes.is_empty() {
        return;
    }
    // The part of each block in the jumps.
    let mut of_block: OnBlocks<Vec<(u32, u32, f64)>> = BTreeMap::new();
    for (row, probe) in (0..).zip(&catalog.probes) {
        for (at, weight) in &probe.entries {
            let of_block = of_block.entry(at.block()).or_default();
            of_block.push((row, at.node, *weight));
        }
    }
    let along = |(row, node, weight): (u32, u32, f64), u: &[f64]| {
        let normal = catalog.probes[row as usize].normal;
        let start = node as usize * catalog.dim;
        let displacement: f64 = (u[start..].iter().take(catalog.dim).zip(normal))
            .map(|(u, n)| u * n)
            .sum();
        (row, weight * displacement)
    };
    let mut jumps = vec![0.0; catalog.probes.len()];
    let mut size: f64 = 0.0;
    comm.gather(
        &plan.owners(),
        |s| match displacement.get(&s) {
            Some(u) => {
                let own = of_block.get(&s).into_iter().flatten();
                let parts: Vec<(u32, f64)> = own.map(|&entry| along(entry, u)).collect();
                (largest(u), parts)
            }
            None => (0.0, Vec::new()),
        },
        |_, (of_block, parts)| {
            size = size.max(of_block);
            for (row, part) in parts {
                jumps[row as usize] += part;
            }
        },
    );
    if comm.is_root() {
        sum_up(&catalog.probes, &jumps, size, contacts);
    }
}

/// Penetration of the contacts by the jumps at probes, where the largest displacement is `size` (m).
fn sum_up(
    probes: &[Probe<SubdomainNode>],
    jumps: &[f64],
    size: f64,
    contacts: &mut [ContactResultant],
) {
    for (probe, jump) in probes.iter().zip(jumps) {
        let contact = &mut contacts[probe.contact as usize];
        let probed = contact.probed.get_or_insert_default();
        let depth = jump - probe.gap;
        probed.touching += usize::from(depth >= -TOUCHING * size);
        if depth > contact.penetration {
            contact.penetration = depth;
            *probed = Probed {
                deepest: probe.tag,
                relative: if size > 0.0 { depth / size } else { 0.0 },
                ..*probed
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_deepest_node_of_each_contact_is_found() {
        let probe = |contact: u32, tag: i64, gap: f64| Probe {
            contact,
            tag,
            entries: Vec::new(),
            normal: [0.0, 1.0, 0.0],
            gap,
        };
        let probes = [probe(1, 5, 0.5), probe(1, 6, 0.25), probe(1, 7, 3.0)];
        let mut contacts = vec![ContactResultant::default(); 3];
        sum_up(&probes, &[0.75, 1.25, 1.0], 2.0, &mut contacts);
        let found = contacts[1].probed.unwrap();
        assert_eq!(contacts[1].penetration, 1.0);
        assert_eq!((found.deepest, found.relative, found.touching), (6, 0.5, 2));
        assert!(contacts[0].probed.is_none() && contacts[2].probed.is_none());
    }
}
