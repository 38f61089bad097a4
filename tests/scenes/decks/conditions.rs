//! Equations of nodes without cells, supports along local axes, and activation and deactivation in steps, each compared
//! with an equivalent deck.

use super::couplings::{BAR, same};
use super::{COLUMN, refused, solved};
use crate::support::close::close;
use crate::support::solution::Solution;

fn step(loads: &str) -> String {
    format!("*STEP\n*STATIC\n{loads}*END STEP\n")
}

#[test]
fn a_node_of_no_body_moves_others_and_hands_on_its_force() {
    let node = "*NODE\n100, 0., 0., 9.\n101, 0., 0., 9.\n";
    let to = |node: i64| {
        (15..19).map(move |tag| format!("*EQUATION\n2\n{tag}, 3, 2., {node}, 3, -1.\n"))
    };
    // 2 u(Top) = u(100), directly or by another node.
    let direct: String = to(100).collect();
    let twice: String = to(101).collect::<String>() + "*EQUATION\n2\n101, 3, 1., 100, 3, -1.\n";
    let tied: String = (16..19)
        .map(|tag| format!("*EQUATION\n2\n{tag}, 3, 1., 15, 3, -1.\n"))
        .collect();
    for equations in [direct, twice] {
        let pulled = solved(&format!(
            "{BAR}{node}{equations}{}",
            step("*CLOAD\n100, 3, 3.\n")
        ));
        let expected = solved(&format!("{BAR}{tied}{}", step("*CLOAD\n15, 3, 6.\n")));
        same(&pulled[0], &expected[0], 1e-10);
        let moved =
            ["0.02", "-0.01"].map(|value| step(&format!("*BOUNDARY\n100, 3, 3, {value}\n")));
        let moved = solved(&format!("{BAR}{node}{equations}{}", moved.concat()));
        let expected =
            ["0.01", "-0.005"].map(|value| step(&format!("*BOUNDARY\nTop, 3, 3, {value}\n")));
        for (moved, expected) in moved
            .iter()
            .zip(&solved(&format!("{BAR}{}", expected.concat())))
        {
            same(moved, expected, 1e-10);
        }
    }
}

#[test]
fn a_node_of_no_body_is_held_in_some_of_the_steps() {
    let deck: String = (15..19)
        .map(|tag| format!("*EQUATION\n2\n{tag}, 3, 2., 100, 3, -1.\n"))
        .collect();
    let deck = format!("{BAR}*NODE\n100, 0., 0., 9.\n{deck}");
    let foot = "*BOUNDARY, OP=NEW\nFoot, 1, 3\n";
    let steps = [
        "100, 3, 3, 0.02\n*CLOAD, OP=NEW\n5, 1, 1.\n",
        "*CLOAD, OP=NEW\n100, 3, 3.\n",
        "100, 3, 3, -0.01\n*CLOAD, OP=NEW\n6, 2, 1.\n",
    ]
    .map(|loads| step(&format!("{foot}{loads}")));
    let found = solved(&format!("{deck}{}", steps.concat()));
    for (found, own) in found.iter().zip(&steps) {
        same(found, &solved(&format!("{deck}{own}"))[0], 1e-9);
    }
    close(found[0].displacement[&15][2], 0.01, 1e-10);
}

/// A fixed node keeps its displacement when the loads are removed, also if it was held before.
#[test]
fn what_is_fixed_stays_where_it_was() {
    let steps = [
        step("*CLOAD\nTop, 3, 3.\n15, 1, 1.\n"),
        step("*BOUNDARY, FIXED\nTop, 1, 3\nFoot, 1, 3\n*CLOAD, OP=NEW\n5, 1, 1.\n"),
        step("*BOUNDARY, OP=NEW\nFoot, 1, 3\n"),
    ];
    let found = solved(&format!("{BAR}{}", steps.concat()));
    for tag in 15..19 {
        let [before, after] = [0, 1].map(|step: usize| found[step].displacement[&tag]);
        assert!(before[2] > 0.0);
        (0..3).for_each(|k| close(after[k], before[k], 1e-12));
    }
    let expected = solved(&format!("{BAR}{}", step("*CLOAD\n5, 1, 1.\n")));
    same(&found[2], &expected[0], 1e-10);
    for (steps, reason) in [
        (
            step("*BOUNDARY, FIXED, OP=NEW\nTop, 1, 3\n"),
            "FIXED and OP=NEW isn't read",
        ),
        (
            step("*BOUNDARY, FIXED\nTop, 3\n") + &step("*BOUNDARY\nTop, 3, 3, 0.1\n"),
            "has been FIXED in a step before",
        ),
    ] {
        let error = refused(&format!("{BAR}{steps}"));
        assert!(error.contains(reason), "{error}");
    }
}

