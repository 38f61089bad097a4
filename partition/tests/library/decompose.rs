//! Laws of the partition.

use std::collections::BTreeSet;

use crate::problem_scenes::{cracked, shuffled, stacked};
use crate::says::says;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;

fn scenes() -> Vec<Model> {
    vec![
        stacked(2, 10, 6),
        cracked(12, &[(0, 4), (8, 12)]),
        stacked(1, 9, 9),
        stacked(3, 8, 5),
        cracked(14, &[(0, 5)]),
        cracked(15, &[(4, 10)]),
        shuffled(&stacked(3, 8, 5), 11),
        shuffled(&cracked(12, &[(0, 4), (8, 12)]), 12),
    ]
}

fn subdomains_of_node(model: &Model, decomposition: &Decomposition) -> Vec<BTreeSet<u32>> {
    let mut sets = vec![BTreeSet::new(); model.mesh.points.len()];
    for (cell, &subdomain) in decomposition.subdomain.iter().enumerate() {
        for &node in model.mesh.cells.nodes_of(cell) {
            sets[node as usize].insert(subdomain);
        }
    }
    sets
}

fn components(model: &Model, decomposition: &Decomposition) -> usize {
    let topology = Topology::new(&model.mesh);
    let mut seen = vec![false; model.mesh.cells.len()];
    let mut count = 0;
    for start in 0..seen.len() {
        if std::mem::replace(&mut seen[start], true) {
            continue;
        }
        count += 1;
        let mut stack = vec![start];
        while let Some(cell) = stack.pop() {
            for &next in topology.neighbours(cell) {
                let next = next as usize;
                let same = decomposition.subdomain[next] == decomposition.subdomain[cell];
                if same && !std::mem::replace(&mut seen[next], true) {
                    stack.push(next);
                }
            }
        }
    }
    count
}

/// The range of counts that an error names.
fn range(model: &Model) -> (usize, usize) {
    let message = Decomposition::new(model, Some(1_000_000))
        .unwrap_err()
        .to_string();
    let numbers: Vec<usize> = message
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|word| word.parse().ok())
        .collect();
    assert_eq!(numbers[0], 1_000_000);
    (numbers[1], numbers[2])
}

/// All small counts for the first two scenes, some for the others, and the largest.
fn counts(scene: usize, (least, most): (usize, usize)) -> Vec<usize> {
    let step = if scene < 2 { 1 } else { 13 };
    let mut counts: Vec<usize> = (least..=60).step_by(step).collect();
    counts.extend([most - 1, most]);
    counts
}

#[test]
fn every_count_gives_as_many_connected_subdomains() {
    for (scene, model) in scenes().iter().enumerate() {
        for count in counts(scene, range(model)) {
            let decomposition = Decomposition::new(model, Some(count)).unwrap();
            let numbers: BTreeSet<u32> = decomposition.subdomain.iter().copied().collect();
            assert_eq!(decomposition.count, count);
            assert_eq!(numbers, (0..count as u32).collect());
            assert_eq!(components(model, &decomposition), count);
        }
    }
}

#[test]
fn equal_models_have_equal_partitions() {
    for model in scenes() {
        let once = Decomposition::new(&model, Some(9)).unwrap();
        assert_eq!(once, Decomposition::new(&model, Some(9)).unwrap());
        let default = Decomposition::new(&model, None).unwrap();
        assert_eq!(default, Decomposition::new(&model, None).unwrap());
    }
}

#[test]
fn a_partition_is_balanced() {
    for model in [
        stacked(1, 30, 30),
        stacked(2, 30, 20),
        cracked(40, &[(0, 12), (28, 40)]),
        shuffled(&cracked(40, &[(0, 12), (28, 40)]), 8),
    ] {
        for count in [4, 8, 12, 16] {
            let decomposition = Decomposition::new(&model, Some(count)).unwrap();
            let problem = Problem::new(&model, &decomposition).unwrap();
            let summary = problem.summary();
            assert!(summary.imbalance() < 1.7, "{count}: {summary}");
        }
    }
}

#[test]
fn a_count_out_of_range_is_an_error_that_names_the_range() {
    let model = stacked(3, 4, 4);
    for count in [0, 1, 2] {
        let message = Decomposition::new(&model, Some(count))
            .unwrap_err()
            .to_string();
        says(&message, "expected 3 ");
    }
    let single = stacked(1, 2, 2);
    assert_eq!(range(&single), (1, 8));
}

#[test]
fn without_a_count_subdomains_have_about_two_thousand_dofs() {
    for (model, dofs) in [
        (stacked(1, 120, 110), 2 * 121 * 111),
        (stacked(1, 31, 31), 2 * 32 * 32),
        (stacked(1, 9, 9), 2 * 10 * 10),
    ] {
        let count = Decomposition::new(&model, None).unwrap().count as f64;
        let suitable = f64::from(dofs) / 2000.0;
        assert!(count <= (1.5 * suitable).max(1.0) && count >= suitable / 1.5);
    }
    // A subdomain lies in one body.
    assert_eq!(
        Decomposition::new(&stacked(3, 9, 9), None).unwrap().count,
        3
    );
}

