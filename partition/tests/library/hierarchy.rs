//! Laws of the tree along which subdomains are merged.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::LazyLock;

use crate::problem_scenes::{cracked, shuffled, stacked};
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::flops::Front;
use contact_dd_partition::hierarchy::work::Work;
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::{Catalog, Hierarchy, Problem};
use proptest::prelude::*;

fn problem(model: &Model, count: usize) -> Problem {
    let decomposition = Decomposition::new(model, Some(count)).unwrap();
    Problem::new(model, &decomposition).unwrap()
}

fn problems() -> Vec<Problem> {
    let crack = cracked(30, &[(0, 9), (21, 30)]);
    let stack = shuffled(&stacked(3, 20, 12), 7);
    let mut problems = vec![problem(&stacked(1, 2, 2), 1), problem(&stacked(2, 5, 3), 2)];
    for count in [8, 13, 40] {
        problems.push(problem(&crack, count));
        problems.push(problem(&stack, count));
        problems.push(problem(&stacked(1, 25, 25), count));
    }
    problems
}

/// The subdomains under every node of a tree.
fn under(catalog: &Catalog, hierarchy: &Hierarchy) -> Vec<BTreeSet<usize>> {
    let mut under: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); hierarchy.parent.len()];
    for subdomain in 0..catalog.subdomains.len() {
        let mut node = Some(subdomain as u32);
        while let Some(at) = node {
            under[at as usize].insert(subdomain);
            node = hierarchy.parent[at as usize];
        }
    }
    under
}

/// The subdomains under each child of a node.
fn children(catalog: &Catalog, hierarchy: &Hierarchy, node: usize) -> Vec<BTreeSet<usize>> {
    let under = under(catalog, hierarchy).into_iter().enumerate();
    let own = under.filter(|&(child, _)| hierarchy.parent[child] == Some(node as u32));
    own.map(|(_, set)| set).collect()
}

/// The front of an inner node by its definition, of a problem without contact.
fn front(catalog: &Catalog, hierarchy: &Hierarchy, node: usize) -> Front {
    let children = children(catalog, hierarchy, node);
    let here: BTreeSet<usize> = children.iter().flatten().copied().collect();
    let (mut eliminated, mut kept) = (0, 0);
    for number in 0..catalog.interface_nodes as u32 {
        let owners: BTreeSet<usize> = (0..catalog.subdomains.len())
            .filter(|&s| catalog.interface[s].contains(&number))
            .collect();
        if owners.is_disjoint(&here) {
            continue;
        }
        if !owners.is_subset(&here) {
            kept += catalog.dim;
        } else if !children.iter().any(|child| owners.is_subset(child)) {
            eliminated += catalog.dim;
        }
    }
    Front { eliminated, kept }
}

/// Conditions that docs/problem-file.md states of a tree.
fn holds(catalog: &Catalog, parent: &[i64]) -> bool {
    let (subdomains, nodes) = (catalog.subdomains.len(), parent.len());
    let later = |(node, &p): (usize, &i64)| {
        p == -1 || (p > node as i64 && p >= subdomains as i64 && p < nodes as i64)
    };
    if nodes < subdomains
        || !parent.iter().enumerate().all(later)
        || (subdomains..nodes).any(|inner| !parent.contains(&(inner as i64)))
    {
        return false;
    }
    let root = |s: usize| {
        let mut at = s;
        while parent[at] != -1 {
            at = parent[at] as usize;
        }
        at
    };
    (0..subdomains).all(|a| {
        (0..a).all(|b| {
            let shared = catalog.interface[a]
                .iter()
                .any(|n| catalog.interface[b].contains(n));
            !shared || root(a) == root(b)
        })
    })
}

fn numbers(hierarchy: &Hierarchy) -> Vec<i64> {
    let parents = hierarchy.parent.iter();
    parents.map(|p| p.map_or(-1, i64::from)).collect()
}

/// Replaces the tree of a file.
fn plant(path: &Path, parent: &[i64]) {
    let file = hdf5::File::open_rw(path).unwrap();
    file.unlink("hierarchy/parent").unwrap();
    file.unlink("hierarchy/cluster").unwrap();
    let dataset = file.new_dataset::<i64>().shape(parent.len());
    let dataset = dataset.create("hierarchy/parent").unwrap();
    dataset.write_raw(parent).unwrap();
    file.close().unwrap();
}

#[test]
fn every_subdomain_is_in_one_cluster_of_about_as_many_as_asked_for() {
    for mut problem in problems() {
        let catalog = &mut problem.catalog;
        let parents = catalog.hierarchy.parent.clone();
        let roots = parents.iter().filter(|parent| parent.is_none()).count();
        for wanted in [1, 2, 3, 5, catalog.subdomains.len()] {
            catalog.choose_clusters(Some(wanted));
            let clusters = &catalog.hierarchy.clusters;
            assert!(
                clusters.len() >= wanted.min(catalog.subdomains.len()).max(roots)
                    && clusters.len() <= catalog.subdomains.len()
            );
            for subdomain in 0..catalog.subdomains.len() as u32 {
                let ancestors = std::iter::successors(Some(subdomain), |&v| parents[v as usize]);
                let above = ancestors.filter(|v| clusters.binary_search(v).is_ok());
                assert_eq!(above.count(), 1, "{clusters:?}");
            }
        }
    }
}

