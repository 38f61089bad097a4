//! Problem files whose parts contradict each other, or that hold what nothing reads.

use std::path::Path;

use crate::says::says;
use contact_dd_partition::contact_point::Law;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::element::ElementKind;
use contact_dd_partition::example;
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::scene::Scene;

use super::{
    Defect, problem, refuse, refuses, refuses_values, replace, set, write, write_two_joints,
};

fn integers(file: &hdf5::File, name: &str) -> Vec<i64> {
    file.dataset(name).unwrap().read_raw().unwrap()
}

const VALUES: &str = "
number beyond all measure: /contact/gap[1] = -1e300
    /contact/gap, row 1: -1e300; expected a number of at most 1e120
no share: /contact/area[0] = 0.0
    /contact/area, row 0 … positive
share of more than there is: /contact/area[0] = 1e6
    /contact/area, row 0: 1e6 … extent
place beside the node: /contact/position[0] = 77.0
    /contact/position, row 0: (77, 3); expected (0, 3), where node
force beside the node: /contact/force_point[0] = 77.0
    /contact/force_point, row 0: (77, 3) … side a
side b that doesn't take what side a gives: /contact/entry_weight[1] = -0.5
    /contact/entry_weight, row 0 … sum to 0.5
name of a node that isn't there: /contact/node_b[2] = 999999
    /contact/node_b, row 2: 999999 … GlobalNodeId
no Γ: without /interface
    /subdomains/body … aren't connected
conditions of supports without names: without /support/name
    /support/name is missing
names without conditions of supports: without /support/condition
    /support/condition is missing
";

#[test]
fn every_contradiction_is_named() {
    let defects: &[Defect] = &[
        (
            "cell twice",
            |f| {
                let nodes = integers(f, "/VTKHDF/Connectivity");
                (0..3).for_each(|i| set(f, "/VTKHDF/Connectivity", 3 + i, nodes[i]));
            },
            "/VTKHDF/Connectivity, row 3 … the cells 0 and 1 … same side",
        ),
        (
            "node twice in a cell",
            |f| {
                let nodes = integers(f, "/VTKHDF/Connectivity");
                set(f, "/VTKHDF/Connectivity", 2, nodes[1]);
            },
            "/VTKHDF/Connectivity, row 2 … has the node twice",
        ),
        (
            "copies of a node in two places",
            |f| {
                let node = integers(f, "/interface/node")[0] as usize;
                let points: Vec<f64> = f.dataset("/VTKHDF/Points").unwrap().read_raw().unwrap();
                set(f, "/VTKHDF/Points", 3 * node, points[3 * node] + 0.01);
            },
            "on Γ: the subdomains … coordinates (/VTKHDF/Points)",
        ),
        (
            "copies that aren't on Γ",
            |f| {
                // The first number on Γ, which all later ones take.
                let (offset, node) = (
                    integers(f, "/interface/offset"),
                    integers(f, "/interface/node"),
                );
                let number = integers(f, "/interface/interface");
                let keep: Vec<usize> = (0..node.len()).filter(|&i| number[i] > 0).collect();
                let of = |values: &[i64]| keep.iter().map(|&i| values[i]).collect::<Vec<_>>();
                let numbers: Vec<i64> = of(&number).iter().map(|n| n - 1).collect();
                let before = |&end: &i64| keep.iter().filter(|&&i| (i as i64) < end).count() as i64;
                let ends: Vec<i64> = offset.iter().map(before).collect();
                replace(f, "/interface/node", &[keep.len()], &of(&node));
                replace(f, "/interface/interface", &[keep.len()], &numbers);
                replace(f, "/interface/offset", &[ends.len()], &ends);
            },
            "/VTKHDF/PointData/GlobalNodeId … isn't one node on Γ",
        ),
        (
            "node of side b on side a",
            |f| {
                let b = integers(f, "/contact/node_b");
                set(f, "/contact/node_a", 0, b[0]);
            },
            "/contact/node_a, row 0 … weight is positive",
        ),
        (
            "stiffness next to nothing",
            |f| replace(f, "/materials/stiffness", &[2, 3, 3], &[1e-310; 18]),
            "/materials/stiffness, row 0",
        ),
    ];
    refuses(write, defects);
    refuses_values(write, VALUES);
}

/// Writes the stack of blocks with Coulomb's friction at its first contact point, given friction at its second.
fn write_rough(path: &Path) {
    let mut problem = problem();
    problem.catalog.points[0].law = Law::coulomb(0.5, 1e5);
    problem.catalog.points[1].law = Law::given(2e5);
    problem.write(path).unwrap();
}

const FRICTION: &str = "
law that isn't known: /contact/law[1] = 4
    /contact/law, row 1: 4 is no law; expected 0 to 3
law below zero: /contact/law[1] = -1
    /contact/law, row 1: -1 is no law
coefficient below zero: /contact/friction[0] = -0.5
    /contact/friction, row 0: -0.5; expected 0 or more
