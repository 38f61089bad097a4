//! A uniform pressure is transferred exactly between cells in space.

use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind::{
    self, Hexahedron8, Hexahedron20, Hexahedron27, Tetrahedron4, Tetrahedron10,
};
use contact_dd_partition::element::geometry::dot;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::joined;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solids::{SOLIDS, between, moved, solid, turned};
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::uneven::PRESSURE;

const SCENE: &str = "
materials.steel = {young = 210e9, poisson = 0.3}
materials.rock = {young = 20e9, poisson = 0.22}
bodies.lower.material = 'rock'
bodies.upper.material = 'steel'
[[bilateral]]
on = ['lower x0', 'lower y0', 'lower z0', 'upper x0', 'upper y0']
[[pressure]]
on = 'upper z1'
value = 1e6
";

const SIDES: [&str; 2] = ["'lower z1', 'upper z0'", "'upper z0', 'lower z1'"];

fn scene(sides: &str) -> String {
    format!("{SCENE}[[contact]]\nname = 'joint'\nsides = [{sides}]\ngap = 0.0\n")
}

/// A box of irregular cells, whose faces are irregular for linear kinds; edges of quadratic ones stay straight.
fn block(name: &str, kind: ElementKind, n: [usize; 3], low: [f64; 3], high: [f64; 3]) -> Mesh {
    let mesh = solid(name, kind, n, |x| x);
    let amount = if [Tetrahedron4, Hexahedron8].contains(&kind) {
        0.06
    } else {
        0.0
    };
    let uneven = |[x, y, z]: [f64; 3]| {
        let bulge = amount * (PI * x).sin() * (PI * y).sin();
        [x + bulge, y - 0.7 * bulge, z]
    };
    let place = between(low, high);
    moved(mesh, |x| place(uneven(x)))
}

/// Fails unless the pressure is uniform and all contacts are closed, to within 1e-10.
#[track_caller]
fn is_uniform(solution: &Solution) {
    let n = turned([0.0, 0.0, 1.0]);
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
    let expected = pairs.map(|(i, j)| -PRESSURE * n[i] * n[j]);
    solution.check_cells(expected, 1e-10 * PRESSURE);
    solution.check_pressure(PRESSURE, 1e-10 * PRESSURE);
    assert!(solution.points().all(|point| point.tags[1] == -1));
}

/// Displacements of the shape of a given gap fill it at every point, also of faces whose points have several nodes.
#[test]
fn a_displacement_of_the_shape_of_a_given_gap_fills_it_at_every_point() {
    let gap = |[x, y, _]: [f64; 3]| 1e-4 * (3.0 + x * x + x * y - y);
    let given = "gap = '1e-4*(3 + x^2 + x*y - y)'";
    for kind in SOLIDS {
        let mesh = joined(
            block("lower", kind, [2, 3, 2], [0.0; 3], [2.0, 2.0, 1.0]),
            block("upper", kind, [3, 2, 1], [0.0, 0.0, 1.0], [2.0; 3]),
        );
        let scene = SCENE.replace("'lower z0', ", "");
        let text = format!(
            "{scene}[[contact]]\nname = 'joint'\nsides = ['upper z0', 'lower z1']\n{given}\n[[contact]]\n\
             name = 'floor'\nsides = ['lower z0']\nobstacle = {{point = [0, 0, 0], normal = [0, 0, 1]}}\n{given}\n"
        );
        let model = model(&text, mesh);
        // The nodes of one body alone move: of two sides those that carry the constraints.
        for (contact, sides) in model
            .contacts
            .iter()
            .zip([["upper z0", "lower z1"], ["lower z0"; 2]])
        {
            let moved = sides.map(|side| {
                let mut u = vec![0.0; 3 * model.mesh.points.len()];
                for &facet in &model.mesh.groups[side].members {
                    for &node in model.mesh.facets.nodes_of(facet as usize) {
                        u[3 * node as usize + 2] = gap(model.mesh.points[node as usize]);
                    }
                }
                u
            });
            for point in &contact.points {
                let moved = &moved[usize::from(point.tag_a == -1)];
                let filled = point.jump_along(point.normal(), 3, moved).abs();
                assert!(
                    (filled - point.gap).abs() < 1e-15,
                    "{kind:?} at {:?}: {filled:e}, gap {:e}",
                    point.position,
                    point.gap
                );
            }
        }
    }
}

