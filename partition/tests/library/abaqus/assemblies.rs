//! Parts and their instances.

use super::{read, tags};
use crate::says::says;

const PART: &str = "\
*PART, NAME=Brick
*NODE
1, 0., 0., 0.
2, 2., 0., 0.
3, 2., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 2., 0., 1.
7, 2., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELSET, ELSET=Set-1
1
*SURFACE, NAME=Bottom
Set-1, S1
*SURFACE, NAME=Top
Set-1, S2
*NSET, NSET=_Picked, INTERNAL
1, 2, 3, 4
*END PART
";

#[test]
fn one_instance_keeps_names_and_numbers() {
    let mesh = read(&format!(
        "{PART}*ASSEMBLY, NAME=A
*INSTANCE, NAME=Brick-1, PART=Brick
*END INSTANCE
*NODE
1, 9., 9., 9.
*NSET, NSET=Reference
1
*ELSET, ELSET=Some, INSTANCE=Brick-1
1
*NSET, NSET=Corner
Brick-1.8
*SURFACE, NAME=Side
Brick-1.Set-1, S6
*END ASSEMBLY
"
    ))
    .unwrap();
    assert_eq!(mesh.node_tags, [1, 2, 3, 4, 5, 6, 7, 8]);
    let groups: Vec<&str> = mesh.groups.keys().map(String::as_str).collect();
    assert_eq!(
        groups,
        [
            "Bottom",
            "Brick-1",
            "Corner",
            "Reference",
            "Set-1",
            "Side",
            "Some",
            "Top"
        ]
    );
    assert_eq!(tags(&mesh, "Bottom"), [[1, 2, 3, 4]]);
    assert_eq!(tags(&mesh, "Side"), [[1, 4, 5, 8]]);
    assert_eq!(tags(&mesh, "Corner"), [[8]]);
    assert!(mesh.groups["Reference"].members.is_empty());
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
}

#[test]
fn instances_are_shifted_turned_and_told_apart() {
    let mesh = read(&format!(
        "{PART}*ASSEMBLY, NAME=A
*INSTANCE, NAME=Low, PART=brick
*END INSTANCE
*INSTANCE, NAME=High, PART=Brick
1., 0., 1.
1., 0., 1., 1., 0., 7., 90.
*END INSTANCE
*END ASSEMBLY
"
    ))
    .unwrap();
    assert_eq!(mesh.node_tags, (1..=16).collect::<Vec<i64>>());
    assert_eq!(mesh.cells.len(), 2);
    assert_eq!(tags(&mesh, "Low"), [[1, 2, 3, 4, 5, 6, 7, 8]]);
    assert_eq!(tags(&mesh, "Low.Top"), [[5, 6, 7, 8]]);
    assert_eq!(tags(&mesh, "High.Bottom"), [[9, 10, 11, 12]]);
    // Node 3 of the part at (2, 1, 0) goes to (3, 1, 1), and about the axis x = 1, y = 0 to (0, 2, 1).
    let at = mesh.points[10];
    for (found, expected) in at.iter().zip([0.0, 2.0, 1.0]) {
        assert!((found - expected).abs() < 1e-15, "{at:?}");
    }
    assert!((mesh.measure(1) - 2.0).abs() < 1e-14);
    let printed = mesh.warnings.join("\n");
    says(
        &printed,
        "'HIGH' are numbered as in its part + 8, its elements + 1",
    );
}
