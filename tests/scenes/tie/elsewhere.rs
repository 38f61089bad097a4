//! Ties combined with frictional contact, with load steps and stages, and with bodies without supports.

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::{Solution, datasets, difference};
use crate::support::solver::{Case, solve, solve_steps};

use super::{ROCK, WELD, same_displacements};

const THIRD: &str = "
bodies.third.material = 'rock'
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
";

/// Two tied blocks, and a third one on top of them.
fn three_blocks(upper: usize) -> Blocks {
    Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [6, 6])
        .rectangle("upper", [0.0, 1.0], [1.0, 2.0], [upper, 6])
        .rectangle("third", [0.2, 0.8], [2.0, 3.0], [5, 5])
}

const RUB: &str = "
[[contact]]
name = 'rub'
sides = ['third bottom', 'upper top']
friction = 0.4
[[step]]
[[step.traction]]
on = 'third top'
value = [0.0, -1e6]
[[step]]
[[step.traction]]
on = 'third top'
value = [2e5, -1e6]
";

/// For matching sides, the friction elsewhere is that of the mesh with merged nodes, in both load steps.
#[test]
fn friction_elsewhere_and_load_steps() {
    let two = three_blocks(6);
    let one = two.clone().glued(|_, y| (y - 1.0).abs() < 1e-9);
    let tied = model(&format!("{ROCK}{THIRD}{RUB}{WELD}"), two.mesh);
    let shared = model(&format!("{ROCK}{THIRD}{RUB}"), one.mesh);
    let expected = solve_steps(&shared, 4);
    for (solution, expected) in solve_steps(&tied, 7).iter().zip(&expected) {
        same_displacements((&tied, solution), (&shared, expected), 1e-9);
        assert_eq!(
            solution.contacts["rub"].len(),
            expected.contacts["rub"].len()
        );
    }
}

#[test]
fn friction_elsewhere_has_the_same_bits_on_any_ranks_with_any_solver() {
    let tied = model(&format!("{ROCK}{THIRD}{RUB}{WELD}"), three_blocks(7).mesh);
    for clusters in [1, 3] {
        let case = Case::in_clusters(&tied, 8, clusters);
        let mut first = None;
        for solver in ["direct", "iterative"] {
            let mut bits = None;
            for ranks in [1, 2, 3] {
                let ended = case.run_on(ranks, &["--interface", solver]);
                assert_eq!(ended.code(), 0, "{}", ended.stderr);
                Solution::steps(&case.result())
                    .iter()
                    .for_each(Solution::check_certificate);
                let found = datasets(&case.result());
                assert!(
                    *bits.get_or_insert_with(|| found.clone()) == found,
                    "{solver}, {ranks} ranks"
                );
            }
            let kept = case.folder().join(format!("{solver}.vtkhdf"));
            std::fs::rename(case.result(), &kept).unwrap();
            let before = first.get_or_insert_with(|| kept.clone());
            let (apart, at) = difference(before, &kept);
            assert!(apart < 1e-8, "{apart:e} in {at}");
        }
    }
}

/// A block tied to others after their deformation is added free of stress, and carries load from then on.
#[test]
fn what_comes_is_tied_as_things_are() {
    let text = format!(
        "{ROCK}{THIRD}{WELD}
[[tie]]
name = 'new'
sides = ['third bottom', 'upper top']
[[step]]
[[step.traction]]
on = 'upper top'
value = [1e5, -1e6]
[[step]]
add = 'third'
[[step.traction]]
on = 'upper top'
value = [1e5, -1e6]
[[step]]
[[step.traction]]
on = 'upper top'
value = [1e5, -1e6]
[[step.traction]]
on = 'third top'
value = [1e5, 1e6]
"
    );
    let model = model(&text, three_blocks(7).mesh);
    let steps = solve_steps(&model, 7);
    let largest = |solution: &Solution| {
        let of_third = solution.cells.iter().filter(|(x, _)| x[1] > 2.0);
        of_third
            .flat_map(|(_, s)| *s)
            .fold(0.0, |m: f64, s| m.max(s.abs()))
    };
    assert_eq!(largest(&steps[0]), 0.0);
    assert!(largest(&steps[1]) < 1e-3, "{}", largest(&steps[1]));
    assert!(largest(&steps[2]) > 5e5, "{}", largest(&steps[2]));
    let force = |k: usize| steps[k].report["contacts"][1]["force"][1].as_f64().unwrap();
    close(force(1), 0.0, 1e-3);
    close(force(2), -0.6e6, 1e-3);
}

/// Bodies joined only by a tie form one body: what remains free is their common motion.
#[test]
fn tied_bodies_move_as_one() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 3])
        .rectangle("upper", [0.0, 1.0], [1.0, 2.0], [6, 5])
        .mesh;
    let text = format!(
        "{ROCK}{WELD}
[[traction]]
on = 'upper top'
value = [0.0, 1e6]
[[traction]]
on = 'lower bottom'
value = [0.0, -1e6]
"
    );
    let solution = solve(&model(&text, mesh.clone()), 4);
    let warnings = solution.report["warnings"].as_array().unwrap();
    let free = |w: &&serde_json::Value| {
        w.as_str()
            .unwrap()
            .starts_with("unconstrained rigid-body motion")
    };
    assert_eq!(warnings.iter().filter(free).count(), 3, "{warnings:?}");
    let ended = Case::of(&model(&text.replace("-1e6", "-2e6"), mesh), 4).run(&[]);
    assert_eq!(ended.code(), 4, "{}", ended.stderr);
}
