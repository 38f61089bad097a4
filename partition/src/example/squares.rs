//! Meshes of mapped unit squares.

use super::pattern::{Pattern, UnitSquare};
use crate::element::{ElementKind, Elements};
use crate::error::InputError;
use crate::mesh::{Group, Mesh};

/// Largest number of cells of a mesh.
pub(super) const MOST_CELLS: usize = 100_000_000;

/// Distance, relative to the largest coordinate, up to which ends of sides coincide.
pub(super) const SAME: f64 = 1e-9;

/// The image of the unit square, a piece of one body.
pub(super) struct Square {
    /// Group of its cells.
    body: String,
    /// Position of a point of the unit square (m); preserves orientation.
    map: Map,
    /// Division of the unit square.
    pattern: Pattern,
    /// True if edges of quadratic cells follow the map; otherwise they are straight, with the node in the middle, which
    /// is right for a map that only grades the mesh.
    is_curved: bool,
    /// Groups of bottom, right, top and left. A side without a group is glued to the side without
    /// a group that has the same ends; a side with a group, such as that of a contact, never is.
    sides: [Option<String>; 4],
}

/// Position of a point of the unit square (m).
type Map = Box<dyn Fn([f64; 2]) -> [f64; 2]>;

impl Square {
    /// A square whose cells have straight edges, with the groups of bottom, right, top and left.
    pub(super) fn new(
        body: &str,
        pattern: Pattern,
        map: impl Fn([f64; 2]) -> [f64; 2] + 'static,
        sides: [Option<&str>; 4],
    ) -> Self {
        Self {
            body: body.to_owned(),
            map: Box::new(map),
            pattern,
            is_curved: false,
            sides: sides.map(|name| name.map(str::to_owned)),
        }
    }

    /// The same square with edges of quadratic cells that follow the map.
    pub(super) fn curved(self) -> Self {
        Self {
            is_curved: true,
            ..self
        }
    }
}

/// The bilinear map to the quadrilateral with these corners, counter-clockwise from the image of
/// (0, 0).
pub(super) fn quadrilateral(corners: [[f64; 2]; 4]) -> impl Fn([f64; 2]) -> [f64; 2] {
    let [a, b, c, d] = corners;
    move |[s, t]| {
        // Exact at both ends, so that sides with the same ends get the same nodes.
        let between = |p: f64, q: f64, w: f64| p * (1.0 - w) + q * w;
        [0, 1].map(|i| between(between(a[i], b[i], s), between(d[i], c[i], s), t))
    }
}

/// A square within its mesh.
struct Placed {
    unit: UnitSquare,
    points: Vec<[f64; 2]>,
    first: usize,
}

/// Meshes the squares with cells of `kind`, each divided into four `refine` times.
///
/// # Errors
/// A refinement that is too large.
pub(super) fn mesh(squares: &[Square], refine: u32, kind: ElementKind) -> Result<Mesh, InputError> {
    if kind.dim() != 2 {
        return Err(InputError::new(format!(
            "a {} doesn't lie in the plane of this scene; expected triangles or quadrilaterals",
            kind.name()
        )));
    }
    let coarsest: usize = squares.iter().map(|p| p.pattern.triangles()).sum();
    let cells = 4_usize
        .checked_pow(refine)
        .and_then(|n| n.checked_mul(coarsest));
    if cells.is_none_or(|cells| cells > MOST_CELLS) {
        return Err(InputError::new(format!(
            "refined {refine} times the mesh has more than {MOST_CELLS} cells; expected a smaller \
             number"
        )));
    }
    let placed = place(squares, refine, kind);
    let node = glue(squares, &placed);

    let mut mesh = Mesh {
        dim: 2,
        ..Mesh::default()
    };
    let mut number = vec![u32::MAX; node.len()];
    for (square, placed) in squares.iter().zip(&placed) {
        for (local, point) in placed.points.iter().enumerate() {
            let glued = node[placed.first + local];
            if number[glued] == u32::MAX {
                number[glued] = mesh.points.len() as u32;
                mesh.points.push([point[0], point[1], 0.0]);
            }
        }
        let number = |local: u32| number[node[placed.first + local as usize]];
        for (kind, nodes) in placed.unit.cells.iter() {
            let cell = mesh.cells.len() as u32;
            group(&mut mesh, &square.body, 2).members.push(cell);
            let nodes: Vec<u32> = nodes.iter().map(|&node| number(node)).collect();
            mesh.cells.push(kind, &nodes);
        }
        for (side, name) in placed.unit.sides.iter().zip(&square.sides) {
            let Some(name) = name else { continue };
            let (facet, segments) = match kind.is_linear() {
                true => (ElementKind::Line2, 1),
                false => (ElementKind::Line3, 2),
            };
            for along in side.windows(segments + 1).step_by(segments) {
                let number_of = mesh.facets.len() as u32;
                group(&mut mesh, name, 1).members.push(number_of);
                let order = facet.along().iter();
                let nodes: Vec<u32> = order.map(|&i| number(along[i])).collect();
                mesh.facets.push(facet, &nodes);
            }
        }
    }
    mesh.node_tags = (1..=mesh.points.len() as i64).collect();
    mesh.cell_tags = (1..=mesh.cells.len() as i64).collect();
    mesh.orient_cells()?;
    Ok(mesh)
}

