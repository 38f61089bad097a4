//! The unknowns of a block: u = T x + c, with x ordered [I | approaches | Γ].

use std::collections::BTreeMap;

use contact_dd_partition::model::{Material, Support};

use super::block::Block;
use super::condition::BlockCondition;
use super::frame::{Frame, dot, support_frames};
use crate::contact::approach::{ApproachOf, ApproachRow, Approaches, OnInterface, Variable};
use crate::schur::ordering::minimum_degree;
use crate::schur::pattern::Cliques;

/// An unknown on Γ: the node's number on Γ and the axis of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TraceDof {
    /// Number on Γ.
    pub node: u32,
    /// Axis of the node's frame.
    pub axis: u32,
}

/// Why a block's unknowns can't be numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DofError {
    /// A condition lies on Γ.
    OnInterface(usize),
    /// Too many unknowns for 32-bit indices.
    Size,
}

/// The unknowns x of a block and the displacement u = T x + c that they stand for.
#[derive(Clone, Debug)]
pub struct Dofs {
    dim: usize,
    offsets: Vec<u32>,
    terms: Vec<(u32, f64)>,
    constants: Vec<f64>,
    first: Vec<u32>,
    /// Number of interior unknowns I.
    pub interior: usize,
    /// Number of approaches; approach j is unknown `interior + j`.
    pub approaches: usize,
    /// Where the approach of each condition is found.
    pub approach_of: Vec<ApproachOf>,
    /// Its unknowns on Γ; they come last, in this order.
    pub traces: Vec<TraceDof>,
}

const NOT_DIRECT: u32 = u32::MAX;

impl Dofs {
    /// Numbers the unknowns of `block`: its interior in a fill-reducing order, then the
    /// approach of each of `conditions`, then the traces on Γ.
    ///
    /// # Errors
    /// A condition that lies on Γ.
    pub fn new(
        block: &Block,
        conditions: &[BlockCondition],
        materials: &[Material],
    ) -> Result<Self, DofError> {
        let dim = block.dim;
        let frames = frames(block, conditions);
        let frame = |node: u32| frames.get(&node).unwrap_or(&Frame::CARTESIAN);
        let mut on_interface = vec![false; block.nodes()];
        for &(node, _) in &block.interface {
            on_interface[node as usize] = true;
        }
        let approaches = {
            let rows: Vec<_> = conditions
                .iter()
                .map(|c| in_frames(c, frame, dim))
                .collect();
            let may_go = |v: u32| !on_interface[v as usize / dim];
            let stiffness = node_stiffness(block, materials);
            Approaches::new(&rows, may_go, |v| stiffness[v as usize / dim])
                .map_err(|OnInterface(j)| DofError::OnInterface(j))?
        };

        let mut number = vec![u32::MAX; block.nodes() * dim];
        let is_interior = |node: u32, axis: usize| {
            !on_interface[node as usize]
                && frame(node).prescribed[axis].is_none()
                && !approaches
                    .replaced
                    .contains_key(&(node * dim as u32 + axis as u32))
        };
        let mut interior = 0u32;
        for node in elimination_order(block, &approaches, is_interior)? {
            for axis in 0..dim {
                if is_interior(node, axis) {
                    number[node as usize * dim + axis] = interior;
                    interior += 1;
                }
            }
        }
        let mut next = interior + approaches.len as u32;
        let mut traces = Vec::new();
        for &(node, id) in &block.interface {
            for axis in 0..dim {
                if frame(node).prescribed[axis].is_none() {
                    number[node as usize * dim + axis] = next;
                    next += 1;
                    traces.push(TraceDof {
                        node: id,
                        axis: axis as u32,
                    });
                }
            }
        }
        let mut dofs = Self {
            dim,
            offsets: vec![0],
            terms: Vec::with_capacity(number.len()),
            constants: Vec::with_capacity(number.len()),
            first: Vec::with_capacity(block.nodes()),
            interior: interior as usize,
            approaches: approaches.len,
            approach_of: approaches.of.clone(),
            traces,
        };
        for node in 0..block.nodes() as u32 {
            dofs.push_node(node, frame(node), &number, &approaches);
        }
        Ok(dofs)
    }

