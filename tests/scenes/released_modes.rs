//! Bodies released by all contacts: of all admissible positions they take the nearest.

use contact_dd_partition::model::Model;

use crate::support::assembled::Assembled;
use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::random::Random;
use crate::support::scenes::{BODIES, HELD, JOINT, built_in_model, model};
use crate::support::solution::{ContactPoint, Solution};
use crate::support::solver::solve;
use crate::support::stress::judge::Findings;

/// Cells along and across half of the lower block.
const CELLS: [usize; 2] = [4, 4];

/// An unloaded block above one whose bottom moves up by `rise`, with the initial `gap`.
fn on_a_lift(rise: f64, gap: f64) -> Model {
    with_cells(CELLS, rise, gap)
}

fn with_cells([along, across]: [usize; 2], rise: f64, gap: f64) -> Model {
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [2 * along, across])
        .rectangle("upper", [0.5, 1.5], [1.0, 2.0], [along, across]);
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 20e9, poisson = 0.22}}
        bodies.lower.material = 'rock'
        bodies.upper.material = 'rock'
        [[displacement]]
        on = 'lower bottom'
        x = 0.0
        y = {rise:e}
        {JOINT}
        gap = {gap:e}"
    );
    model(&text, blocks.mesh)
}

/// Fails unless the upper block has moved by `y` and the lower one by `rise`.
#[track_caller]
fn moved(model: &Model, solution: &Solution, rise: f64, y: f64) {
    moved_with_cells(CELLS, model, solution, rise, y);
}

#[track_caller]
fn moved_with_cells(
    [along, across]: [usize; 2],
    model: &Model,
    solution: &Solution,
    rise: f64,
    y: f64,
) {
    let of_lower = ((2 * along + 1) * (across + 1)) as i64;
    // Round-off grows with the slenderness of cells.
    let slender = 1.0_f64.max(along as f64 / across as f64 / 32.0);
    for (x, tag) in model.mesh.points.iter().zip(&model.mesh.node_tags) {
        let u = solution.displacement[tag];
        // Nodes coincide where the blocks touch; those of the lower one come first.
        let on_upper = x[1] > 1.0 || (x[1] == 1.0 && *tag > of_lower);
        let expected = [0.0, if on_upper { y } else { rise }];
        for (u, e) in u.iter().zip(expected) {
            close(*u, e, 1e-12 * slender * rise.abs());
        }
    }
}

fn names(solution: &Solution, body: &str) -> bool {
    let warnings = solution.report["warnings"].as_array().unwrap();
    (warnings.iter()).any(|w| w.as_str().unwrap().contains(&format!("'{body}'")))
}

#[test]
fn a_body_without_load_stays_when_its_support_leaves() {
    let model = on_a_lift(-0.01, 0.0);
    for count in [2, 5, 8] {
        let solution = solve(&model, count);
        moved(&model, &solution, -0.01, 0.0);
        assert_eq!(solution.closed(), 0);
        assert!(names(&solution, "upper"));
        let gap_is_left = |p: &ContactPoint| (p.gap - 0.01).abs() < 1e-14;
        assert!(solution.points().all(gap_is_left));
    }
}

/// So many constraints that fixed active sets are solved: where all are open, springs hold the upper block.
#[test]
fn a_body_stays_that_many_contacts_let_go() {
    let cells = [650, 2];
    let model = with_cells(cells, -0.01, 0.0);
    let solution = solve(&model, 9);
    moved_with_cells(cells, &model, &solution, -0.01, 0.0);
    assert_eq!(solution.closed(), 0);
    assert!(names(&solution, "upper"));
}

#[test]
fn a_body_without_load_is_lifted_no_further_than_it_must() {
    let model = on_a_lift(0.01, 0.004);
    for count in [2, 5, 8] {
        let solution = solve(&model, count);
        moved(&model, &solution, 0.01, 0.006);
        assert!(solution.largest_force() < 1e-3);
        assert!(names(&solution, "upper"));
    }
}

/// Squeezed from both sides with different meshes: the resultants of the loads differ by round-off, and so do their
/// moments.
#[test]
fn a_body_whose_load_is_in_balance_stays_where_it_is() {
    for (seed, gap) in [(1, 0.0), (2, 1e-5), (3, 0.3)] {
        let blocks = Blocks::new()
            .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 4])
            .rectangle("upper", [0.5, 1.5], [1.0, 2.0], [4, 7]);
        let text = format!(
            "{BODIES}{HELD}
            [[pressure]]
            on = 'lower left'
            value = 1e6
            {JOINT}
            gap = {gap:e}"
        );
        let mut model = model(&text, blocks.mesh);
        // Forces of a displacement: the resultant of K u is pure round-off.
        let stiffness = Assembled::new(&model);
        let mut random = Random::new(seed);
        let u: Vec<f64> = (model.mesh.node_tags.iter())
            .flat_map(|tag| match *tag > 9 * 5 {
                true => [1e-4 * random.signed(), 1e-4 * random.signed()],
                false => [0.0; 2],
            })
            .collect();
        let forces = stiffness.times(&u);
        let of_upper = (0_u32..).zip(forces.chunks(2)).skip(9 * 5);
        model
            .forces
            .extend(of_upper.map(|(node, f)| (node, [f[0], f[1], 0.0])));
        let assembled = Assembled::new(&model);
        for count in [2, 5] {
            let solution = solve(&model, count);
            assert!(solution.largest_displacement() < 3e-4);
            let found = Findings::new(&model, &assembled, &solution, false);
            assert!(found.backward_error < 1e-14, "{}", found.backward_error);
        }
    }
}

#[test]
fn what_carries_force_is_not_loose() {
    let solution = solve(&built_in_model("stack", 0), 6);
    let warnings = solution.report["warnings"].to_string();
    assert!(!warnings.contains("no contact force"), "{warnings}");
}

/// A disc in a larger round hole may rotate freely: it doesn't, in any number of subdomains.
#[test]
fn a_disc_in_a_hole_has_one_answer_in_any_number_of_subdomains() {
    let text = "
        plane = 'strain'
        materials.rock = {young = 20e9, poisson = 0.22}
        bodies.disc = {material = 'rock', body_force = [0.0, -25e3]}
        [[contact]]
        name = 'hole'
        sides = [['disc bottom', 'disc right', 'disc top', 'disc left']]
        obstacle = {center = [0.0, 0.0], radius = 1.001, inside = true}";
    let model = model(text, Blocks::new().disc("disc", [0.0, 0.0], 1.0, 6).mesh);
    let first = solve(&model, 1);
    assert!(names(&first, "disc"));
    let turned: f64 = (model.mesh.points.iter().zip(&model.mesh.node_tags))
        .map(|(x, tag)| {
            let u = first.displacement[tag];
            x[0] * u[1] - x[1] * u[0]
        })
        .sum();
    close(turned, 0.0, 1e-12 * first.largest_displacement());
    for count in [2, 4] {
        let other = solve(&model, count);
        for (tag, u) in &first.displacement {
            for (a, b) in u.iter().zip(other.displacement[tag]) {
                close(*a, b, 1e-9 * first.largest_displacement());
            }
        }
    }
}
