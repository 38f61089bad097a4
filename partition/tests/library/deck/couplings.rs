//! Nodes that follow a reference node.

use super::refused::refused;
use super::{CUBES, MODEL, means, read, step};

/// A reference node off the cubes, and the face that is at the top.
const ROOF: &str = "\
*NODE
100, 0.5, 0.5, 3.
101, 0., 0., 0.
*SURFACE, NAME=Roof
Upper, S2
";

/// Keys of a coupling beside its loads.
const GRIP: &str = "name = 'Grip', on = 'Roof', point = [0.5, 0.5, 3.0]";

fn coupling(kind: &str) -> String {
    format!("{ROOF}*COUPLING, CONSTRAINT NAME=Grip, REF NODE=100, SURFACE=Roof\n{kind}\n")
}

#[test]
fn a_reference_node_is_loaded_and_held_at_its_point() {
    let acts = step("*CLOAD\n100, 1, 2.\n100, 6, -3.\n*BOUNDARY\n100, 3, 4, 1e-3\n");
    let keys = "force = [2.0, 0.0, 0.0], moment = [0.0, 0.0, -3.0], z = 1e-3, rx = 1e-3";
    for (kind, key) in [
        ("*KINEMATIC", "rigid"),
        ("*KINEMATIC\n1, 3", "rigid"),
        ("*KINEMATIC\n3\n1, 2\n4, 6", "rigid"),
        ("*DISTRIBUTING, COUPLING=CONTINUUM", "distributing"),
        ("*DISTRIBUTING\n4\n6", "distributing"),
    ] {
        let expected = format!("coupling = [{{ {GRIP}, kind = '{key}', {keys} }}]");
        means(&format!("{}{acts}", coupling(kind)), &expected);
    }
    let named = "*NSET, NSET=Point\n100\n*COUPLING, CONSTRAINT NAME=Grip, REF NODE=Point, SURFACE=Roof\n*KINEMATIC\n";
    let held = step("*BOUNDARY\nPoint, ENCASTRE");
    let all = "x = 0.0, y = 0.0, z = 0.0, rx = 0.0, ry = 0.0, rz = 0.0";
    means(
        &format!("{ROOF}{named}{held}"),
        &format!("coupling = [{{ {GRIP}, {all} }}]"),
    );
}

#[test]
fn nodes_may_follow_along_some_axes() {
    let held = step("*BOUNDARY\n100, 1, 6");
    let all = "x = 0.0, y = 0.0, z = 0.0, rx = 0.0, ry = 0.0, rz = 0.0";
    means(
        &format!("{}{held}", coupling("*KINEMATIC\n1, 1\n3, 3")),
        &format!(
            "coupling = [{{ {GRIP}, directions = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], {} }}]",
            all.replacen(" y = 0.0,", "", 1)
        ),
    );
    let axes = "*ORIENTATION, NAME=O\n0., 2., 0., -1., 0., 0.\n";
    let local = coupling("*KINEMATIC\n2, 2").replace("REF NODE", "ORIENTATION=O, REF NODE");
    means(
        &format!("{axes}{local}{held}"),
        &format!(
            "coupling = [{{ {GRIP}, directions = [[-1.0, 0.0, 0.0]], {} }}]",
            all.replacen(" y = 0.0, z = 0.0,", "", 1)
        ),
    );
    // All of them are all, whatever the axes.
    let local = local.replace("2, 2", "1, 3");
    means(
        &format!("{axes}{local}{held}"),
        &format!("coupling = [{{ {GRIP}, {all} }}]"),
    );
}

#[test]
fn forces_are_shared_by_faces_or_in_equal_parts_by_nodes() {
    let dim = |surface: &str, kind: &str| {
        let deck = coupling(kind).replace("SURFACE, NAME=Roof\nUpper, S2", surface);
        let translation = read(&format!("{CUBES}{MODEL}{deck}{}", step(""))).unwrap();
        let on = translation.scene.split("point = ").next().unwrap();
        let on = on
            .rsplit("on = \"")
            .next()
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        translation.mesh.groups[on].dim
    };
    let of_nodes = "SURFACE, NAME=Roof, TYPE=NODE\nTop";
    assert_eq!(dim("SURFACE, NAME=Roof\nUpper, S2", "*DISTRIBUTING"), 2);
    assert_eq!(dim(of_nodes, "*DISTRIBUTING"), 0);
    assert_eq!(dim(of_nodes, "*KINEMATIC"), 2);
}

