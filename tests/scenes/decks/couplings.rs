//! Reference nodes of decks, compared with equivalent conditions on the single nodes.

use super::solved;
use crate::support::close::close;
use crate::support::solution::Solution;

/// A bar of two cubes with common nodes, fixed at its foot.
pub const BAR: &str = "\
*NODE
 1, 0, 0, 0
 2, 1, 0, 0
 3, 1, 1, 0
 4, 0, 1, 0
 5, 0, 0, 1
 6, 1, 0, 1
 7, 1, 1, 1
 8, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=Bar
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 5, 6, 7, 8, 15, 16, 17, 18
*NSET, NSET=Foot
1, 2, 3, 4
*NSET, NSET=Top
15, 16, 17, 18
*SURFACE, NAME=Roof
2, S2
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=Bar, MATERIAL=M
*BOUNDARY
Foot, 1, 3
*AMPLITUDE, NAME=Half
0., 0., 2., 1.
";

/// Fails unless nodes of the bar have the same displacements.
#[track_caller]
pub fn same(one: &Solution, other: &Solution, slack: f64) {
    let scale = one.largest_displacement();
    for tag in (1..9).chain(15..19) {
        let [u, v] = [one, other].map(|solution| solution.displacement[&tag]);
        (0..3).for_each(|k| close(u[k], v[k], slack * scale));
    }
}

/// The force and the moment about the origin at the foot.
fn at_foot(solution: &Solution) -> [f64; 6] {
    let of = &solution.report["reactions"][0];
    let number = |list: &str, k: usize| of[list][k].as_f64().unwrap();
    std::array::from_fn(|k| match k {
        0..3 => number("force", k),
        _ => number("moment", k - 3),
    })
}

#[test]
fn nodes_follow_a_reference_node_as_if_each_were_moved() {
    let (point, u, turn) = ([0.4, 0.7, 3.0], [1e-3, -2e-3, 3e-3], [2e-3, -1e-3, 4e-3]);
    let mut moved = String::from("*BOUNDARY, AMPLITUDE=Half\n");
    for (tag, at) in [
        (15, [0.0, 0.0, 2.0]),
        (16, [1.0, 0.0, 2.0]),
        (17, [1.0, 1.0, 2.0]),
        (18, [0.0, 1.0, 2.0]),
    ] {
        for (k, shift) in u.iter().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let arm = |k: usize| at[k] - point[k];
            let value = shift + turn[i] * arm(j) - turn[j] * arm(i);
            moved += &format!("{tag}, {0}, {0}, {value:?}\n", k + 1);
        }
    }
    let steps = |moved: &str| {
        format!("*STEP\n*STATIC\n{moved}*END STEP\n*STEP\n*STATIC\n*CLOAD\n5, 1, 2.\n*END STEP\n")
    };
    let expected = solved(&format!("{BAR}{}", steps(&moved)));
    let all = |node: [i64; 6], freedom: [usize; 6]| {
        let line = |k: usize| {
            let value = if k < 3 { u[k] } else { turn[k - 3] };
            format!("{}, {1}, {1}, {value:?}\n", node[k], freedom[k])
        };
        let lines: Vec<String> = (0..6).map(line).collect();
        format!("*BOUNDARY, AMPLITUDE=Half\n{}", lines.concat())
    };
    let node = "*NODE\n100, 0.4, 0.7, 3.\n101, 0., 0., 0.\n";
    let own = all([100; 6], [1, 2, 3, 4, 5, 6]);
    for (coupling, moved) in [
        (
            "*COUPLING, CONSTRAINT NAME=Grip, REF NODE=100, SURFACE=Roof\n*KINEMATIC\n1, 3\n",
            &own,
        ),
        ("*RIGID BODY, NSET=Top, REF NODE=100\n", &own),
        (
            "*RIGID BODY, NSET=Top, REF NODE=100, ROT NODE=101\n",
            &all([100, 100, 100, 101, 101, 101], [1, 2, 3, 1, 2, 3]),
        ),
    ] {
        let found = solved(&format!("{BAR}{node}{coupling}{}", steps(moved)));
        assert_eq!(found.len(), 2);
        for (found, expected) in found.iter().zip(&expected) {
            same(found, expected, 1e-10);
        }
        close(
            found[0].displacement[&15][2],
            expected[0].displacement[&15][2],
            1e-12,
        );
        assert!(expected[0].largest_displacement() > 1e-3);
    }
}

