//! The kinds of cells and facets.

/// The kind of a cell or of a facet.
///
/// Nodes are numbered as in VTK: corners first, counter-clockwise, then a node on each edge, in the order of the edges,
/// then those in the middles of faces and cells. Edges and faces of quadratic kinds may be curved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ElementKind {
    /// A single node.
    Point1,
    /// A straight line of two nodes.
    Line2,
    /// A quadratic line: two ends, then the middle node.
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
    /// A linear tetrahedron of four nodes.
    Tetrahedron4,
    /// A quadratic tetrahedron of ten nodes.
    Tetrahedron10,
    /// A trilinear hexahedron of eight nodes.
    Hexahedron8,
    /// A quadratic hexahedron of twenty nodes, the serendipity element.
    Hexahedron20,
    /// A triquadratic hexahedron of twenty-seven nodes.
    Hexahedron27,
}
