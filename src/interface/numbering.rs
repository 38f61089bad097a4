//! R̄_i of (15): the unknowns on Γ, in the order in which the root eliminates them.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::error::Failure;
use crate::schur::condensed::InterfaceDof;
use crate::schur::pattern::Cliques;

/// The numbering of the interface's unknowns.
#[derive(Clone, Debug, Default)]
pub struct Numbering {
    /// Number of unknowns.
    pub len: usize,
    /// Number of unknowns that belong to no pair; they come first.
    pub linear: usize,
    /// Numbers of every cluster's interface dofs.
    pub interface_dofs: Vec<Vec<u32>>,
}

impl Numbering {
    /// Numbers the interface dofs of all clusters, those of pairs last; `nodes[c]` are the nodes of Γ that cluster c
    /// shares with others, `in_contact[c]` is true if it is a pair.
    ///
    /// # Errors
    /// Two clusters disagree on which components of a shared node are free.
    pub fn new(
        interface_dofs: &[&[InterfaceDof]],
        nodes: &[&[u32]],
        in_contact: &[bool],
    ) -> Result<Self, Failure> {
        check_agreement(interface_dofs, nodes)?;
        let mut clusters_of: BTreeMap<InterfaceDof, Vec<u32>> = BTreeMap::new();
        for (c, list) in interface_dofs.iter().enumerate() {
            for &dof in *list {
                clusters_of.entry(dof).or_default().push(c as u32);
            }
        }
        let faces = Faces::new(&clusters_of, interface_dofs.len());
        let mut number: HashMap<InterfaceDof, u32> = HashMap::with_capacity(clusters_of.len());
        let mut linear = 0;
        for face in faces.elimination_order(in_contact) {
            for &dof in &faces.dofs[face] {
                number.insert(dof, number.len() as u32);
            }
            if !faces.touches(face, in_contact) {
                linear = number.len();
            }
        }
        Ok(Self {
            len: number.len(),
            linear,
            interface_dofs: interface_dofs
                .iter()
                .map(|list| list.iter().map(|dof| number[dof]).collect())
                .collect(),
        })
    }

    /// The clusters' traces as cliques.
    pub fn cliques(&self, clusters: impl IntoIterator<Item = usize>) -> Cliques {
        let mut cliques = Cliques::default();
        for c in clusters {
            cliques.push(self.interface_dofs[c].iter().copied());
        }
        cliques
    }
}

/// Checks that every node of Γ is free along the same axes in all parts that contain it; `nodes[p]` are the nodes of
/// part p, `interface_dofs[p]` its unknowns, both ascending.
///
/// # Errors
/// A node with different unknowns in two parts.
pub fn check_agreement(
    interface_dofs: &[&[InterfaceDof]],
    nodes: &[&[u32]],
) -> Result<(), Failure> {
    let mut known: Vec<(u32, u32)> = Vec::new();
    for (interface_dofs, nodes) in interface_dofs.iter().zip(nodes) {
        let mut interface_dofs = interface_dofs.iter().peekable();
        for &node in *nodes {
            let mut free = 0;
            while let Some(dof) = interface_dofs.next_if(|dof| dof.node <= node) {
                free |= 1 << dof.axis;
            }
            known.push((node, free));
        }
    }
    known.sort_unstable();
    let different = |w: &&[(u32, u32)]| w[0].0 == w[1].0 && w[0].1 != w[1].1;
    match known.windows(2).find(different) {
        Some(w) => Err(Failure::input(format!(
            "/support: the subdomains that share node {} of /interface/interface hold it in \
             different ways; expected the same supports in all of them",
            w[0].0
        ))),
        None => Ok(()),
    }
}

/// Faces: sets of unknowns of Γ that belong to the same clusters; the root eliminates each as a whole.
struct Faces {
    clusters: Vec<Vec<u32>>,
    dofs: Vec<Vec<InterfaceDof>>,
    of_cluster: Vec<Vec<usize>>,
}