#[test]
fn a_tree_joins_two_at_least_and_is_what_the_format_asks_for() {
    for problem in problems() {
        let catalog = &problem.catalog;
        let hierarchy = &catalog.hierarchy;
        assert!(holds(catalog, &numbers(hierarchy)), "{hierarchy:?}");
        for inner in catalog.subdomains.len()..hierarchy.parent.len() {
            assert!(children(catalog, hierarchy, inner).len() >= 2);
        }
    }
}

#[test]
fn fronts_are_what_their_definition_says() {
    let without_contact = |problem: &Problem| problem.catalog.contacts.is_empty();
    for problem in problems().into_iter().filter(without_contact) {
        let catalog = &problem.catalog;
        let fronts = Work::new(catalog).fronts;
        for (inner, &found) in (catalog.subdomains.len()..).zip(&fronts) {
            assert_eq!(found, front(catalog, &catalog.hierarchy, inner));
        }
    }
}

/// Where active sets are frozen no jump goes up to the root, which else keeps all of them.
#[test]
fn many_conditions_leave_fronts_small() {
    let largest = |length: usize| {
        let problem = problem(&stacked(5, length, 3), 60);
        let kept = Work::new(&problem.catalog)
            .fronts
            .iter()
            .map(|f| f.kept)
            .max();
        (problem.catalog.conditions(), kept.unwrap())
    };
    let (few, kept) = largest(100);
    assert!(few < 600 && kept >= few, "{few} {kept}");
    let (many, kept) = largest(200);
    assert!(many > 600 && kept < many / 2, "{many} {kept}");
}

#[test]
fn many_ranks_find_something_to_do() {
    let crack = cracked(60, &[(0, 18), (42, 60)]);
    for (problem, ranks) in [
        (problem(&stacked(1, 9, 9), 1), 1),
        (problem(&stacked(1, 50, 50), 64), 16),
        (problem(&crack, 90), 16),
        (problem(&crack, 200), 16),
    ] {
        let work = Work::new(&problem.catalog);
        assert!(work.useful_ranks() >= ranks, "{}", problem.summary());
        assert!(work.speed_up <= problem.catalog.subdomains.len() as f64);
    }
}

#[test]
fn what_is_under_a_node_is_one_slice() {
    for problem in problems() {
        let catalog = &problem.catalog;
        for set in under(catalog, &catalog.hierarchy) {
            let (first, last) = (*set.first().unwrap(), *set.last().unwrap());
            assert_eq!(last + 1 - first, set.len(), "{:?}", catalog.hierarchy);
        }
    }
}

#[test]
fn subdomains_that_a_scene_prescribes_get_a_tree_that_is_about_as_good() {
    let model = stacked(1, 60, 60);
    let own = Decomposition::new(&model, Some(64)).unwrap();
    let prescribed = Decomposition::of_cells(&model, own.subdomain.clone(), 64);
    let flops = |decomposition| {
        let problem = Problem::new(&model, decomposition).unwrap();
        Work::new(&problem.catalog).of_fronts()
    };
    assert!(flops(&prescribed) < 1.3 * flops(&own));
}

#[test]
fn trees_with_one_child_or_many_are_taken_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    let problem = problem(&stacked(1, 12, 6), 9);
    problem.write(&path).unwrap();
    // All nine under one, and two more on top of it.
    let parent = [&[9; 9][..], &[10, 11, -1]].concat();
    plant(&path, &parent);
    let file = ProblemFile::open(&path).unwrap();
    let catalog = file.catalog();
    assert_eq!(numbers(&catalog.hierarchy), parent);
    for (inner, front_of) in (9..).zip(Work::new(catalog).fronts) {
        assert_eq!(front_of, front(catalog, &catalog.hierarchy, inner));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_tree_is_refused_exactly_where_it_breaks_the_format(
        changes in prop::collection::vec((0usize..20, -2i64..22), 0..3),
        more in prop::collection::vec(-1i64..22, 0..3),
        loose in any::<bool>(),
    ) {
        static PROBLEM: LazyLock<Problem> = LazyLock::new(|| problem(&stacked(1, 8, 4), 7));
        let problem = &*PROBLEM;
        // Either the tool's tree or one root above all, then damaged.
        let mut parent = match loose {
            true => [vec![7i64; 7], vec![-1]].concat(),
            false => numbers(&problem.catalog.hierarchy),
        };
        for (at, value) in changes {
            let rows = parent.len();
            parent[at % rows] = value;
        }
        parent.extend(more);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("problem.h5");
        problem.write(&path).unwrap();
        plant(&path, &parent);
        let read = ProblemFile::open(&path);
        prop_assert_eq!(read.is_ok(), holds(&problem.catalog, &parent), "{:?}: {:?}", parent, read);
        if let Err(error) = read {
            prop_assert!(error.to_string().contains("dataset /hierarchy/parent"));
        }
    }
}
