//! Errors of decks, by file and line.

use super::{SQUARES, read, read_all};
use crate::says::says;

#[test]
fn a_mistake_is_named_with_its_line() {
    for (more, expected) in [
        (
            "*NODE\n1, 5., 5.",
            "line 20: the node 1 occurs twice, at (0, 0, 0) and at (5, 5, 0)",
        ),
        (
            "*NODE\n7, 5.-x",
            "line 20: expected the x coordinate, a number, found `5.-x`",
        ),
        (
            "*NODE\n7, a",
            "line 20: expected the x coordinate, a number, found `a`",
        ),
        (
            "*NODE\n-7, 1.",
            "line 20: expected the number of a node, a positive integer",
        ),
        ("*NODE\n7, 1e300", "line 20: the x coordinate is 1e300"),
        (
            "*NODE, SYSTEM=C\n7, 1.",
            "line 19: *NODE has SYSTEM=C; expected Cartesian",
        ),
        (
            "*ELEMENT, TYPE=CPE4\n3, 1, 2, 5",
            "line 20: element 3 has 3 nodes; expected 4",
        ),
        (
            "*ELEMENT, TYPE=CPE4\n3, 1, 2, 5, 77",
            "line 20: element 3 has the node 77",
        ),
        (
            "*ELEMENT, TYPE=CPE4\n3, 1, 2, 5, 5",
            "line 20: element 3 has the node 5 twice",
        ),
        (
            "*ELEMENT, TYPE=CPE4\n1, 2, 5, 4, 1",
            "line 20: the element 1 occurs twice, with different nodes",
        ),
        (
            "*ELEMENT, TYPE=C3D6\n3, 1, 2, 5",
            "line 19: elements of type C3D6 aren't supported; expected one of C3D4",
        ),
        (
            "*ELEMENT\n3, 1, 2, 5",
            "line 19: *ELEMENT has no TYPE; expected TYPE=",
        ),
        (
            "*NSET, NSET=a\nb",
            "line 20: there is no node and no set of nodes 'b'",
        ),
        (
            "*ELSET, ELSET=a\nb\n*ELSET, ELSET=b\na",
            "line 20: there is no element and no set of elements 'b'",
        ),
        (
            "*ELSET, ELSET=a\na",
            "line 20: there is no element and no set of elements 'a'",
        ),
        (
            "*ELSET, ELSET=a, GENERATE\n1, 2, 0",
            "line 20: expected first, last and increment, a positive integer",
        ),
        (
            "*ELSET, ELSET=a, INSTANCE=i\n1",
            "line 20: there is no instance 'i'",
        ),
        (
            "*SURFACE, NAME=a\nLeft, S5",
            "line 20: element 1, a quadrilateral of 4 nodes, has no face `S5`; expected S1 to S4",
        ),
        ("*SURFACE, NAME=a\nLeft, SPOS", "has no face `SPOS`"),
        (
            "*ELEMENT, TYPE=T2D2, ELSET=E\n7, 1, 2\n*SURFACE, NAME=a\nE, S3",
            "line 22: element 7, a line of 2 nodes, has no face `S3`; expected SPOS or SNEG",
        ),
        (
            "*SURFACE, NAME=a, COMBINE=DIFFERENCE\nb, c",
            "line 19: the surface 'a' has COMBINE=DIFFERENCE; expected COMBINE=UNION",
        ),
        (
            "*SURFACE, NAME=a, COMBINE=UNION\nb",
            "line 20: there is no surface 'b'",
        ),
        (
            "*SURFACE, NAME=a, TYPE=CUTTING SURFACE\n1",
            "line 19: the surface 'a' isn't made of faces",
        ),
        (
            "*NGEN\n1, 3, 1",
            "line 19: *NGEN isn't read; expected a deck that lists all nodes",
        ),
        ("*INSTANCE, NAME=a, PART=b", "line 19: there is no part 'b'"),
        (
            "*PART, NAME=b",
            "line 19: the deck ends within the part 'B'; expected *END PART",
        ),
        (
            "*PART, NAME=b\n*END PART\n*INSTANCE, NAME=c, PART=b\n*INSTANCE, NAME=d, PART=b",
            "line 22: *INSTANCE within the instance 'c'; expected *END INSTANCE before it",
        ),
        (
            "*PART, NAME=b\n*END PART\n*INSTANCE, NAME=c, PART=b",
            "line 21: the deck ends within the instance 'c'",
        ),
        (
            "*INCLUDE, INPUT=none.inp",
            "part.inp: line 19: none.inp: can't be read",
        ),
        (
            "*INCLUDE, INPUT=part.inp",
            "files are included in each other",
        ),
    ] {
        let printed = read(&format!("{SQUARES}{more}\n")).unwrap_err();
        assert!(printed.contains(expected), "{more}: {printed}");
    }
    for (deck, expected) in [
        (
            "12 4 1 0 0\n1 0 0 0\n",
            "part.inp: line 1: expected a keyword, such as *NODE",
        ),
        (
            "",
            "part.inp: the deck has no cells; expected *ELEMENT of type C3D4",
        ),
        (
            "*NODE\n1, 0., 0.\n2, 1., 0.\n*ELEMENT, TYPE=T2D2\n1, 1, 2\n",
            "has no cells",
        ),
    ] {
        let printed = read(deck).unwrap_err();
        says(&printed, expected);
    }
    let printed = read_all(&[
        ("a.inp", "*INCLUDE, INPUT=b.inp"),
        ("b.inp", "** \n*NODE\n1, x"),
    ])
    .unwrap_err();
    assert!(printed.starts_with("b.inp: line 3: "), "{printed}");
}

