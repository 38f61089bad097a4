//! Activation and deactivation of bodies and contacts: every load step has the solution of its active parts.

mod exact;

use std::collections::BTreeSet;

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::model::{Model, Support};
use contact_dd_partition::problem::Body;

use crate::support::blocks::joined;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::{BODIES, HELD, JOINT, LOAD, SUPPORTS, at_step, model, two_blocks};
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, problem, solve_steps};

/// The nodes of the absent bodies in step k.
fn absent_nodes(model: &Model, k: usize) -> BTreeSet<u32> {
    let cells = model.mesh.cells.iter().zip(&model.cell_body);
    let absent = cells.filter(|(_, body)| model.steps[k].absent_bodies.contains(body));
    absent.flat_map(|((_, nodes), _)| nodes.to_vec()).collect()
}

/// For each contact whether it is active in step k.
fn is_there(model: &Model, k: usize) -> Vec<bool> {
    let absent = absent_nodes(model, k);
    let of_contact = |(c, contact): (u32, &contact_dd_partition::model::Contact)| {
        let mut entries = contact.points.iter().flat_map(|point| &point.entries);
        !model.steps[k].absent_contacts.contains(&c)
            && entries.all(|(node, _)| !absent.contains(node))
    };
    (0..).zip(&model.contacts).map(of_contact).collect()
}

/// Fails unless every step is the monolithic solution of its active parts: absent bodies fixed everywhere, absent
/// contacts left out, and added ones closed at the jump of their sides in the previous step.
#[track_caller]
fn agrees(model: &Model, solutions: &[Solution]) {
    let dim = model.mesh.dim;
    let mut shifted = model.contacts.clone();
    let mut before: Option<(Vec<f64>, Vec<bool>)> = None;
    for (k, solution) in solutions.iter().enumerate() {
        let there = is_there(model, k);
        let mut reference = at_step(model, k);
        let absent = absent_nodes(model, k);
        reference.supports.retain(|s| !absent.contains(&s.node));
        for &node in &absent {
            reference.supports.extend((0..dim).map(|axis| Support {
                node,
                direction: std::array::from_fn(|i| f64::from(i == axis)),
                value: 0.0,
                condition: 0,
            }));
        }
        reference.supports.sort_by_key(|support| support.node);
        assert!(
            reference
                .forces
                .iter()
                .all(|(node, _)| !absent.contains(node))
        );
        for (c, contact) in shifted.iter_mut().enumerate() {
            let Some((u, was_there)) = &before else {
                continue;
            };
            if there[c] && !was_there[c] {
                *contact = model.contacts[c].clone();
                for point in &mut contact.points {
                    point.gap += point.jump_along(point.normal(), dim, u);
                }
            }
        }
        let contacts = shifted.iter().zip(&there).filter(|(_, there)| **there);
        reference.contacts = contacts.map(|(contact, _)| contact.clone()).collect();
        let solved = Monolithic::new(&reference);
        compare(&reference, &solved, solution);
        for (contact, _) in model
            .contacts
            .iter()
            .zip(&there)
            .filter(|(_, there)| !**there)
        {
            let points = &solution.contacts[&contact.name];
            assert!(
                points
                    .iter()
                    .all(|p| p.gap.is_nan() && p.force == 0.0 && !p.closed)
            );
        }
        for node in absent {
            let tag = model.mesh.node_tags[node as usize];
            assert_eq!(solution.displacement[&tag], [0.0; 3]);
        }
        before = Some((solved.u, there));
    }
}

/// Solves all steps.
#[track_caller]
fn solved(model: &Model, count: usize, args: &[&str]) -> Vec<Solution> {
    let case = Case::of(model, count);
    let ended = case.run(args);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    assert!(
        !ended.stdout.contains("unconstrained rigid-body motion"),
        "{}",
        ended.stdout
    );
    let steps = Solution::steps(&case.result());
    steps.iter().for_each(Solution::check_certificate);
    steps
}

/// The upper block is added on the deformed lower one, loaded, and removed.
const COMES_AND_GOES: &str = "
[[step]]
body_force = { lower = [0.0, -1e6] }
[[step]]
add = 'upper'
body_force = { lower = [0.0, -1e6] }
[[step]]
scale = 2
[[step]]
remove = 'upper'
body_force = { lower = [0.0, -2e6] }
[[step]]
add = 'upper'
";

