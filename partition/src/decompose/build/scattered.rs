//! Subdomains that don't hang together.

use crate::decompose::Decomposition;
use crate::disjoint_sets::DisjointSets;
use crate::mesh::topology::Topology;
use crate::model::Model;

/// Names the subdomains of the user's own partition that don't hang together across facets.
pub(super) fn warning(model: &Model, decomposition: &Decomposition) -> Option<String> {
    model.prescribed_subdomains.as_ref()?;
    let of = &decomposition.subdomain;
    let topology = Topology::new(&model.mesh);
    let mut sets = DisjointSets::new(of.len());
    for cell in 0..of.len() {
        for &next in topology.neighbours(cell) {
            if of[cell] == of[next as usize] {
                sets.unite(cell as u32, next);
            }
        }
    }
    let mut components = vec![0; decomposition.count];
    for cell in 0..of.len() as u32 {
        if sets.find(cell) == cell {
            components[of[cell as usize] as usize] += 1;
        }
    }
    let scattered: Vec<String> = components
        .iter()
        .enumerate()
        .filter(|&(_, &count)| count > 1)
        .map(|(subdomain, _)| subdomain.to_string())
        .collect();
    (!scattered.is_empty()).then(|| {
        format!(
            "the scene's partition has subdomains that don't hang together: {}",
            scattered.join(", ")
        )
    })
}
