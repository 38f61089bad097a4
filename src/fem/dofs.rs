//! The unknowns of a block: u = T x + c, with x ordered [I | Γ].

use std::collections::BTreeMap;

use super::block::Block;
use super::frame::{Frame, node_frames};
use super::load::BlockLoads;
use super::sites::{Sites, elimination_order};
use crate::schur::condensed::InterfaceDof;
use crate::schur::pattern::Cliques;

/// A block has too many unknowns for 32-bit indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooManyUnknowns;

/// The unknowns x of a block and T of the displacement u = T x + c; c of each load step is
/// [`Prescribed`](super::prescribed::Prescribed).
#[derive(Clone, Debug)]
pub struct Dofs {
    dim: usize,
    offsets: Vec<u32>,
    terms: Vec<(u32, f64)>,
    first: Vec<u32>,
    sites: Sites,
    /// Number of interior unknowns I.
    pub interior: usize,
    /// Unknowns on Γ; they come last, in this order.
    pub interface_dofs: Vec<InterfaceDof>,
}

const NOT_DIRECT: u32 = u32::MAX;

/// Flags of the components, along the axes of the nodes' `frames`, that are interior unknowns, and of those that are
/// unknowns on Γ.
fn free_components(block: &Block, frames: &BTreeMap<u32, Frame>) -> [Vec<bool>; 2] {
    let dim = block.dim;
    let raw_of = |node: u32| node as usize * dim..(node as usize + 1) * dim;
    let mut is_interior = vec![true; block.nodes() * dim];
    for (&node, frame) in frames {
        for (raw, prescribed) in raw_of(node).zip(&frame.prescribed) {
            is_interior[raw] = prescribed.is_none();
        }
    }
    let mut is_on_interface = vec![false; block.nodes() * dim];
    for &(node, _) in &block.interface {
        let is_held = |frame: &Frame| frame.prescribed.iter().any(Option::is_some);
        let slides = block.slides.contains_key(&node) && !frames.get(&node).is_some_and(is_held);
        let on_interface = if slides { 1 } else { dim };
        for raw in raw_of(node).take(on_interface) {
            is_on_interface[raw] = std::mem::take(&mut is_interior[raw]);
        }
    }
    [is_interior, is_on_interface]
}

impl Dofs {
    /// Numbers the unknowns of `block`: the interior in a fill-reducing order, then the interface dofs on Γ. Of `loads`
    /// only the directions of supports are used, not their values.
    ///
    /// # Errors
    /// More unknowns than 32-bit indices allow.
    pub fn new(block: &Block, loads: &BlockLoads) -> Result<Self, TooManyUnknowns> {
        let dim = block.dim;
        if block.nodes() * dim >= u32::MAX as usize {
            return Err(TooManyUnknowns);
        }
        let frames = node_frames(block, &loads.supports);
        let raw_of = |node: u32| node as usize * dim..(node as usize + 1) * dim;
        let [is_interior, is_on_interface] = free_components(block, &frames);

        let mut number = vec![u32::MAX; block.nodes() * dim];
        let mut sites = Sites::new(block.nodes());
        for node in elimination_order(block, |node| is_interior[raw_of(node)].contains(&true)) {
            sites.of_node[node as usize] = sites.len() as u32;
            for raw in raw_of(node).filter(|&raw| is_interior[raw]) {
                number[raw] = sites.unknown();
            }
            sites.end();
        }
        let interior = sites.next as usize;
        let mut interface_dofs = Vec::new();
        for &(node, id) in &block.interface {
            sites.of_node[node as usize] = sites.len() as u32;
            for (axis, raw) in (0..).zip(raw_of(node)) {
                if is_on_interface[raw] {
                    number[raw] = sites.unknown();
                    interface_dofs.push(InterfaceDof { node: id, axis });
                }
            }
            sites.end();
        }
        let mut dofs = Self {
            dim,
            offsets: Vec::with_capacity(number.len() + 1),
            terms: Vec::with_capacity(number.len()),
            first: Vec::with_capacity(block.nodes()),
            sites,
            interior,
            interface_dofs,
        };
        dofs.offsets.push(0);
        for node in 0..block.nodes() as u32 {
            match frames.get(&node) {
                None => dofs.push_direct(node, &number),
                Some(frame) => dofs.push_node(node, frame, &number),
            }
        }
        Ok(dofs)
    }

    /// Appends the rows of T for a node whose Cartesian components are unknowns.
    fn push_direct(&mut self, node: u32, number: &[u32]) {
        let raw = node as usize * self.dim;
        for &dof in &number[raw..raw + self.dim] {
            self.terms.push((dof, 1.0));
            self.offsets.push(self.terms.len() as u32);
        }
        self.first.push(number[raw]);
    }

