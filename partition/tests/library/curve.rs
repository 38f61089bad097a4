//! A mesh whose cells were put along a curve.

use std::collections::BTreeMap;

use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;

/// All that a mesh says, by tags.
fn printed(mesh: &Mesh) -> impl PartialEq + std::fmt::Debug {
    let tags = |nodes: &[u32]| {
        nodes
            .iter()
            .map(|&n| mesh.node_tags[n as usize])
            .collect::<Vec<_>>()
    };
    let cells = mesh.cell_tags.iter().zip(mesh.cells.iter());
    let cells: BTreeMap<_, _> = cells
        .map(|(&tag, (kind, nodes))| (tag, (kind, tags(nodes))))
        .collect();
    let points = mesh.points.iter().map(|p| p.map(f64::to_bits));
    let points: BTreeMap<_, _> = mesh.node_tags.iter().zip(points).collect();
    let facets: Vec<_> = mesh
        .facets
        .iter()
        .map(|(kind, nodes)| (kind, tags(nodes)))
        .collect();
    let groups: Vec<_> = (mesh.groups.iter())
        .map(|(name, group)| {
            let tag = |&member: &u32| match mesh.dim - group.dim {
                0 => mesh.cell_tags[member as usize],
                1 => i64::from(member),
                _ => mesh.node_tags[member as usize],
            };
            let mut members: Vec<i64> = group.members.iter().map(tag).collect();
            members.sort_unstable();
            (name.clone(), group.dim, members)
        })
        .collect();
    let points: Vec<_> = points
        .into_iter()
        .map(|(&tag, point)| (tag, point))
        .collect();
    (points, cells, facets, groups)
}

#[test]
fn a_mesh_along_the_curve_says_the_same_and_has_neighbours_near_each_other() {
    let mesh = example::find("granite").unwrap().mesh(1).unwrap();
    let sorted = mesh.clone().along_curve();
    assert_eq!(printed(&sorted), printed(&mesh));
    assert_eq!(sorted.clone().along_curve(), sorted);
    let centre = |cell: usize| sorted.points[sorted.cells.nodes_of(cell)[0] as usize];
    let far = |cell: &usize| {
        let (a, b) = (centre(*cell - 1), centre(*cell));
        (a[0] - b[0]).hypot(a[1] - b[1]) > 1.0
    };
    let jumps = (1..sorted.cells.len()).filter(far).count();
    assert!(
        jumps < sorted.cells.len() / 50,
        "{jumps} of {}",
        sorted.cells.len()
    );
}