#[test]
fn a_uniform_pressure_passes_between_solids_of_any_cells() {
    for (i, lower) in SOLIDS.into_iter().enumerate() {
        for (step, sides) in [(1, SIDES[0]), (3, SIDES[1])] {
            let upper = SOLIDS[(i + step) % SOLIDS.len()];
            let mesh = joined(
                block("lower", lower, [2, 3, 2], [0.0; 3], [2.0, 2.0, 1.0]),
                block("upper", upper, [3, 2, 1], [0.0, 0.0, 1.0], [2.0; 3]),
            );
            is_uniform(&solve(&model(&scene(sides), moved(mesh, turned)), 3));
        }
    }
}

/// A facet that another one overlaps by next to nothing has a tiny weight in a contact constraint: no displacement of
/// it may be replaced by that constraint's jump.
#[test]
fn facets_that_overlap_by_slivers_leave_the_stiffness_whole() {
    for sliver in [1e-7, 1e-5] {
        for (lower, upper) in [
            (Tetrahedron10, Tetrahedron10),
            (Hexahedron20, Tetrahedron10),
            (Tetrahedron4, Hexahedron27),
        ] {
            let [first, last] = [1.0 - sliver, 3.0 + sliver];
            let mesh = joined(
                solid(
                    "lower",
                    lower,
                    [4, 4, 2],
                    between([0.0; 3], [4.0, 4.0, 1.0]),
                ),
                solid(
                    "upper",
                    upper,
                    [3, 3, 2],
                    between([first, first, 1.0], [last, last, 2.0]),
                ),
            );
            for sides in SIDES {
                let model = model(&scene(sides), moved(mesh.clone(), turned));
                let reference = Monolithic::new(&model);
                for count in [5, 8, 13] {
                    compare(&model, &reference, &solve(&model, count));
                }
            }
        }
    }
}

/// A rectangle in the plane, along x and y.
type Rectangle = [[f64; 2]; 2];

/// ∫ N over the part of a side of rectangular facets that lies in a rectangle: node and value.
fn integrals(mesh: &Mesh, side: &str, part: Rectangle) -> Vec<(u32, f64)> {
    let mut list = Vec::new();
    for &facet in &mesh.groups[side].members {
        let kind = mesh.facets.kind(facet as usize);
        let nodes = mesh.facets.nodes_of(facet as usize);
        let at = |local: usize| mesh.points[nodes[local] as usize];
        let range = |axis: usize| {
            let own = [at(0)[axis].min(at(2)[axis]), at(0)[axis].max(at(2)[axis])];
            let common = [own[0].max(part[axis][0]), own[1].min(part[axis][1])];
            (own, common)
        };
        let ranges = [range(0), range(1)];
        if ranges.iter().any(|(_, common)| common[0] >= common[1]) {
            continue;
        }
        for (xi, weight) in kind.quadrature(4) {
            let x = [0, 1].map(|axis| {
                let [from, to] = ranges[axis].1;
                from + 0.5 * (1.0 + xi[axis]) * (to - from)
            });
            let area: f64 = ranges
                .iter()
                .map(|(_, [from, to])| 0.5 * (to - from))
                .product();
            // The reference coordinates of x, along the edges at the first corner.
            let along = |end: usize| {
                let edge = [0, 1].map(|axis| at(end)[axis] - at(0)[axis]);
                let way = [0, 1].map(|axis| x[axis] - at(0)[axis]);
                let [edge, way] = [edge, way].map(|[x, y]| [x, y, 0.0]);
                2.0 * dot(way, edge) / dot(edge, edge) - 1.0
            };
            let shape = kind.shape([along(1), along(3), 0.0]);
            list.extend(
                nodes
                    .iter()
                    .zip(shape)
                    .map(|(&node, n)| (node, weight * area * n)),
            );
        }
    }
    list
}