#[test]
fn a_mistake_is_short_however_long_its_words_are() {
    let long = "9".repeat(100_000);
    for more in [
        format!("*NODE\n{long}, 1."),
        format!("*NODE\n7, {long}x"),
        format!("*NODE\n7, {long}"),
        format!("*NODE, SYSTEM={long}\n"),
        format!("*ELEMENT, TYPE={long}\n"),
        format!("*NSET, NSET=a\nx{long}"),
        format!("*NSET, NSET=a, INSTANCE={long}\n1"),
        format!("*ELSET, ELSET={long}\n1, b"),
        format!("*SURFACE, NAME={long}, COMBINE={long}\n"),
        format!("*SURFACE, NAME=a\n1, {long}"),
        format!("*INCLUDE, INPUT={long}\n"),
        format!("*PART, NAME={long}\n*PART, NAME={long}\n"),
    ] {
        let printed = read(&format!("{SQUARES}{more}\n")).unwrap_err();
        assert!(printed.len() < 2500, "{}: {printed}", printed.len());
        says(&printed, "part.inp: line … ");
    }
    let mesh = read(&format!(
        "{long}\n{SQUARES}*{long}\n*NSET, NSET={long}\n77\n*ELEMENT, TYPE=MASS{long}\n9, 1\n"
    ));
    let printed = mesh.unwrap().warnings.join("\n");
    assert!(printed.len() < 2000, "{}: {printed}", printed.len());
}

#[test]
fn no_damage_makes_the_reader_panic() {
    let deck = format!("{SQUARES}*NSET, NSET=n, GENERATE\n1, 3, 1\n*SURFACE, NAME=s\nLeft, S1\n");
    let assembly = "*PART, NAME=P\n*NODE\n1, 0.\n2, 1.\n3, 1., 1.\n*ELEMENT, TYPE=CPS3I, ELSET=E\n1, 1, 2, 3\n\
                    *ELEMENT, TYPE=T2D2, ELSET=S\n2, 1, 2\n*SURFACE, NAME=A\nS, SPOS\n*END PART\n\
                    *INSTANCE, NAME=I, PART=P\n1., 2.\n0., 0., 0., 0., 0., 1., 90.\n*ELEMENT, TYPE=MASS\n9, 1\n\
                    *NSET, NSET=N, ELSET=E\n1, 7\n*END INSTANCE\n*INSTANCE, NAME=J, PART=P\n*END INSTANCE\n\
                    *SURFACE, NAME=U, COMBINE=UNION\nI.A, T\n*SURFACE, NAME=T, TYPE=NODE\nM, 1.\n\
                    *NSET, NSET=M\nI.N, J.1\n*NODE, NSET=R\n1, 5.-1\n";
    assert!(read(assembly).is_ok());
    for deck in [&deck, assembly] {
        for cut in (0..deck.len()).filter(|&cut| deck.is_char_boundary(cut)) {
            let _ = read(&deck[..cut]);
            let changed = format!("{}9{}", &deck[..cut], &deck[cut..]);
            let _ = read(&changed);
            let lost = format!(
                "{}{}",
                &deck[..cut],
                deck.get(cut + 1..).unwrap_or_default()
            );
            let _ = read(&lost);
        }
    }
}
