//! Γ_c between discs whose nodes don't match.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use crate::blocks::Blocks;
use crate::close::close;
use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::model::Model;

/// A disc of `n` facets.
fn disc(blocks: Blocks, name: &str, centre: [f64; 2], radius: f64, n: usize, turn: f64) -> Blocks {
    let first = blocks.mesh.points.len();
    let mut blocks = blocks.block(name, [0.0, 1.0], [0.0, 1.0], [n, 1]);
    // The block is bent to a ring, and the ring closed.
    for point in &mut blocks.mesh.points[first..] {
        let [s, t, _] = *point;
        let angle = turn - 2.0 * PI * s;
        let r = radius * (0.5 + 0.5 * t);
        *point = [
            centre[0] + r * angle.cos(),
            centre[1] + r * angle.sin(),
            0.0,
        ];
    }
    let close = |node: u32| match (node as usize).checked_sub(first) {
        Some(local) if local % (n + 1) == n => node - n as u32,
        _ => node,
    };
    let mesh = &mut blocks.mesh;
    for e in 0..mesh.cells.len() {
        mesh.cells
            .nodes_of_mut(e)
            .iter_mut()
            .for_each(|node| *node = close(*node));
    }
    for e in 0..mesh.facets.len() {
        mesh.facets
            .nodes_of_mut(e)
            .iter_mut()
            .for_each(|node| *node = close(*node));
    }
    blocks
}

/// Two discs that touch at the origin, the lower one of radius 2.
fn discs(n: [usize; 2]) -> Blocks {
    let lower = disc(Blocks::new(), "lower", [0.0, -2.0], 2.0, n[0], PI / 2.0);
    disc(lower, "upper", [0.0, 1.0], 1.0, n[1], -PI / 2.0)
}

#[test]
fn discs_that_touch_leave_the_gap_between_their_circles() {
    let text = "[[contact]]\nname = 'c'\nsides = ['upper top', 'lower top']\n";
    let mut errors = Vec::new();
    for refine in [1, 2, 4] {
        let blocks = discs([50 * refine, 33 * refine]);
        let model = blocks.model(text).unwrap();
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let rows = &model.contacts[0].points;
        assert!(
            rows.iter()
                .all(|row| row.gap >= 0.0 && row.position[1] < 1.0)
        );
        let mut worst = 0.0_f64;
        for row in rows
            .iter()
            .filter(|row| row.position[0].abs() < 0.5 && row.position[1] < 0.5)
        {
            let [x, y, _] = row.position;
            let [n_x, n_y, _] = row.frame.normal;
            // Where the line from the node along its normal meets the lower circle.
            let way = [x, y + 2.0];
            let half = way[0] * n_x + way[1] * n_y;
            let left = half * half - (way[0] * way[0] + way[1] * way[1] - 4.0);
            let gap = -half - left.sqrt();
            worst = worst.max((row.gap - gap).abs());
        }
        errors.push(worst);
    }
    assert!(
        errors[0] < 0.01 && errors[2] < 0.3 * errors[0],
        "{errors:?}"
    );
}

/// A disc of this radius within a ring of inner radius 1, whose inner facets are those of its bottom.
fn fitting(n: [usize; 2], radius: f64, keys: &str) -> Model {
    let ring = disc(Blocks::new(), "lower", [0.0; 2], 2.0, n[0], 0.3);
    let fitted = disc(ring, "upper", [0.0; 2], radius, n[1], 0.1);
    let sides = "sides = ['upper top', 'lower bottom']\n";
    let text = format!("[[contact]]\nname = 'c'\n{sides}{keys}");
    fitted.model(&text).unwrap()
}

/// Thirds of the sagittas of 33 and of 50 facets, 4.5e-3 and 2e-3.
#[test]
fn gaps_that_straight_facets_alone_make_are_named() {
    let is_named = |model: &Model| {
        let printed = model.warnings.join("\n");
        printed.contains("are no larger than straight facets stand off the curve, by up to 0.0045")
    };
    let model = fitting([50, 33], 1.0, "");
    let gaps = || model.contacts[0].points.iter().map(|point| point.gap);
    assert!(gaps().all(|gap| gap > 1e-3 && gap < 3e-3));
    assert!(is_named(&model), "{:?}", model.warnings);
    for (facets, radius, keys) in [
        ([50, 33], 1.0, "gap = 0.0"),
        ([50, 33], 1.0, "adjust = 0.01"),
        ([50, 33], 0.95, ""),
    ] {
        let model = fitting(facets, radius, keys);
        assert!(!is_named(&model), "{keys}: {:?}", model.warnings);
    }
}

/// The nodes of the finer side see first where curves touch; facets that fit each other are another matter.
#[test]
fn the_finer_of_two_curved_sides_has_the_conditions_unless_they_fit() {
    let text = "[[contact]]\nname = 'c'\nsides = ['upper top', 'lower top']\n";
    for (facets, is_turned) in [([50, 33], false), ([50, 90], false), ([50, 12], true)] {
        let model = discs(facets).model(text).unwrap();
        assert_eq!(model.warnings, Vec::<String>::new());
        for point in &model.contacts[0].points {
            assert_eq!(point.tag_a == -1, is_turned, "{facets:?} {point:?}");
            assert_eq!(point.tag_b == -1, !is_turned, "{facets:?}");
        }
    }
    for (facets, is_warned) in [([50, 33], false), ([33, 90], true)] {
        let model = fitting(facets, 1.0, "");
        assert!(model.contacts[0].points.iter().all(|point| point.tag_a > 0));
        let printed = model
            .warnings
            .join("\n")
            .contains("expected the coarser one first");
        assert_eq!(printed, is_warned, "{:?}", model.warnings);
    }
}

#[test]
fn discs_that_turn_together_or_on_their_own_keep_their_gaps() {
    let text = "[[contact]]\nname = 'c'\nsides = ['upper top', 'lower top']\n";
    let blocks = discs([50, 33]);
    let model = blocks.model(text).unwrap();
    for row in &model.contacts[0].points {
        // About the origin, and the upper one about its centre.
        let (mut together, mut alone) = (0.0, 0.0);
        for (node, c) in row.row() {
            let [x, y, _] = model.mesh.points[node as usize];
            together += x * c[1] - y * c[0];
            if y > 0.0 {
                alone += x * c[1] - (y - 1.0) * c[0];
            }
        }
        close(together, 0.0, 1e-13);
        close(alone, 0.0, 1e-13);
    }
}

#[test]
fn numbering_in_the_mesh_file_doesnt_matter() {
    let blocks = discs([50, 33]);
    let text = "[[contact]]\nname = 'c'\nsides = ['upper top', 'lower top']\n";
    let (one, other) = (
        blocks.model(text).unwrap(),
        blocks.disguised().model(text).unwrap(),
    );
    let entries = |model: &Model, row: &ContactPoint<u32>| {
        let tagged = |&(node, c): &(u32, f64)| (model.mesh.node_tags[node as usize], c);
        row.entries.iter().map(tagged).collect::<BTreeMap<_, _>>()
    };
    let (a, b) = (&one.contacts[0].points, &other.contacts[0].points);
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.tag_a, a.tag_b), (b.tag_a, b.tag_b));
        close(a.gap, b.gap, 1e-15);
        close(a.area, b.area, 1e-15);
        let (a, b) = (entries(&one, a), entries(&other, b));
        assert!(a.keys().eq(b.keys()));
        for (c, d) in a.values().zip(b.values()) {
            close(*c, *d, 1e-13);
        }
    }
}