    /// Appends the rows of T for `node`, which has supports or slides.
    fn push_node(&mut self, node: u32, frame: &Frame, number: &[u32]) {
        let dim = self.dim;
        let start = self.offsets.len() - 1;
        for component in 0..dim {
            let mut row: BTreeMap<u32, f64> = BTreeMap::new();
            for axis in 0..dim {
                let along = frame.axes[axis][component];
                if along != 0.0 && frame.prescribed[axis].is_none() {
                    let raw = node as usize * dim + axis;
                    *row.entry(number[raw]).or_default() += along;
                }
            }
            self.terms.extend(row);
            self.offsets.push(self.terms.len() as u32);
        }
        self.first.push(self.direct_from(start));
    }

    /// The first of the unknowns that are the node's Cartesian components, if they are.
    fn direct_from(&self, start: usize) -> u32 {
        let base = &self.terms[self.offsets[start] as usize..];
        // Of a sliding node, only one component is on Γ.
        let of_gamma = base
            .iter()
            .filter(|&&(dof, _)| dof as usize >= self.interior);
        let direct = base.len() == self.dim
            && [0, self.dim].contains(&of_gamma.count())
            && base
                .iter()
                .enumerate()
                .all(|(k, &(dof, c))| c == 1.0 && dof == base[0].0 + k as u32);
        if direct { base[0].0 } else { NOT_DIRECT }
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.interior + self.interface_dofs.len()
    }

    /// The terms of a component of a node's displacement: unknown and coefficient.
    pub fn terms(&self, node: u32, component: usize) -> &[(u32, f64)] {
        let row = node as usize * self.dim + component;
        &self.terms[self.offsets[row] as usize..self.offsets[row + 1] as usize]
    }

    /// The first of the consecutive unknowns that are the node's Cartesian components, if they are.
    pub fn direct(&self, node: u32) -> Option<u32> {
        let first = self.first[node as usize];
        (first != NOT_DIRECT).then_some(first)
    }

    /// u ← u + T x: adds the displacement of a change of the unknowns.
    pub fn add_change(&self, x: &[f64], u: &mut [f64]) {
        for (row, u) in u.iter_mut().enumerate() {
            let range = self.offsets[row] as usize..self.offsets[row + 1] as usize;
            for &(dof, c) in &self.terms[range] {
                *u += c * x[dof as usize];
            }
        }
    }

    /// y ← y + Tᵀ f for nodal forces f, node by node.
    pub fn add_load(&self, f: &[f64], y: &mut [f64]) {
        for (row, &f) in f.iter().enumerate() {
            if f != 0.0 {
                let range = self.offsets[row] as usize..self.offsets[row + 1] as usize;
                for &(dof, c) in &self.terms[range] {
                    y[dof as usize] += c * f;
                }
            }
        }
    }

    /// First unknown of each site of the pattern: a run of unknowns that occur in the same cells, those of a node.
    pub fn site_starts(&self) -> &[u32] {
        &self.sites.starts
    }

    /// The sites of every cell of `block`, and of every node without cells.
    pub fn cliques(&self, block: &Block) -> Cliques {
        let mut cliques = Cliques::default();
        let mut list = Vec::new();
        for cell in block.cells() {
            list.clear();
            for node in cell.nodes() {
                if self.first[node as usize] != NOT_DIRECT {
                    list.push(self.sites.of_node[node as usize]);
                    continue;
                }
                for component in 0..self.dim {
                    let terms = self.terms(node, component);
                    list.extend(terms.iter().map(|&(dof, _)| self.sites.of(dof)));
                }
            }
            list.sort_unstable();
            list.dedup();
            cliques.push(list.iter().copied());
        }
        for node in block.subdomain.cell_nodes()..block.nodes() {
            let unknowns = self.unknowns(&[node as u32]);
            let mut sites: Vec<u32> = unknowns.iter().map(|&dof| self.sites.of(dof)).collect();
            sites.dedup();
            cliques.push(sites);
        }
        cliques
    }

    /// The unknowns of a cell, each once, ascending.
    pub fn unknowns(&self, nodes: &[u32]) -> Vec<u32> {
        let mut list: Vec<u32> = nodes
            .iter()
            .flat_map(|&node| (0..self.dim).flat_map(move |c| self.terms(node, c)))
            .map(|&(dof, _)| dof)
            .collect();
        list.sort_unstable();
        list.dedup();
        list
    }
}

#[cfg(test)]
mod tests;
