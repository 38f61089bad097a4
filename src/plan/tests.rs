use contact_dd_partition::contact_point::{ContactPoint, Law, LocalFrame};
use contact_dd_partition::model::PlaneState;
use contact_dd_partition::problem::{Body, Hierarchy, PointNode, SubdomainNode, SubdomainSummary};
use contact_dd_partition::scene::units::Units;
use contact_dd_partition::solver::SolverSettings;

use super::*;

/// Two contact points between subdomains 1 and 3; subdomains 0, 2 and 4 are linear, 4 is the largest.
fn catalog() -> Catalog {
    let sizes = [40, 30, 20, 30, 90];
    let node = |subdomain, node| SubdomainNode { subdomain, node };
    let point = |a, b| {
        let entries = vec![(node(1, a), 1.0), (node(3, b), -1.0)];
        ContactPoint::new(entries, [1.0, 0.0, 0.0], [0.0; 3], 0)
    };
    let free = |interface| PointNode {
        interface,
        is_free: true,
    };
    Catalog {
        title: String::new(),
        dim: 2,
        units: Units::Metre,
        plane: Some(PlaneState::Strain),
        materials: Vec::new(),
        bodies: vec![Body::new("b".into())],
        supports: Vec::new(),
        contacts: Vec::new(),
        steps: Vec::new(),
        subdomains: sizes
            .iter()
            .enumerate()
            .map(|(s, &nodes)| SubdomainSummary {
                body: 0,
                group: [1, 3].contains(&s).then_some(0),
                nodes,
                cells: nodes,
            })
            .collect(),
        interface: vec![vec![0, 1], vec![1, 2], vec![0, 3], vec![2, 3], vec![0]],
        interface_nodes: 4,
        groups: vec![2],
        probes: Vec::new(),
        tips: Vec::new(),
        quantities: Vec::new(),
        parameters: Vec::new(),
        points: vec![point(5, 6), point(7, 8)],
        point_nodes: vec![vec![free(None); 2], vec![free(Some(2)), free(None)]],
        hierarchy: Hierarchy {
            parent: [6, 5, 6, 5, 5, 7, 7]
                .map(Some)
                .into_iter()
                .chain([None])
                .collect(),
            clusters: Vec::new(),
        },
        solver: SolverSettings::default(),
        warnings: Vec::new(),
    }
}

/// The number in the tree of node v of the file, after two leaves for subdomains with nodes only used by contact
/// points.
fn inner(v: usize) -> TreeNodeId {
    TreeNodeId::new(v + 2)
}

fn plan(catalog: &Catalog, ranks: usize, merging: Merging) -> Plan {
    Plan::new(catalog, &Tree::new(catalog), ranks, merging)
}

#[test]
fn contact_points_belong_where_all_that_have_their_nodes_come_together() {
    let plan = plan(&catalog(), 3, Merging::All);
    let [group] = plan.groups.values() else {
        panic!("{:?}", plan.groups);
    };
    assert_eq!((group.node, group.nodes.len()), (inner(5), 4));
    let node = &plan.tree.nodes[inner(5)];
    assert_eq!((&node.points[..], node.conditions), (&[0, 1][..], 2));
    // Nodes only used by contact points belong there, too.
    assert_eq!(plan.tree.interface_nodes, 7);
    assert_eq!(node.eliminated, [2, 4, 5, 6]);
    assert_eq!(node.kept, [0, 1, 3]);
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_ranks() {
    let catalog = catalog();
    let one = plan(&catalog, 1, Merging::All);
    for ranks in 2..8 {
        let plan = plan(&catalog, ranks, Merging::All);
        assert_eq!(one.tree, plan.tree);
        assert!(plan.node_owners.iter().all(|&owner| owner < ranks));
    }
}

#[test]
fn what_picard_merges_has_no_contact() {
    let clusters = |merging| -> Vec<TreeNodeId> {
        let plan = plan(&catalog(), 2, merging);
        plan.clusters.iter().map(|c| c.node).collect()
    };
    assert_eq!(clusters(Merging::All), [inner(5), inner(6)]);
    let mut apart = catalog();
    apart.points.clear();
    apart.point_nodes.clear();
    let plan = plan(&apart, 2, Merging::Linear);
    assert_eq!(plan.clusters.len(), 2);
}

#[test]
fn subtrees_are_split_until_ranks_have_about_the_same_to_do() {
    let plan = plan(&catalog(), 2, Merging::All);
    let nodes = [40, 30, 20, 30, 90];
    let of_rank = |rank: usize| -> usize {
        let owners = plan.owners();
        let own = owners
            .iter()
            .zip(nodes)
            .filter(|(owner, _)| **owner == rank);
        own.map(|(_, nodes)| nodes).sum()
    };
    assert_eq!((of_rank(0), of_rank(1)), (110, 100));
}

/// Normals along which nodes of one subdomain slide, in `catalog`.
fn slides(catalog: &Catalog) -> Vec<Option<[f64; 3]>> {
    let tree = Tree::new(catalog);
    tree.unshared.iter().map(|own| own.slides).collect()
}

#[test]
fn without_friction_a_node_that_others_have_not_is_on_the_interface_along_its_normal() {
    let mut catalog = catalog();
    let n = [1.0, 0.0, 0.0];
    // Node 7 of subdomain 1 also belongs to subdomain 2.
    assert_eq!(slides(&catalog), [Some(n); 3]);
    let node = &Tree::new(&catalog).nodes[inner(5)];
    assert_eq!(node.dofs, [2 + 3, 3 * 2]);
    // Another normal at one of its nodes.
    let mut other = catalog.points[0].clone();
    other.frame = LocalFrame::new([0.0, 1.0, 0.0]);
    other.entries.truncate(1);
    catalog.points.push(other);
    catalog
        .point_nodes
        .push(catalog.point_nodes[0][..1].to_vec());
    assert_eq!(slides(&catalog), [None, Some(n), Some(n)]);
    catalog.points[1].law = Law::coulomb(0.3, 0.0);
    assert_eq!(slides(&catalog), [None, Some(n), None]);
}
