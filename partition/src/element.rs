//! Elements: x(ξ) = Σ N_i(ξ) x_i, u(ξ) = Σ N_i(ξ) u_i over a reference element.
//!
//! An [`ElementKind`] is a byte, stored in lists and files; it identifies a [`ReferenceElement`] with nodes, shape
//! functions, facets and quadrature rules. A new kind needs a [`Definition`](definition::Definition) and an entry here.

pub mod definition;
pub mod geometry;
pub mod hexahedra;
pub mod jacobian;
mod kind;
pub mod lines;
pub mod quadrature;
pub mod quadrilaterals;
pub mod reference;
mod tables;
pub mod tetrahedra;
pub mod triangles;

use std::ops::Deref;

pub use self::kind::ElementKind;
use self::reference::ReferenceElement;

impl ElementKind {
    /// All kinds, in the order of their declaration.
    pub const ALL: [Self; 13] = [
        Self::Point1,
        Self::Line2,
        Self::Line3,
        Self::Triangle3,
        Self::Triangle6,
        Self::Quad4,
        Self::Quad8,
        Self::Quad9,
        Self::Tetrahedron4,
        Self::Tetrahedron10,
        Self::Hexahedron8,
        Self::Hexahedron20,
        Self::Hexahedron27,
    ];

    /// The reference element: nodes, shape functions, facets, quadrature rules.
    pub fn reference(self) -> &'static ReferenceElement {
        match self {
            Self::Point1 => &lines::POINT1,
            Self::Line2 => &lines::LINE2,
            Self::Line3 => &lines::LINE3,
            Self::Triangle3 => &triangles::TRIANGLE3,
            Self::Triangle6 => &triangles::TRIANGLE6,
            Self::Quad4 => &quadrilaterals::QUAD4,
            Self::Quad8 => &quadrilaterals::QUAD8,
            Self::Quad9 => &quadrilaterals::QUAD9,
            Self::Tetrahedron4 => &tetrahedra::TETRAHEDRON4,
            Self::Tetrahedron10 => &tetrahedra::TETRAHEDRON10,
            Self::Hexahedron8 => &hexahedra::HEXAHEDRON8,
            Self::Hexahedron20 => &hexahedra::HEXAHEDRON20,
            Self::Hexahedron27 => &hexahedra::HEXAHEDRON27,
        }
    }

    /// All kinds of dimension `dim`.
    pub fn of_dim(dim: usize) -> impl Iterator<Item = Self> + Clone {
        Self::ALL.into_iter().filter(move |kind| kind.dim() == dim)
    }

    /// The kind of a cell of dimension `dim` with VTK's number `code`.
    ///
    /// # Errors
    /// An unsupported cell type, with the supported ones, in words.
    pub fn cell_from_vtk(code: i64, dim: usize) -> Result<Self, String> {
        let cells = Self::of_dim(dim);
        let found = cells.clone().find(|kind| i64::from(kind.vtk()) == code);
        found.ok_or_else(|| {
            let known = cells.map(|kind| format!("{} ({})", kind.vtk(), kind.name()));
            let known: Vec<String> = known.collect();
            format!("VTK cell type {code}; expected {}", known.join(", "))
        })
    }
}

impl Deref for ElementKind {
    type Target = ReferenceElement;

    fn deref(&self) -> &ReferenceElement {
        self.reference()
    }
}

/// Elements of mixed kinds; element `e` has the nodes `nodes_of(e)`.
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

    /// True if there is no element.
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

    /// The nodes of element `e`, mutable.
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

    /// Start of every element in [`connectivity`](Self::connectivity), and the end: `len() + 1` entries.
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }
}
