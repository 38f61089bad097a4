//! Reference elements: their nodes and facets, shape functions, quadrature, and geometry.

pub mod geometry;
pub mod jacobian;
pub mod quadrature;
pub mod shape;
pub mod tabulation;

/// The kind of a cell or of a facet.
///
/// Nodes are numbered as VTK and Gmsh do: corners first, counter-clockwise, then a node on each
/// edge, in the order of the edges, then one in the middle. Edges of quadratic kinds may be curved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ElementKind {
    /// A single node.
    Point1,
    /// A straight line of two nodes.
    Line2,
    /// A quadratic line: two ends, then the node between them.
    Line3,
    /// A linear triangle of three nodes, counter-clockwise.
    Triangle3,
    /// A quadratic triangle of six nodes.
    Triangle6,
    /// A bilinear quadrilateral of four nodes.
    Quad4,
    /// A quadratic quadrilateral of eight nodes, the serendipity element.
    Quad8,
    /// A biquadratic quadrilateral of nine nodes.
    Quad9,
}

impl ElementKind {
    /// All kinds, in the order of their declaration.
    pub const ALL: [Self; 8] = [
        Self::Point1,
        Self::Line2,
        Self::Line3,
        Self::Triangle3,
        Self::Triangle6,
        Self::Quad4,
        Self::Quad8,
        Self::Quad9,
    ];

    /// Dimension of the reference element.
    pub fn dim(self) -> usize {
        match self {
            Self::Point1 => 0,
            Self::Line2 | Self::Line3 => 1,
            Self::Triangle3 | Self::Triangle6 | Self::Quad4 | Self::Quad8 | Self::Quad9 => 2,
        }
    }

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::Point1 => 1,
            Self::Line2 => 2,
            Self::Line3 | Self::Triangle3 => 3,
            Self::Quad4 => 4,
            Self::Triangle6 => 6,
            Self::Quad8 => 8,
            Self::Quad9 => 9,
        }
    }

    /// Number of corners, which are the first of its nodes.
    pub fn corners(self) -> usize {
        match self {
            Self::Point1 => 1,
            Self::Line2 | Self::Line3 => 2,
            Self::Triangle3 | Self::Triangle6 => 3,
            Self::Quad4 | Self::Quad8 | Self::Quad9 => 4,
        }
    }

    /// Its name in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Point1 => "point",
            Self::Line2 => "line of 2 nodes",
            Self::Line3 => "line of 3 nodes",
            Self::Triangle3 => "triangle of 3 nodes",
            Self::Triangle6 => "triangle of 6 nodes",
            Self::Quad4 => "quadrilateral of 4 nodes",
            Self::Quad8 => "quadrilateral of 8 nodes",
            Self::Quad9 => "quadrilateral of 9 nodes",
        }
    }

    /// VTK's number of the cell type.
    pub fn vtk(self) -> u8 {
        match self {
            Self::Point1 => 1,
            Self::Line2 => 3,
            Self::Line3 => 21,
            Self::Triangle3 => 5,
            Self::Triangle6 => 22,
            Self::Quad4 => 9,
            Self::Quad8 => 23,
            Self::Quad9 => 28,
        }
    }

    /// The kind of a cell of dimension `dim` that VTK numbers `code`.
    ///
    /// # Errors
    /// In words: a cell type that isn't supported, and those that are.
    pub fn cell_from_vtk(code: i64, dim: usize) -> Result<Self, String> {
        let cells = Self::ALL.into_iter().filter(|kind| kind.dim() == dim);
        let found = cells.clone().find(|kind| i64::from(kind.vtk()) == code);
        found.ok_or_else(|| {
            let known = cells.map(|kind| format!("{} ({})", kind.vtk(), kind.name()));
            let known: Vec<String> = known.collect();
            format!("VTK cell type {code}; expected {}", known.join(", "))
        })
    }

    /// Facets of a cell: kind and local nodes, in the order in which the cell lies to their left.
    pub fn facets(self) -> &'static [(ElementKind, &'static [usize])] {
        match self {
            Self::Point1 => &[],
            Self::Line2 | Self::Line3 => &[(Self::Point1, &[0]), (Self::Point1, &[1])],
            Self::Triangle3 => &[
                (Self::Line2, &[0, 1]),
                (Self::Line2, &[1, 2]),
                (Self::Line2, &[2, 0]),
            ],
            Self::Triangle6 => &[
                (Self::Line3, &[0, 1, 3]),
                (Self::Line3, &[1, 2, 4]),
                (Self::Line3, &[2, 0, 5]),
            ],
            Self::Quad4 => &[
                (Self::Line2, &[0, 1]),
                (Self::Line2, &[1, 2]),
                (Self::Line2, &[2, 3]),
                (Self::Line2, &[3, 0]),
            ],
            Self::Quad8 | Self::Quad9 => &[
                (Self::Line3, &[0, 1, 4]),
                (Self::Line3, &[1, 2, 5]),
                (Self::Line3, &[2, 3, 6]),
                (Self::Line3, &[3, 0, 7]),
            ],
        }
    }

    /// The order of local nodes that turns the element inside out.
    pub fn reversed(self) -> &'static [usize] {
        match self {
            Self::Point1 => &[0],
            Self::Line2 => &[1, 0],
            Self::Line3 => &[1, 0, 2],
            Self::Triangle3 => &[0, 2, 1],
            Self::Triangle6 => &[0, 2, 1, 5, 4, 3],
            Self::Quad4 => &[0, 3, 2, 1],
            Self::Quad8 => &[0, 3, 2, 1, 7, 6, 5, 4],
            Self::Quad9 => &[0, 3, 2, 1, 7, 6, 5, 4, 8],
        }
    }

    /// The local nodes of a line from its start to its end; those of other kinds as they are.
    pub fn along(self) -> &'static [usize] {
        const AS_NUMBERED: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 7, 8];
        match self {
            Self::Line3 => &[0, 2, 1],
            _ => &AS_NUMBERED[..self.nodes()],
        }
    }

    /// Whether its nodes lie at its corners alone.
    pub fn is_linear(self) -> bool {
        self.nodes() == self.corners()
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
