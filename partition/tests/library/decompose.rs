//! Laws of the contact-aware partition.

use std::collections::BTreeSet;

use crate::problem_scenes::{cracked, shuffled, stacked};
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
fn no_node_with_a_contact_condition_lies_on_the_interface() {
    for (scene, model) in scenes().iter().enumerate() {
        for count in counts(scene, range(model)) {
            let decomposition = Decomposition::new(model, Some(count)).unwrap();
            let sets = subdomains_of_node(model, &decomposition);
            for condition in model.contacts.iter().flat_map(|c| &c.points) {
                for &(node, _) in &condition.entries {
                    assert_eq!(sets[node as usize].len(), 1, "{count} subdomains");
                }
            }
        }
    }
}

#[test]
fn contacts_lie_within_pairs_wherever_the_count_allows() {
    // Sides of contacts, so many subdomains are needed.
    for (model, sides) in [
        (stacked(2, 10, 6), 2),
        (stacked(3, 8, 5), 4),
        (shuffled(&stacked(4, 8, 6), 3), 6),
        (cracked(16, &[(0, 5), (11, 16)]), 4),
        (shuffled(&cracked(16, &[(0, 5), (11, 16)]), 4), 4),
    ] {
        for count in (sides..40).step_by(5) {
            let decomposition = Decomposition::new(&model, Some(count)).unwrap();
            let problem = Problem::new(&model, &decomposition).unwrap();
            let pairs = vec![2; model.contacts.len()];
            assert_eq!(problem.summary().groups(), pairs, "{count} subdomains");
            assert_eq!(2 * pairs.len(), sides);
        }
    }
}

/// The materials in every subdomain.
fn materials(model: &Model, decomposition: &Decomposition) -> Vec<BTreeSet<u32>> {
    let mut materials = vec![BTreeSet::new(); decomposition.count];
    for (&subdomain, &material) in decomposition.subdomain.iter().zip(&model.cell_material) {
        materials[subdomain as usize].insert(material);
    }
    materials
}

/// Gives a material to every cell of a model by its centre.
fn with_materials(mut model: Model, material: impl Fn(f64, f64) -> u32) -> Model {
    for cell in 0..model.mesh.cells.len() {
        let nodes = model.mesh.cells.nodes_of(cell).iter();
        let points: Vec<_> = nodes.map(|&n| model.mesh.points[n as usize]).collect();
        let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / points.len() as f64;
        model.cell_material[cell] = material(mean(0), mean(1));
    }
    model
}

#[test]
fn bonded_materials_have_subdomains_of_their_own_wherever_the_count_allows() {
    let layers = with_materials(stacked(1, 12, 10), |_, y| u32::from(y > 3.0));
    // A frame around an island: three regions, two of them of one material.
    let island = with_materials(stacked(1, 12, 12), |x, y| {
        let out = (x - 6.0).abs().max((y - 6.0).abs());
        u32::from(out > 2.0 && out < 4.0)
    });
    for (model, regions) in [(layers, 2), (island, 3)] {
        assert_eq!(range(&model).0, 1);
        for count in 1..=12 {
            let decomposition = Decomposition::new(&model, Some(count)).unwrap();
            assert_eq!(components(&model, &decomposition), count);
            let pure = materials(&model, &decomposition)
                .iter()
                .all(|materials| materials.len() == 1);
            assert_eq!(pure, count >= regions, "{count} subdomains");
        }
        let default = Decomposition::new(&model, None).unwrap();
        assert_eq!(default.count, regions);
    }
}