/// Elements of a distribution have the same axes as with a separate section.
#[test]
fn a_distribution_turns_the_axes_of_some_elements() {
    let (mesh, rest) = BAR.split_once("*MATERIAL").unwrap();
    let (_, held) = rest.split_once("MATERIAL=M\n").unwrap();
    let law = "*MATERIAL, NAME=M\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1000., 500., 200., 0.2, 0.3, 0.1, 300., 200.,\n100.\n";
    let turned = "0.6, 0.8, 0., -0.8, 0.6, 0.";
    let distribution = format!(
        "{mesh}{law}*DISTRIBUTION, NAME=D\n, 1., 0., 0., 0., 1., 0.\n2, {turned}\n*ORIENTATION, NAME=O\nD\n\
         *SOLID SECTION, ELSET=Bar, MATERIAL=M, ORIENTATION=O\n{held}"
    );
    let sections = format!(
        "{mesh}{law}*ELSET, ELSET=First\n1\n*ELSET, ELSET=Second\n2\n*ORIENTATION, NAME=P\n1., 0., 0., 0., 1., 0.\n*ORIENTATION, NAME=O\n{turned}\n\
         *SOLID SECTION, ELSET=First, MATERIAL=M, ORIENTATION=P\n\
         *SOLID SECTION, ELSET=Second, MATERIAL=M, ORIENTATION=O\n{held}"
    );
    let load = step("*CLOAD\nTop, 3, 3.\n15, 1, 1.\n");
    let [found, expected] =
        [distribution, sections].map(|deck| solved(&format!("{deck}{load}")).remove(0));
    same(&found, &expected, 1e-10);
}

#[test]
fn a_distributing_coupling_shares_a_force_by_weights() {
    let coupling = "*NODE\n100, .5, .5, 2.\n*ELEMENT, TYPE=DCOUP3D, ELSET=Hook\n9, 100\n*DISTRIBUTING COUPLING, ELSET=Hook\n\
                    15, 3.\n16, 1.\n";
    let found = solved(&format!(
        "{BAR}{coupling}{}",
        step("*CLOAD\n100, 1, 4.\n100, 3, 8.\n")
    ));
    let shared = step("*CLOAD\n15, 1, 3.\n16, 1, 1.\n15, 3, 6.\n16, 3, 2.\n");
    same(&found[0], &solved(&format!("{BAR}{shared}"))[0], 1e-10);
}

/// Supports and equations along local axes act as in the bar rotated by that angle.
#[test]
fn local_axes_turn_what_is_held_and_equated() {
    let (c, s) = (0.8, 0.6);
    let held = "*BOUNDARY\nTop, 1, 1, 0.01\n*EQUATION\n2\n6, 2, 1., 7, 1, 2.\n";
    let plain = solved(&format!(
        "{BAR}{held}{}",
        step("*CLOAD\n8, 2, 3.\n17, 3, 2.\n")
    ));
    let mut turned = BAR.to_owned();
    for x in [0.0, 1.0] {
        for y in [0.0, 1.0] {
            for z in [0, 1, 2] {
                let place = format!(", {x}, {y}, {z}\n");
                let there = format!(", {:?}, {:?}, {z}.\n", c * x - s * y, s * x + c * y);
                turned = turned.replace(&place, &there);
            }
        }
    }
    let axes =
        "*NSET, NSET=Upper\n6, 7, 8, Top\n*TRANSFORM, NSET=Upper\n0.8, 0.6, 0., -0.6, 0.8, 0.\n";
    let turned = solved(&format!(
        "{turned}{axes}{held}{}",
        step("*CLOAD\n8, 2, 3.\n17, 3, 2.\n")
    ));
    let scale = plain[0].largest_displacement();
    for tag in (5..9).chain(15..19) {
        let [x, y, z] = plain[0].displacement[&tag];
        let there = turned[0].displacement[&tag];
        for (k, expected) in [c * x - s * y, s * x + c * y, z].into_iter().enumerate() {
            close(there[k], expected, 1e-9 * scale);
        }
    }
}

