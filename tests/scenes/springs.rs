//! Springs to the ground and elastic foundations.

mod between;

use contact_dd_partition::mesh::Group;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::extruded::extruded;
use crate::support::scenes::{BODIES, JOINT, model, two_blocks};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};
use crate::support::sorts::{SORTS, sort};
use crate::support::statics::{balanced, reaction};

const BLOCK: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.0}
bodies.block.material = 'rock'
";

/// A column on a foundation under pressure: u_y = −p/k − p y/E, in any cells.
#[test]
fn a_column_on_a_foundation_sinks_as_a_whole() {
    let (p, k, young) = (1e6, 4e8, 20e9);
    let mesh = Blocks::new()
        .rectangle("block", [0.0, 1.5], [0.0, 1.0], [5, 4])
        .mesh;
    for sort in SORTS {
        let text = format!(
            "{BLOCK}
[[spring]]
on = 'block bottom'
normal = {k}
tangential = {k}
[[pressure]]
on = 'block top'
value = {p}"
        );
        let model = model(&text, sort.of(&mesh));
        for count in [1, 5] {
            let solution = solve(&model, count);
            for (x, tag) in model.mesh.points.iter().zip(&model.mesh.node_tags) {
                let u = solution.displacement[tag];
                let expected = -p / k - p * x[1] / young;
                close(u[0], 0.0, 1e-11 * p / k);
                close(u[1], expected, 1e-11 * p / k);
            }
        }
    }
}

/// A beam on springs at its ends under an eccentric force: equilibrium determines the force at each end.
#[test]
fn a_beam_on_springs_at_points_is_a_lever() {
    let plane = Blocks::new()
        .rectangle("block", [0.0, 4.0], [0.0, 0.5], [8, 2])
        .mesh;
    let mut mesh = extruded(&sort("quad4").of(&plane), &[0.0, 0.5]).unwrap();
    let at = |x: f64| {
        let bottom = |(_, p): &(usize, &[f64; 3])| p[1].abs() < 1e-9 && (p[0] - x).abs() < 1e-9;
        let nodes = mesh.points.iter().enumerate().filter(bottom);
        nodes.map(|(node, _)| node as u32).collect::<Vec<u32>>()
    };
    let groups = [("left", at(0.0)), ("right", at(4.0)), ("loaded", at(1.0))];
    for (name, members) in groups {
        assert_eq!(members.len(), 2);
        mesh.groups.insert(name.into(), Group { dim: 0, members });
    }
    let (k, force) = (1e3, -4e2);
    let text = format!(
        "materials.stiff = {{young = 1e9, poisson = 0.0}}
bodies.block.material = 'stiff'
[[spring]]
on = 'left'
stiffness = [{k}, {k}, {k}]
[[spring]]
on = 'right'
stiffness = [0.0, {k}, {k}]
[[force]]
on = 'loaded'
total = [0.0, {force}, 0.0]"
    );
    let model = model(&text, mesh);
    for count in [1, 4] {
        let solution = solve(&model, count);
        // Three quarters of the force on the left two springs, one quarter on the right two.
        for (name, part) in [("left", 0.75), ("right", 0.25)] {
            for &node in &model.mesh.groups[name].members {
                close(
                    solution.displacement[&model.mesh.node_tags[node as usize]][1],
                    0.5 * part * force / k,
                    1e-9 * (force / k).abs(),
                );
            }
        }
    }
}

/// A body held only by springs presses on one held by supports: they share the load by their stiffnesses.
#[test]
fn springs_and_contact_share_a_load() {
    let (k, p) = (5e9, 1e6);
    let text = format!(
        "{BODIES}{JOINT}
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[spring]]
on = 'upper left'
stiffness = [1e8, {k}]
[[spring]]
on = 'upper right'
stiffness = [1e8, {k}]
[[pressure]]
on = 'upper top'
value = {p}"
    );
    let model = model(&text, two_blocks().mesh);
    let mut of_contact = Vec::new();
    for count in [2, 7] {
        let solution = solve(&model, count);
        let [x, y, _] = reaction(solution.contacts.values().flatten());
        assert!(y > 0.2 * p && y < 0.9 * p, "{y}");
        // ∫ k u dS on both sides and the contact carry the pressure.
        let mut springs = 0.0;
        for side in ["upper left", "upper right"] {
            for &facet in &model.mesh.groups[side].members {
                let nodes = model.mesh.facets.nodes_of(facet as usize);
                let sum: f64 = nodes
                    .iter()
                    .map(|&n| solution.displacement[&model.mesh.node_tags[n as usize]][1])
                    .sum();
                springs -= k * 0.125 * sum / nodes.len() as f64;
            }
        }
        balanced([x, y + springs, 0.0], [x, p, 0.0], 1e-9 * p);
        of_contact.push(y);
    }
    close(of_contact[0], of_contact[1], 1e-9 * p);
}

/// A block on a foundation, and another one with friction on top of it with springs at its sides, sheared in the second
/// step.
#[test]
fn ranks_and_solvers_make_no_difference() {
    let text = format!(
        "{BODIES}{JOINT}friction = 0.3
[[spring]]
on = 'lower bottom'
normal = 4e9
tangential = 1e9
[[spring]]
on = ['upper left', 'upper right']
stiffness = [1e8, 2e8]
[[pressure]]
on = 'upper top'
value = 1e6
[[step]]
[[step]]
pressure = [{{ on = 'upper top', value = 1e6 }}, {{ on = 'upper left', value = 4e5 }}]
"
    );
    let case = Case::in_clusters(&model(&text, two_blocks().mesh), 8, 4);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let steps = Solution::steps(&case.result());
    steps.iter().for_each(Solution::check_certificate);
    assert!(steps[1].slipping() > 0);
    case.is_the_same_on_all_ranks_and_by_iteration(1e-8);
}

#[test]
fn a_spring_that_pushes_or_has_no_direction_is_refused() {
    let mut mesh = two_blocks().mesh;
    mesh.groups.insert(
        "corner".into(),
        Group {
            dim: 0,
            members: vec![0],
        },
    );
    let of = |spring: &str| {
        let text = format!("mesh = 'm'\n{BODIES}{JOINT}[[spring]]\n{spring}");
        match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, mesh.clone()).unwrap_err().to_string(),
        }
    };
    for (spring, expected) in [
        ("on = 'upper top'", "'stiffness' along the axes"),
        (
            "on = 'upper top'\ntangential = 1.0",
            "'stiffness' along the axes",
        ),
        (
            "on = 'upper top'\nnormal = -1.0",
            "a stiffness of -1; expected at least 0",
        ),
        ("on = 'corner'\nnormal = 1.0", "points have no normal"),
        (
            "on = 'upper'\nstiffness = [1.0, 1.0]",
            "group of cells; expected",
        ),
    ] {
        let error = of(spring);
        assert!(error.contains(expected), "{error}");
    }
}