/// The model with the pressure wherever a side is uncovered.
fn pressed_beside(text: &str, mesh: &Mesh, covered: Rectangle) -> Model {
    let mut model = model(text, moved(mesh.clone(), turned));
    let everywhere = [[-9.0, 9.0]; 2];
    for (side, out) in [("lower z1", 1.0), ("upper z0", -1.0)] {
        for (part, sign) in [(everywhere, 1.0), (covered, -1.0)] {
            for (node, integral) in integrals(mesh, side, part) {
                let force = turned([0.0, 0.0, -out * sign * PRESSURE * integral]);
                model.forces.push((node, force));
            }
        }
    }
    let mut sums = std::collections::BTreeMap::new();
    for (node, force) in model.forces {
        let sum = sums.entry(node).or_insert([0.0; 3]);
        *sum = [0, 1, 2].map(|k| sum[k] + force[k]);
    }
    model.forces = sums.into_iter().collect();
    model
}

#[test]
fn a_uniform_pressure_passes_where_solids_overlap_in_part() {
    let kinds = [Hexahedron8, Hexahedron20, Hexahedron27];
    for (i, (low, high, n)) in [
        ([0.0, 0.0], [1.3, 0.9], [3, 2, 1]),
        ([0.0, 0.0], [2.6, 1.2], [2, 2, 1]),
        ([0.3, 0.4], [1.1, 2.3], [2, 2, 2]),
        ([0.0, 0.0], [1.0 + 1e-7, 1.0], [1, 2, 1]),
    ]
    .into_iter()
    .enumerate()
    {
        for sides in SIDES {
            let (lower, upper) = (kinds[i % 3], kinds[(i + 1) % 3]);
            let low = [low[0], low[1], 1.0];
            let mesh = joined(
                solid(
                    "lower",
                    lower,
                    [3, 2, 1],
                    between([0.0; 3], [2.0, 2.0, 1.0]),
                ),
                solid("upper", upper, n, between(low, [high[0], high[1], 2.0])),
            );
            let covered = [0, 1].map(|axis| [low[axis], high[axis].min(2.0)]);
            is_uniform(&solve(&pressed_beside(&scene(sides), &mesh, covered), 2));
        }
    }
}

/// The nodes of both sides coincide, but are the corners of quadrilaterals on one and of triangles on the other.
#[test]
fn a_uniform_pressure_passes_where_nodes_match_but_facets_do_not() {
    for (lower, upper) in [(Hexahedron8, Tetrahedron4), (Tetrahedron10, Hexahedron27)] {
        let mesh = joined(
            solid(
                "lower",
                lower,
                [2, 3, 1],
                between([0.0; 3], [2.0, 2.0, 1.0]),
            ),
            solid(
                "upper",
                upper,
                [2, 3, 1],
                between([0.0, 0.0, 1.0], [2.0; 3]),
            ),
        );
        is_uniform(&solve(&model(&scene(SIDES[0]), moved(mesh, turned)), 2));
    }
    let tetrahedra = |name, low, high| solid(name, Tetrahedron4, [2, 2, 1], between(low, high));
    let lower = tetrahedra("lower", [0.0; 3], [2.0, 2.0, 1.0]);
    // Rotated by 90°, its faces have the other diagonals.
    let upper = moved(
        tetrahedra("upper", [0.0, 0.0, 1.0], [2.0; 3]),
        |[x, y, z]| [2.0 - y, x, z],
    );
    is_uniform(&solve(
        &model(&scene(SIDES[0]), moved(joined(lower, upper), turned)),
        2,
    ));
}