/// Without friction the load path doesn't matter: every step has the solution of a deck with this step only.
#[test]
fn supports_come_and_go_with_the_steps() {
    let foot = "*BOUNDARY, OP=NEW\nFoot, 1, 3\n";
    let steps = [
        "Top, 3, 3, 0.01\n*CLOAD, OP=NEW\n",
        "*CLOAD, OP=NEW\n15, 1, 2.\n15, 3, 4.\n",
        "Top, 1, 1, 0.02\n16, 3, 3, -0.01\n*CLOAD, OP=NEW\n17, 3, 1.\n",
        "Top, 1, 1, 0.03\n16, 3, 3\n*CLOAD, OP=NEW\n17, 3, 1.\n",
    ];
    let all: String = steps
        .iter()
        .map(|loads| step(&format!("{foot}{loads}")))
        .collect();
    for (solution, loads) in solved(&format!("{BAR}{all}")).iter().zip(steps) {
        let alone = solved(&format!("{BAR}{}", step(&format!("{foot}{loads}"))));
        same(solution, &alone[0], 1e-9);
    }
}

#[test]
fn laws_and_pairs_change_with_the_steps() {
    let (model, _) = COLUMN.split_once("*AMPLITUDE").unwrap();
    let law =
        |stiffness: &str| format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness}\n");
    let soft = model.replace("NAME=I\n", &format!("NAME=I\n{}", law("100.")));
    let press = "*DLOAD\nUpper, P2, 20.\n";
    let change = format!("*CHANGE SURFACE BEHAVIOR, INTERACTION=I\n{}", law("400."));
    let steps = [step(press), step(&change), step("*DLOAD\nUpper, P2, 10.\n")];
    let found = solved(&(soft + &steps.concat()));
    // p/K + 2 p/E.
    for (solution, [pressure, stiffness]) in
        found
            .iter()
            .zip([[20.0, 100.0], [20.0, 400.0], [10.0, 400.0]])
    {
        let expected = -pressure / stiffness - pressure / 500.0;
        close(solution.displacement[&15][2], expected, 1e-10);
    }
    // After being moved apart and back while the contact is inactive, the cubes touch at the same positions.
    let pair = |what: &str| format!("*MODEL CHANGE, TYPE=CONTACT PAIR, {what}\nHigh, Low\n");
    let lifted = step(&format!("{}*BOUNDARY\nTop, 3, 3, 0.1\n", pair("REMOVE")));
    let pressed = step(&format!("{}*BOUNDARY\nTop, 3, 3, -0.02\n", pair("ADD")));
    let found = solved(&format!("{model}{lifted}{pressed}"));
    close(found[0].displacement[&11][2], 0.1, 1e-12);
    close(found[1].displacement[&11][2], -0.01, 1e-10);
    // Removed elements leave the others without load.
    let gone = "*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nUpper\n";
    let found = solved(&format!("{model}{}{}", step(press), step(gone)));
    close(found[0].displacement[&5][2], -0.02, 1e-12);
    close(found[1].displacement[&5][2], 0.0, 1e-12);
}

#[test]
fn stress_that_is_there_at_first_makes_a_bar_longer() {
    let stress = "*INITIAL CONDITIONS, TYPE=STRESS\n1, -5., -5., -5.\n2, 0., 0., -8.\n";
    let bar = BAR.replace("1000., 0.3", "1000., 0.");
    let held = "*BOUNDARY\n5, 1, 2\n6, 1, 2\n7, 1, 2\n8, 1, 2\n";
    let found = solved(&format!("{bar}{held}{stress}{}", step("")));
    close(found[0].displacement[&6][2], 5.0 / 1000.0, 1e-12);
    close(found[0].displacement[&16][2], 13.0 / 1000.0, 1e-12);
    // CalculiX has a line for every integration point.
    let points: String = (1..9)
        .map(|k| format!("1, {k}, -5., -5., -5., 0., 0., 0.\n"))
        .collect();
    let points =
        format!("*INITIAL CONDITIONS, TYPE=STRESS\n{points}2, 1, 0., 0., -8., 0., 0., 0.\n");
    let same_one = solved(&format!("{bar}{held}{points}{}", step("")));
    same(&same_one[0], &found[0], 1e-12);
}

