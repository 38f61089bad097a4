//! Meshes of other cells, made from linear triangles.

use std::collections::HashMap;

use contact_dd_partition::element::ElementKind::{
    self, Line3, Quad4, Quad8, Quad9, Triangle3, Triangle6,
};
use contact_dd_partition::element::Elements;
use contact_dd_partition::mesh::Mesh;

/// A kind of cells into which those of a mesh are converted.
#[derive(Clone, Copy, Debug)]
pub struct Sort {
    pub name: &'static str,
    /// The kind of quadrilateral made of a pair of triangles, by the pair's number; `None` keeps the triangles.
    quadrilateral: fn(usize) -> Option<ElementKind>,
    pub is_quadratic: bool,
}

/// Every kind of cells alone, and the mixtures.
pub const SORTS: [Sort; 7] = [
    Sort {
        name: "triangle3",
        quadrilateral: |_| None,
        is_quadratic: false,
    },
    Sort {
        name: "quad4",
        quadrilateral: |_| Some(Quad4),
        is_quadratic: false,
    },
    Sort {
        name: "triangle3 and quad4",
        quadrilateral: |pair| (pair % 2 == 0).then_some(Quad4),
        is_quadratic: false,
    },
    Sort {
        name: "triangle6",
        quadrilateral: |_| None,
        is_quadratic: true,
    },
    Sort {
        name: "quad8",
        quadrilateral: |_| Some(Quad8),
        is_quadratic: true,
    },
    Sort {
        name: "quad9",
        quadrilateral: |_| Some(Quad9),
        is_quadratic: true,
    },
    Sort {
        name: "triangle6, quad8 and quad9",
        quadrilateral: |pair| [None, Some(Quad8), Some(Quad9)][pair % 3],
        is_quadratic: true,
    },
];

/// The sort with a name.
pub fn sort(name: &str) -> Sort {
    *SORTS.iter().find(|sort| sort.name == name).unwrap()
}

impl Sort {
    /// A mesh of [`super::blocks::Blocks`], of pairs of linear triangles, in cells of this sort, with straight edges.
    pub fn of(self, mesh: &Mesh) -> Mesh {
        let paired = self.paired(mesh);
        if self.is_quadratic {
            self.raised(paired)
        } else {
            paired
        }
    }

    /// The mesh with pairs of triangles joined to linear quadrilaterals.
    fn paired(self, mesh: &Mesh) -> Mesh {
        let mut cells = Elements::default();
        let mut first_of_pair = Vec::new();
        for pair in 0..mesh.cells.len() / 2 {
            first_of_pair.push(cells.len() as u32);
            let halves = [0, 1].map(|half| mesh.cells.nodes_of(2 * pair + half));
            if (self.quadrilateral)(pair).is_none() {
                halves.iter().for_each(|half| cells.push(Triangle3, half));
                continue;
            }
            // The corner of a triangle that the other one misses lies between the two shared ones.
            let misses = |half: &[u32], node: &u32| !half.contains(node);
            let own = halves[0].iter().position(|n| misses(halves[1], n)).unwrap();
            let mut corners = halves[0].to_vec();
            corners.rotate_left(own);
            let other = halves[1].iter().find(|n| misses(halves[0], n)).unwrap();
            corners.insert(2, *other);
            cells.push(Quad4, &corners);
        }
        first_of_pair.push(cells.len() as u32);
        let mut paired = mesh.clone();
        paired.cell_tags = (1..=cells.len() as i64).collect();
        paired.cells = cells;
        for group in paired.groups.values_mut().filter(|group| group.dim == 2) {
            let pairs = group.members.iter().filter(|&&cell| cell % 2 == 0);
            let of_pair = |cell: &u32| {
                let pair = *cell as usize / 2;
                first_of_pair[pair]..first_of_pair[pair + 1]
            };
            group.members = pairs.flat_map(of_pair).collect();
        }
        paired
    }

    /// The mesh with a node at the middle of every edge, and in the middle of quadrilaterals with nine nodes.
    fn raised(self, mesh: Mesh) -> Mesh {
        let mut raised = Mesh {
            cells: Elements::default(),
            facets: Elements::default(),
            ..mesh.clone()
        };
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut quadrilaterals = (0..).map(self.quadrilateral);
        let mut is_second = false;
        for (kind, corners) in mesh.cells.iter() {
            let kind = if kind == Triangle3 {
                // Two triangles are one pair.
                if !is_second {
                    quadrilaterals.next();
                }
                is_second = !is_second;
                Triangle6
            } else {
                quadrilaterals.next().flatten().unwrap()
            };
            let mut nodes = corners.to_vec();
            for i in 0..corners.len() {
                let ends = [corners[i], corners[(i + 1) % corners.len()]];
                nodes.push(middle(&mut raised, &mut middles, ends));
            }
            if kind == Quad9 {
                let at = corners.iter().map(|&n| mesh.points[n as usize]);
                let centre = at.fold([0.0; 3], |sum, p| [0, 1, 2].map(|i| sum[i] + 0.25 * p[i]));
                nodes.push(node(&mut raised, centre));
            }
            raised.cells.push(kind, &nodes);
        }
        for (_, ends) in mesh.facets.iter() {
            let ends = [ends[0], ends[1]];
            let middle = middle(&mut raised, &mut middles, ends);
            raised.facets.push(Line3, &[ends[0], ends[1], middle]);
        }
        raised
    }
}

fn node(mesh: &mut Mesh, at: [f64; 3]) -> u32 {
    mesh.points.push(at);
    mesh.node_tags.push(mesh.points.len() as i64);
    mesh.points.len() as u32 - 1
}

/// The node at the middle of an edge.
fn middle(mesh: &mut Mesh, known: &mut HashMap<[u32; 2], u32>, [a, b]: [u32; 2]) -> u32 {
    *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
        let (p, q) = (mesh.points[a as usize], mesh.points[b as usize]);
        node(mesh, [0, 1, 2].map(|i| 0.5 * (p[i] + q[i])))
    })
}
