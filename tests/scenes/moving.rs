//! Obstacles that move with the load steps.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve, solve_steps};

const BLOCK: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.block = {material = 'rock'}
";

fn mesh() -> Mesh {
    Blocks::new()
        .rectangle("block", [0.0, 1.0], [0.0, 0.6], [8, 5])
        .mesh
}

/// Supports of a side of the block.
fn held(side: &str, [x, y]: [f64; 2]) -> String {
    format!("[[displacement]]\non = 'block {side}'\nx = {x:?}\ny = {y:?}\n")
}

/// A contact of its bottom.
fn contact(obstacle: &str, keys: &str) -> String {
    format!(
        "[[contact]]\nname = 'die'\nsides = ['block bottom']\nobstacle = {{ {obstacle} }}\n{keys}\n"
    )
}

/// A wall at a height below the block, facing its bottom.
fn wall(height: f64) -> String {
    format!("point = [0.2, {height:?}], normal = [-2e-5, 1.0]")
}

/// Fails unless both have the same displacements, apart from the translation `moved` of the second.
#[track_caller]
fn same(one: &Solution, other: &Solution, moved: [f64; 3], slack: f64) {
    let scale = one.largest_displacement();
    for (tag, u) in &one.displacement {
        let v = other.displacement[tag];
        (0..3).for_each(|k| close(u[k], v[k] + moved[k], slack * scale));
    }
    for (point, of_other) in one.points().zip(other.points()) {
        close(point.force, of_other.force, slack * one.largest_force());
        for k in 0..3 {
            let [a, b] = [point, of_other].map(|p| p.tangential_force[k]);
            close(a, b, 10.0 * slack * one.largest_force());
            close(point.slip[k], of_other.slip[k], 10.0 * slack * scale);
        }
    }
}

#[test]
fn a_wall_that_moves_is_in_every_step_the_wall_that_stands_there() {
    let heights = [-1e-5, 2e-5, 8e-5, 4e-5];
    let steps: String = heights
        .iter()
        .map(|height| {
            format!(
                "[[step]]\nmotion = {{ die = [0.0, {:?}] }}\n",
                height + 1e-3
            )
        })
        .collect();
    let text = [
        BLOCK,
        &held("top", [0.0; 2]),
        &contact(&wall(-1e-3), ""),
        &steps,
    ]
    .concat();
    let moving = model(&text, mesh());
    for count in [1, 5] {
        for (solution, height) in solve_steps(&moving, count).iter().zip(heights) {
            let text = [BLOCK, &held("top", [0.0; 2]), &contact(&wall(height), "")].concat();
            let there = solve(&model(&text, mesh()), count);
            same(solution, &there, [0.0; 3], 1e-9);
        }
    }
}

/// The solution is the same whether the die moves to the block or the block to the die, with friction, in every step.
#[test]
fn it_is_the_same_whether_the_die_moves_or_the_body() {
    for keys in [
        "friction = 0.3",
        "friction = 0.3\nstiffness = { normal = 2e11, tangential = 1e11 }",
    ] {
        let way = [[0.0, 5e-5], [9e-5, 5e-5], [2e-5, 3e-5], [-6e-5, 4e-5]];
        let of_die: String = way
            .iter()
            .map(|m| format!("[[step]]\nmotion.die = {m:?}\n"))
            .collect();
        let of_body: String = way
            .iter()
            .map(|m| {
                format!(
                    "[[step]]\n[[step.displacement]]\non = 'block top'\nx = {:?}\ny = {:?}\n",
                    -m[0], -m[1]
                )
            })
            .collect();
        let start = [BLOCK, &held("top", [0.0; 2]), &contact(&wall(0.0), keys)].concat();
        let [die, body] =
            [of_die, of_body].map(|steps| model(&[&start[..], &steps].concat(), mesh()));
        let [die, body] = [die, body].map(|model| solve_steps(&model, 4));
        assert!(die.iter().any(|step| step.slipping() > 0));
        for ((of_die, of_body), [x, y]) in die.iter().zip(&body).zip(way) {
            same(of_die, of_body, [x, y, 0.0], 1e-8);
        }
    }
}

