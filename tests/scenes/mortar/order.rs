//! The order of two sides doesn't affect their penetration.

use std::time::{SystemTime, UNIX_EPOCH};

use contact_dd_partition::element::ElementKind::{Hexahedron8, Hexahedron20, Triangle3};
use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::{Blocks, joined};
use crate::support::punches::{BLOCK, Punch};
use crate::support::random::Random;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};

/// Difference of two solutions, relative to the larger displacement of the second.
fn apart(one: &Solution, other: &Solution) -> f64 {
    let pairs = one.displacement.iter().zip(&other.displacement);
    let all = pairs.flat_map(|((_, u), (_, v))| u.iter().zip(v));
    let most = all.map(|(u, v)| (u - v).abs()).fold(0.0, f64::max);
    most / other.largest_displacement()
}

fn estimate(solution: &Solution) -> f64 {
    solution.report["error_estimate"]["relative"]
        .as_f64()
        .unwrap()
}

/// The largest penetration in the report, measured at the nodes of the side without constraints.
fn penetrates(solution: &Solution) -> f64 {
    solution.report["contacts"][0]["penetration"]
        .as_f64()
        .unwrap()
}

/// Features below the resolution of the sides' meshes add to the error: at most the penetration, with a warning if it
/// dominates.
///
/// `PUNCHES=100 cargo test --workspace --test scenes -- both_orders --nocapture` tests that many pairs of meshes, from
/// `SEED` on.
#[test]
fn both_orders_of_sides_agree_within_the_estimate_of_the_error_and_the_penetration() {
    let number = |name: &str| {
        std::env::var(name)
            .ok()
            .map(|of| of.parse::<u64>().unwrap())
    };
    let count = number("PUNCHES").unwrap_or(5);
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    let first = number("SEED").unwrap_or(now.as_millis() as u64);
    let (mut worst, mut sum, mut beyond) = (0.0_f64, 0.0, 0);
    let mut wrong = Vec::new();
    for seed in (0..count).map(|i| first + i) {
        let punch = Punch::random(&mut Random::new(seed));
        let [block, face] = punch.sides();
        let solutions = [[block, face], [face, block]].map(|sides| solve(&punch.model(sides), 2));
        let [one, other] = &solutions;
        let bound = estimate(one).max(estimate(other));
        let apart = apart(one, other);
        let deepest = penetrates(one).max(penetrates(other)) / other.largest_displacement();
        worst = worst.max(apart / (bound + deepest));
        sum += apart / bound;
        beyond += usize::from(apart > bound);
        let printed = |of: &Solution| of.report["warnings"].to_string().contains("penetrate by");
        let is_said = apart <= bound || solutions.iter().any(printed);
        if apart > bound + deepest || !is_said {
            wrong.push(format!(
                "seed {seed}: {apart} beyond {bound} and {deepest}, printed: {is_said}, of {punch:?}"
            ));
        }
    }
    let mean = sum / count as f64;
    println!(
        "{count} pairs from {first}: {mean:.3} of the estimate, {beyond} beyond it, at most {worst:.3} of estimate and \
         penetration"
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The depth of a punch whose contact is narrower than a facet of the block.
#[test]
fn a_punch_narrower_than_a_facet_goes_as_deep_as_on_a_fine_mesh() {
    let punch = |kind, block, across| Punch {
        kind,
        block,
        across,
        width: 2.0,
        radius: 100.0,
    };
    for (kind, fine, slack) in [
        (Hexahedron8, [10, 6], 0.25),
        (Hexahedron20, [5, 4], 0.25),
        (Triangle3, [40, 16], 0.25),
    ] {
        let fine = punch(kind, fine[0], fine[1]);
        let fine = solve(&fine.model(fine.sides()), 2).largest_displacement();
        let coarse = punch(kind, 2, 4);
        let [block, face] = coarse.sides();
        for sides in [[block, face], [face, block]] {
            let solution = solve(&coarse.model(sides), 2);
            let depth = solution.largest_displacement();
            assert!(
                (depth / fine - 1.0).abs() < slack,
                "{kind:?} {sides:?}: {depth} {fine}"
            );
            // Forces act on the side named first, whichever carries the constraints.
            let on_a = &solution.report["contacts"][0]["force"];
            let up = on_a[if kind.dim() == 3 { 2 } else { 1 }].as_f64().unwrap();
            assert_eq!(up < 0.0, sides[0] == block, "{on_a}");
            let has_a = sides[0] == face;
            for point in solution.points() {
                assert_eq!(point.tags.map(|tag| tag > 0), [has_a, !has_a]);
                assert_eq!(
                    point.normal[if kind.dim() == 3 { 2 } else { 1 }] > 0.0,
                    !has_a
                );
            }
        }
    }
}

/// The largest penetration of the punch's nodes into the block, for hexahedra with `cells` cells.
fn penetration(solution: &Solution, mesh: &Mesh, cells: usize) -> f64 {
    let size = BLOCK / cells as f64;
    let up = |node: usize| solution.displacement[&mesh.node_tags[node]][2];
    let at = |x: [f64; 3]| {
        let is_there = |p: &[f64; 3]| (0..3).all(|k| (p[k] - x[k]).abs() < 1e-9);
        up(mesh.points.iter().position(is_there).unwrap())
    };
    let first = (cells + 1).pow(3);
    let mut most: f64 = 0.0;
    for node in (first..mesh.points.len()).filter(|&n| mesh.points[n][2] == BLOCK) {
        let [x, y, _] = mesh.points[node];
        let [i, j] = [x, y].map(|c| (c / size).floor().min(cells as f64 - 1.0));
        let (s, t) = (x / size - i, y / size - j);
        let corner = |k: f64, l: f64| at([(i + k) * size, (j + l) * size, BLOCK]);
        let below = (1.0 - t) * ((1.0 - s) * corner(0.0, 0.0) + s * corner(1.0, 0.0))
            + t * ((1.0 - s) * corner(0.0, 1.0) + s * corner(1.0, 1.0));
        most = most.max(below - up(node));
    }
    most
}

#[test]
fn what_penetrates_where_no_condition_holds_it_is_said() {
    let punch = Punch {
        kind: Hexahedron8,
        block: 6,
        across: 4,
        width: 2.0,
        radius: f64::INFINITY,
    };
    let mesh = punch.mesh();
    let case = Case::of(&punch.model(punch.sides()), 3);
    for ranks in [1, 2] {
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        let solution = Solution::read(&case.result());
        let expected = penetration(&solution, &mesh, 6);
        let found = solution.report["contacts"][0]["penetration"]
            .as_f64()
            .unwrap();
        assert!(
            (found - expected).abs() < 1e-6 * expected,
            "{found} {expected}"
        );
        let warnings = solution.report["warnings"].to_string();
        assert!(
            warnings.contains("of side b the sides penetrate by"),
            "{warnings}"
        );
    }
}

/// A block that protrudes over the end of a table topples if its centre does.
#[test]
fn a_block_topples_where_its_middle_has_nothing_below() {
    let text = |plane: &str, bottom: &str, sides: [&str; 2]| {
        let [a, b] = sides;
        let (force, fixed) = match plane {
            "" => ("[0, 0, -1e4]", "x = 0\ny = 0\nz = 0"),
            _ => ("[0, -1e4]", "x = 0\ny = 0"),
        };
        format!(
            "{plane}
materials.stone = {{young = 1e9, poisson = 0.2}}
bodies.table.material = 'stone'
bodies.block = {{material = 'stone', body_force = {force}}}
[[displacement]]
on = '{bottom}'
{fixed}
[[contact]]
name = 'c'
sides = ['{a}', '{b}']
gap = 0
"
        )
    };
    for covered in [0.25, 0.45, 0.55, 0.75] {
        let [from, to] = [4.0 * (1.0 - covered), 4.0 * (2.0 - covered)];
        for (m, n) in [(1, 1), (3, 1), (1, 4), (3, 5)] {
            let plane = Blocks::new()
                .rectangle("table", [0.0, 4.0], [-1.0, 0.0], [m, 1])
                .rectangle("block", [from, to], [0.0, 1.0], [n, 1]);
            let table = between([0.0, 0.0, -1.0], [4.0, 2.0, 0.0]);
            let block = between([from, 0.5, 0.0], [to, 1.5, 1.0]);
            let space = joined(
                solid("table", Hexahedron8, [m, 1, 1], table),
                solid("block", Hexahedron8, [n, 1, 1], block),
            );
            for (plane, mesh, bottom, [a, b]) in [
                (
                    "plane = 'strain'",
                    plane.mesh,
                    "table bottom",
                    ["table top", "block bottom"],
                ),
                ("", space, "table z0", ["table z1", "block z0"]),
            ] {
                for sides in [[a, b], [b, a]] {
                    let scene = model(&text(plane, bottom, sides), mesh.clone());
                    let ended = Case::of(&scene, 2).run(&[]);
                    let expected = if covered < 0.5 { 4 } else { 0 };
                    assert_eq!(ended.code(), expected, "{covered} {m} {n} {sides:?}");
                }
            }
        }
    }
}
