//! Laws of the problem file and of how a model is cut.

mod errors;
mod page;

use std::collections::BTreeMap;
use std::path::Path;

use crate::problem_scenes::{cracked, shuffled, stacked};
use crate::says::says;
use contact_dd_partition::contact_point::Law;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::element::ElementKind::{Quad4, Quad8, Quad9, Triangle6};
use contact_dd_partition::example;
use contact_dd_partition::model::{InitialStress, Model, ModelStep};
use contact_dd_partition::problem::Problem;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::quantity::{
    Goals, LoadForce, NodalShares, NodeWeight, Parameter, ParameterKind, Quantity, QuantityKind,
};
use contact_dd_partition::scene::Scene;

/// A decomposition by columns of the lattice, two for every block.
fn halves(model: &Model, column: f64) -> Decomposition {
    let subdomain: Vec<u32> = (0..model.mesh.cells.len())
        .map(|cell| {
            let nodes = model.mesh.cells.nodes_of(cell);
            let x: f64 = nodes
                .iter()
                .map(|&n| model.mesh.points[n as usize][0])
                .sum();
            2 * model.cell_body[cell] + u32::from(x / nodes.len() as f64 > column)
        })
        .collect();
    Decomposition::of_cells(model, subdomain, 2 * model.bodies.len())
}

fn written(problem: &Problem, folder: &Path) -> ProblemFile {
    let path = folder.join("problem.h5");
    problem.write(&path).unwrap();
    ProblemFile::open(&path).unwrap()
}

/// The model with a law of every kind, and points without.
fn with_friction(model: &Model) -> Model {
    let mut model = model.clone();
    let points = model.contacts.iter_mut().flat_map(|c| &mut c.points);
    for (k, point) in points.enumerate() {
        let size = k as f64;
        point.law = match k % 3 {
            0 => Law::Frictionless,
            1 => Law::given(1e5 * size),
            _ => Law::coulomb(0.1 * size, 1e3 * (size - 2.0)),
        };
    }
    model
}

/// The model with its loads in three steps, the second of which has none.
fn with_steps(model: &Model) -> Model {
    let mut model = model.clone();
    model.steps = [1.0, 0.0, -2.5]
        .map(|factor| ModelStep {
            name: format!("times {factor}"),
            time: 10.0 - factor,
            supports: model.supports.iter().map(|s| factor + s.value).collect(),
            forces: (model.forces.iter())
                .map(|(_, force)| force.map(|f| factor * f))
                .collect(),
            initial_stress: InitialStress::default(),
            absent_bodies: Vec::new(),
            absent_contacts: Vec::new(),
        })
        .into();
    let first = &model.steps[0];
    for (support, &value) in model.supports.iter_mut().zip(&first.supports) {
        support.value = value;
    }
    model
}

/// The model with a quantity and a parameter of some kinds, and parts of nodes in them.
fn with_goals(model: &Model) -> Model {
    let steps = model.steps.len().max(1);
    let quantity = |kind, of: &[u32], node| Quantity {
        name: format!("{kind:?}"),
        kind,
        point: [0.5, -1.0, 0.0],
        length: 0.25,
        direction: [0.6, -0.8, 0.0],
        constants: (0..steps).map(|k| 0.5 * k as f64).collect(),
        of: of.to_vec(),
        node,
    };
    let parameter = |kind, of: &[u32]| Parameter {
        name: format!("{kind:?}"),
        kind,
        value: 2.5,
        of: of.to_vec(),
    };
    let loaded = model.forces.iter().map(|&(node, force)| LoadForce {
        parameter: 0,
        node,
        forces: (0..steps)
            .map(|k| force.map(|f| f * (1.0 + k as f64)))
            .collect(),
    });
    let weights = [0, 7, 12].map(|node| NodeWeight {
        quantity: node % 2,
        node,
        value: [f64::from(node), 1.0, 0.0],
    });
    let goals = Goals {
        quantities: vec![
            quantity(QuantityKind::Displacement, &[], 7),
            quantity(QuantityKind::MeanStress, &[0, 1], -1),
            quantity(QuantityKind::Reaction, &[1], -1),
            quantity(QuantityKind::Opening, &[1, 3], 10),
            quantity(QuantityKind::Energy, &[], -1),
        ],
        parameters: vec![
            parameter(ParameterKind::Load, &[]),
            parameter(ParameterKind::Stiffness, &[0, 1]),
            parameter(ParameterKind::Gap, &[1]),
            parameter(ParameterKind::Displacement, &[1, 0]),
        ],
        shares: NodalShares {
            weights: weights.into(),
            forces: loaded.collect(),
        },
    };
    Model {
        goals,
        ..model.clone()
    }
}