/// Motions are relative to the given position, are scaled with displacements, and without steps are applied at once.
#[test]
fn a_motion_is_scaled_like_displacements() {
    let of = |keys: &str, steps: &str| {
        let text = [
            BLOCK,
            &held("top", [0.0; 2]),
            &contact(&wall(-1e-4), keys),
            steps,
        ]
        .concat();
        solve_steps(&model(&text, mesh()), 3)
    };
    let at_once = of("motion = [0.0, 1.2e-4]", "");
    let steps = of(
        "motion = [0.0, 2.4e-4]",
        "[[step]]\nscale = 0.25\n[[step]]\nscale = { displacement = 0.5 }\n",
    );
    assert_eq!(steps[0].closed(), 0);
    same(&steps[1], &at_once[0], [0.0; 3], 1e-10);
}

/// The final position of a round obstacle is exact.
#[test]
fn a_round_die_presses_at_its_end_as_one_that_stands_there() {
    let round = |height: f64| format!("center = [0.4, {height:?}], radius = 50.0");
    let text =
        |place: &str, keys: &str| [BLOCK, &held("top", [0.0; 2]), &contact(place, keys)].concat();
    let moving = solve(
        &model(&text(&round(-50.01), "motion = [0.0, 0.011]"), mesh()),
        4,
    );
    let there = solve(&model(&text(&round(-49.999), ""), mesh()), 4);
    assert!(there.closed() > 1);
    same(&moving, &there, [0.0; 3], 1e-9);
}

/// A body held only by the table rests on it and moves with it.
#[test]
fn a_table_lifts_what_stands_on_it() {
    let lift = 0.25;
    let text = format!(
        "{}{}[[step]]\n[[step]]\nmotion.die = [0.0, {lift:?}]\n",
        BLOCK.replace("'rock'}", "'rock', body_force = [0.0, -25e3]}"),
        contact("point = [0.0, 0.0], normal = [0.0, 1.0]", "friction = 0.5")
    );
    let steps = solve_steps(&model(&text, mesh()), 3);
    // Round-off is larger for a displacement of a million times the deformation.
    same(&steps[1], &steps[0], [0.0, lift, 0.0], 1e-7);
    assert!(steps.iter().all(|step| step.closed() == 9));
}

#[test]
fn ranks_and_solvers_make_no_difference() {
    let mesh = solid(
        "block",
        Hexahedron8,
        [4, 3, 3],
        between([0.0; 3], [1.0, 0.8, 0.5]),
    );
    let text = "
materials.rock = {young = 20e9, poisson = 0.22}
bodies.block = {material = 'rock'}
[[displacement]]
on = 'block z1'
x = 0.0
y = 0.0
z = 0.0
[[contact]]
name = 'ball'
sides = ['block z0']
obstacle = { center = [0.5, 0.4, -30.0], radius = 30.0 }
friction = 0.3
[[step]]
motion.ball = [0.0, 0.0, 2e-3]
[[step]]
motion.ball = [2e-3, 5e-4, 2e-3]
";
    let case = Case::in_clusters(&model(text, mesh), 6, 3);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let steps = Solution::steps(&case.result());
    steps.iter().for_each(Solution::check_certificate);
    assert!(steps[1].slipping() > 0);
    case.is_the_same_on_all_ranks_and_by_iteration(1e-8);
}

#[test]
fn what_moves_nothing_is_refused() {
    let text = [BLOCK, &held("top", [0.0; 2]), &contact(&wall(0.0), "")].concat();
    let of = |keys: &str| {
        let text = format!("mesh = 'm'\n{text}{keys}");
        match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, mesh()).unwrap_err().to_string(),
        }
    };
    for (keys, expected) in [
        ("motion = [0.0, 1.0, 2.0]", "vectors of two components"),
        (
            "[[step]]\nmotion.dye = [0.0, 1.0]",
            "there is no contact 'dye' with an obstacle",
        ),
        ("[[step]]\nmotion.die = [0.0, 'x']", "depends on the place"),
        ("[[step]]\nequation.sum = 1.0", "there is no equation 'sum'"),
        (
            "[[contact]]\nname = 'other'\nsides = ['block left', 'block right']\nmotion = [0.0, 1.0]",
            "'motion' is of an 'obstacle', which is missing",
        ),
    ] {
        let error = of(keys);
        assert!(error.contains(expected), "{error}");
    }
}
