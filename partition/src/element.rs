//! Reference elements: their nodes and facets, shape functions, quadrature, and geometry.

pub mod geometry;
pub mod quadrature;
pub mod shape;

use crate::error::InputError;

/// The kind of a cell or of a facet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ElementKind {
    /// A single node.
    Point1,
    /// A straight line of two nodes.
    Line2,
    /// A linear triangle of three nodes, counter-clockwise.
    Triangle3,
}

impl ElementKind {
    /// Dimension of the reference element.
    pub fn dim(self) -> usize {
        match self {
            Self::Point1 => 0,
            Self::Line2 => 1,
            Self::Triangle3 => 2,
        }
    }

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::Point1 => 1,
            Self::Line2 => 2,
            Self::Triangle3 => 3,
        }
    }

    /// VTK's number of the cell type.
    pub fn vtk(self) -> u8 {
        match self {
            Self::Point1 => 1,
            Self::Line2 => 3,
            Self::Triangle3 => 5,
        }
    }

    /// The kind that VTK numbers `code`.
    ///
    /// # Errors
    /// A cell type that isn't supported.
    pub fn from_vtk(code: u8) -> Result<Self, InputError> {
        match code {
            1 => Ok(Self::Point1),
            3 => Ok(Self::Line2),
            5 => Ok(Self::Triangle3),
            _ => Err(InputError::new(format!(
                "VTK cell type {code} isn't supported; expected 5 (triangle of 3 nodes)"
            ))),
        }
    }

    /// Facets of a cell: kind and local nodes, in the order in which the cell lies to their left.
    pub fn facets(self) -> &'static [(ElementKind, &'static [usize])] {
        match self {
            Self::Point1 => &[],
            Self::Line2 => &[(Self::Point1, &[0]), (Self::Point1, &[1])],
            Self::Triangle3 => &[
                (Self::Line2, &[0, 1]),
                (Self::Line2, &[1, 2]),
                (Self::Line2, &[2, 0]),
            ],
        }
    }

    /// The order of local nodes that turns the element inside out.
    pub fn reversed(self) -> &'static [usize] {
        match self {
            Self::Point1 => &[0],
            Self::Line2 => &[1, 0],
            Self::Triangle3 => &[0, 2, 1],
        }
    }
}

/// Elements of any kinds in one list; element `e` has the nodes `nodes_of(e)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Elements {
    kinds: Vec<ElementKind>,
    offsets: Vec<usize>,
    nodes: Vec<u32>,
}

impl Default for Elements {
    fn default() -> Self {
        Self {
            kinds: Vec::new(),
            offsets: vec![0],
            nodes: Vec::new(),
        }
    }
}

impl Elements {
    /// Appends an element. `nodes` has as many entries as its kind has nodes.
    pub fn push(&mut self, kind: ElementKind, nodes: &[u32]) {
        debug_assert_eq!(kind.nodes(), nodes.len());
        self.kinds.push(kind);
        self.nodes.extend_from_slice(nodes);
        self.offsets.push(self.nodes.len());
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there is no element.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// The kind of element `e`.
    pub fn kind(&self, e: usize) -> ElementKind {
        self.kinds[e]
    }

    /// The nodes of element `e`.
    pub fn nodes_of(&self, e: usize) -> &[u32] {
        &self.nodes[self.offsets[e]..self.offsets[e + 1]]
    }

    /// The nodes of element `e`, to be renumbered or reordered.
    pub fn nodes_of_mut(&mut self, e: usize) -> &mut [u32] {
        &mut self.nodes[self.offsets[e]..self.offsets[e + 1]]
    }

    /// The elements in order: kind and nodes.
    pub fn iter(&self) -> impl Iterator<Item = (ElementKind, &[u32])> + Clone {
        (0..self.len()).map(|e| (self.kind(e), self.nodes_of(e)))
    }

    /// All nodes of all elements, one element after the other.
    pub fn connectivity(&self) -> &[u32] {
        &self.nodes
    }

    /// Start of every element in [`connectivity`](Self::connectivity), and its end: `len() + 1`.
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }
}