impl Faces {
    fn new(clusters_of: &BTreeMap<InterfaceDof, Vec<u32>>, cluster_count: usize) -> Self {
        let mut faces: BTreeMap<&[u32], Vec<InterfaceDof>> = BTreeMap::new();
        for (&dof, clusters) in clusters_of {
            faces.entry(clusters).or_default().push(dof);
        }
        let mut of_cluster = vec![Vec::new(); cluster_count];
        for (face, clusters) in faces.keys().enumerate() {
            for &c in *clusters {
                of_cluster[c as usize].push(face);
            }
        }
        Self {
            clusters: faces.keys().map(|clusters| clusters.to_vec()).collect(),
            dofs: faces.into_values().collect(),
            of_cluster,
        }
    }

    /// True if a face belongs to a pair.
    fn touches(&self, face: usize, in_contact: &[bool]) -> bool {
        let mut clusters = self.clusters[face].iter();
        clusters.any(|&c| in_contact[c as usize])
    }

    /// Minimum-degree order of the faces, each weighted by its number of unknowns; those of pairs come last.
    fn elimination_order(&self, in_contact: &[bool]) -> Vec<usize> {
        let n = self.dofs.len();
        let mut neighbours: Vec<BTreeSet<usize>> = self
            .clusters
            .iter()
            .enumerate()
            .map(|(face, clusters)| {
                let mut list: BTreeSet<usize> = clusters
                    .iter()
                    .flat_map(|&c| self.of_cluster[c as usize].iter().copied())
                    .collect();
                list.remove(&face);
                list
            })
            .collect();
        let degree =
            |list: &BTreeSet<usize>| list.iter().map(|&f| self.dofs[f].len()).sum::<usize>();
        let place = |f: usize, neighbours: &[BTreeSet<usize>]| {
            (self.touches(f, in_contact), degree(&neighbours[f]), f)
        };
        let mut queue: BTreeSet<(bool, usize, usize)> =
            (0..n).map(|f| place(f, &neighbours)).collect();
        let mut order = Vec::with_capacity(n);
        while let Some((_, _, face)) = queue.pop_first() {
            order.push(face);
            let clique = std::mem::take(&mut neighbours[face]);
            for &f in &clique {
                queue.remove(&place(f, &neighbours));
                // `face` is part of the old degree and is therefore removed only now.
                neighbours[f].remove(&face);
                neighbours[f].extend(clique.iter().copied().filter(|&g| g != f));
            }
            for &f in &clique {
                queue.insert(place(f, &neighbours));
            }
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interface_dofs(nodes: &[u32]) -> Vec<InterfaceDof> {
        nodes
            .iter()
            .flat_map(|&node| (0..2).map(move |axis| InterfaceDof { node, axis }))
            .collect()
    }

    #[test]
    fn every_trace_gets_one_number_whichever_cluster_asks() {
        let nodes = [vec![0, 1, 2], vec![2, 3, 4], vec![0, 1, 4, 5], vec![3, 5]];
        let lists: Vec<_> = nodes.iter().map(|n| interface_dofs(n)).collect();
        let slices: Vec<&[InterfaceDof]> = lists.iter().map(Vec::as_slice).collect();
        let of_cluster: Vec<&[u32]> = nodes.iter().map(Vec::as_slice).collect();
        let numbering = Numbering::new(&slices, &of_cluster, &[false, true, false, false]).unwrap();
        let mut seen: BTreeMap<InterfaceDof, u32> = BTreeMap::new();
        for (list, numbers) in lists.iter().zip(&numbering.interface_dofs) {
            for (&dof, &number) in list.iter().zip(numbers) {
                assert_eq!(*seen.entry(dof).or_insert(number), number);
            }
        }
        let mut numbers: Vec<u32> = seen.into_values().collect();
        numbers.sort_unstable();
        assert_eq!(numbers, (0..12).collect::<Vec<u32>>());
        // Nodes 2, 3 and 4 belong to the pair.
        assert_eq!(numbering.linear, 6);
        assert!(numbering.interface_dofs[1].iter().all(|&i| i >= 6));
    }

    #[test]
    fn parts_that_hold_a_shared_node_differently_are_told_so() {
        let mut lists = [interface_dofs(&[7]), interface_dofs(&[7])];
        lists[1].pop();
        let error = check_agreement(&[&lists[0], &lists[1]], &[&[7], &[7]]).unwrap_err();
        assert!(error.message.contains("node 7"));
    }
}
