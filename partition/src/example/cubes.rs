//! Meshes of mapped unit cubes.

use std::collections::HashMap;

use super::squares::{MOST_CELLS, SAME, group, root};
use crate::element::ElementKind;
use crate::element::definition::Domain;
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;

/// The image of the unit cube, a piece of one body.
pub(super) struct Cube {
    /// Group of its cells.
    body: String,
    /// Position of a point of the unit cube (m).
    map: Map,
    /// Number of cells along each axis before refinement.
    cells: [usize; 3],
    /// True if edges of quadratic cells follow the map; otherwise they are straight, with the node in the middle.
    is_curved: bool,
    /// Groups of the faces at the start and the end of each axis. A face without a group is glued to the face without a
    /// group that has the same corners; a face with a group, such as that of a contact, never is. For tetrahedra the
    /// axes of both faces have to have the same directions.
    sides: [[Option<String>; 2]; 3],
}

/// Position of a point of the unit cube (m).
type Map = Box<dyn Fn([f64; 3]) -> [f64; 3]>;

/// A grid point of a cube, in halves of cells.
type Place = [usize; 3];

/// A face: its axis, and true at the end of the axis.
type Face = (usize, usize);

/// The coordinate at a fraction of the cells between grid lines.
pub(super) fn along(lines: &[f64], part: f64) -> f64 {
    let place = part * (lines.len() - 1) as f64;
    let cell = (place as usize).min(lines.len() - 2);
    let rest = place - cell as f64;
    lines[cell] * (1.0 - rest) + lines[cell + 1] * rest
}

impl Cube {
    /// A cube whose cells have straight edges, with the groups of its faces.
    pub(super) fn new(
        body: &str,
        cells: [usize; 3],
        map: impl Fn([f64; 3]) -> [f64; 3] + 'static,
        sides: [[Option<&str>; 2]; 3],
    ) -> Self {
        Self {
            body: body.to_owned(),
            map: Box::new(map),
            cells,
            is_curved: false,
            sides: sides.map(|pair| pair.map(|name| name.map(str::to_owned))),
        }
    }

    /// The same cube with edges of quadratic cells that follow the map.
    pub(super) fn curved(self) -> Self {
        Self {
            is_curved: true,
            ..self
        }
    }

    /// The position of the node at a grid point of the cube with this number of cells.
    fn point(&self, place: Place, cells: [usize; 3], kind: ElementKind) -> [f64; 3] {
        let at = |place: Place| {
            (self.map)([0, 1, 2].map(|axis| place[axis] as f64 / (2 * cells[axis]) as f64))
        };
        if self.is_curved {
            return at(place);
        }
        let between: Vec<usize> = (0..3).filter(|&axis| place[axis] % 2 == 1).collect();
        let corners: Vec<Place> = match kind.domain() {
            // Edges of tetrahedra ascend along all axes.
            Domain::Tetrahedron => {
                let end = |towards: usize| {
                    [0, 1, 2].map(|axis| place[axis] + towards * (place[axis] % 2))
                };
                let start = [0, 1, 2].map(|axis| place[axis] - place[axis] % 2);
                vec![start, end(1)]
            }
            _ => (0..1 << between.len())
                .map(|choice: usize| {
                    let mut corner = place;
                    for (bit, &axis) in between.iter().enumerate() {
                        corner[axis] = corner[axis] + 2 * (choice >> bit & 1) - 1;
                    }
                    corner
                })
                .collect(),
        };
        let part = 1.0 / corners.len() as f64;
        let sum = |sum: [f64; 3], x: [f64; 3]| [0, 1, 2].map(|k| sum[k] + part * x[k]);
        corners.into_iter().map(at).fold([0.0; 3], sum)
    }
}

/// A cube within its mesh.
struct Placed {
    cells: [usize; 3],
    /// The grid points of its nodes, and their numbers among the nodes of all cubes.
    nodes: HashMap<Place, usize>,
    /// The nodes of its cells.
    elements: Vec<Vec<Place>>,
}