#[test]
fn a_force_that_is_distributed_is_a_uniform_traction() {
    let steps = |first: &str, second: &str| {
        format!(
            "{BAR}*NODE\n100, .5, .5, 2.\n*COUPLING, CONSTRAINT NAME=Hook, REF NODE=100, SURFACE=Roof\n*DISTRIBUTING\n1, 3\n\
                 *STEP\n*STATIC\n{first}\n*END STEP\n*STEP\n*STATIC\n{second}\n*END STEP\n"
        )
    };
    let expected = solved(&steps(
        "*DSLOAD, AMPLITUDE=Half\nRoof, TRVEC, 5., 3., 0., 4.",
        "*DSLOAD, OP=NEW\nRoof, TRVEC, 2., 0., 1., 0.",
    ));
    let found = solved(&steps(
        "*CLOAD, AMPLITUDE=Half\n100, 1, 3.\n100, 3, 4.",
        "*CLOAD, OP=NEW\n100, 2, 2.",
    ));
    for (found, expected) in found.iter().zip(&expected) {
        same(found, expected, 1e-10);
    }
    close(at_foot(&expected[0])[2], -2.0, 1e-9);
}

#[test]
fn the_foot_bears_what_acts_on_a_reference_node() {
    let loads = "*STEP\n*STATIC\n*CLOAD\n100, 1, 3.\n100, 2, -1.\n100, 3, 4.\n100, 4, 5.\n100, 5, -6.\n100, 6, 7.\n*END STEP\n";
    let (f, m, at) = ([3.0, -1.0, 4.0], [5.0, -6.0, 7.0], [0.4, 0.7, 3.0]);
    for coupling in [
        "*COUPLING, CONSTRAINT NAME=Grip, REF NODE=100, SURFACE=Roof\n*KINEMATIC\n",
        "*COUPLING, CONSTRAINT NAME=Hook, REF NODE=100, SURFACE=Roof\n*DISTRIBUTING\n1, 6\n",
        "*RIGID BODY, NSET=Top, REF NODE=100\n",
    ] {
        let deck = format!("{BAR}*NODE\n100, 0.4, 0.7, 3.\n{coupling}{loads}");
        let found = at_foot(&solved(&deck)[0]);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            close(found[k], -f[k], 1e-10);
            close(found[3 + k], -(m[k] + at[i] * f[j] - at[j] * f[i]), 1e-9);
        }
    }
}

/// A coupling of the roof whose reference node lies at the place of node 15.
const AT_15: &str = "*NODE\n100, 0., 0., 2.\n*COUPLING, CONSTRAINT NAME=Grip, REF NODE=100, SURFACE=Roof\n*KINEMATIC\n1, 3\n";

fn step(loads: &str) -> String {
    format!("*STEP\n*STATIC\n{loads}*END STEP\n")
}

/// Without friction the load path doesn't matter: every step has the solution of a deck with this step only.
#[test]
fn supports_of_a_reference_node_come_and_go_with_the_steps() {
    let node = "*NODE\n100, 0.4, 0.7, 3.\n";
    let foot = "*BOUNDARY, OP=NEW\nFoot, 1, 3\n";
    let steps = [
        "100, 3, 3, 0.01\n100, 4, 4, 2e-3\n*CLOAD, OP=NEW\n",
        "*CLOAD, OP=NEW\n100, 1, 2.\n100, 5, 4.\n",
        "100, 1, 2, 0.02\n100, 6, 6, -3e-3\n*CLOAD, OP=NEW\n100, 3, 1.\n5, 2, 3.\n",
        "100, 1, 1, 0.03\n*BOUNDARY, AMPLITUDE=Half\n100, 5, 5, 8e-3\n*CLOAD, OP=NEW\n100, 2, 1.\n",
    ]
    .map(|loads| step(&format!("{foot}{loads}")));
    for coupling in [
        "*COUPLING, CONSTRAINT NAME=Grip, REF NODE=100, SURFACE=Roof\n*KINEMATIC\n1, 3\n",
        "*COUPLING, CONSTRAINT NAME=Hook, REF NODE=100, SURFACE=Roof\n*DISTRIBUTING\n1, 6\n",
        "*RIGID BODY, NSET=Top, REF NODE=100\n",
    ] {
        let found = solved(&format!("{BAR}{node}{coupling}{}", steps.concat()));
        for (found, own) in found.iter().zip(&steps) {
            let alone = solved(&format!("{BAR}{node}{coupling}{own}"));
            same(found, &alone[0], 1e-9);
        }
    }
    // Along x nothing follows this point, so that a support along x has no effect.
    let slides = format!(
        "{BAR}{node}*COUPLING, CONSTRAINT NAME=Grip, REF NODE=100, SURFACE=Roof\n*KINEMATIC\n3\n"
    );
    let push = "*CLOAD\n15, 1, 2.\n";
    let free = solved(&format!("{slides}{}", step(push)));
    let held = solved(&format!(
        "{slides}{}{}",
        step(push),
        step("*BOUNDARY\n100, 1, 1\n")
    ));
    same(&held[1], &free[0], 1e-9);
}

