//! Points where several bodies meet.

use super::contact::conditions;
use crate::blocks::Blocks;
use crate::close::close;

/// A block of four cells a side on the left, one of eight on the right, above each one of its kind.
fn four_blocks() -> Blocks {
    Blocks::new()
        .block("lower left", [0.0, 1.0], [0.0, 1.0], [4, 4])
        .block("lower right", [1.0, 2.0], [0.0, 1.0], [8, 4])
        .block("upper left", [0.0, 1.0], [1.0, 2.0], [4, 4])
        .block("upper right", [1.0, 2.0], [1.0, 2.0], [8, 4])
}

#[test]
fn blocks_that_lie_diagonally_across_a_corner_share_no_condition() {
    let text = "[[contact]]\nname = 'bed'\nsides = [['lower left top', 'lower right top'], ['upper left bottom', 'upper right bottom']]";
    let blocks = four_blocks();
    let rows = conditions(&blocks, text).unwrap();
    assert_eq!(rows.len(), 5 + 9);
    let corner: Vec<_> = rows.iter().filter(|row| row.position[0] == 1.0).collect();
    assert_eq!(corner.len(), 2);
    for row in corner {
        let [below, above] = [0, 1].map(|i| {
            let node = row.entries[i].0;
            let cells = ["lower left", "lower right", "upper left", "upper right"];
            let holds = |name: &&str| {
                let mut members = blocks.mesh.groups[*name].members.iter();
                members.any(|&cell| blocks.mesh.cells.nodes_of(cell as usize).contains(&node))
            };
            cells.into_iter().find(holds).unwrap()
        });
        assert_eq!(below.replace("lower", "upper"), above);
        let left = below == "lower left";
        close(row.area, if left { 0.125 } else { 0.0625 }, 1e-15);
    }
    close(rows.iter().map(|row| row.area).sum(), 2.0, 1e-14);
}

#[test]
fn a_node_opposite_two_corners_shares_with_each_what_lies_opposite_it() {
    // Its facets are half as long on the right as they are on the left.
    let graded = |[x, y, z]: [f64; 3]| [if x > 1.0 { 0.5 + 0.5 * x } else { x }, y, z];
    let blocks = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [8, 4])
        .block("upper left", [0.0, 1.0], [1.0, 2.0], [4, 4])
        .block("upper right", [1.0, 2.0], [1.0, 2.0], [4, 4])
        .moved(graded);
    let text = "[[contact]]\nname = 'c'\nsides = ['lower top', ['upper left bottom', 'upper right bottom']]";
    let rows = conditions(&blocks, text).unwrap();
    assert_eq!(rows.len(), 10);
    let at_joint = rows.iter().filter(|row| row.position[0] == 1.0);
    let mut shares: Vec<f64> = at_joint.map(|row| row.area).collect();
    shares.sort_by(f64::total_cmp);
    close(shares[0], 0.0625, 1e-15);
    close(shares[1], 0.125, 1e-15);
}

#[test]
fn outlines_press_on_each_other_like_the_sides_that_face_each_other() {
    let outline = |body: &str| {
        let sides = ["bottom", "right", "top", "left"].map(|side| format!("'{body} {side}'"));
        format!("[{}]", sides.join(", "))
    };
    let contact = |a: &str, b: &str| format!("[[contact]]\nname = 'c'\nsides = [{a}, {b}]");
    let sides = contact("'lower top'", "'upper bottom'");
    let outlines = contact(&outline("lower"), &outline("upper"));
    // As wide as each other, and the lower one wider on both ends.
    for (ends, n) in [([0.0, 4.0], 8), ([1.0, 3.0], 4)] {
        let blocks = Blocks::new()
            .block("lower", [0.0, 4.0], [0.0, 1.0], [8, 2])
            .block("upper", ends, [1.0, 2.0], [n, 2]);
        for blocks in [blocks.clone(), blocks.quadratic()] {
            let expected = conditions(&blocks, &sides).unwrap();
            let mut found = conditions(&blocks, &outlines).unwrap();
            found.sort_by(|a, b| b.position[0].total_cmp(&a.position[0]));
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(&expected) {
                assert_eq!(found.position, expected.position);
                assert_eq!(found.entries, expected.entries);
                assert_eq!(found.gap, expected.gap);
                close(found.area, expected.area, 1e-15);
            }
        }
    }
}