#[test]
fn bodies_that_come_are_put_on_what_is_deformed() {
    let text = format!("{BODIES}{SUPPORTS}{LOAD}{JOINT}{COMES_AND_GOES}");
    for pairing in ["nodes", "mortar"] {
        let text = text.replace(
            "name = 'joint'",
            &format!("name = 'joint'\npairing = '{pairing}'"),
        );
        let model = model(&text, two_blocks().mesh);
        for args in [
            &[][..],
            &["--method", "anderson"],
            &["--interface", "iterative"],
        ] {
            let steps = solved(&model, 6, args);
            assert_eq!(steps[0].closed(), 0);
            assert!(steps[1].closed() > 0);
            agrees(&model, &steps);
        }
    }
}

/// A ring on a shaft around an axis, and a solid on another one in space.
#[test]
fn bodies_come_and_go_around_an_axis_and_in_space() {
    let steps = "
        [[step]]
        [[step]]
        add = 'upper'
        [[step]]
        remove = 'upper'";
    let bodies = "
        materials.rock = {young = 20e9, poisson = 0.22}
        bodies.lower = {material = 'rock', body_force = [0.0, -1e6]}
        bodies.upper = {material = 'rock', body_force = [1e5, -1e6]}\n";
    let plane = format!(
        "plane = 'axisymmetric'{bodies}
        [[displacement]]
        on = 'lower bottom'
        y = 0.0
        {JOINT}{steps}"
    );
    let ring = model(&plane, two_blocks().mesh);
    agrees(&ring, &solved(&ring, 4, &[]));
    let block = |name, z| {
        solid(
            name,
            Hexahedron8,
            [3, 3, 2],
            between([0.0, 0.0, z], [1.0, 1.0, z + 0.5]),
        )
    };
    let space = format!(
        "{}
        [[displacement]]
        on = 'lower z0'
        x = 0.0
        y = 0.0
        z = 0.0
        [[displacement]]
        on = ['upper x0', 'upper y0']
        x = 0.0
        y = 0.0
        [[contact]]
        name = 'joint'
        sides = ['upper z0', 'lower z1']
        {steps}",
        bodies
            .replace("[0.0, -1e6]", "[0.0, 1e5, -1e6]")
            .replace("[1e5, -1e6]", "['1e5*x', 0.0, -1e6]")
    );
    let solids = model(&space, joined(block("lower", 0.0), block("upper", 0.5)));
    agrees(&solids, &solved(&solids, 4, &[]));
}

/// Without loads a body added on deformed ones carries no force and has no effect on them; it sticks at the position at
/// which it is added.
#[test]
fn what_comes_without_load_has_no_stress() {
    for law in ["", "friction = 0.5", "tresca = 1e5"] {
        comes_without_load(law);
    }
}

#[track_caller]
fn comes_without_load(law: &str) {
    let text = format!(
        "{BODIES}{HELD}{JOINT}{law}
        [[displacement]]
        on = 'upper left'
        x = 0.0
        [[displacement]]
        on = 'upper top'
        y = 0.0
        [[traction]]
        on = 'lower top'
        value = ['1e5*x', 1e6]
        [[step]]
        [[step]]
        add = 'upper'"
    );
    let model = model(&text, two_blocks().mesh);
    let steps = solved(&model, 4, &[]);
    let size = steps[0].largest_displacement();
    for point in steps[1].points() {
        let [x, y, _] = point.tangential_force;
        assert!(
            point.force.max(x.abs()).max(y.abs()) <= 1e-9 * 1e6,
            "{point:?}"
        );
        assert!(
            point.slip.iter().all(|slip| slip.abs() <= 1e-12 * size),
            "{point:?}"
        );
        assert!(point.gap.abs() <= 1e-12 * size, "{point:?}");
    }
    for (tag, u) in &steps[1].displacement {
        let was = steps[0].displacement[tag];
        assert!((0..2).all(|i| (u[i] - was[i]).abs() <= 1e-12 * size));
    }
}

