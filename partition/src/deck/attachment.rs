//! Attachment of loaded and held nodes: to solids, equations or reference points. Forces on other nodes act on nothing.

use std::collections::BTreeSet;

use super::equations::Equation;
use super::loads::Loads;
use super::place::Places;
use super::reference::NodeAxis;
use super::springs::Springs;
use crate::error::InputError;

/// Refuses forces and supports of nodes that belong to no element and no coupling. Zero supports of a set of which
/// other nodes are attached are left out with a warning: sets of planes often have nodes that no element has.
///
/// # Errors
/// The line of the force or support.
pub(super) fn check(
    places: &Places,
    (equations, springs): (&[Equation], &Springs),
    loads: &Loads,
    warnings: &mut Vec<String>,
) -> Result<(), InputError> {
    let has_cell = places.with_cells();
    let terms = equations.iter().flat_map(|equation| &equation.terms);
    let in_equations: BTreeSet<NodeAxis> = terms.map(|(dof, _)| *dof).collect();
    // Springs refuse ends outside of solids themselves.
    let of_springs: BTreeSet<u32> = springs.nodes().collect();
    let mut left_out = Vec::new();
    for line in &loads.lines {
        let is_attached = |node: u32| {
            let mut dofs = line.axes.iter().map(|&axis| (node, axis));
            has_cell[node as usize]
                || of_springs.contains(&node)
                || loads.references.contains_key(&node)
                || dofs.any(|dof| in_equations.contains(&dof))
        };
        let mut alone = line.nodes.iter().filter(|&&node| !is_attached(node));
        let Some(&first) = alone.next() else {
            continue;
        };
        let tag = places.deck.node_tags[first as usize];
        let has_others = alone.count() + 1 < line.nodes.len();
        let lost = match line.is_force {
            true if line.value == 0.0 => continue,
            true => "force acts on nothing",
            false if line.value == 0.0 && has_others => {
                left_out.push((line.place, tag));
                continue;
            }
            false => "support holds nothing",
        };
        let message = format!(
            "the node {tag} belongs to no solid element and no coupling, so its {lost}; expected a node of a solid, or of an \
             equation, or the reference node of a coupling"
        );
        return Err(places.source.error(line.place, message));
    }
    if let Some((place, tag)) = left_out.first() {
        let more = match left_out.len() - 1 {
            0 => String::new(),
            more => format!(", and so in {more} more lines"),
        };
        warnings.push(format!(
            "{}: the support leaves out nodes that belong to no solid element and no coupling, such as {tag}{more}",
            places.source.place(*place)
        ));
    }
    Ok(())
}
