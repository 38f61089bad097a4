//! Decks of Abaqus and CalculiX in place of a scene.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Two squares, one on the other, of which the upper one is pressed down.
const DECK: &str = "\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 0., 1.
6, 1., 1.
7, 1., 2.
8, 0., 2.
*ELEMENT, TYPE=CPE4, ELSET=LOWER
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=UPPER
2, 5, 6, 7, 8
*SURFACE, NAME=LOW
1, S3
*SURFACE, NAME=HIGH
2, S1
*MATERIAL, NAME=STEEL
*ELASTIC
210e3, 0.3
*SOLID SECTION, ELSET=LOWER, MATERIAL=STEEL
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=DRY
*CONTACT PAIR, INTERACTION=DRY
HIGH, LOW
*BOUNDARY
1, 1, 2
2, 1, 2
5, 1
8, 1
*STEP
*STATIC
*DLOAD
2, P3, 10.
*END STEP
";

fn program(args: &[&str], dir: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_contact-dd-partition"));
    command.args(args).current_dir(dir).output().unwrap()
}

#[test]
fn a_deck_and_the_scene_that_is_written_of_it_make_the_same_problem() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("part.inp"), DECK).unwrap();
    let done = |args: &[&str]| {
        let output = program(args, dir.path());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let printed = done(&["part.inp"]);
    assert!(printed.contains("HIGH on LOW, node by node"), "{printed}");
    let printed = done(&["part.inp", "--write-scene", "made"]);
    assert!(
        printed.ends_with("contact-dd-partition made/scene.toml\n"),
        "{printed}"
    );
    // Existing files with the same content are accepted.
    done(&["part.inp", "--write-scene", "made", "-o", "again.h5"]);
    done(&["made/scene.toml", "-o", "made.h5"]);
    let bytes = |name: &str| fs::read(dir.path().join(name)).unwrap();
    assert!(bytes("part.h5") == bytes("again.h5"));
    assert!(bytes("part.h5") == bytes("made.h5"));
    fs::write(dir.path().join("made/scene.toml"), "edited").unwrap();
    let output = program(&["part.inp", "--write-scene", "made"], dir.path());
    assert_eq!(output.status.code(), Some(5));
    assert_eq!(bytes("made/scene.toml"), b"edited");
}

#[test]
fn what_a_deck_prints_is_written_as_json() {
    let dir = tempfile::tempdir().unwrap();
    let wanted = DECK.replace("*DLOAD", "*NODE PRINT, NSET=N\nU\n*DLOAD");
    let deck = wanted.replace("*NODE\n", "*NODE, NSET=N\n");
    fs::write(dir.path().join("part.inp"), deck).unwrap();
    let output = program(&["part.inp", "--write-prints", "part.json"], dir.path());
    assert!(output.status.success(), "{output:?}");
    let text = fs::read_to_string(dir.path().join("part.json")).unwrap();
    let prints: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(prints["steps"][0][0]["label"], "U");
    assert_eq!(prints["nodes"]["N"].as_array().unwrap().len(), 8);
    fs::write(dir.path().join("scene.toml"), "").unwrap();
    let output = program(&["scene.toml", "--write-prints", "part.json"], dir.path());
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_deck_that_isnt_computed_ends_with_2_and_its_line() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("part.inp");
    for (from, to, expected) in [
        (
            "*STATIC",
            "*DYNAMIC",
            "part.inp: line 32: *DYNAMIC isn't read",
        ),
        (
            "*DLOAD",
            "*CLOAT",
            "part.inp: line 33: the keyword *CLOAT isn't known",
        ),
        (
            "210e3, 0.3",
            "210e3, 0.7",
            "part.inp: line 20: *ELASTIC: Poisson's ratio is 0.7; expected",
        ),
    ] {
        fs::write(&path, DECK.replacen(from, to, 1)).unwrap();
        let output = program(&["part.inp"], dir.path());
        let printed = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{printed}");
        assert!(
            printed.starts_with(&format!("error: {expected}")),
            "{printed}"
        );
        assert!(!dir.path().join("part.h5").exists());
    }
    fs::write(&path, DECK.replace("CPE4", "CPE4I")).unwrap();
    let output = program(&["part.inp", "--write-scene", "made"], dir.path());
    assert_eq!(output.status.code(), Some(2));
    assert!(!dir.path().join("made").exists());
}
