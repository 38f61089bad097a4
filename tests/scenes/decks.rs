//! Unmodified decks of Abaqus and CalculiX.

mod conditions;
mod couplings;
mod node_surface;
mod parts;
mod pretension;

use contact_dd_partition::deck;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::close::close;
use crate::support::solution::Solution;
use crate::support::solver::solve_steps;

/// The solutions of all steps of a deck.
#[track_caller]
fn solved(deck: &str) -> Vec<Solution> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.inp");
    std::fs::write(&path, deck).unwrap();
    let translation = deck::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let scene = Scene::parse(&translation.scene).unwrap();
    let model = Model::new(&scene, translation.mesh).unwrap_or_else(|e| panic!("{e}"));
    solve_steps(&model, 2)
}

/// The reason why a deck is refused.
#[track_caller]
fn refused(deck: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.inp");
    std::fs::write(&path, deck).unwrap();
    let error = deck::read(&path).err();
    error.unwrap_or_else(|| panic!("it is read")).to_string()
}

/// A column of two cubes in contact, with Poisson's ratio 0: under a pressure, with its weight, and under forces only.
const COLUMN: &str = "\
*NODE
 1, 0, 0, 0
 2, 1, 0, 0
 3, 1, 1, 0
 4, 0, 1, 0
 5, 0, 0, 1
 6, 1, 0, 1
 7, 1, 1, 1
 8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=Lower
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=Upper
2, 11, 12, 13, 14, 15, 16, 17, 18
*ELSET, ELSET=All
Lower, Upper
*NSET, NSET=Top
15, 16, 17, 18
*SURFACE, NAME=Low
Lower, S2
*SURFACE, NAME=High
Upper, S1
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*DENSITY
3.
*SOLID SECTION, ELSET=All, MATERIAL=M
*SURFACE INTERACTION, NAME=I
*CONTACT PAIR, INTERACTION=I
High, Low
*BOUNDARY
1, 1, 3
2, 1, 3
3, 1, 3
4, 1, 3
11, 1, 2
12, 2
*AMPLITUDE, NAME=Half
0., 0., 2., 1.
*STEP
*STATIC
1., 1.
*DLOAD, AMPLITUDE=Half
Upper, P2, 20.
*END STEP
*STEP
*STATIC
*DLOAD
All, GRAV, 10., 0., 0., -1.
*END STEP
*STEP
*STATIC
*DLOAD, OP=NEW
*CLOAD
Top, 3, -2.5
*END STEP
";

#[test]
fn a_column_of_a_deck_is_as_short_as_by_hooke() {
    let steps = solved(COLUMN);
    // −∫ (p + γ (2 − z)) dz / E up to the middle and up to the top.
    let expected = [(10.0, 0.0), (10.0, 30.0), (10.0, 0.0)];
    assert_eq!(steps.len(), expected.len());
    for (solution, (p, weight)) in steps.iter().zip(expected) {
        let middle = -(p + 1.5 * weight) / 1000.0;
        let top = -(2.0 * p + 2.0 * weight) / 1000.0;
        for (tags, expected) in [(5..9, middle), (11..15, middle), (15..19, top)] {
            for tag in tags {
                let [x, y, z] = solution.displacement[&tag];
                close(z, expected, 1e-14);
                close(x, 0.0, 1e-14);
                close(y, 0.0, 1e-14);
            }
        }
        let force: f64 = solution.points().map(|point| point.force).sum();
        close(force.abs(), p + weight, 1e-12);
    }
}

/// The same column, pulled at one node, whose displacement the other nodes at the top share: the tie transmits tension.
const PULLED: &str = "\
*EQUATION
2
16, 3, 1., 15, 3, -1.
2
17, 3, 1., 15, 3, -1.
2
18, 3, 1., 15, 3, -1.
*STEP
*STATIC
*CLOAD
15, 3, 4.
*END STEP
";