#[test]
fn a_contact_surface_is_cut_like_everything_else() {
    let model = stacked(2, 200, 40);
    let decomposition = Decomposition::new(&model, Some(16)).unwrap();
    let sets = subdomains_of_node(&model, &decomposition);
    let points = model.contacts[0].points.iter();
    let on_surface: BTreeSet<u32> = points
        .flat_map(|point| &point.entries)
        .flat_map(|&(node, _)| &sets[node as usize])
        .copied()
        .collect();
    assert!(on_surface.len() > 4, "{on_surface:?}");
}

#[test]
fn both_sides_of_a_contact_come_together_low_in_the_tree() {
    // Of a long contact both sides of most points are under a node not higher than two above them.
    let model = stacked(2, 400, 10);
    let decomposition = Decomposition::new(&model, None).unwrap();
    let sets = subdomains_of_node(&model, &decomposition);
    let above = |node: u32| {
        let parent = &decomposition.hierarchy.parent;
        let mut way = vec![*sets[node as usize].first().unwrap()];
        while let Some(next) = parent[way[way.len() - 1] as usize] {
            way.push(next);
        }
        way
    };
    let points = &model.contacts[0].points;
    let near = points.iter().filter(|point| {
        let [a, b] = [0, 1].map(|side| above(point.entries[side].0));
        a[..3].iter().any(|node| b[..3].contains(node))
    });
    assert!(2 * near.count() > points.len());
}

#[test]
fn a_prescribed_partition_is_taken_as_it_is() {
    let mut model = stacked(2, 6, 3);
    let halves: Vec<u32> = model.cell_body.iter().map(|b| 1 - b).collect();
    model.prescribed_subdomains = Some(halves.clone());
    for count in [None, Some(2)] {
        let decomposition = Decomposition::new(&model, count).unwrap();
        assert_eq!(decomposition.subdomain, halves);
    }
    let message = Decomposition::new(&model, Some(3)).unwrap_err().to_string();
    says(&message, "expected 2");

    let mut across = halves.clone();
    across[0] = 0;
    let refused = |model: &Model| {
        let decomposition = Decomposition::new(model, None).unwrap();
        Problem::new(model, &decomposition).unwrap_err().to_string()
    };
    model.prescribed_subdomains = Some(across);
    let message = refused(&model);
    says(&message, "subdomain 0 lies in two disconnected bodies");

    let mut gap = halves;
    gap[0] = 3;
    model.prescribed_subdomains = Some(gap);
    let message = refused(&model);
    says(&message, "subdomain 2 has no cells");
}

#[test]
fn a_prescribed_subdomain_in_two_parts_is_a_warning() {
    let mut model = stacked(1, 6, 2);
    let third = |cell: usize| {
        let nodes = model.mesh.cells.nodes_of(cell);
        let x: f64 = nodes
            .iter()
            .map(|&n| model.mesh.points[n as usize][0])
            .sum();
        u32::from((6.0..12.0).contains(&x))
    };
    model.prescribed_subdomains = Some((0..model.mesh.cells.len()).map(third).collect());
    let decomposition = Decomposition::new(&model, None).unwrap();
    let warnings = Problem::new(&model, &decomposition)
        .unwrap()
        .catalog
        .warnings;
    assert!(
        warnings[1].ends_with("disconnected subdomains: 0"),
        "{warnings:?}"
    );
}

#[test]
fn pieces_that_share_a_node_alone_are_one_body_of_two_subdomains() {
    let mut model = stacked(2, 4, 3);
    let first = model.contacts[0].points.remove(0);
    let (hinge, gone) = (first.entries[0].0, first.entries[1].0);
    for cell in 0..model.mesh.cells.len() {
        for node in model.mesh.cells.nodes_of_mut(cell) {
            if *node == gone {
                *node = hinge;
            }
        }
    }
    model.topology = Topology::new(&model.mesh);
    assert_eq!(range(&model).0, 2);
    let decomposition = Decomposition::new(&model, Some(2)).unwrap();
    let catalog = Problem::new(&model, &decomposition).unwrap().catalog;
    assert_eq!(catalog.bodies[0].name, "block 0+block 1");
    assert_eq!((catalog.bodies.len(), catalog.interface_nodes), (1, 1));
}

#[test]
fn a_node_with_a_condition_at_which_the_mesh_is_pinched_keeps_its_group_together() {
    // Two blocks that share one node, which has a condition of its own.
    let mut model = stacked(2, 4, 3);
    let (hinge, gone) = {
        let entries = &mut model.contacts[0].points[0].entries;
        let gone = entries.pop().unwrap().0;
        (entries[0].0, gone)
    };
    for cell in 0..model.mesh.cells.len() {
        for node in model.mesh.cells.nodes_of_mut(cell) {
            if *node == gone {
                *node = hinge;
            }
        }
    }
    model.topology = Topology::new(&model.mesh);
    for count in 2..12 {
        let decomposition = Decomposition::new(&model, Some(count)).unwrap();
        assert_eq!(components(&model, &decomposition), count);
        let catalog = Problem::new(&model, &decomposition).unwrap().catalog;
        let sets = subdomains_of_node(&model, &decomposition);
        for &subdomain in &sets[hinge as usize] {
            assert_eq!(catalog.subdomains[subdomain as usize].group, Some(0));
        }
    }
}
