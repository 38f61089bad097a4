//! Springs between points.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::mesh::{Group, Mesh};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::Case;

/// A contact in the report, by its name: its kind and its force.
fn of_report(solution: &Solution, name: &str) -> (String, [f64; 3]) {
    let contacts = solution.report["contacts"].as_array().unwrap();
    let found = contacts.iter().find(|of| of["name"] == name).unwrap();
    let force = std::array::from_fn(|k| found["force"][k].as_f64().unwrap());
    (found["kind"].as_str().unwrap().to_owned(), force)
}

fn with_points(mut mesh: Mesh, points: &[(&str, &[[f64; 3]])]) -> Mesh {
    for (name, places) in points {
        let at = |place: &[f64; 3]| {
            let apart = |x: &[f64; 3]| (0..3).map(|k| (x[k] - place[k]).abs()).fold(0.0, f64::max);
            let found = mesh.points.iter().position(|x| apart(x) < 1e-9);
            found.unwrap_or_else(|| panic!("{name}")) as u32
        };
        let members = places.iter().map(at).collect();
        mesh.groups
            .insert((*name).into(), Group { dim: 0, members });
    }
    mesh
}

/// Two bars with a spring between them under tension: they lengthen by F (1/k + 2 L/EA), for every form of the spring.
#[test]
fn two_bars_and_a_spring_are_in_series() {
    let (young, side, force, k) = (20e9, 0.5, 3e5, 4e9);
    let mesh = Blocks::new()
        .rectangle("left", [0.0, 1.0], [0.0, side], [3, 1])
        .rectangle("right", [1.2, 2.2], [0.0, side], [4, 1])
        .mesh;
    for stiffness in ["axial = 4e9", "stiffness = [4e9, 0.0]"] {
        let text = format!(
            "plane = 'stress'
materials.rock = {{young = {young:?}, poisson = 0.0}}
bodies.left.material = 'rock'
bodies.right.material = 'rock'
[[displacement]]
on = 'left left'
x = 0.0
[[displacement]]
on = ['left bottom', 'right bottom']
y = 0.0
[[traction]]
on = 'right right'
value = [{:?}, 0.0]
[[spring]]
name = 'link'
between = ['left right', 'right left']
{stiffness}",
            force / side
        );
        let model = model(&text, mesh.clone());
        for count in [2, 5] {
            for interface in ["direct", "iterative"] {
                let case = Case::of(&model, count);
                let solution = case.solve(&["--interface", interface]);
                let bar = force / (young * side);
                let slack = 1e-12 * (force / k + 2.0 * bar);
                for (x, tag) in model.mesh.points.iter().zip(&model.mesh.node_tags) {
                    let expected = match x[0] < 1.1 {
                        true => bar * x[0],
                        false => bar * (x[0] - 0.2) + force / k,
                    };
                    close(solution.displacement[tag][0], expected, 10.0 * slack);
                }
                let (kind, found) = of_report(&solution, "link");
                assert_eq!(kind, "spring");
                close(found[0], force, 1e-11 * force);
                close(found[1], 0.0, 1e-11 * force);
            }
        }
    }
}

/// A spring along a skew line acts along that line: an end that moves only along x is displaced by F/(k e_x²).
#[test]
fn a_spring_pulls_along_its_line() {
    let (k, force) = (2e6, 3e2);
    let lower = solid("lower", Hexahedron8, [2, 2, 1], between([0.0; 3], [1.0; 3]));
    let upper = solid(
        "upper",
        Hexahedron8,
        [1, 2, 2],
        between([2.0, 3.0, 1.0], [3.0, 4.0, 2.0]),
    );
    let mesh = joined(lower, upper);
    let all: Vec<[f64; 3]> = mesh.points.iter().copied().filter(|x| x[0] > 1.5).collect();
    let mesh = with_points(
        mesh,
        &[
            ("p", &[[1.0, 1.0, 1.0]]),
            ("q", &[[2.0, 3.0, 1.0]]),
            ("guided", &all),
        ],
    );
    let text = format!(
        "materials.rock = {{young = 1e7, poisson = 0.2}}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[displacement]]
on = 'lower z0'
x = 0.0
y = 0.0
z = 0.0
[[displacement]]
on = 'lower x1'
x = 0.0
y = 0.0
z = 0.0
[[displacement]]
on = 'guided'
y = 0.0
z = 0.0
[[force]]
on = 'q'
total = [{force:?}, 0.0, 0.0]
[[spring]]
between = ['p', 'q']
axial = {k:?}"
    );
    let model = model(&text, mesh);
    // The vector from p to q is (1, 2, 0).
    let along = 0.2_f64.sqrt();
    let expected = force / (k * along * along);
    for count in [2, 6] {
        for interface in ["direct", "iterative"] {
            let solution = Case::of(&model, count).solve(&["--interface", interface]);
            for (x, tag) in model.mesh.points.iter().zip(&model.mesh.node_tags) {
                let expected = if x[0] > 1.5 { expected } else { 0.0 };
                close(solution.displacement[tag][0], expected, 1e-10 * force / k);
            }
            let (_, found) = of_report(&solution, "p to q");
            for (found, expected) in found.into_iter().zip([force, 2.0 * force, 0.0]) {
                close(found, expected, 1e-10 * force);
            }
        }
    }
}