/// The group with a name, created if missing.
pub(super) fn group<'a>(mesh: &'a mut Mesh, name: &str, dim: usize) -> &'a mut Group {
    let group = mesh.groups.entry(name.to_owned()).or_default();
    group.dim = dim;
    group
}

fn place(squares: &[Square], refine: u32, kind: ElementKind) -> Vec<Placed> {
    let mut first = 0;
    let mut placed = Vec::with_capacity(squares.len());
    for square in squares {
        let mut unit = UnitSquare::new(square.pattern, kind, &square.map);
        for _ in 0..refine {
            unit.refine();
        }
        if !kind.is_linear() {
            unit.raise(kind);
        }
        let mut points: Vec<[f64; 2]> = unit.points.iter().map(|&p| (square.map)(p)).collect();
        if !square.is_curved {
            straighten(&unit.cells, &mut points);
        }
        let count = points.len();
        placed.push(Placed {
            unit,
            points,
            first,
        });
        first += count;
    }
    placed
}

/// Moves the nodes on edges of quadratic cells to the middle of the edge, and those inside a cell to its centre.
fn straighten(cells: &Elements, points: &mut [[f64; 2]]) {
    for (kind, nodes) in cells.iter().filter(|(kind, _)| !kind.is_linear()) {
        let (corners, others) = nodes.split_at(kind.corners());
        let mean = |of: &[u32]| {
            let sum = |axis: usize| of.iter().map(|&n| points[n as usize][axis]).sum::<f64>();
            [0, 1].map(|axis| sum(axis) / of.len() as f64)
        };
        let next = corners.iter().cycle().skip(1);
        let edges = corners.iter().zip(next).map(|(&a, &b)| mean(&[a, b]));
        let places: Vec<[f64; 2]> = edges.chain([mean(corners)]).collect();
        for (&node, place) in others.iter().zip(places) {
            points[node as usize] = place;
        }
    }
}

/// The first node that every node of every square is glued to.
fn glue(squares: &[Square], placed: &[Placed]) -> Vec<usize> {
    let count = placed.iter().map(|p| p.points.len()).sum();
    let mut parent: Vec<usize> = (0..count).collect();
    let size = placed.iter().flat_map(|p| &p.points).flatten();
    let size = size.fold(0.0_f64, |size, x| size.max(x.abs()));
    let same = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) < SAME * size;

    let mut open: Vec<(Vec<usize>, [[f64; 2]; 2])> = Vec::new();
    for (square, placed) in squares.iter().zip(placed) {
        for (side, name) in placed.unit.sides.iter().zip(&square.sides) {
            if name.is_some() {
                continue;
            }
            let mut nodes: Vec<usize> = side.iter().map(|&n| placed.first + n as usize).collect();
            let ends = [side[0], side[side.len() - 1]].map(|n| placed.points[n as usize]);
            let partner = open.iter().position(|(other, [a, b])| {
                other.len() == nodes.len()
                    && (same(*a, ends[0]) && same(*b, ends[1])
                        || same(*a, ends[1]) && same(*b, ends[0]))
            });
            let Some(partner) = partner else {
                open.push((nodes, ends));
                continue;
            };
            let (other, [a, _]) = open.swap_remove(partner);
            if !same(a, ends[0]) {
                nodes.reverse();
            }
            for (a, b) in other.into_iter().zip(nodes) {
                let (a, b) = (root(&parent, a), root(&parent, b));
                parent[a.max(b)] = a.min(b);
            }
        }
    }
    (0..count).map(|node| root(&parent, node)).collect()
}

/// The representative of the nodes that a node is glued to.
pub(super) fn root(parent: &[usize], mut node: usize) -> usize {
    while parent[node] != node {
        node = parent[node];
    }
    node
}
