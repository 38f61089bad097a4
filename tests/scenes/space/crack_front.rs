//! Cracks at whose front facets of the two sides share most of their nodes, or all corners.

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::mesh::{Group, Mesh};

use crate::support::blocks::{glued, joined};
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solver::solve;

/// A block with a crack in its middle, free to expand laterally.
const CRACKED: &str = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[bilateral]]
on = ['lower x0', 'upper x0', 'lower y0', 'upper y0', 'lower z0']
[[contact]]
name = 'crack'
sides = ['crack of lower', 'crack of upper']
";

/// The unit cube with a square crack in the plane z = 1/2, of two facets in each direction: in cells of 8 nodes each
/// side has only one node that the other side lacks.
fn cracked(kind: ElementKind) -> Mesh {
    let n = [4, 4, 1];
    let lower = solid("lower", kind, n, between([0.0; 3], [1.0, 1.0, 0.5]));
    let upper = solid("upper", kind, n, between([0.0, 0.0, 0.5], [1.0; 3]));
    let is_inside = |x: [f64; 3]| (x[0] - 0.5).abs() < 0.249 && (x[1] - 0.5).abs() < 0.249;
    let mut mesh = glued(joined(lower, upper), |x| !is_inside(x));
    for (body, side) in [("lower", "lower z1"), ("upper", "upper z0")] {
        let is_of_crack = |facet: &u32| {
            let nodes = mesh.facets.nodes_of(*facet as usize).iter();
            let mut nodes = nodes.map(|&node| mesh.points[node as usize]);
            nodes.any(is_inside)
        };
        let members = mesh.groups[side].members.iter();
        let members = members.copied().filter(is_of_crack).collect();
        let group = Group { dim: 2, members };
        mesh.groups.insert(format!("crack of {body}"), group);
    }
    mesh
}

#[test]
fn a_closed_crack_carries_as_if_there_was_none() {
    let pressed = format!("{CRACKED}[[pressure]]\non = 'upper z1'\nvalue = 1e6\n");
    for kind in [
        Hexahedron8,
        Hexahedron20,
        Hexahedron27,
        Tetrahedron4,
        Tetrahedron10,
    ] {
        let model = model(&pressed, cracked(kind));
        for count in [1, 4] {
            let solution = solve(&model, count);
            assert!(solution.closed() > 0, "{kind:?}");
            solution.check_stress([0.0, 0.0, -1e6, 0.0, 0.0, 0.0], 1e-9 * 1e6);
        }
    }
}

#[test]
fn an_open_crack_is_that_of_a_monolithic_solve() {
    let pulled = format!("{CRACKED}[[pressure]]\non = 'upper z1'\nvalue = '-1e6*(1-0.7*x)'\n");
    for kind in [Hexahedron8, Hexahedron20, Tetrahedron10] {
        let model = model(&pulled, cracked(kind));
        let reference = Monolithic::new(&model);
        let solution = solve(&model, 4);
        compare(&model, &reference, &solution);
        assert_eq!(solution.closed(), 0, "{kind:?}");
        // The crack is open: its sides aren't joined.
        assert!(solution.points().all(|point| point.gap > 1e-6), "{kind:?}");
    }
}