coefficient that isn't finite: /contact/friction[0] = nan
    /contact/friction, row 0 … expected a finite number
bound below zero: /contact/shear_bound[1] = -1.0
    /contact/shear_bound, row 1: -1; expected 0 or more
bound that isn't finite: /contact/shear_bound[1] = inf
    /contact/shear_bound, row 1: inf; expected a finite number
coefficient of given friction: /contact/friction[1] = 0.5
    /contact/friction, row 1: 0.5 at a point of law 1; expected 0
bound without friction: /contact/shear_bound[2] = 1e5
    /contact/shear_bound, row 2: 100000 at a point of law 0; expected 0
law without its numbers: without /contact/friction
    /contact/friction is missing … or none of them
numbers without law: without /contact/law
    /contact/law is missing … or none of them
";

#[test]
fn friction_that_cannot_be_is_named() {
    refuses_values(write_rough, FRICTION);
}

#[test]
fn a_name_that_is_not_known_is_answered_with_the_nearest_that_is() {
    let defects: &[Defect] = &[
        (
            "group",
            |f| drop(f.create_group("suport").unwrap()),
            "/suport isn't known; did you mean 'support'?",
        ),
        (
            "dataset",
            |f| drop(f.new_dataset::<f64>().create("contact/gaps").unwrap()),
            "/contact/gaps isn't known; did you mean 'gap'?",
        ),
        (
            "attribute",
            |f| drop(f.new_attr::<i64>().create("titel").unwrap()),
            "attribute /titel isn't known; did you mean 'title'?",
        ),
    ];
    refuses(write, defects);
}

#[test]
fn no_other_file_is_read() {
    let defects: &[Defect] = &[
        (
            "link to another file",
            |f| {
                f.unlink("/force/value").unwrap();
                f.link_external("other.h5", "/value", "/force/value")
                    .unwrap();
            },
            "/force/value is a link to another file",
        ),
        (
            "data in another file",
            |f| {
                let shape = f.dataset("/force/value").unwrap().shape();
                f.unlink("/force/value").unwrap();
                let builder = f.new_dataset::<f64>().shape(shape);
                let builder = builder.external("other.raw", 0, 1 << 20);
                builder.create("/force/value").unwrap();
            },
            "/force/value: lies in another file",
        ),
    ];
    refuses(write, defects);
}

#[test]
fn names_that_would_lead_elsewhere_are_refused() {
    for (names, expected) in [
        (["../x", "b"], "'../x' holds a '/'"),
        (["/abs", "b"], "'/abs' holds a '/'"),
        (["a/b", "b"], "'a/b' holds a '/'"),
        ([".", "b"], "'.' means a place in a path"),
        (["..", "b"], "'..' means a place in a path"),
        (["", "b"], "'' is empty"),
        (["a\nerror: b", "b"], "holds a control character"),
        (
            ["joint", "joint"],
            "1: 'joint' is the name of contact 0 already",
        ),
    ] {
        let damage = |f: &hdf5::File| {
            let names = names.map(|name| name.parse::<hdf5::types::VarLenUnicode>().unwrap());
            replace(f, "/contact/name", &[2], &names);
        };
        let expected = format!("/contact/name, row … {expected}");
        refuse(write_two_joints, "names", &damage, &expected);
    }
    for name in ["", "a\u{1b}[31m", &"x".repeat(300)] {
        let damage = |f: &hdf5::File| {
            let names: Vec<hdf5::types::VarLenUnicode> = ["block 0", name]
                .iter()
                .map(|name| name.parse().unwrap())
                .collect();
            replace(f, "/bodies/name", &[2], &names);
        };
        refuse(write, "names", &damage, "/bodies/name, row 1");
    }
}

#[test]
fn a_folded_cell_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    let example = example::find("patch").unwrap();
    let mesh = example.mesh_of(ElementKind::Quad8, 0).unwrap();
    let model = Model::new(&Scene::parse(example.scene).unwrap(), mesh).unwrap();
    let decomposition = Decomposition::new(&model, None).unwrap();
    let problem = Problem::new(&model, &decomposition).unwrap();
    problem.write(&path).unwrap();
    assert_eq!(
        ProblemFile::open(&path).unwrap().problem().unwrap(),
        problem
    );
    // The node in the middle of the third cell's first edge, beside that edge's end.
    let nodes = problem.subdomains[0].cells.nodes_of(2);
    let (end, middle) = (nodes[0] as usize, nodes[4] as usize);
    let file = hdf5::File::open_rw(&path).unwrap();
    for axis in 0..2 {
        let x = problem.subdomains[0].points[end][axis];
        set(&file, "/VTKHDF/Points", 3 * middle + axis, x);
    }
    file.close().unwrap();
    let error = ProblemFile::open(&path).unwrap().problem().unwrap_err();
    let message = error.to_string();
    for word in [
        "/VTKHDF/Connectivity, row ",
        "(quadrilateral of 8 nodes) is folded",
    ] {
        says(&message, word);
    }
}
