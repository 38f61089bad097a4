//! Names of element types, and the faces of elements by their numbers.

use crate::element::ElementKind::{self, *};

/// Types by kind of element; their nodes are in VTK's order.
const TYPES: [(&[&str], ElementKind); 12] = [
    (&["C3D4"], Tetrahedron4),
    (&["C3D10"], Tetrahedron10),
    (&["C3D8"], Hexahedron8),
    (&["C3D20"], Hexahedron20),
    (&["CPE3", "CPS3", "CAX3"], Triangle3),
    (&["CPE6", "CPS6", "CAX6"], Triangle6),
    (&["CPE4", "CPS4", "CAX4"], Quad4),
    (&["CPE8", "CPS8", "CAX8"], Quad8),
    // The following types can only be sides.
    (&["S3", "M3D3", "SFM3D3"], Triangle3),
    (&["S6", "STRI65", "M3D6", "SFM3D6"], Triangle6),
    (&["S4", "M3D4", "SFM3D4"], Quad4),
    (&["S8", "M3D8", "SFM3D8"], Quad8),
];

/// Types of lines, by the number of their nodes.
const LINES: [(&[&str], ElementKind); 2] = [(&["T2D2", "T3D2"], Line2), (&["T2D3", "T3D3"], Line3)];

/// Number of the entries of [`TYPES`] for cells.
const OF_CELLS: usize = 8;

/// Letters that may follow the name of a type: reduced integration, incompatible modes, modified and hybrid
/// formulation, temperature.
const FORMULATIONS: [char; 6] = ['R', 'I', 'M', 'H', 'S', 'T'];

/// Prefixes of the names of types that neither have a volume nor can be sides: masses, springs, dashpots, rigid faces,
/// connectors, couplings, beams, pipes and gaps.
const WITHOUT_VOLUME: [&str; 17] = [
    "MASS", "ROTARYI", "HEATCAP", "SPRING", "DASHPOT", "R2D2", "R3D3", "R3D4", "RAX2", "RB",
    "CONN", "DCOUP", "B2", "B3", "PIPE", "GAP", "ITS",
];

/// The meaning of an element type.
pub(super) struct ElementType {
    pub(super) kind: ElementKind,
    /// True if the element has no volume, or in the plane no area.
    pub(super) is_side: bool,
    /// The type of the same shape with the formulation used here, if it is another one.
    pub(super) plain: Option<&'static str>,
    /// True if the element has incompatible modes.
    pub(super) has_modes: bool,
    /// True if the element has reduced integration.
    pub(super) is_reduced: bool,
}

impl ElementType {
    /// True if the element has reduced integration that is available here.
    pub(super) fn has_reduced_points(&self) -> bool {
        self.is_reduced && self.kind.reduced_points().is_some()
    }
}

/// The meaning of the type `name`; `None` if it is unsupported.
pub(super) fn find(name: &str) -> Option<ElementType> {
    let name = name.to_uppercase();
    let types = TYPES.iter().chain(&LINES).enumerate();
    let mut named =
        types.flat_map(|(place, (names, kind))| names.iter().map(move |n| (place, n, *kind)));
    // No other type's name is a prefix of C3D20R, so that the first match with an optional formulation is right.
    let (place, plain, kind) = named.find(|(_, known, _)| {
        (name.strip_prefix(**known))
            .is_some_and(|rest| rest.chars().all(|c| FORMULATIONS.contains(&c)))
    })?;
    Some(ElementType {
        kind,
        is_side: place >= OF_CELLS,
        plain: (*plain != name).then_some(*plain),
        has_modes: place < OF_CELLS && name[plain.len()..].contains('I'),
        is_reduced: place < OF_CELLS && name[plain.len()..].contains('R'),
    })
}

/// True if elements of an unsupported type have no volume, so that the mesh is complete without them.
pub(super) fn has_no_volume(name: &str) -> bool {
    let name = name.to_uppercase();
    WITHOUT_VOLUME.iter().any(|known| name.starts_with(known))
}

/// The supported types of cells, for messages.
pub(super) fn known() -> String {
    let names = TYPES[..OF_CELLS].iter().flat_map(|(names, _)| *names);
    names.copied().collect::<Vec<_>>().join(", ")
}

/// The corners of the face `number`, from 1, of an element: S1 to S6.
pub(super) fn face(kind: ElementKind, number: usize) -> Option<&'static [usize]> {
    let faces: &[&[usize]] = match kind {
        Triangle3 | Triangle6 => &[&[0, 1], &[1, 2], &[2, 0]],
        Quad4 | Quad8 => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        Tetrahedron4 | Tetrahedron10 => &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]],
        Hexahedron8 | Hexahedron20 => &[
            &[0, 1, 2, 3],
            &[4, 7, 6, 5],
            &[0, 4, 5, 1],
            &[1, 5, 6, 2],
            &[2, 6, 7, 3],
            &[3, 7, 4, 0],
        ],
        _ => &[],
    };
    faces.get(number.checked_sub(1)?).copied()
}