/// Checks that the cubes can be meshed.
///
/// # Errors
/// A refinement that is too large, cells of the plane.
fn check(cubes: &[Cube], refine: u32, kind: ElementKind) -> Result<(), InputError> {
    if kind.dim() != 3 {
        return Err(InputError::new(format!(
            "a {} doesn't fill the space of this scene; expected tetrahedra or hexahedra",
            kind.name()
        )));
    }
    let coarsest: usize = cubes
        .iter()
        .map(|cube| 6 * cube.cells.iter().product::<usize>())
        .sum();
    let cells = 8_usize
        .checked_pow(refine)
        .and_then(|n| n.checked_mul(coarsest));
    if cells.is_none_or(|cells| cells > MOST_CELLS) {
        return Err(InputError::new(format!(
            "refined {refine} times the mesh has more than {MOST_CELLS} cells; expected a smaller number"
        )));
    }
    Ok(())
}

/// Meshes the cubes with cells of `kind`, each divided into eight `refine` times.
///
/// # Errors
/// A refinement that is too large, cells of the plane.
pub(super) fn mesh(cubes: &[Cube], refine: u32, kind: ElementKind) -> Result<Mesh, InputError> {
    check(cubes, refine, kind)?;
    let mut points = Vec::new();
    let placed: Vec<Placed> = (cubes.iter())
        .map(|cube| place(cube, refine, kind, &mut points))
        .collect();
    let node = glue(cubes, &placed, &points, kind);

    let mut mesh = Mesh {
        dim: 3,
        ..Mesh::default()
    };
    let mut number = vec![u32::MAX; points.len()];
    for (own, point) in points.iter().enumerate() {
        if node[own] == own {
            number[own] = mesh.points.len() as u32;
            mesh.points.push(*point);
        }
    }
    let mut sides: Vec<(&str, ElementKind, Vec<u32>)> = Vec::new();
    for (cube, placed) in cubes.iter().zip(&placed) {
        let number = |place: &Place| number[node[placed.nodes[place]]];
        for element in &placed.elements {
            let cell = mesh.cells.len() as u32;
            group(&mut mesh, &cube.body, 3).members.push(cell);
            let nodes: Vec<u32> = element.iter().map(number).collect();
            mesh.cells.push(kind, &nodes);
            for (face, name) in named(cube) {
                for (kind, local) in kind.facets() {
                    let at: Vec<Place> = local.iter().map(|&node| element[node]).collect();
                    if at.iter().all(|&place| is_on(place, face, placed.cells)) {
                        sides.push((name, *kind, at.iter().map(number).collect()));
                    }
                }
            }
        }
    }
    mesh.node_tags = (1..=mesh.points.len() as i64).collect();
    mesh.cell_tags = (1..=mesh.cells.len() as i64).collect();
    mesh.orient_cells()?;
    let topology = Topology::new(&mesh);
    for (name, kind, nodes) in sides {
        // A triangle in the corner of a crack's tip has nodes of the tip only, and isn't part of the crack.
        if topology.cells_at(&nodes).len() == 1 {
            let facet = mesh.facets.len() as u32;
            group(&mut mesh, name, 2).members.push(facet);
            mesh.facets.push(kind, &nodes);
        }
    }
    Ok(mesh)
}

/// The faces with a group.
fn named(cube: &Cube) -> impl Iterator<Item = (Face, &str)> {
    let faces = cube.sides.iter().enumerate();
    faces.flat_map(|(axis, pair)| {
        let ends = pair.iter().enumerate();
        ends.filter_map(move |(end, name)| Some(((axis, end), name.as_deref()?)))
    })
}

/// True if a grid point is on a face.
fn is_on(place: Place, (axis, end): Face, cells: [usize; 3]) -> bool {
    place[axis] == end * 2 * cells[axis]
}

