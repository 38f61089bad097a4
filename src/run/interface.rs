//! Bringing the clusters together at the root: Γ, S_0 and the bilateral operator.

use faer::Par;

use super::condensed_blocks::CondensedBlocks;
use super::context::Context;
use crate::comm::Message;
use crate::contact::law::PairLaw;
use crate::error::Failure;
use crate::interface::coupled::MAX_APPROACHES;
use crate::interface::numbering::Numbering;
use crate::interface::operator::{Contribution, Interface};
use crate::plan::Plan;
use crate::schur::condensed::Condensed;
use crate::schur::trace::TraceDof;

/// Numbers what clusters share of Γ and assembles S_0 and the bilateral operator on the root.
/// Collective; the other ranks get nothing.
///
/// # Errors
/// Supports that differ between subdomains, or a singular bilateral problem.
pub fn assemble_interface(
    context: &Context<'_>,
    blocks: &CondensedBlocks,
) -> Result<Option<(Numbering, Interface)>, Failure> {
    let &Context {
        comm,
        catalog,
        plan,
        par,
        ..
    } = context;
    // Few enough conditions for the root to solve for all of them at once.
    let with_laws = catalog.conditions() <= MAX_APPROACHES;
    let mut traces: Vec<Vec<TraceDof>> = Vec::new();
    let mut contributions: Vec<Contribution> = Vec::new();
    comm.gather(
        &plan.cluster_owners(),
        |c| pack(blocks, plan, c, with_laws),
        |_, message| {
            let (list, contribution) = unpack(message);
            traces.push(list);
            contributions.push(contribution);
        },
    );
    let assemble = || assemble(plan, &traces, contributions, par);
    comm.agree(comm.is_root().then(assemble).transpose())
}

/// The interface problem of what the clusters sent to the root.
fn assemble(
    plan: &Plan,
    traces: &[Vec<TraceDof>],
    contributions: Vec<Contribution>,
    par: Par,
) -> Result<(Numbering, Interface), Failure> {
    let nodes = plan
        .clusters
        .iter()
        .map(|c| &plan.tree.nodes[c.node].kept[..]);
    let in_contact: Vec<bool> = plan.clusters.iter().map(|c| c.is_in_contact()).collect();
    let traces: Vec<&[TraceDof]> = traces.iter().map(Vec::as_slice).collect();
    let numbering = Numbering::new(&traces, &nodes.collect::<Vec<_>>(), &in_contact)?;
    let interface = Interface::new(&numbering, contributions, &in_contact, par)?;
    Ok((numbering, interface))
}

fn pack(blocks: &CondensedBlocks, plan: &Plan, c: usize, with_laws: bool) -> Message {
    let mut message = Message::default();
    if let Some(linear) = blocks.linear.get(&c) {
        pack_head(linear, false, &mut message);
        message.push_lower(linear.s.as_ref());
    } else if let Some(cluster) = plan.contact_place(c).and_then(|p| blocks.contact.get(&p)) {
        let condensed = &cluster.condensed;
        pack_head(condensed, with_laws, &mut message);
        message.push_lower(condensed.bilateral());
        if with_laws {
            PairLaw::pack(condensed, &cluster.limits, &mut message);
        }
    }
    message
}

fn pack_head(condensed: &Condensed, has_law: bool, message: &mut Message) {
    let head = [condensed.traces.len() as i64, i64::from(has_law)];
    message.integers.extend(head);
    TraceDof::pack(&condensed.traces, message);
    message.reals.push(condensed.smallest_pivot);
}

fn unpack(message: Message) -> (Vec<TraceDof>, Contribution) {
    let mut reader = message.read();
    let n = reader.count();
    let has_law = reader.integer() != 0;
    let traces = TraceDof::unpack(&mut reader, n);
    let contribution = Contribution {
        smallest_pivot: reader.real(),
        s: reader.symmetric(n),
        law: has_law.then(|| PairLaw::unpack(&mut reader, n)),
    };
    (traces, contribution)
}
