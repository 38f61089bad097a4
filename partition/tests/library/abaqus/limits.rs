//! Small decks that expand to more than any memory: they are read, or refused with the limit.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use super::{SQUARES, read, read_all, tags};
use crate::says::says;

/// Far above the time for reading such a deck, far below the time for expanding it.
const AT_ONCE: Duration = Duration::from_secs(20);

#[test]
fn sets_of_sets_are_sets() {
    let started = Instant::now();
    let mut deck = format!("{SQUARES}*NSET, NSET=A0\n1, 2, 3\n");
    for level in 1..=11 {
        let below = vec![format!("A{}", level - 1); 10].join(", ");
        writeln!(deck, "*NSET, NSET=A{level}\n{below}").unwrap();
    }
    for _ in 0..40 {
        deck += "*NSET, NSET=A11\nA11, A11\n*ELSET, ELSET=Left\nLeft, Left\n";
    }
    for level in 0..25 {
        let union = format!("*SURFACE, NAME=S{}, COMBINE=UNION\n", level + 1);
        write!(
            deck,
            "*SURFACE, NAME=S0\nLeft, S4\n{union}S{level}, S{level}\n"
        )
        .unwrap();
    }
    let mesh = read(&deck).unwrap();
    assert_eq!(tags(&mesh, "A11"), [[1, 2], [2, 3]]);
    assert_eq!(tags(&mesh, "Left"), [[1, 2, 4, 5]]);
    assert_eq!(tags(&mesh, "S25"), [[1, 4]]);
    assert!(started.elapsed() < AT_ONCE);
}

#[test]
fn a_range_takes_no_longer_than_what_is_in_it() {
    let started = Instant::now();
    let far = 1_i64 << 50;
    let mesh = read(&format!(
        "*NODE\n{far}, 7., 7.\n{SQUARES}*NSET, NSET=six, GENERATE\n1, {far}, 1\n1, {far}, 1\n\
         *NSET, NSET=odd, GENERATE\n1, {far}, 2\n*ELSET, ELSET=second, GENERATE\n2, 999999999, 3\n\
         *NSET, NSET=none, GENERATE\n100, 7\n"
    ))
    .unwrap();
    assert_eq!(tags(&mesh, "six").len(), 6);
    assert_eq!(tags(&mesh, "odd"), [[1], [3], [5]]);
    assert_eq!(tags(&mesh, "second"), [[2, 3, 5, 6]]);
    assert!(mesh.groups["none"].members.is_empty());
    assert!(started.elapsed() < AT_ONCE);
}

#[test]
fn files_that_include_each_other_again_and_again_are_refused() {
    let started = Instant::now();
    let include = |name: &str| format!("*INCLUDE, INPUT={name}\n").repeat(100);
    let (a, b, c) = (include("b.inp"), include("c.inp"), include("d.inp"));
    let mut files = vec![
        ("a.inp", a.as_str()),
        ("b.inp", b.as_str()),
        ("c.inp", c.as_str()),
        ("d.inp", "** nothing\n"),
    ];
    says(
        &read_all(&files).unwrap_err(),
        "line … more than 10000 files are included",
    );
    let long = "** a comment of many words\n".repeat(100_000);
    files[3].1 = &long;
    says(
        &read_all(&files).unwrap_err(),
        "c.inp: line … files that are included more than once add up to more than 67108864 bytes; expected each once",
    );
    assert!(started.elapsed() < AT_ONCE);
}

#[test]
fn numbers_of_instances_stay_numbers() {
    let (highest, next) = ((1_i64 << 50) - 1, 1_i64 << 50);
    let mut deck = format!(
        "*PART, NAME=P\n*NODE\n1, 0.\n2, 1.\n{highest}, 1., 1.\n{next}, 0., 1.\n\
         *ELEMENT, TYPE=CPE4\n{next}, 1, 2, {highest}, {next}\n*END PART\n"
    );
    for instance in 0..9000 {
        writeln!(
            deck,
            "*INSTANCE, NAME=I{instance}, PART=P\n{instance}.\n*END INSTANCE"
        )
        .unwrap();
    }
    says(
        &read(&deck).unwrap_err(),
        "the instance 'I1024' would be numbered up to … expected smaller numbers",
    );
    let few = deck.split_once("*INSTANCE, NAME=I1000").unwrap().0;
    let mesh = read(few).unwrap();
    assert_eq!(mesh.cells.len(), 1000);
    assert!(mesh.node_tags.is_sorted() && mesh.node_tags[0] == 1);
    let printed = mesh.warnings.join("\n");
    says(
        &printed,
        "979 more instances are numbered on in the same way",
    );
}
