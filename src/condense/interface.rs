//! Assembly at the root: Γ, S_0 and the bilateral operator from all clusters.

use contact_dd_partition::id::ClusterId;
use faer::Par;

use crate::condense::blocks::CondensedBlocks;
use crate::contact::condensed_contact::CondensedContact;
use crate::context::Context;
use crate::error::Failure;
use crate::interface::coupled::MAX_JUMPS;
use crate::interface::numbering::Numbering;
use crate::interface::operator::{Contribution, Interface};
use crate::plan::Plan;
use crate::schur::condensed::InterfaceDof;

/// Numbers the unknowns of Γ shared by clusters and assembles S_0 and the bilateral operator on the root. Collective;
/// `None` on the other ranks.
///
/// # Errors
/// Supports of a shared node differ between subdomains, or the bilateral problem is singular.
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
    // With few constraints the root solves the coupled contact problem of all pairs.
    let with_laws = catalog.conditions() <= MAX_JUMPS;
    let mut interface_dofs: Vec<Vec<InterfaceDof>> = Vec::new();
    let mut contributions: Vec<Contribution> = Vec::new();
    comm.gather(
        &plan.cluster_owners(),
        |c| contribution(blocks, plan, c, with_laws),
        |_, sent| {
            // Owners keep their own data; only the root assembles.
            let Some((list, contribution)) = sent else {
                return;
            };
            interface_dofs.push(list);
            contributions.push(contribution);
        },
    );
    let assemble = || assemble(plan, &interface_dofs, contributions, par);
    comm.agree(comm.is_root().then(assemble).transpose())
}

/// The interface problem from the contributions of the clusters.
fn assemble(
    plan: &Plan,
    interface_dofs: &[Vec<InterfaceDof>],
    contributions: Vec<Contribution>,
    par: Par,
) -> Result<(Numbering, Interface), Failure> {
    let nodes = plan.clusters.iter().map(|c| plan.kept(c.node));
    let in_contact: Vec<bool> = plan.clusters.iter().map(|c| c.is_in_contact()).collect();
    let interface_dofs: Vec<&[InterfaceDof]> = interface_dofs.iter().map(Vec::as_slice).collect();
    let numbering = Numbering::new(&interface_dofs, &nodes.collect::<Vec<_>>(), &in_contact)?;
    let interface = Interface::new(&numbering, contributions, &in_contact, par)?;
    Ok((numbering, interface))
}

/// The traces of cluster c of this rank, and its contribution.
fn contribution(
    blocks: &CondensedBlocks,
    plan: &Plan,
    c: ClusterId,
    with_laws: bool,
) -> Option<(Vec<InterfaceDof>, Contribution)> {
    if let Some(linear) = blocks.linear.get(&c) {
        let mut condensed = linear.clone();
        condensed.fill_upper_triangle();
        let contribution = Contribution {
            s: condensed.s,
            smallest_pivot: condensed.smallest_pivot,
            law: None,
        };
        return Some((condensed.interface_dofs, contribution));
    }
    let cluster = blocks.contact.get(&plan.pair_of(c)?)?;
    let condensed = &cluster.condensed;
    let contribution = Contribution {
        s: condensed.bilateral().to_owned(),
        smallest_pivot: condensed.smallest_pivot,
        law: with_laws.then(|| CondensedContact::new(condensed, &cluster.limits)),
    };
    Some((condensed.interface_dofs.clone(), contribution))
}