/// A free block on a table with friction, pulled at a corner by a spring to another block, which is moved.
fn pulled() -> Model {
    let sled = solid(
        "sled",
        Hexahedron8,
        [4, 2, 2],
        between([0.0; 3], [1.0, 0.5, 0.4]),
    );
    let hand = solid(
        "hand",
        Hexahedron8,
        [2, 2, 1],
        between([2.0, 0.0, 0.1], [2.5, 0.5, 0.5]),
    );
    let mesh = with_points(
        joined(sled, hand),
        &[
            (
                "hook",
                &[[1.0, 0.0, 0.2], [1.0, 0.25, 0.2], [1.0, 0.5, 0.2]],
            ),
            ("eye", &[[2.0, 0.25, 0.1]]),
        ],
    );
    let text = "
materials.rock = {young = 20e6, poisson = 0.22}
bodies.sled.material = 'rock'
bodies.hand.material = 'rock'
[[contact]]
name = 'table'
sides = ['sled z0']
obstacle = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
friction = 0.3
[[pressure]]
on = 'sled z1'
value = 1e3
[[displacement]]
on = 'hand x1'
x = 1e-4
y = 0.0
z = 0.0
[[spring]]
name = 'rope'
between = ['hook', 'eye']
axial = 1e6
[[spring]]
name = 'guide'
between = ['hook', 'eye']
stiffness = [0.0, 1e6, 2e5]
[[step]]
[[step]]
displacement = [{ on = 'hand x1', x = 4e-4, y = 0.0, z = 0.0 }]
";
    model(text, mesh)
}

#[test]
fn ranks_and_solvers_make_no_difference() {
    let case = Case::in_clusters(&pulled(), 6, 3);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let steps = Solution::steps(&case.result());
    steps.iter().for_each(Solution::check_certificate);
    assert!(steps[1].slipping() > 0);
    let pulls: Vec<f64> = (steps.iter())
        .map(|step| of_report_of_step(step, "rope"))
        .collect();
    // The table can't exert more than its friction.
    assert!(pulls[0] > 0.0 && pulls[1] > pulls[0], "{pulls:?}");
    case.is_the_same_on_all_ranks_and_by_iteration(1e-7);
}

/// The force of a spring along x, from the table of its constraints.
fn of_report_of_step(step: &Solution, name: &str) -> f64 {
    step.contacts[name].iter().map(|row| row.force).sum()
}

#[test]
fn a_spring_between_nothing_is_refused() {
    let mesh = with_points(
        Blocks::new()
            .rectangle("block", [0.0, 1.0], [0.0, 1.0], [1, 1])
            .mesh,
        &[("p", &[[0.0; 3]]), ("q", &[[1.0, 0.0, 0.0]])],
    );
    let of = |spring: &str| {
        let text = format!(
            "mesh = 'm'\nplane = 'strain'\nmaterials.rock = {{young = 1.0, poisson = 0.0}}\nbodies.block.material = 'rock'\n\
             [[spring]]\n{spring}"
        );
        match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, mesh.clone()).unwrap_err().to_string(),
        }
    };
    for (spring, expected) in [
        (
            "between = ['p', 'q']",
            "'stiffness' along the axes, or 'axial'",
        ),
        (
            "between = ['p', 'q']\nnormal = 1.0",
            "'between' with two points",
        ),
        ("on = 'p'\naxial = 1.0", "'stiffness' along the axes"),
        ("between = ['p', 'p']\naxial = 1.0", "is at both ends"),
        ("between = ['p', 'q']\naxial = -1.0", "a stiffness of -1"),
        (
            "between = ['p', 'q']\nstiffness = [0.0, 0.0]",
            "its stiffness is 0",
        ),
        (
            "between = ['p', 'q']\nstiffness = ['x', 0.0]",
            "depends on the place",
        ),
        (
            "between = ['p', 'q']\nstiffness = [1.0, 0.0, 0.0]",
            "vectors of two components",
        ),
        ("between = ['p', 'r']\naxial = 1.0", "no physical group 'r'"),
        (
            "between = ['p', 'q']\naxial = 1.0\n[[spring]]\nbetween = ['p', 'q']\naxial = 1.0",
            "spring[2]",
        ),
    ] {
        let error = of(spring);
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn an_axial_spring_between_ends_at_one_place_up_to_round_off_is_refused() {
    let square = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 1.0], [1, 1]);
    let ends: [(&str, &[[f64; 3]]); 2] = [
        ("one diagonal", &[[0.0; 3], [1.0, 1.0, 0.0]]),
        ("the other", &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
    ];
    let text = "mesh = 'm'\nplane = 'strain'\nmaterials.rock = {young = 1.0, poisson = 0.0}\n\
        bodies.block.material = 'rock'\n[[spring]]\nbetween = ['one diagonal', 'the other']\naxial = 1.0\n";
    let scene = Scene::parse(text).unwrap();
    for (off, is_refused) in [(0.0, true), (1e-13, true), (1e-3, false)] {
        let mut mesh = with_points(square.mesh.clone(), &ends);
        let corner = mesh.points.iter().position(|x| *x == [1.0, 1.0, 0.0]);
        mesh.points[corner.unwrap()][1] += off;
        let made = Model::new(&scene, mesh);
        let is_named = |error: &str| error.contains("its ends lie at one place");
        assert_eq!(
            made.is_err_and(|error| is_named(&error.to_string())),
            is_refused,
            "{off}"
        );
    }
}
