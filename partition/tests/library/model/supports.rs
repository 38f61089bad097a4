//! Γ_u and Γ_o.

use crate::blocks::Blocks;
use crate::close::close;
use crate::says::says;
use contact_dd_partition::model::{Model, Support};

fn square() -> Blocks {
    Blocks::new().block("b", [0.0, 1.0], [0.0, 1.0], [2, 2])
}

fn at(model: &Model, node: u32) -> Vec<Support> {
    let rows = model.supports.iter().filter(|s| s.node == node);
    rows.copied().collect()
}

/// Checks that the rows at a node prescribe u·direction = value.
#[track_caller]
fn prescribes(rows: &[Support], direction: [f64; 2], value: f64) {
    let dot = |s: &Support| s.direction[0] * direction[0] + s.direction[1] * direction[1];
    let norm: f64 = rows.iter().map(|s| dot(s).powi(2)).sum();
    close(norm, direction[0].powi(2) + direction[1].powi(2), 1e-14);
    close(rows.iter().map(|s| dot(s) * s.value).sum(), value, 1e-14);
}

#[test]
fn displacements_hold_on_points_facets_and_cells() {
    let model = square()
        .point("p", 0.5, 0.5)
        .model("[[displacement]]\non = 'p'\ny = 3\n[[displacement]]\non = 'b bottom'\nx = '2*x+y'")
        .unwrap();
    assert_eq!(model.supports.len(), 4);
    let directions: Vec<_> = model
        .supports
        .iter()
        .map(|s| (s.node, s.direction, s.value))
        .collect();
    assert_eq!(directions[1], (1, [1.0, 0.0, 0.0], 1.0));
    assert_eq!(directions[3], (4, [0.0, 1.0, 0.0], 3.0));
    let model = square()
        .model("[[displacement]]\non = 'b'\nx = 0\ny = 0")
        .unwrap();
    assert_eq!(model.supports.len(), 18);
}

#[test]
fn displacements_that_agree_are_one_and_those_that_dont_are_named() {
    let text = |a: &str| {
        format!(
            "[[displacement]]\non = 'b bottom'\nx = {a}\n[[displacement]]\non = 'b left'\nx = 0.1\ny = 2"
        )
    };
    let model = square().model(&text("0.1000000000000001")).unwrap();
    assert_eq!(at(&model, 0).len(), 2);
    let error = square().model(&text("0.1000001")).unwrap_err();
    says(
        &error,
        "node 1003: displacement[2] on 'b left' prescribes 0.1",
    );
    says(&error, "displacement[1] on 'b bottom' prescribes 0.1000001");
    let error = square().model(&text("0")).unwrap_err();
    says(&error, "node 1003");
}

#[test]
fn a_condition_is_named_with_those_that_hold_a_part_of_it() {
    let left = "[[displacement]]\non = 'b left'\n";
    let bottom = "[[displacement]]\non = 'b bottom'\n";
    let names = |blocks: &Blocks, text: &str| blocks.model(text).unwrap().support_names;
    // The corner belongs to both; along perpendicular directions nothing is shared.
    let rollers = names(&square(), &format!("{left}x = 0\n{bottom}y = 0\n"));
    assert_eq!(
        rollers,
        [
            "displacement[1] on 'b left'",
            "displacement[2] on 'b bottom'"
        ]
    );
    let clamped = names(&square(), &format!("{left}x = 0\n{bottom}x = 0\ny = 0\n"));
    assert_eq!(clamped[0], "displacement[1] on 'b left'");
    assert_eq!(
        clamped[1],
        "displacement[2] on 'b bottom', except the part of displacement[1]"
    );
    // Bilateral sides that meet at an angle share its direction in part.
    let skewed = square().moved(|[x, y, z]| [x + 0.5 * y, y, z]);
    let sides = "[[bilateral]]\non = 'b left'\n[[bilateral]]\non = 'b bottom'\n";
    assert_eq!(
        names(&skewed, sides)[1],
        "bilateral[2] on 'b bottom', except the part of bilateral[1]"
    );
    assert_eq!(names(&square(), sides)[1], "bilateral[2] on 'b bottom'");
    // Conditions on other sides share no node.
    let opposite =
        "[[displacement]]\non = 'b left'\nx = 0\n[[displacement]]\non = 'b right'\nx = 0\ny = 0\n";
    assert!(
        names(&square(), opposite)
            .iter()
            .all(|name| !name.contains("without"))
    );
}

