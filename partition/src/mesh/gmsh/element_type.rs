//! Gmsh's numbers of element types.

use crate::element::ElementKind;

/// The kind that Gmsh numbers `number`; its name where it isn't supported.
pub(super) fn kind(number: i64) -> Result<ElementKind, &'static str> {
    let found = ElementKind::ALL
        .into_iter()
        .find(|&kind| code(kind) == number);
    found.ok_or(match number {
        4 => "tetrahedron of 4 nodes",
        5 => "hexahedron of 8 nodes",
        6 => "prism of 6 nodes",
        7 => "pyramid of 5 nodes",
        11 => "quadratic tetrahedron of 10 nodes",
        12 => "quadratic hexahedron of 27 nodes",
        13 => "quadratic prism of 18 nodes",
        14 => "quadratic pyramid of 14 nodes",
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
    let known: Vec<&str> = ElementKind::ALL.iter().map(|kind| kind.name()).collect();
    let is_solid = ["tetrahedron", "hexahedron", "prism", "pyramid"];
    let advice = match name {
        _ if is_solid.iter().any(|solid| name.contains(solid)) => {
            "; scenes lie in the plane: gmsh -2 makes a mesh that does"
        }
        _ if name.contains("third or higher") => "; gmsh -order 2 makes quadratic ones",
        _ => "",
    };
    format!(
        "element {element} is of type {code} ({name}), which isn't supported{advice}; expected one of: {}",
        known.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solid_is_told_apart_from_a_plane_cell_of_high_order() {
        for (code, words) in [
            (4, "scenes lie in the plane"),
            (11, "scenes lie in the plane"),
            (21, "gmsh -order 2"),
        ] {
            let name = kind(code).unwrap_err();
            let said = unsupported(7, code, name);
            assert!(said.contains(words), "{said}");
        }
    }

    #[test]
    fn every_kind_has_the_number_it_is_read_by() {
        for of in ElementKind::ALL {
            assert_eq!(kind(code(of)), Ok(of));
        }
    }
}