#[test]
fn contacts_are_switched_by_themselves() {
    let text = format!(
        "{BODIES}{HELD}{JOINT}
        [[displacement]]
        on = 'upper top'
        x = 0.0
        y = '-1e-4*(x-0.4)^2'
        [[step]]
        [[step]]
        remove = 'joint'
        [[step]]
        add = ['joint']
        scale = 1.5
        [[step]]
        scale = 2"
    );
    let model = model(&text, two_blocks().mesh);
    let steps = solved(&model, 6, &[]);
    agrees(&model, &steps);
    let closed: Vec<bool> = steps
        .iter()
        .map(|step| step.largest_force() > 1.0)
        .collect();
    assert_eq!(closed, [true, false, true, true]);
}

/// Friction isn't affected by activation and deactivation of a body elsewhere.
#[test]
fn friction_goes_on_where_something_else_comes_and_goes() {
    let friction = JOINT.replace("name", "friction = 0.3\nname");
    let pushes = |extra: [&str; 3]| {
        let push = |x: f64, extra: &str| {
            format!("[[step]]\n{extra}\n[[step.traction]]\non = 'upper left'\nvalue = [{x}, 0.0]\n")
        };
        format!(
            "{}{}{}",
            push(2.5e5, extra[0]),
            push(-2e5, extra[1]),
            push(0.5e5, extra[2])
        )
    };
    let pair = format!("{BODIES}{HELD}[[pressure]]\non = 'upper top'\nvalue = 1e6\n{friction}");
    let alone = model(&format!("{pair}{}", pushes([""; 3])), two_blocks().mesh);
    let beside = two_blocks().rectangle("other", [5.0, 6.0], [0.0, 1.0], [4, 4]);
    let other = "
        [bodies.other]
        material = 'rock'
        body_force = [0.0, -1e6]
        [[displacement]]
        on = 'other bottom'
        x = 0.0
        y = 0.0\n";
    let steps = pushes(["", "remove = 'other'", "add = 'other'"]);
    let beside = model(&format!("{pair}{other}{steps}"), beside.mesh);
    let (alone, beside) = (solve_steps(&alone, 4), solved(&beside, 6, &[]));
    let slips = alone.iter().map(Solution::slipping);
    assert!(slips.max() > Some(0));
    for (a, b) in alone.iter().zip(&beside) {
        let (size, force) = (a.largest_displacement(), a.largest_force());
        for (tag, u) in &a.displacement {
            let v = b.displacement[tag];
            assert!(
                (0..2).all(|i| (u[i] - v[i]).abs() <= 1e-10 * size),
                "{u:?} {v:?}"
            );
        }
        for (p, q) in a.points().zip(b.points()) {
            let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-9 * scale;
            assert!(near(p.force, q.force, force), "{p:?} {q:?}");
            assert!(
                (0..2).all(|i| near(p.slip[i], q.slip[i], size)),
                "{p:?} {q:?}"
            );
            assert!((0..2).all(|i| near(p.tangential_force[i], q.tangential_force[i], force)));
        }
    }
}

#[test]
fn what_is_left_has_to_hold() {
    let text = format!(
        "{BODIES}{SUPPORTS}{LOAD}{JOINT}
        [[step]]
        [[step]]
        name = 'dig'
        remove = 'lower'"
    );
    let case = Case::of(&model(&text, two_blocks().mesh), 6);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 4, "{}{}", ended.stdout, ended.stderr);
    for words in ["step 'dig'", "'upper' is under-constrained"] {
        assert!(ended.stderr.contains(words), "{}", ended.stderr);
    }
    assert_eq!(case.files(), ["problem.h5"]);
}

/// A file with a loaded absent body is refused.
#[test]
fn nothing_may_act_on_what_is_not_there() {
    let text = format!("{BODIES}{SUPPORTS}{LOAD}{JOINT}[[step]]\n[[step]]");
    let mut problem = problem(&model(&text, two_blocks().mesh), Some(4));
    let upper = |body: &Body| body.name == "upper";
    let upper = problem.catalog.bodies.iter().position(upper).unwrap() as u32;
    problem.catalog.steps[1].absent.bodies.push(upper);
    let ended = Case::new(&problem).run(&[]);
    assert_eq!(ended.code(), 2, "{}{}", ended.stdout, ended.stderr);
    let words = "step '2': body 'upper' isn't there, but forces act on it";
    assert!(ended.stderr.contains(words), "{}", ended.stderr);
}
