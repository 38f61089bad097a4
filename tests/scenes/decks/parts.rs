//! Parts of decks whose instances are turned, compared with the same deck without parts.

use super::couplings::BAR;
use super::{refused, solved};
use crate::support::close::close;

/// The bar as the instance of a part that lies along x there, with what the part holds besides.
fn turned(in_part: &str) -> String {
    let (mesh, _) = BAR.split_once("*NSET, NSET=Foot").unwrap();
    let sets = "*NSET, NSET=Foot\n1, 2, 3, 4\n*NSET, NSET=Top\n15, 16, 17, 18\n*SURFACE, NAME=Middle\n1, S2\n";
    let material = "*MATERIAL, NAME=M\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1000., 500., 200., 0.2, 0.3, 0.1, 300., 200.,\n100.\n";
    // By 90° about y: the part's z is x, its x is −z.
    format!(
        "*PART, NAME=P\n{mesh}{sets}{in_part}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n0., 0., 0.\n\
         0., 0., 0., 0., 1., 0., 90.\n*END INSTANCE\n*NSET, NSET=Foot, INSTANCE=I\n1, 2, 3, 4\n*NSET, NSET=Top, INSTANCE=I\n\
         15, 16, 17, 18\n*END ASSEMBLY\n{material}*BOUNDARY\nFoot, 1, 3\n*STEP\n*STATIC\n*CLOAD\nTop, 1, 3.\nTop, 3, 1.\n\
         *END STEP\n"
    )
}

const SECTION: &str = "*ORIENTATION, NAME=O\n0.6, 0.8, 0., -0.8, 0.6, 0.\n*SOLID SECTION, ELSET=Bar, MATERIAL=M, ORIENTATION=O\n";

#[test]
fn a_section_of_a_turned_part_may_be_given_twice() {
    let once = solved(&turned(SECTION));
    let again = "*SOLID SECTION, ELSET=Bar, MATERIAL=M, ORIENTATION=O\n";
    let twice = solved(&turned(&format!("{SECTION}{again}")));
    let scale = once[0].largest_displacement();
    for (tag, u) in &once[0].displacement {
        (0..3).for_each(|k| close(twice[0].displacement[tag][k], u[k], 1e-12 * scale));
    }
    let other = "*SOLID SECTION, ELSET=Bar, MATERIAL=M\n";
    let error = refused(&turned(&format!("{SECTION}{other}")));
    assert!(error.contains("has another *SOLID SECTION"), "{error}");
}

/// Degrees of freedom are along the axes of the deck, in a part as behind it.
#[test]
fn equations_and_springs_of_a_part_do_not_turn() {
    let joined = "*EQUATION\n2\n5, 1, 1., 16, 1, -1.\n*ELEMENT, TYPE=SPRING1, ELSET=S\n30, 17\n*SPRING, ELSET=S\n3\n40.\n";
    let in_part = solved(&turned(&format!("{SECTION}{joined}")));
    let u = |tag: i64| in_part[0].displacement[&tag];
    let scale = in_part[0].largest_displacement();
    close(u(5)[0], u(16)[0], 1e-10 * scale);
    assert!((u(5)[2] - u(16)[2]).abs() > 1e-3 * scale);
    let free = solved(&turned(SECTION));
    assert!(free[0].displacement[&17][2].abs() > 1.5 * u(17)[2].abs());
}

#[test]
fn a_direction_of_a_bolt_in_a_turned_part_is_refused() {
    let section = "*PRE-TENSION SECTION, SURFACE=Middle, NODE=99\n";
    let node = "*NODE\n99, 0., 0., 0.\n";
    let error = refused(&turned(&format!("{node}{SECTION}{section}0., 0., 1.\n")));
    assert!(error.contains("whose instances are turned"), "{error}");
    let deck = turned(&format!("{node}{SECTION}{section}"));
    // The foot holds one part alone, so that the shortening is given.
    let short = deck.replace("*STEP\n", "*STEP\n*BOUNDARY\nI.99, 1, 1, 0.01\n");
    let bolt = &solved(&short)[0].report["pretensions"][0];
    close(bolt["shortening"].as_f64().unwrap(), 0.01, 1e-12);
    // Across the cut acts what pulls at the top, along the bar.
    close(bolt["force"].as_f64().unwrap(), 4.0 * 3.0, 1e-9);
}