#[test]
fn a_rigid_body_is_a_rigid_coupling_of_its_nodes() {
    let point = "name = 'rigid body', point = [0.5, 0.5, 3.0], force = [0.0, 0.0, 2.0], ry = 1e-3";
    let acts = |node: usize, freedom: usize| {
        step(&format!(
            "*CLOAD\n100, 3, 2.\n*BOUNDARY\n{node}, {freedom}, {freedom}, 1e-3"
        ))
    };
    for (body, acts, on) in [
        ("NSET=Top", acts(100, 5), "Top"),
        ("NSET=Top, ROT NODE=101", acts(101, 2), "Top"),
        ("PIN NSET=Top", acts(100, 5), "Top"),
        ("ELSET=Upper", acts(100, 5), "rigid 1"),
    ] {
        means(
            &format!("{ROOF}*RIGID BODY, REF NODE=100, {body}\n{acts}"),
            &format!("coupling = [{{ {point}, on = '{on}' }}]"),
        );
    }
    // A reference node that a body has is one of those that follow.
    let deck = format!(
        "{CUBES}{MODEL}*RIGID BODY, REF NODE=13, NSET=Top\n{}",
        step("")
    );
    let mesh = read(&deck).unwrap().mesh;
    assert_eq!(mesh.groups["rigid 1"].members.len(), 5);
}

#[test]
fn loads_of_a_reference_node_go_by_steps_and_amplitudes() {
    let steps = [
        "*STEP\n*STATIC\n*CLOAD, AMPLITUDE=Half\n100, 1, 2.\n*BOUNDARY\n100, 6, 6, 1e-3\n*END STEP\n",
        "*STEP\n*STATIC\n*CLOAD\n100, 5, 4.\n*BOUNDARY\n100, 6, 6, 3e-3\n*END STEP\n",
        "*STEP\n*STATIC\n*CLOAD, OP=NEW\n100, 2, 5.\n*END STEP\n",
    ];
    let held = "[{ on = 'Bottom', x = 0.0, y = 0.0, z = 0.0 }]";
    let of = |force: &str, moment: &str, rz: &str| {
        format!("force = [{force}, 0.0], moment = [0.0, {moment}, 0.0], rz = {rz}")
    };
    let of_step = |time: usize, acts: &str| {
        format!("[[step]]\ntime = {time}\ndisplacement = {held}\ncoupling.Grip = {{ {acts} }}\n")
    };
    let first = of("1.0, 0.0", "0.0", "1e-3");
    let expected = format!(
        "coupling = [{{ {GRIP}, {first} }}]\n{}{}{}",
        of_step(1, &first),
        of_step(2, &of("1.0, 0.0", "4.0", "3e-3")),
        of_step(3, &of("0.0, 5.0", "0.0", "3e-3")),
    );
    let amplitude = "*AMPLITUDE, NAME=Half\n0., 0., 2., 1.\n";
    let deck = format!("{}{amplitude}{}", coupling("*KINEMATIC"), steps.concat());
    means(&deck, &expected);
}

