//! Gmsh's numbers of element types.

use crate::element::ElementKind;

/// The kind of element `element`, which Gmsh numbers `number`.
///
/// # Errors
/// What to say of one that isn't supported.
pub(super) fn kind(element: i64, number: i64) -> Result<ElementKind, String> {
    if let Some(kind) = ElementKind::ALL.into_iter().find(|&k| code(k) == number) {
        return Ok(kind);
    }
    let what = match number {
        4..=7 | 11..=14 | 17..=19 | 29..=31 => {
            ", a solid; scenes lie in the plane: gmsh -2 makes a mesh that does"
        }
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
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solid_is_told_apart_from_a_plane_cell_of_high_order() {
        for (number, words) in [
            (4, "scenes lie in the plane"),
            (11, "scenes lie in the plane"),
            (21, "gmsh -order 2"),
            (99, "isn't supported"),
        ] {
            let said = kind(7, number).unwrap_err();
            assert!(said.contains(words), "{said}");
        }
    }
}