#[test]
fn only_cells_around_a_contact_surface_mix_materials() {
    // Both sides of the crack end at the bond between the materials.
    let model = with_materials(cracked(16, &[(0, 9)]), |x, _| u32::from(x > 8.0));
    let conditions = || model.contacts.iter().flat_map(|c| &c.points);
    let in_contact: BTreeSet<u32> = conditions()
        .flat_map(|c| &c.entries)
        .map(|&(node, _)| node)
        .collect();
    for count in 6..20 {
        let decomposition = Decomposition::new(&model, Some(count)).unwrap();
        let mixed = materials(&model, &decomposition);
        for (cell, &subdomain) in decomposition.subdomain.iter().enumerate() {
            let away = |n: &u32| !in_contact.contains(n);
            if mixed[subdomain as usize].len() > 1 && model.cell_material[cell] == 1 {
                let nodes = model.mesh.cells.nodes_of(cell);
                assert!(!nodes.iter().all(away), "{count} subdomains, cell {cell}");
            }
        }
    }
}

#[test]
fn grains_that_are_more_than_the_subdomains_leave_them_balanced() {
    let grain = |x: f64, y: f64| u32::from((x % 4.0).max(y % 4.0) < 1.0);
    let model = with_materials(stacked(1, 40, 40), grain);
    for count in [4, 8, 16] {
        let decomposition = Decomposition::new(&model, Some(count)).unwrap();
        let problem = Problem::new(&model, &decomposition).unwrap();
        let summary = problem.summary();
        assert!(summary.imbalance() < 1.2, "{count}: {summary}");
    }
    assert_eq!(Decomposition::new(&model, None).unwrap().count, 1);
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
        assert!(message.contains("expected 3 "), "{message}");
    }
    let single = stacked(1, 2, 2);
    assert_eq!(range(&single), (1, 8));
}

#[test]
fn without_a_count_small_scenes_have_every_side_apart() {
    let of = |model: &Model| Decomposition::new(model, None).unwrap().count;
    assert_eq!(of(&stacked(1, 9, 9)), 1);
    assert_eq!(of(&stacked(2, 9, 9)), 6);
    assert_eq!(of(&cracked(16, &[(0, 5), (11, 16)])), 8);
    assert_eq!(of(&stacked(1, 1, 1)), 1);
    assert_eq!(of(&stacked(1, 99, 99)), 1);
}

#[test]
fn without_a_count_large_scenes_have_subdomains_of_two_thousand_dofs() {
    let model = stacked(1, 120, 110);
    let decomposition = Decomposition::new(&model, None).unwrap();
    assert_eq!(decomposition.count, (2 * 121 * 111usize).div_ceil(2000));
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
    assert!(message.contains("expected 2"), "{message}");

    let mut across = halves.clone();
    across[0] = 0;
    let refused = |model: &Model| {
        let decomposition = Decomposition::new(model, None).unwrap();
        Problem::new(model, &decomposition).unwrap_err().to_string()
    };
    model.prescribed_subdomains = Some(across);
    let message = refused(&model);
    assert!(
        message.contains("subdomain 0 lies in two bodies"),
        "{message}"
    );

    let mut gap = halves;
    gap[0] = 3;
    model.prescribed_subdomains = Some(gap);
    let message = refused(&model);
    assert!(message.contains("subdomain 2 has no cells"), "{message}");
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
    assert!(warnings[1].ends_with("hang together: 0"), "{warnings:?}");
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

#[test]
fn contact_patches_grow_where_a_boundary_along_the_contact_would_be_dear() {
    let long = stacked(2, 400, 8);
    let catalog = |count| {
        let decomposition = Decomposition::new(&long, count).unwrap();
        Problem::new(&long, &decomposition).unwrap().catalog
    };
    let by_itself = catalog(None);
    assert_eq!(
        (by_itself.subdomains.len(), by_itself.interface_nodes),
        (2, 0)
    );
    // As much is left to others as what was asked for needs.
    for count in [6, 1000] {
        assert_eq!(catalog(Some(count)).subdomains.len(), count);
    }

    let short = stacked(2, 10, 6);
    let decomposition = Decomposition::new(&short, None).unwrap();
    let catalog = Problem::new(&short, &decomposition).unwrap().catalog;
    assert!(catalog.subdomains.iter().any(|s| s.group.is_none()));
}