#[test]
fn a_reference_node_that_is_fixed_stays_where_it_was() {
    let steps = [
        step("*CLOAD\n100, 3, 3.\n100, 4, 1.\n"),
        step("*BOUNDARY, FIXED\n100, 1, 6\n*CLOAD, OP=NEW\n5, 1, 1.\n"),
        step("*BOUNDARY, OP=NEW\nFoot, 1, 3\n"),
    ];
    let found = solved(&format!("{BAR}{AT_15}{}", steps.concat()));
    for tag in 15..19 {
        let [before, after] = [0, 1].map(|step: usize| found[step].displacement[&tag]);
        assert!(before[2] != 0.0);
        (0..3).for_each(|k| close(after[k], before[k], 1e-12));
    }
    let expected = solved(&format!("{BAR}{AT_15}{}", step("*CLOAD\n5, 1, 1.\n")));
    same(&found[2], &expected[0], 1e-9);
}

/// The roof is rigid, so that the differences of its nodes are the rotations of the reference node.
#[test]
fn equations_refer_to_the_motion_of_a_reference_node() {
    let loads = step("*CLOAD\n100, 3, 3.\n100, 4, 1.\n6, 2, 2.\n");
    for [own, other] in [
        ["2\n100, 3, 1., 6, 1, -2.\n", "2\n15, 3, 1., 6, 1, -2.\n"],
        [
            "2\n100, 4, 1., 6, 1, -1.\n",
            "3\n18, 3, 1., 15, 3, -1., 6, 1, -1.\n",
        ],
        [
            "3\n6, 1, 1., 100, 6, 2., 100, 2, 1.\n",
            "4\n6, 1, 1., 16, 2, 2., 15, 2, -2., 15, 2, 1.\n",
        ],
    ] {
        let [found, expected] =
            [own, other].map(|terms| solved(&format!("{BAR}{AT_15}*EQUATION\n{terms}{loads}")));
        same(&found[0], &expected[0], 1e-9);
    }
    for (terms, reason) in [
        ("2\n100, 7, 1., 6, 1, -1.\n", "degree of freedom 7"),
        (
            "2\n6, 4, 1., 100, 1, -1.\n",
            "4 of the node 6 is no displacement",
        ),
    ] {
        let error = super::refused(&format!("{BAR}{AT_15}*EQUATION\n{terms}{loads}"));
        assert!(error.contains(reason), "{error}");
    }
}

/// A spring acts like the forces that its stretch determines.
#[test]
fn springs_at_a_reference_node_act_like_their_forces() {
    let element =
        |kind: &str, nodes: &str| format!("*ELEMENT, TYPE={kind}, ELSET=S\n20, {nodes}\n");
    let loads = "100, 3, 3.\n100, 4, 1.\n6, 1, 2.\n";
    // The element, its degrees of freedom, its stretch, and the directions of its forces.
    type Case = (
        String,
        &'static str,
        fn(&Solution) -> f64,
        &'static [(&'static str, f64)],
    );
    let cases: [Case; 4] = [
        (
            element("SPRING1", "100"),
            "3\n",
            |u| u.displacement[&15][2],
            &[("100, 3", 1.0)],
        ),
        (
            element("SPRING1", "100"),
            "4\n",
            |u| u.displacement[&18][2] - u.displacement[&15][2],
            &[("100, 4", 1.0)],
        ),
        (
            element("SPRING2", "100, 6"),
            "3, 1\n",
            |u| u.displacement[&15][2] - u.displacement[&6][0],
            &[("100, 3", 1.0), ("6, 1", -1.0)],
        ),
        (
            element("SPRINGA", "100, 5"),
            "\n",
            |u| u.displacement[&15][2] - u.displacement[&5][2],
            &[("100, 3", 1.0), ("5, 3", -1.0)],
        ),
    ];
    for (element, freedoms, stretch, ends) in cases {
        let spring = format!("{element}*SPRING, ELSET=S\n{freedoms}70.\n");
        let found = solved(&format!(
            "{BAR}{AT_15}{spring}{}",
            step(&format!("*CLOAD\n{loads}"))
        ));
        let force = -70.0 * stretch(&found[0]);
        assert!(force.abs() > 0.01, "{element}: {force}");
        let forces = ends
            .iter()
            .map(|(end, sign)| format!("{end}, {:?}\n", sign * force));
        let forces = step(&format!("*CLOAD\n{loads}{}", forces.collect::<String>()));
        same(
            &solved(&format!("{BAR}{AT_15}{forces}"))[0],
            &found[0],
            1e-9,
        );
    }
}