    /// Appends the rows of T and c for `node`.
    fn push_node(&mut self, node: u32, frame: &Frame, number: &[u32], approaches: &Approaches) {
        let dim = self.dim;
        let start = self.offsets.len() - 1;
        for component in 0..dim {
            let mut row: BTreeMap<u32, f64> = BTreeMap::new();
            let mut constant = 0.0;
            for axis in 0..dim {
                let along = frame.axes[axis][component];
                if along == 0.0 {
                    continue;
                }
                let raw = node * dim as u32 + axis as u32;
                if let Some(value) = frame.prescribed[axis] {
                    constant += along * value;
                } else if let Some(value) = approaches.replaced.get(&raw) {
                    constant += along * value.constant;
                    for &(variable, c) in &value.terms {
                        let dof = match variable {
                            Variable::Displacement(v) => number[v as usize],
                            Variable::Approach(j) => self.interior as u32 + j,
                        };
                        *row.entry(dof).or_default() += along * c;
                    }
                } else {
                    *row.entry(number[raw as usize]).or_default() += along;
                }
            }
            self.terms.extend(row);
            self.constants.push(constant);
            self.offsets.push(self.terms.len() as u32);
        }
        self.first.push(self.direct_from(start));
    }

    /// The first of `dim` consecutive unknowns that are the node's components, if they are.
    fn direct_from(&self, start: usize) -> u32 {
        let base = &self.terms[self.offsets[start] as usize..];
        let direct = base.len() == self.dim
            && base
                .iter()
                .enumerate()
                .all(|(k, &(dof, c))| c == 1.0 && dof == base[0].0 + k as u32)
            && self.constants[start..].iter().all(|&c| c == 0.0);
        if direct { base[0].0 } else { NOT_DIRECT }
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.interior + self.approaches + self.traces.len()
    }

    /// Whether there is no unknown.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The terms of a component of a node's displacement: unknown and coefficient.
    pub fn terms(&self, node: u32, component: usize) -> &[(u32, f64)] {
        let row = node as usize * self.dim + component;
        &self.terms[self.offsets[row] as usize..self.offsets[row + 1] as usize]
    }

    /// The constant part of a component of a node's displacement (m).
    pub fn constant(&self, node: u32, component: usize) -> f64 {
        self.constants[node as usize * self.dim + component]
    }

    /// The first of the consecutive unknowns that simply are the node's components, if so.
    pub fn direct(&self, node: u32) -> Option<u32> {
        let first = self.first[node as usize];
        (first != NOT_DIRECT).then_some(first)
    }

    /// u = T x + c, node by node.
    pub fn displacement(&self, x: &[f64]) -> Vec<f64> {
        let mut u = self.constants.clone();
        self.add_change(x, &mut u);
        u
    }

    /// u ← u + T x: what a change of the unknowns adds to the displacement.
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

    /// The unknowns of every cell of `block`, each once, ascending.
    pub fn cliques(&self, block: &Block) -> Cliques {
        let mut cliques = Cliques::default();
        let mut list = Vec::new();
        for cell in block.cells() {
            list.clear();
            for node in cell.nodes() {
                for component in 0..self.dim {
                    list.extend(self.terms(node, component).iter().map(|&(dof, _)| dof));
                }
            }
            list.sort_unstable();
            list.dedup();
            cliques.push(list.iter().copied());
        }
        cliques
    }
}

/// The frames of a block's supported nodes.
pub fn supported_frames(block: &Block) -> BTreeMap<u32, Frame> {
    let supports: Vec<Support> = block
        .members
        .iter()
        .zip(&block.node_of)
        .flat_map(|(member, node_of)| {
            member.supports.iter().map(|s| Support {
                node: node_of[s.node as usize],
                ..*s
            })
        })
        .collect();
    support_frames(&without_repetition(supports), block.dim)
}

