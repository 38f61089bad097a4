//! Bolts and cyclic symmetry in decks.

use super::solved;
use crate::support::close::close;

/// A bar of two cubes between two walls, with their common face as the cut.
const BOLT: &str = "\
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
99, 0, 0, 0
*ELEMENT, TYPE=C3D8, ELSET=Bar
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 5, 6, 7, 8, 15, 16, 17, 18
*NSET, NSET=Ends
1, 2, 3, 4, 15, 16, 17, 18
*SURFACE, NAME=Cut
1, S2
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=Bar, MATERIAL=M
*BOUNDARY
Ends, 1, 3
*PRE-TENSION SECTION, SURFACE=Cut, NODE=99
";

/// Tightened by a force, locked, stretched by a receding wall, and released.
#[test]
fn a_bolt_is_tightened_by_its_node_and_fixed() {
    let steps = "\
*STEP
*STATIC
*CLOAD
99, 1, 20.
*END STEP
*STEP
*STATIC
*BOUNDARY, FIXED
99, 1, 1
*BOUNDARY
15, 3, 3, 0.01
16, 3, 3, 0.01
17, 3, 3, 0.01
18, 3, 3, 0.01
*END STEP
*STEP
*STATIC
*BOUNDARY, OP=NEW
Ends, 1, 3
*CLOAD, OP=NEW
99, 1, 20.
*END STEP
";
    let solutions = solved(&format!("{BOLT}{steps}"));
    // E A / L = 500.
    for (solution, [force, shortening]) in
        (solutions.iter()).zip([[20.0, 0.04], [25.0, 0.04], [20.0, 0.04]])
    {
        let bolt = &solution.report["pretensions"][0];
        close(bolt["force"].as_f64().unwrap(), force, 1e-10);
        close(bolt["shortening"].as_f64().unwrap(), shortening, 1e-12);
    }
    // A positive force is tensile if the direction points away from the elements of the surface.
    for (direction, force) in [("0., 0., -1.", "-20."), ("0., 0., 2.", "20.")] {
        let deck =
            format!("{BOLT}{direction}\n*STEP\n*STATIC\n*CLOAD\n99, 1, {force}\n*END STEP\n");
        let bolt = &solved(&deck)[0].report["pretensions"][0];
        close(bolt["force"].as_f64().unwrap(), 20.0, 1e-10);
    }
    let shortened = format!("{BOLT}*STEP\n*STATIC\n*BOUNDARY\n99, 1, 1, 0.04\n*END STEP\n");
    let bolt = &solved(&shortened)[0].report["pretensions"][0];
    close(bolt["force"].as_f64().unwrap(), 20.0, 1e-10);
}

/// As in CalculiX, nodes on the cut stay with the elements beyond those of the surface.
#[test]
fn nodes_of_a_cut_move_with_the_elements_beyond_the_surface() {
    let step = "*STEP\n*STATIC\n*CLOAD\n99, 1, 20.\n*END STEP\n";
    for (surface, expected) in [("1, S2", -0.02), ("2, S1", 0.02)] {
        let deck = BOLT.replace("1, S2", surface);
        let solution = &solved(&format!("{deck}{step}"))[0];
        for tag in 5..9 {
            close(solution.displacement[&tag][2], expected, 1e-12);
        }
    }
}

/// A quarter of a square under torsion at its outer faces: the displacements of its sides are equal after rotation.
#[test]
fn a_quarter_of_a_square_does_what_the_others_do() {
    let deck = "\
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
*ELEMENT, TYPE=C3D8, ELSET=Quarter
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 5, 6, 7, 8, 15, 16, 17, 18
*NSET, NSET=Foot
1, 2, 3, 4
*SURFACE, NAME=One
Quarter, S3
*SURFACE, NAME=Next
Quarter, S6
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=Quarter, MATERIAL=M
*BOUNDARY
Foot, 1, 3
*TIE, NAME=Sides, CYCLIC SYMMETRY
One, Next
*CYCLIC SYMMETRY MODEL, N=4, TIE=Sides
0., 0., 0., 0., 0., 1.
*STEP
*STATIC
*CLOAD
6, 2, 3.
7, 1, 2.
*END STEP
";
    let solution = &solved(deck)[0];
    let [u, v, on_axis] = [6, 8, 5].map(|tag| solution.displacement[&tag]);
    let scale = solution.largest_displacement();
    close(v[0], -u[1], 1e-10 * scale);
    close(v[1], u[0], 1e-10 * scale);
    close(v[2], u[2], 1e-10 * scale);
    close(on_axis[0].hypot(on_axis[1]), 0.0, 1e-10 * scale);
    assert!(u[1].abs() > 0.1 * scale);
}
