//! A plane mesh of quadrilaterals extruded into space.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::mesh::{Group, Mesh};

/// The nodes of a plane mesh at the levels of an extruded one, created on demand.
struct Levels<'a> {
    plane: &'a Mesh,
    heights: Vec<f64>,
    number: Vec<Option<u32>>,
    points: Vec<[f64; 3]>,
}

impl Levels<'_> {
    /// Node `node` of the plane mesh at a level.
    fn at(&mut self, level: usize, node: u32) -> u32 {
        let place = &mut self.number[level * self.plane.points.len() + node as usize];
        *place.get_or_insert_with(|| {
            let [x, y, _] = self.plane.points[node as usize];
            self.points.push([x, y, self.heights[level]]);
            self.points.len() as u32 - 1
        })
    }

    /// Nodes of the plane mesh, given as `places` in `nodes`, at a level.
    fn pick(&mut self, level: usize, nodes: &[u32], places: &[usize]) -> Vec<u32> {
        places.iter().map(|&i| self.at(level, nodes[i])).collect()
    }
}

/// The mesh with a layer of hexahedra between consecutive `heights` (m, ascending): of 8, 20 and 27 nodes over
/// quadrilaterals of 4, 8 and 9. Groups of cells and facets keep their names; the ends of a group of cells are `NAME
/// back` and `NAME front`. `None` if there are other cells, or different ones.
pub fn extruded(plane: &Mesh, heights: &[f64]) -> Option<Mesh> {
    let kind = plane.cells.iter().next()?.0;
    let (solid, side) = match kind {
        ElementKind::Quad4 => (ElementKind::Hexahedron8, ElementKind::Quad4),
        ElementKind::Quad8 => (ElementKind::Hexahedron20, ElementKind::Quad8),
        ElementKind::Quad9 => (ElementKind::Hexahedron27, ElementKind::Quad9),
        _ => return None,
    };
    if plane.cells.iter().any(|(other, _)| other != kind) {
        return None;
    }
    let step = if kind.is_linear() { 1 } else { 2 };
    let between = heights.windows(2).flat_map(|pair| match step {
        1 => vec![pair[0]],
        _ => vec![pair[0], 0.5 * (pair[0] + pair[1])],
    });
    let mut levels = Levels {
        plane,
        heights: between.chain(heights.last().copied()).collect(),
        number: vec![None; (step * heights.len()) * plane.points.len()],
        points: Vec::new(),
    };
    let layers = heights.len().saturating_sub(1);
    let mut mesh = Mesh {
        dim: 3,
        ..Mesh::default()
    };
    for layer in 0..layers {
        let (low, high) = (step * layer, step * (layer + 1));
        for (_, nodes) in plane.cells.iter() {
            let mut all = levels.pick(low, nodes, &[0, 1, 2, 3]);
            all.extend(levels.pick(high, nodes, &[0, 1, 2, 3]));
            if step == 2 {
                all.extend(levels.pick(low, nodes, &[4, 5, 6, 7]));
                all.extend(levels.pick(high, nodes, &[4, 5, 6, 7]));
                all.extend(levels.pick(low + 1, nodes, &[0, 1, 2, 3]));
            }
            if kind == ElementKind::Quad9 {
                all.extend(levels.pick(low + 1, nodes, &[7, 5, 4, 6]));
                all.extend([low, high, low + 1].map(|level| levels.at(level, nodes[8])));
            }
            mesh.cells.push(solid, &all);
        }
        for (_, nodes) in plane.facets.iter() {
            let mut all = levels.pick(low, nodes, &[0, 1]);
            all.extend(levels.pick(high, nodes, &[1, 0]));
            if step == 2 {
                let places = [
                    (low, 2),
                    (low + 1, 1),
                    (high, 2),
                    (low + 1, 0),
                    (low + 1, 2),
                ];
                let kept = places.into_iter().take(side.nodes() - 4);
                all.extend(kept.map(|(level, i)| levels.at(level, nodes[i])));
            }
            mesh.facets.push(side, &all);
        }
    }
    let repeated = |members: &[u32], count: usize| {
        let layers = (0..layers as u32).map(|layer| layer * count as u32);
        layers
            .flat_map(|first| members.iter().map(move |m| first + m))
            .collect()
    };
    for (name, group) in &plane.groups {
        let count = match group.dim {
            2 => plane.cells.len(),
            1 => plane.facets.len(),
            _ => continue,
        };
        let members = repeated(&group.members, count);
        let dim = group.dim + 1;
        mesh.groups.insert(name.clone(), Group { dim, members });
        if group.dim == 2 {
            for (end, level) in [("back", 0), ("front", step * layers)] {
                let first = mesh.facets.len() as u32;
                for &cell in &group.members {
                    let nodes = plane.cells.nodes_of(cell as usize);
                    let nodes: Vec<u32> =
                        nodes.iter().map(|&node| levels.at(level, node)).collect();
                    mesh.facets.push(kind, &nodes);
                }
                let members = (first..mesh.facets.len() as u32).collect();
                mesh.groups
                    .insert(format!("{name} {end}"), Group { dim: 2, members });
            }
        }
    }
    mesh.points = levels.points;
    mesh.node_tags = (1..=mesh.points.len() as i64).collect();
    mesh.cell_tags = (1..=mesh.cells.len() as i64).collect();
    Some(mesh)
}
