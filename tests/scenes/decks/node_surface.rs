//! Contact of nodes without faces, compared with equivalent equations.

use super::solved;
use crate::support::close::close;

/// A narrow cube on a wide one, whose bottom has the nodes 11 to 14 at a height.
fn cubes(height: f64) -> String {
    let node = |tag: usize, x: f64, y: f64, z: f64| format!("{tag}, {x}, {y}, {z}\n");
    let corners = [(0.2, 0.3), (0.8, 0.3), (0.8, 0.9), (0.2, 0.9)];
    let ring = |first: usize, z: f64| -> String {
        let nodes = (first..).zip(corners);
        nodes.map(|(tag, (x, y))| node(tag, x, y, z)).collect()
    };
    let (bottom, top) = (ring(11, height), ring(15, height + 1.0));
    format!(
        "\
*NODE
 1, 0, 0, 0
 2, 1, 0, 0
 3, 1, 1, 0
 4, 0, 1, 0
 5, 0, 0, 1
 6, 1, 0, 1
 7, 1, 1, 1
 8, 0, 1, 1
{bottom}{top}*ELEMENT, TYPE=C3D8, ELSET=Lower
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=Upper
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=Foot
1, 2, 3, 4
*NSET, NSET=Top
15, 16, 17, 18
*SURFACE, NAME=Roof
Lower, S2
*SURFACE, NAME=Feet, TYPE=NODE
11
12
14
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=Lower, MATERIAL=M
*SOLID SECTION, ELSET=Upper, MATERIAL=M
*BOUNDARY
Foot, 1, 3
Top, 1, 2
"
    )
}

const PRESSED: &str = "\
*STEP
*STATIC
*CLOAD
Top, 3, -0.5
15, 3, -0.6
*END STEP
";

fn pair(interaction: &str) -> String {
    format!(
        "*SURFACE INTERACTION, NAME=I\n{interaction}*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE\nFeet, Roof\n"
    )
}

/// Three corners of the upper cube touch the face of the lower one, away from its nodes.
#[test]
fn nodes_stand_on_the_face_that_they_are_in_front_of() {
    let equations: String = [(11, 0.2, 0.3), (12, 0.8, 0.3), (14, 0.2, 0.9)]
        .map(|(tag, x, y)| {
            let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), x * y, (1.0 - x) * y];
            let terms = (5..).zip(weights);
            let terms: String = terms
                .map(|(of, n)| format!("{of}, 3, {:?}\n", -n))
                .collect();
            format!("*EQUATION\n5\n{tag}, 3, 1.\n{terms}")
        })
        .concat();
    let expected = &solved(&format!("{}{equations}{PRESSED}", cubes(1.0)))[0];
    let scale = expected.largest_displacement();
    for gap in [0.0, 1e-3] {
        let found = &solved(&format!("{}{}{PRESSED}", cubes(1.0 + gap), pair("")))[0];
        let contact = &found.contacts["Feet on Roof"];
        assert_eq!(contact.len(), 3);
        assert!(contact.iter().all(|row| row.force > 0.0));
        close(contact.iter().map(|row| row.force).sum(), 2.6, 1e-12);
        for tag in (1..9).chain(11..19) {
            let fall = [0.0, 0.0, if tag > 10 { -gap } else { 0.0 }];
            (0..3).for_each(|k| {
                let expected = expected.displacement[&tag][k] + fall[k];
                close(found.displacement[&tag][k], expected, 1e-9 * scale);
            });
        }
    }
}

/// A softened law uses the areas of all faces around the nodes.
#[test]
fn soft_feet_sink_in_by_their_force_over_the_stiffness() {
    let soft = pair("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n50.\n");
    let found = &solved(&format!("{}{soft}{PRESSED}", cubes(1.0)))[0];
    // A quarter of each of three faces: 0.6 by 0.6, and twice 0.6 by 1.
    let area = 0.25 * (0.6 * 0.6 + 2.0 * 0.6);
    for (row, [x, y]) in
        found.contacts["Feet on Roof"]
            .iter()
            .zip([[0.2, 0.3], [0.2, 0.9], [0.8, 0.3]])
    {
        let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), x * y, (1.0 - x) * y];
        let of_face = (5..)
            .zip(weights)
            .map(|(tag, n)| n * found.displacement[&tag][2]);
        let own = found.displacement[&row.tags[0]][2];
        close(of_face.sum::<f64>() - own, row.force / (50.0 * area), 1e-10);
    }
}
