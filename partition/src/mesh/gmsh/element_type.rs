//! Gmsh's numbers of element types, and the order of their nodes.

use crate::element::ElementKind;

/// The kind of element `element`, given Gmsh's number of its type.
///
/// # Errors
/// The message of an unsupported element type.
pub(super) fn kind(element: i64, number: i64) -> Result<ElementKind, String> {
    if let Some(kind) = ElementKind::ALL.into_iter().find(|&k| code(k) == number) {
        return Ok(kind);
    }
    let what = match number {
        6 | 13 | 18 => ", a prism",
        7 | 14 | 19 => ", a pyramid",
        29..=31 | 92 | 93 => ", of third or higher order; gmsh -order 2 makes quadratic ones",
        20..=28 => ", of third or higher order; gmsh -order 2 makes quadratic ones",
        _ => ", which isn't supported",
    };
    let known: Vec<&str> = ElementKind::ALL.iter().map(|kind| kind.name()).collect();
    Err(format!(
        "element {element} is of type {number}{what}; expected one of: {}",
        known.join(", ")
    ))
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
        ElementKind::Tetrahedron4 => 4,
        ElementKind::Tetrahedron10 => 11,
        ElementKind::Hexahedron8 => 5,
        ElementKind::Hexahedron20 => 17,
        ElementKind::Hexahedron27 => 12,
    }
}

/// The permutation from Gmsh's order of nodes for `kind`; `None` where it is the same as VTK's.
pub(super) fn order(kind: ElementKind) -> Option<&'static [usize]> {
    const TETRAHEDRON: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8];
    const HEXAHEDRON: &[usize; 27] = &[
        0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20,
        25, 26,
    ];
    match kind {
        ElementKind::Tetrahedron10 => Some(TETRAHEDRON),
        ElementKind::Hexahedron20 => Some(HEXAHEDRON.split_at(20).0),
        ElementKind::Hexahedron27 => Some(HEXAHEDRON),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_supported_is_named() {
        for (number, words) in [
            (6, "a prism; expected one of"),
            (19, "a pyramid; expected one of"),
            (21, "gmsh -order 2"),
            (29, "gmsh -order 2"),
            (99, "isn't supported"),
        ] {
            let printed = kind(7, number).unwrap_err();
            assert!(printed.contains(words), "{printed}");
        }
    }
}