#[test]
fn couplings_that_arent_supported_are_refused_with_their_line() {
    for (more, expected) in [
        (
            coupling("*KINEMATIC\n4, 6"),
            "line 55: *KINEMATIC of no displacement; expected some of 1 to 3",
        ),
        (
            coupling("*KINEMATIC\n1, 7"),
            "line 56: *KINEMATIC of the degrees of freedom 1 to 7; expected some of 1 to 6",
        ),
        (
            coupling("*KINEMATIC").replace("REF NODE", "ORIENTATION=O, REF NODE"),
            "line 54: there is no *ORIENTATION 'O'",
        ),
        (
            coupling("*DISTRIBUTING\n4, 4").replace("REF NODE", "ORIENTATION=O, REF NODE")
                + "*ORIENTATION, NAME=O\n0., 1., 0., -1., 0., 0.\n*BOUNDARY\n100, 4, 4, 0.1\n",
            "line 54: *COUPLING with ORIENTATION and *DISTRIBUTING isn't read where its reference node is held",
        ),
        (
            coupling("*KINEMATIC").replace("REF NODE", "INFLUENCE RADIUS=1., REF NODE"),
            "line 54: *COUPLING with INFLUENCE RADIUS isn't read, and may change the answer",
        ),
        (
            coupling("*DISTRIBUTING, WEIGHTING METHOD=LINEAR"),
            "line 55: *DISTRIBUTING with WEIGHTING METHOD isn't read but for WEIGHTING METHOD=UNIFORM",
        ),
        (
            coupling(""),
            "line 54: *COUPLING doesn't say how nodes follow; expected *KINEMATIC or *DISTRIBUTING",
        ),
        (
            "*KINEMATIC\n".into(),
            "line 49: *KINEMATIC belongs to nothing; expected *COUPLING before it",
        ),
        (
            coupling("*KINEMATIC").replace("REF NODE=100", "REF NODE=Top"),
            "line 54: *COUPLING: REF NODE is 4 nodes; expected one",
        ),
        (
            coupling("*KINEMATIC").replace("REF NODE=100", "REF NODE=15"),
            "line 54: *COUPLING: the reference node 15 is one of a body, which isn't supported; expected a node of its own",
        ),
        (
            coupling("*KINEMATIC") + "*RIGID BODY, NSET=Bottom, REF NODE=100\n",
            "line 56: *RIGID BODY: the node 100 is a reference node already; expected one for each coupling",
        ),
        (
            coupling("*KINEMATIC")
                + "*NSET, NSET=Both\n11, 100\n*RIGID BODY, NSET=Both, REF NODE=101\n",
            "line 58: *RIGID BODY: the reference node 100 of another coupling is one of the nodes",
        ),
        (
            "*RIGID BODY, REF NODE=1\n".into(),
            "line 49: *RIGID BODY has no nodes; expected NSET",
        ),
        (
            format!("{ROOF}*RIGID BODY, NSET=101, REF NODE=100\n"),
            "line 54: *RIGID BODY: its nodes are none of a body; expected nodes of solids",
        ),
        (
            coupling("*KINEMATIC") + "*TRANSFORM, NSET=100\n0., 1., 0., -1., 0., 0.\n",
            "line 54: *COUPLING: the reference node 100 with *TRANSFORM isn't read",
        ),
        (
            coupling("*DISTRIBUTING\n1, 3") + &step("*CLOAD\n100, 4, 1."),
            "line 60: *CLOAD on the degree of freedom 4 of the reference node 100, which isn't coupled",
        ),
    ] {
        let end = if more.contains("*STEP") {
            String::new()
        } else {
            step("*DLOAD\nUpper, P2, 1.")
        };
        refused(&format!("{CUBES}{MODEL}{more}{end}"), expected);
    }
}

#[test]
fn a_reference_node_in_the_plane_turns_about_z() {
    let deck = |kind: &str| {
        format!(
            "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n9, 0.5, 2.\n*ELEMENT, TYPE={kind}, ELSET=Plate\n1, 1, 2, 3, 4\n\
             *SURFACE, NAME=Roof\n1, S3\n*MATERIAL, NAME=M\n*ELASTIC\n1e3, 0.3\n*SOLID SECTION, ELSET=Plate, MATERIAL=M\n2.\n\
             *COUPLING, CONSTRAINT NAME=Grip, REF NODE=9, SURFACE=Roof\n*KINEMATIC\n1, 2\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n{}",
            step("*CLOAD\n9, 1, 3.\n9, 6, 5.\n*BOUNDARY\n9, 2, 5")
        )
    };
    let scene = read(&deck("CPE4")).unwrap().scene;
    for line in [
        "point = [0.5, 2.0]",
        "force = [1.5, 0.0]",
        "moment = 2.5",
        "\ny = 0.0",
    ] {
        assert!(scene.contains(line), "{line}: {scene}");
    }
    assert!(
        !scene.contains("rx") && !scene.contains("\nz = "),
        "{scene}"
    );
    let around = deck("CAX4").replace("\n2.\n", "\n");
    refused(
        &around,
        "line 15: couplings around an axis aren't supported; instead",
    );
}
