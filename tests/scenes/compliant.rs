//! Compliant contacts, whose sides overlap by pressure over stiffness.

mod exact;
mod friction;

use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;
use faer::sparse::Triplet;

use crate::support::assembled::Assembled;
use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::{BODIES, JOINT, LOAD, SUPPORTS, at_step, model, two_blocks};
use crate::support::solution::{Solution, datasets, difference};
use crate::support::solver::{Case, solve, solve_steps};

/// The joint of the two blocks, with a stiffness that varies along it.
fn joint(normal: f64) -> String {
    format!("{JOINT}stiffness = {{ normal = '{normal:?}*(1+x)' }}\n")
}

/// The scene of two blocks with a compliant joint.
fn scene(normal: f64) -> String {
    format!("{BODIES}{SUPPORTS}{LOAD}{}", joint(normal))
}

/// Blocks with non-matching meshes.
fn uneven() -> Blocks {
    Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [13, 7])
        .rectangle("upper", [0.5, 1.5], [1.0, 2.0], [9, 8])
}

/// The displacement and the forces of a model by penalty: springs where sides overlap, K + Σ k b bᵀ, starting from the
/// overlaps without springs.
fn by_springs(model: &Model) -> (Vec<f64>, Vec<f64>) {
    let dim = model.mesh.dim;
    let points: Vec<_> = model.contacts.iter().flat_map(|of| &of.points).collect();
    let rows: Vec<Vec<(usize, f64)>> = (points.iter())
        .map(|point| {
            let entries = point.row().flat_map(|(node, c)| {
                (0..dim).map(move |axis| (node as usize * dim + axis, c[axis]))
            });
            entries.filter(|(_, c)| *c != 0.0).collect()
        })
        .collect();
    let mut without = model.clone();
    without.contacts.clear();
    let mut pressed = vec![true; points.len()];
    for _ in 0..50 {
        let mut system = Assembled::new(&without);
        let acting = points.iter().zip(&rows).zip(&pressed);
        for ((point, row), _) in acting.filter(|(_, pressed)| **pressed) {
            let k = point.stiffness[0];
            for &(i, a) in row {
                let of_row = row.iter().map(|&(j, b)| Triplet::new(i, j, k * a * b));
                system.stiffness.extend(of_row);
                system.load[i] += k * a * point.gap;
            }
        }
        let (u, _) = system.solve(&[], &[]);
        let overlap = |row: &[(usize, f64)]| row.iter().map(|&(i, c)| c * u[i]).sum::<f64>();
        let forces = (points.iter().zip(&rows))
            .map(|(point, row)| (point.stiffness[0] * (overlap(row) - point.gap)).max(0.0));
        let forces: Vec<f64> = forces.collect();
        let now: Vec<bool> = forces.iter().map(|&force| force > 0.0).collect();
        if now == pressed {
            return (u, forces);
        }
        pressed = now;
    }
    panic!("springs come and go");
}

/// Fails unless a solution is that with penalty springs.
#[track_caller]
fn is_as_by_springs(model: &Model, solution: &Solution) {
    let (u, forces) = by_springs(model);
    let size = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (found, expected) in solution.dofs(model).iter().zip(&u) {
        close(*found, *expected, 1e-9 * size(&u));
    }
    for (point, force) in solution.points().zip(&forces) {
        close(point.force, *force, 1e-9 * size(&forces));
    }
}

#[test]
fn a_compliant_contact_is_what_springs_make_of_the_whole_mesh() {
    for mesh in [two_blocks().mesh, uneven().mesh] {
        for stiffness in [1e9, 1e11, 1e14] {
            let model = model(&scene(stiffness), mesh.clone());
            let solution = solve(&model, 5);
            let closed = solution.closed();
            assert!(
                closed > 0 && (stiffness < 1e10 || closed < solution.points().count()),
                "{closed}"
            );
            is_as_by_springs(&model, &solution);
        }
    }
}

/// Half the compliance gives half the difference from hard contact.
#[test]
fn the_limit_of_a_stiff_joint_is_hard_contact_to_first_order() {
    let mesh = two_blocks().mesh;
    let hard = model(&format!("{BODIES}{SUPPORTS}{LOAD}{JOINT}"), mesh.clone());
    let expected = Monolithic::new(&hard);
    let far = |stiffness: f64| {
        let u = solve(&model(&scene(stiffness), mesh.clone()), 3).dofs(&hard);
        expected.energy_difference(&u)
    };
    let all: Vec<f64> = [4e13, 8e13, 16e13].map(far).to_vec();
    assert!(all[0] < 0.05, "{all:?}");
    for pair in all.windows(2) {
        close(pair[0] / pair[1], 2.0, 0.1);
    }
}

/// The solution has the same bits on any number of ranks, and both solvers agree.
#[test]
fn ranks_and_solvers_make_no_difference() {
    for mesh in [two_blocks().mesh, uneven().mesh] {
        let model = model(&scene(1e11), mesh);
        let case = Case::in_clusters(&model, 8, 4);
        let solution = case.solve(&[]);
        is_as_by_springs(&model, &solution);
        let direct = case.folder().join("direct.vtkhdf");
        std::fs::rename(case.result(), &direct).unwrap();
        let expected = datasets(&direct);
        for ranks in [2, 3, 4] {
            let ended = case.run_on(ranks, &[]);
            assert_eq!(ended.code(), 0, "{}", ended.stderr);
            assert!(datasets(&case.result()) == expected, "{ranks} ranks");
        }
        case.solve(&["--interface", "iterative"]);
        let (apart, at) = difference(&direct, &case.result());
        assert!(apart < 1e-9, "{apart:e} in {at}");
        let one = datasets(&case.result());
        for ranks in [2, 3, 4] {
            let ended = case.run_on(ranks, &["--interface", "iterative"]);
            assert_eq!(ended.code(), 0, "{}", ended.stderr);
            assert!(datasets(&case.result()) == one, "{ranks} ranks");
        }
    }
}

/// A contact that is added in the second step has its springs from then on.
#[test]
fn a_compliant_contact_may_come_later() {
    let steps = "
[[step]]
remove = 'joint'
[step.scale]
pressure = 0.0
[[step]]
add = 'joint'
";
    let held = "[[displacement]]\non = 'upper right'\ny = 0.0\n";
    let text = format!("{}{held}{steps}", scene(1e11));
    let model = model(&text, two_blocks().mesh);
    let solutions = solve_steps(&model, 4);
    assert_eq!(solutions[0].closed(), 0);
    let last = at_step(&model, 1);
    is_as_by_springs(&last, &solutions[1]);
}

#[test]
fn what_is_no_stiffness_is_refused() {
    let of = |keys: &str| {
        let text = format!("mesh = 'm'\n{BODIES}{SUPPORTS}{LOAD}{JOINT}{keys}\n");
        match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, two_blocks().mesh)
                .unwrap_err()
                .to_string(),
        }
    };
    for (keys, expected) in [
        ("stiffness = 1e9", "a table of normal"),
        (
            "stiffness = { normal = -1.0 }",
            "contact 'joint'.stiffness.normal: -1e0; expected more than 0",
        ),
        (
            "stiffness = { normal = '1e9*(x-1)' }",
            "expected more than 0 (node",
        ),
        ("stiffness = { normal = 'z' }", "plane"),
        (
            "stiffness = { normal = 1e9, tangential = 1e9 }",
            "expected 'friction' or 'tresca' beside it",
        ),
        (
            "stiffness = { tangential = 1e9 }",
            "the key 'normal' is missing",
        ),
    ] {
        let error = of(keys);
        assert!(error.contains(expected), "{error}");
    }
}