/// The stiffest material around every node (Pa).
fn node_stiffness(block: &Block, materials: &[Material]) -> Vec<f64> {
    let mut stiffness = vec![0.0; block.nodes()];
    for cell in block.cells() {
        let modulus = materials[cell.material].stiffness[0][0];
        for node in cell.nodes() {
            let of_node: &mut f64 = &mut stiffness[node as usize];
            *of_node = of_node.max(modulus);
        }
    }
    stiffness
}

/// Frames of supported nodes, and of nodes with a condition along the first one's normal.
fn frames(block: &Block, conditions: &[BlockCondition]) -> BTreeMap<u32, Frame> {
    let mut frames = supported_frames(block);
    let shared: std::collections::BTreeSet<u32> =
        block.interface.iter().map(|&(node, _)| node).collect();
    for condition in conditions {
        for &(node, coefficient) in &condition.entries {
            let norm = dot(&coefficient, &coefficient).sqrt();
            if norm > 0.0 && !shared.contains(&node) {
                let direction = coefficient.map(|c| c / norm);
                frames
                    .entry(node)
                    .or_insert_with(|| Frame::along(&[direction], block.dim));
            }
        }
    }
    frames
}

/// Supports of nodes that several members share, once.
fn without_repetition(supports: Vec<Support>) -> Vec<Support> {
    let mut kept: BTreeMap<u32, Vec<Support>> = BTreeMap::new();
    for support in supports {
        let rows = kept.entry(support.node).or_default();
        if !rows.contains(&support) {
            rows.push(support);
        }
    }
    kept.into_values().flatten().collect()
}

/// A condition in terms of components along the axes of its nodes' frames.
fn in_frames<'a>(
    condition: &BlockCondition,
    frame: impl Fn(u32) -> &'a Frame,
    dim: usize,
) -> ApproachRow {
    let mut constant = 0.0;
    let mut row: BTreeMap<u32, f64> = BTreeMap::new();
    for (node, coefficient) in &condition.entries {
        let frame = frame(*node);
        for axis in 0..dim {
            let along = dot(coefficient, &frame.axes[axis]);
            match frame.prescribed[axis] {
                Some(value) => constant += along * value,
                None => *row.entry(node * dim as u32 + axis as u32).or_default() += along,
            }
        }
    }
    // A frame along the condition's own normal leaves round-off on its other axes.
    let scale = condition
        .entries
        .iter()
        .map(|(_, c)| dot(c, c).sqrt())
        .fold(0.0, f64::max);
    ApproachRow {
        constant,
        terms: row
            .into_iter()
            .filter(|(_, c)| c.abs() > 1e-14 * scale)
            .collect(),
        gap: condition.gap,
    }
}

/// The order in which nodes with interior unknowns are eliminated.
fn elimination_order(
    block: &Block,
    approaches: &Approaches,
    is_interior: impl Fn(u32, usize) -> bool,
) -> Result<Vec<u32>, DofError> {
    let dim = block.dim;
    let mut site = vec![u32::MAX; block.nodes()];
    let mut nodes = Vec::new();
    for node in 0..block.nodes() as u32 {
        if (0..dim).any(|axis| is_interior(node, axis)) {
            site[node as usize] = nodes.len() as u32;
            nodes.push(node);
        }
    }
    let mut partners: Vec<Vec<u32>> = vec![Vec::new(); block.nodes()];
    for (&raw, value) in &approaches.replaced {
        for &(variable, _) in &value.terms {
            if let Variable::Displacement(v) = variable {
                partners[raw as usize / dim].push(v / dim as u32);
            }
        }
    }
    let mut cliques = Cliques::default();
    let mut list = Vec::new();
    for cell in block.cells() {
        list.clear();
        for node in cell.nodes() {
            list.push(site[node as usize]);
            list.extend(partners[node as usize].iter().map(|&p| site[p as usize]));
        }
        list.sort_unstable();
        list.dedup();
        list.retain(|&s| s != u32::MAX);
        cliques.push(list.iter().copied());
    }
    let order = minimum_degree(nodes.len(), &cliques).ok_or(DofError::Size)?;
    Ok(order.into_iter().map(|s| nodes[s as usize]).collect())
}

#[cfg(test)]
mod tests;