#[test]
fn a_tied_column_of_a_deck_is_as_long_as_by_hooke() {
    let (mesh, _) = COLUMN.split_once("*SURFACE INTERACTION").unwrap();
    let (_, held) = COLUMN.split_once("High, Low\n").unwrap();
    let (held, _) = held.split_once("*AMPLITUDE").unwrap();
    for (tie, tables) in [
        ("*TIE, NAME=Glue, POSITION TOLERANCE=0.1\nHigh, Low\n", 1),
        ("*TIE, NAME=Glue, ADJUST=NO\nHigh, Low\n", 1),
        (
            "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e7\n\
             *CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nHigh, Low\n",
            1,
        ),
        (
            "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I, TIED\nHigh, Low\n",
            1,
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("column.inp");
        std::fs::write(&path, [mesh, tie, held, PULLED].concat()).unwrap();
        let translation = deck::read(&path).unwrap();
        assert_eq!(translation.scene.matches("[[tie]]").count(), tables);
        assert_eq!(translation.scene.matches("[[equation]]").count(), 3);
        let scene = Scene::parse(&translation.scene).unwrap();
        let model = Model::new(&scene, translation.mesh).unwrap();
        let solution = &solve_steps(&model, 2)[0];
        for tag in 15..=18 {
            close(solution.displacement[&tag][2], 4.0 * 2.0 / 1000.0, 1e-12);
        }
    }
}

#[test]
fn springs_of_a_deck_hold_a_column_as_by_hooke() {
    let (mesh, _) = COLUMN.split_once("*BOUNDARY").unwrap();
    let on_springs = "\
*ELEMENT, TYPE=SPRING1, ELSET=Feet
21, 1
22, 2
23, 3
24, 4
*SPRING, ELSET=Feet
3
100.
*NSET, NSET=Lower
1, 2, 3, 4, 5, 6, 7, 8
*BOUNDARY
Lower, 1, 2
11, 1, 2
12, 2
*STEP
*STATIC
*DLOAD
Upper, P2, 20.
*END STEP
";
    let solution = &solved(&format!("{mesh}{on_springs}"))[0];
    // Four springs have the stiffness 400 together, the column 1000 / 2.
    for (tags, expected) in [
        (1..5, -20.0 / 400.0),
        (15..19, -20.0 / 400.0 - 20.0 / 500.0),
    ] {
        for tag in tags {
            close(solution.displacement[&tag][2], expected, 1e-12);
        }
    }
}

#[test]
fn gaps_of_a_deck_are_closed_up_to_a_distance() {
    let (model, _) = COLUMN.split_once("*AMPLITUDE").unwrap();
    let pressed = "*STEP\n*STATIC\n*DLOAD\nUpper, P2, 20.\n*END STEP\n";
    // The cubes are separated by a gap, which is closed without strain or stays open.
    for (gap, adjust, closed) in [
        (0.01, "0.02", true),
        (0.01, "0.005", false),
        (-0.01, "0.0", true),
    ] {
        let mut deck = model.replace(
            "INTERACTION=I\n",
            &format!("INTERACTION=I, ADJUST={adjust}\n"),
        ) + pressed;
        for (tag, x, y) in [(11, 0, 0), (12, 1, 0), (13, 1, 1), (14, 0, 1)] {
            let apart = format!("{tag}, {x}, {y}, {:?}\n", 1.0 + gap);
            deck = deck.replace(&format!("{tag}, {x}, {y}, 1\n"), &apart);
        }
        let solution = &solved(&deck)[0];
        let middle = -20.0 / 1000.0;
        let foot = if closed { middle } else { middle - gap };
        for (tags, expected) in [(5..9, middle), (11..15, foot)] {
            for tag in tags {
                close(solution.displacement[&tag][2], expected, 1e-12);
            }
        }
        for tag in 15..19 {
            close(
                solution.displacement[&tag][2],
                foot - (1.0 - gap) * 0.02,
                1e-12,
            );
        }
    }
}