#[test]
fn nodes_follow_around_an_axis() {
    let deck = |rest: &str| {
        let coupling = "*NODE\n100, 0.5, 0.5, 2.\n*ORIENTATION, NAME=Round, SYSTEM=CYLINDRICAL\n.5, .5, 0., .5, .5, 1.\n";
        format!(
            "{BAR}{coupling}{rest}{}",
            step("*BOUNDARY\n100, 6, 6, 0.01\n")
        )
    };
    let around = solved(&deck(
        "*COUPLING, CONSTRAINT NAME=Hub, REF NODE=100, SURFACE=Roof, ORIENTATION=Round\n*KINEMATIC\n2\n",
    ));
    for (tag, x, y) in [
        (15, -0.5, -0.5),
        (16, 0.5, -0.5),
        (17, 0.5, 0.5),
        (18, -0.5, 0.5),
    ] {
        let u = around[0].displacement[&tag];
        close((x * u[1] - y * u[0]) / 0.5, 0.01, 1e-9);
    }
    // By symmetry corners only move around the axis, as all nodes do if they are rigid.
    let rigid = solved(&deck(
        "*COUPLING, CONSTRAINT NAME=Hub, REF NODE=100, SURFACE=Roof\n*KINEMATIC\n1, 3\n",
    ));
    same(&around[0], &rigid[0], 1e-9);
}

/// Every kind of `*MPC`, with its equation between the displacements, and other nodes free to move.
#[test]
fn constraints_of_several_nodes_hold() {
    let loads = step("*CLOAD\n15, 1, 2.\n16, 2, 3.\n17, 3, -4.\n18, 1, 1.\n6, 3, 5.\n");
    let free = &solved(&format!("{BAR}{loads}"))[0];
    let mut checks = 0;
    let mut check = |mpc: &str, rest: &dyn Fn(&Solution) -> f64| {
        let held = &solved(&format!(
            "{BAR}*NODE\n100, 0., 0., 4.\n*MPC\n{mpc}\n{loads}"
        ))[0];
        close(rest(held), 0.0, 1e-9 * held.largest_displacement());
        assert!(
            rest(free).abs() > 1e-3 * free.largest_displacement(),
            "{mpc}"
        );
        checks += 1;
    };
    // 15 and 17 lie on a diagonal of the roof, 7 is below 17.
    check("BEAM, 15, 17", &|of| {
        let [a, b] = [15, 17].map(|tag| of.displacement[&tag]);
        b[0] - a[0] + b[1] - a[1]
    });
    for k in [0, 1] {
        check("STRAIGHT, 3, 17, 7", &|of| {
            let [a, b, c] = [3, 17, 7].map(|tag| of.displacement[&tag]);
            c[k] - (a[k] + b[k]) / 2.0
        });
    }
    check("PLANE, 15, 16, 17, 18", &|of| {
        let [a, b, c, d] = [15, 16, 17, 18].map(|tag| of.displacement[&tag][2]);
        a + c - b - d
    });
    assert_eq!(checks, 4);
    // A common rotation of all nodes is their average rotation, also if it is prescribed.
    let turned = "MEANROT, 15, 15, 15, 16, 16, 16, 17, 17, 17, 18, 18, 18, 100\n";
    let deck = format!(
        "{BAR}*NODE\n100, 0., 0., 4.\n*MPC\n{turned}{}",
        step("*BOUNDARY\n100, 1, 1, 0.01\n")
    );
    let coupling = "*NODE\n100, 0.5, 0.5, 2.\n*ORIENTATION, NAME=Round, SYSTEM=CYLINDRICAL\n.5, .5, 0., .5, .5, 1.\n\
                    *COUPLING, CONSTRAINT NAME=Hub, REF NODE=100, SURFACE=Roof, ORIENTATION=Round\n*KINEMATIC\n2\n";
    let hub = format!("{BAR}{coupling}{}", step("*BOUNDARY\n100, 6, 6, 0.01\n"));
    same(&solved(&deck)[0], &solved(&hub)[0], 1e-9);
}