/// Fills a cube with cells and appends its nodes to `points`.
fn place(cube: &Cube, refine: u32, kind: ElementKind, points: &mut Vec<[f64; 3]>) -> Placed {
    let cells = cube.cells.map(|count| count << refine);
    let mut elements = Vec::new();
    for i in 0..cells[0] {
        for j in 0..cells[1] {
            for k in 0..cells[2] {
                elements.extend(elements_of([2 * i, 2 * j, 2 * k], kind));
            }
        }
    }
    let mut nodes = HashMap::new();
    for place in elements.iter().flatten() {
        nodes.entry(*place).or_insert_with(|| {
            points.push(cube.point(*place, cells, kind));
            points.len() - 1
        });
    }
    Placed {
        cells,
        nodes,
        elements,
    }
}

/// The cells that fill the one at `start`: a single one, or six tetrahedra around its diagonal.
fn elements_of(start: Place, kind: ElementKind) -> Vec<Vec<Place>> {
    let nodes = kind.node_coordinates().iter();
    // Reference coordinates are −1, 0, 1, or the barycentric fractions 0, ½, 1 of three corners.
    if kind.domain() == Domain::Cube {
        let place = |xi: &[f64; 3]| [0, 1, 2].map(|axis| start[axis] + (xi[axis] + 1.0) as usize);
        return vec![nodes.map(place).collect()];
    }
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let tetrahedron = |order: [usize; 3]| {
        let place = |xi: &[f64; 3]| {
            let mut place = start;
            for (step, &axis) in order.iter().enumerate() {
                // All later corners of the path include this step.
                place[axis] += (2.0 * xi[step..].iter().sum::<f64>()) as usize;
            }
            place
        };
        nodes.clone().map(place).collect()
    };
    orders.map(tetrahedron).into()
}

/// The first node that every node of every cube is glued to.
fn glue(cubes: &[Cube], placed: &[Placed], points: &[[f64; 3]], kind: ElementKind) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..points.len()).collect();
    let size = points
        .iter()
        .flatten()
        .fold(0.0_f64, |size, x| size.max(x.abs()));
    let key = |node: usize| points[node].map(|x| (x / (SAME * size)).round() as i64);
    let mut open: HashMap<[[i64; 3]; 4], HashMap<[i64; 3], usize>> = HashMap::new();
    for (cube, placed) in cubes.iter().zip(placed) {
        let all = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
        for face in all.filter(|&(axis, end)| cube.sides[axis][end].is_none()) {
            let on_face = |(place, _): &(&Place, &usize)| is_on(**place, face, placed.cells);
            let nodes = placed.nodes.iter().filter(on_face);
            let is_corner = |place: &Place| {
                (0..3).all(|axis| place[axis] == 0 || place[axis] == 2 * placed.cells[axis])
            };
            let mut corners = [[0; 3]; 4];
            let at_corners = nodes.clone().filter(|(place, _)| is_corner(place));
            for (corner, (_, &node)) in corners.iter_mut().zip(at_corners) {
                *corner = key(node);
            }
            corners.sort_unstable();
            let nodes = nodes.map(|(_, &node)| (key(node), node)).collect();
            let Some(others) = open.remove(&corners) else {
                open.insert(corners, nodes);
                continue;
            };
            for (key, node) in nodes {
                if let Some(&other) = others.get(&key) {
                    let (a, b) = (root(&parent, node), root(&parent, other));
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
    }
    if kind == ElementKind::Tetrahedron10 {
        close_edges(placed, &mut parent, kind);
    }
    (0..points.len()).map(|node| root(&parent, node)).collect()
}

/// Glues the middle nodes of edges whose ends are glued: those across the corner of a crack's tip.
fn close_edges(placed: &[Placed], parent: &mut [usize], kind: ElementKind) {
    let mut known: HashMap<[usize; 2], usize> = HashMap::new();
    for placed in placed {
        for element in &placed.elements {
            for (face, local) in kind.facets() {
                for (_, edge) in face.facets() {
                    let [p, q, middle] =
                        [0, 1, 2].map(|i| root(parent, placed.nodes[&element[local[edge[i]]]]));
                    let other = *known.entry([p.min(q), p.max(q)]).or_insert(middle);
                    let (a, b) = (root(parent, other), middle);
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
    }
}