#[test]
fn bilateral_prescribes_the_normal_of_an_inclined_side() {
    let (c, s) = (0.6, 0.8);
    let blocks = square().moved(|[x, y, z]| [c * x - s * y, s * x + c * y, z]);
    let model = blocks.model("[[bilateral]]\non = 'b bottom'").unwrap();
    assert_eq!(model.supports.len(), 3);
    for node in 0..3 {
        let rows = at(&model, node);
        prescribes(&rows, [s, -c], 0.0);
        assert_eq!(rows.len(), 1);
    }
}

#[test]
fn both_bilateral_directions_hold_at_a_corner() {
    let together = square()
        .model("[[bilateral]]\non = ['b bottom', 'b left']")
        .unwrap();
    let apart = square()
        .model("[[bilateral]]\non = 'b bottom'\n[[bilateral]]\non = 'b left'")
        .unwrap();
    for model in [together, apart] {
        let corner = at(&model, 0);
        assert_eq!(corner.len(), 2);
        prescribes(&corner, [1.0, 0.0], 0.0);
        prescribes(&corner, [0.0, 1.0], 0.0);
        assert_eq!(model.supports.len(), 6);
    }
}

#[test]
fn the_normal_of_a_curve_is_the_average_weighted_by_length() {
    let blocks = square().moved(|[x, y, z]| [x, y - 0.1 * x * x, z]);
    let model = blocks.model("[[bilateral]]\non = 'b bottom'").unwrap();
    let rows = at(&model, 1);
    assert_eq!(rows.len(), 1);
    // Σ length·normal of a chain of facets is the chord, turned: from (0, 0) to (1, −0.1).
    prescribes(&rows, [-0.1, -1.0], 0.0);
}

#[test]
fn a_displacement_beside_a_bilateral_direction_gives_both() {
    let (c, s) = (0.6, 0.8);
    let blocks = square().moved(|[x, y, z]| [c * x - s * y, s * x + c * y, z]);
    let text = "[[bilateral]]\non = 'b bottom'\n[[displacement]]\non = 'b bottom'\nx = 0.3";
    let model = blocks.model(text).unwrap();
    for node in 0..3 {
        let rows = at(&model, node);
        assert_eq!(rows.len(), 2);
        prescribes(&rows, [1.0, 0.0], 0.3);
        prescribes(&rows, [s, -c], 0.0);
        let [a, b] = [rows[0].direction, rows[1].direction];
        close(a[0] * b[0] + a[1] * b[1], 0.0, 1e-15);
    }
}

#[test]
fn what_is_prescribed_twice_is_dropped_or_contradicts() {
    let text =
        |x: f64| format!("[[displacement]]\non = 'b left'\nx = {x}\n[[bilateral]]\non = 'b left'");
    let model = square().model(&text(0.0)).unwrap();
    assert_eq!(model.supports.len(), 3);
    let error = square().model(&text(1e-9)).unwrap_err();
    says(&error, "bilateral[1] on 'b left' prescribes 0");
    says(&error, "displacement[1] on 'b left'");
}

#[test]
fn supports_stand_in_ascending_order_of_nodes() {
    let model = square()
        .model("[[displacement]]\non = ['b top', 'b bottom', 'b left']\nx = 0\ny = 1")
        .unwrap();
    assert!(model.supports.windows(2).all(|w| w[0].node <= w[1].node));
}

#[test]
fn an_expression_without_a_value_is_an_error() {
    let error = square()
        .model("[[displacement]]\non = 'b left'\ny = '1/x'")
        .unwrap_err();
    says(&error, "displacement[1] on 'b left': '1/x' is inf at x = 0");
}