#[test]
fn a_step_gives_supports_and_forces_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let model = with_steps(&shuffled(&stacked(3, 6, 3), 5));
    let problem = Problem::new(&model, &halves(&model, 3.0)).unwrap();
    let file = written(&problem, folder.path());
    let mut loaded = 0;
    for subdomain in file.problem().unwrap().subdomains {
        for (before, after) in subdomain.supports.iter().zip(subdomain.supports_in(2)) {
            assert_eq!(after.value, before.value - 3.5);
        }
        for ((_, before), (_, after)) in subdomain.forces.iter().zip(subdomain.forces_in(2)) {
            assert_eq!(after, before.map(|f| -2.5 * f));
            loaded += 1;
        }
    }
    assert!(loaded > 0);
}

#[test]
fn what_is_written_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let mut bare = stacked(1, 3, 2);
    bare.supports.clear();
    bare.forces.clear();
    bare.warnings.clear();
    let whole = Decomposition::of_cells(&bare, vec![0; bare.mesh.cells.len()], 1);
    let crack = cracked(8, &[(0, 3), (5, 8)]);
    let upright = Decomposition::of_cells(&crack, halves(&crack, 4.0).subdomain, 2);
    let stack = shuffled(&stacked(3, 6, 3), 5);
    let in_steps = with_steps(&stack);
    let rough = with_friction(&stack);
    for (model, decomposition) in [
        (&bare, &whole),
        (&crack, &upright),
        (&stack, &halves(&stack, 3.0)),
        (&in_steps, &halves(&stack, 3.0)),
        (&rough, &halves(&stack, 3.0)),
        (&with_goals(&rough), &halves(&stack, 3.0)),
        (&with_goals(&in_steps), &halves(&stack, 3.0)),
    ] {
        let problem = Problem::new(model, decomposition).unwrap();
        assert_eq!(written(&problem, folder.path()).problem().unwrap(), problem);
    }
}

#[test]
fn a_file_says_nothing_of_friction_where_there_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["law", "friction", "shear_bound"];
    let stack = stacked(3, 6, 3);
    for (model, expected) in [(&stack, false), (&with_friction(&stack), true)] {
        let problem = Problem::new(model, &halves(model, 3.0)).unwrap();
        let catalog = written(&problem, folder.path()).catalog().clone();
        assert_eq!(catalog.contacts[0].has_friction, expected);
        let file = hdf5::File::open(folder.path().join("problem.h5")).unwrap();
        let contact = file.group("contact").unwrap();
        assert!((names.iter()).all(|name| contact.link_exists(name) == expected));
    }
}

#[test]
fn a_slab_of_subdomains_is_what_they_are_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let model = shuffled(&stacked(3, 6, 3), 4);
    let problem = Problem::new(&model, &halves(&model, 3.0)).unwrap();
    let file = written(&problem, folder.path());
    for range in [0..6, 2..5, 5..6, 3..3] {
        let slab = file.subdomains(range.clone()).unwrap();
        let singly: Vec<_> = range.map(|i| file.subdomain(i).unwrap()).collect();
        assert_eq!(slab, singly);
    }
    for range in [4..7, 9..11] {
        let message = file.subdomains(range).unwrap_err().to_string();
        says(&message, "there is no subdomain");
    }
    for index in [6, usize::MAX] {
        let message = file.subdomain(index).unwrap_err().to_string();
        assert!(
            message.starts_with(folder.path().to_str().unwrap()),
            "{message}"
        );
    }
}

#[test]
fn every_force_arrives_once_and_every_support_everywhere() {
    let model = shuffled(&stacked(2, 6, 3), 1);
    let problem = Problem::new(&model, &halves(&model, 3.0)).unwrap();
    let mut forces: BTreeMap<i64, [f64; 3]> = BTreeMap::new();
    for subdomain in &problem.subdomains {
        for &(node, force) in &subdomain.forces {
            let tag = subdomain.node_tags[node as usize];
            assert_eq!(forces.insert(tag, force), None);
        }
        let supported: Vec<i64> = subdomain
            .supports
            .iter()
            .map(|s| subdomain.node_tags[s.node as usize])
            .collect();
        let expected: Vec<i64> = model
            .supports
            .iter()
            .map(|s| model.mesh.node_tags[s.node as usize])
            .filter(|tag| subdomain.node_tags.contains(tag))
            .collect();
        assert_eq!(supported, expected);
    }
    let expected = model
        .forces
        .iter()
        .map(|&(node, force)| (model.mesh.node_tags[node as usize], force))
        .collect();
    assert_eq!(forces, expected);
}

#[test]
fn interface_nodes_are_those_with_cells_in_two_subdomains() {
    let model = shuffled(&cracked(8, &[(0, 3)]), 2);
    let decomposition = halves(&model, 4.0);
    let problem = Problem::new(&model, &decomposition).unwrap();
    assert_eq!(
        problem.catalog.interface.concat().len(),
        2 * shared(&model, &decomposition).len()
    );
    on_interface_is_what_is_shared(&model, &decomposition, &problem);
}

