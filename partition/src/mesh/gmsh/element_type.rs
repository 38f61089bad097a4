//! Gmsh's numbers of element types.

use crate::element::ElementKind;

/// The kind that Gmsh numbers `code`; its name where it isn't supported.
pub(super) fn kind(code: i64) -> Result<ElementKind, &'static str> {
    Err(match code {
        15 => return Ok(ElementKind::Point1),
        1 => return Ok(ElementKind::Line2),
        2 => return Ok(ElementKind::Triangle3),
        3 => return Ok(ElementKind::Quad4),
        4 => "tetrahedron of 4 nodes",
        5 => "hexahedron of 8 nodes",
        6 => "prism of 6 nodes",
        7 => "pyramid of 5 nodes",
        8 => return Ok(ElementKind::Line3),
        9 => return Ok(ElementKind::Triangle6),
        10 => return Ok(ElementKind::Quad9),
        11 => "quadratic tetrahedron of 10 nodes",
        12 => "quadratic hexahedron of 27 nodes",
        13 => "quadratic prism of 18 nodes",
        14 => "quadratic pyramid of 14 nodes",
        16 => return Ok(ElementKind::Quad8),
        17 => "quadratic hexahedron of 20 nodes",
        18 => "quadratic prism of 15 nodes",
        19 => "quadratic pyramid of 13 nodes",
        20..=25 => "triangle of third or higher order",
        26..=28 => "line of third or higher order",
        29..=31 => "tetrahedron of third or higher order",
        _ => "unknown here",
    })
}

/// Gmsh's number of `kind`.
pub(super) fn code(kind: ElementKind) -> i64 {
    match kind {
        ElementKind::Point1 => 15,
        ElementKind::Line2 => 1,
        ElementKind::Line3 => 8,
        ElementKind::Triangle3 => 2,
        ElementKind::Triangle6 => 9,
        ElementKind::Quad4 => 3,
        ElementKind::Quad8 => 16,
        ElementKind::Quad9 => 10,
    }
}

/// What to say of an element of a type that isn't supported.
pub(super) fn unsupported(element: i64, code: i64, name: &str) -> String {
    format!(
        "element {element} is of type {code} ({name}), which isn't supported; expected triangles \
         of 3 or 6 nodes, quadrilaterals of 4, 8 or 9, lines of 2 or 3, and points"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_the_number_it_is_read_by() {
        for of in ElementKind::ALL {
            assert_eq!(kind(code(of)), Ok(of));
        }
    }
}