#[test]
fn nodes_in_the_middle_of_cut_edges_are_on_the_interface() {
    let example = example::find("granite").unwrap();
    for kind in [Triangle6, Quad4, Quad8, Quad9] {
        let mesh = example.mesh_of(kind, 0).unwrap();
        let model = Model::new(&Scene::parse(example.scene).unwrap(), mesh).unwrap();
        let decomposition = Decomposition::new(&model, Some(12)).unwrap();
        let problem = Problem::new(&model, &decomposition).unwrap();
        on_interface_is_what_is_shared(&model, &decomposition, &problem);
        assert_eq!(problem.catalog.warnings, Vec::<String>::new());
    }
}

/// The tags of the nodes with cells in two subdomains, in the order of the nodes.
fn shared(model: &Model, decomposition: &Decomposition) -> Vec<i64> {
    let mut owners: BTreeMap<i64, Vec<u32>> = BTreeMap::new();
    for (cell, &subdomain) in decomposition.subdomain.iter().enumerate() {
        for &node in model.mesh.cells.nodes_of(cell) {
            let list = owners
                .entry(model.mesh.node_tags[node as usize])
                .or_default();
            if !list.contains(&subdomain) {
                list.push(subdomain);
            }
        }
    }
    let tags = model.mesh.node_tags.iter().copied();
    tags.filter(|tag| owners[tag].len() > 1).collect()
}

#[track_caller]
fn on_interface_is_what_is_shared(model: &Model, decomposition: &Decomposition, problem: &Problem) {
    let expected = shared(model, decomposition);
    for subdomain in &problem.subdomains {
        for on in &subdomain.interface {
            let tag = subdomain.node_tags[on.node as usize];
            assert_eq!(tag, expected[on.interface as usize]);
        }
    }
    assert_eq!(problem.catalog.interface_nodes, expected.len());
}

#[test]
fn points_name_the_nodes_of_the_scene() {
    let model = shuffled(&stacked(3, 6, 3), 3);
    let problem = Problem::new(&model, &halves(&model, 3.0)).unwrap();
    for point in &problem.catalog.points {
        let of_model = &model.contacts[point.contact as usize].points[point.place as usize];
        for ((at, weight), &(node, expected)) in point.entries.iter().zip(&of_model.entries) {
            let subdomain = &problem.subdomains[at.subdomain as usize];
            let tag = subdomain.node_tags[at.node as usize];
            assert_eq!(tag, model.mesh.node_tags[node as usize]);
            assert_eq!(*weight, expected);
        }
    }
}

#[test]
fn subdomains_that_share_a_contact_node_are_in_one_group() {
    let model = stacked(2, 6, 3);
    let cut = Problem::new(&model, &halves(&model, 3.0)).unwrap();
    assert_eq!(cut.catalog.groups, [7]);
    assert!(cut.catalog.subdomains.iter().all(|s| s.group == Some(0)));

    let tip = cracked(8, &[(0, 3)]);
    let mut decomposition = halves(&tip, 4.0);
    decomposition.count = 2;
    let whole = Problem::new(&tip, &decomposition).unwrap();
    assert_eq!(whole.catalog.subdomains[0].group, Some(0));
    assert_eq!(whole.catalog.subdomains[1].group, None);
}

#[test]
fn a_body_is_what_hangs_together() {
    let mut model = stacked(3, 4, 2);
    model.bodies = vec!["die".into(), "plate".into()];
    for body in &mut model.cell_body {
        *body = u32::from(*body == 1);
    }
    let subdomain = (0..model.mesh.cells.len()).map(|c| c as u32 / 16).collect();
    let decomposition = Decomposition::of_cells(&model, subdomain, 3);
    let problem = Problem::new(&model, &decomposition).unwrap();
    let names: Vec<&str> = problem
        .catalog
        .bodies
        .iter()
        .map(|b| b.name.as_str())
        .collect();
    assert_eq!(names.len(), 3);
    assert_eq!(names[1], "plate");
    // The point that identifies a part of the body lies in a cell of that part only.
    for (body, number) in [(0, 1), (2, 2)] {
        let point = names[body]
            .strip_prefix(&format!("die #{number} at ("))
            .unwrap();
        let point: Vec<f64> = (point.strip_suffix(')').unwrap().split(", "))
            .map(|x| x.parse().unwrap())
            .collect();
        let holds = |cell: usize| {
            let at = (model.mesh.cells.nodes_of(cell).iter())
                .map(|&node| model.mesh.points[node as usize]);
            let around = at.fold(
                [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]],
                |[low, high], x| {
                    [
                        [0, 1].map(|k| x[k].min(low[k])),
                        [0, 1].map(|k| x[k].max(high[k])),
                    ]
                },
            );
            (0..2).all(|k| around[0][k] < point[k] && point[k] < around[1][k])
        };
        let within: Vec<usize> = (0..model.mesh.cells.len())
            .filter(|&cell| holds(cell))
            .collect();
        assert!(!within.is_empty());
        assert!(
            within.iter().all(|cell| cell / 16 == body),
            "{} {within:?}",
            names[body]
        );
    }

    let glued = Decomposition::of_cells(&model, vec![0; model.mesh.cells.len()], 1);
    let message = Problem::new(&model, &glued).unwrap_err().to_string();
    says(&message, "\"die #1 at ( … and \"plate\"");
}
