//! A uniform pressure is transferred exactly.

use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, moved};
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::sorts::{SORTS, Sort, sort};
use crate::support::uneven::{PRESSURE, block, materials, turned_pressure, two_sorts};

/// Blocks on top of each other, from below.
struct Pile {
    names: Vec<&'static str>,
    x: Vec<[f64; 2]>,
    blocks: Blocks,
    text: String,
}

impl Pile {
    /// Blocks 1 m high with n cells along x. Each is held at its left end, the lowest at its bottom, and the uppermost
    /// is under pressure. With `upside_down` the lower side is side a.
    fn new(x: &[[f64; 2]], n: &[usize], upside_down: bool) -> Self {
        let names: Vec<&str> = ["zero", "one", "two", "three"][..x.len()].to_vec();
        let mut text = materials(&names) + "[[bilateral]]\non = 'zero bottom'\n";
        let mut blocks = Blocks::new();
        for (i, name) in names.iter().enumerate() {
            let y = [i as f64, i as f64 + 1.0];
            blocks = block(
                blocks,
                name,
                x[i],
                y,
                [n[i], 3],
                17 * i as u64 + n[i] as u64,
            );
            text += &format!("[[bilateral]]\non = '{name} left'\n");
            if i > 0 {
                let (upper, lower) = (format!("{name} bottom"), format!("{} top", names[i - 1]));
                let [a, b] = if upside_down {
                    [lower, upper]
                } else {
                    [upper, lower]
                };
                text += &format!("[[contact]]\nname = 'joint {i}'\nsides = ['{a}', '{b}']\n");
                // Round-off of coordinates isn't much smaller than the displacements.
                text += "gap = 0.0\n";
            }
        }
        let last = names[names.len() - 1];
        text += &format!("[[pressure]]\non = '{last} top'\nvalue = {PRESSURE}\n");
        Self {
            names,
            x: x.to_vec(),
            blocks,
            text,
        }
    }

    /// The pile rotated by an angle, under pressure wherever its surface is uncovered.
    fn model(&self, angle: f64) -> Model {
        let (sin, cos) = angle.sin_cos();
        let mesh = moved(self.blocks.mesh.clone(), |[x, y]| {
            [cos * x - sin * y, sin * x + cos * y]
        });
        let mut model = model(&self.text, mesh);
        let mut forces = vec![[0.0; 2]; model.mesh.points.len()];
        for &(node, [x, y, _]) in &model.forces {
            forces[node as usize] = [x, y];
        }
        for i in 1..self.names.len() {
            let (below, above) = (self.x[i - 1], self.x[i]);
            for (side, own, other, down) in [
                (format!("{} top", self.names[i - 1]), below, above, -1.0),
                (format!("{} bottom", self.names[i]), above, below, 1.0),
            ] {
                for free in [[own[0], other[0]], [other[1], own[1]]] {
                    for (node, length) in self.integrals(&side, free) {
                        let force = down * PRESSURE * length;
                        let at = &mut forces[node as usize];
                        *at = [at[0] - sin * force, at[1] + cos * force];
                    }
                }
            }
        }
        model.forces = (0_u32..)
            .zip(forces)
            .filter(|(_, f)| *f != [0.0; 2])
            .map(|(node, [x, y])| (node, [x, y, 0.0]))
            .collect();
        model
    }

    /// ∫ N over part of a side, for every node and facet.
    fn integrals(&self, side: &str, part: [f64; 2]) -> Vec<(u32, f64)> {
        let mesh = &self.blocks.mesh;
        let mut list = Vec::new();
        for &facet in &mesh.groups[side].members {
            let nodes = mesh.facets.nodes_of(facet as usize);
            for (own, other) in [(nodes[0], nodes[1]), (nodes[1], nodes[0])] {
                let [p, q] = [own, other].map(|n| mesh.points[n as usize][0]);
                let (from, to) = (p.min(q).max(part[0]), p.max(q).min(part[1]));
                if to > from {
                    list.push((own, (to - from) * (q - 0.5 * (from + to)) / (q - p)));
                }
            }
        }
        list
    }
}

/// Fails unless the pressure is uniform and all contacts are closed, to within 1e-10.
#[track_caller]
fn is_uniform(solution: &Solution, angle: f64) {
    let [xx, yy, xy] = turned_pressure(angle);
    for (centre, [s_xx, s_yy, _, s_xy, _, _]) in &solution.cells {
        for (found, expected) in [(s_xx, xx), (s_yy, yy), (s_xy, xy)] {
            let error = (found - expected).abs() / PRESSURE;
            assert!(error < 1e-10, "{error:e} at {centre:?}");
        }
    }
    solution.check_pressure(PRESSURE, 1e-10 * PRESSURE);
}

/// Extents of stacked blocks along x, numbers of cells, angles, and numbers of subdomains.
type Patch = (Vec<[f64; 2]>, Vec<usize>, Vec<f64>, Vec<usize>);

/// Sides that end together with meshes of any size, sides with partial overlap, three blocks in any position.
fn patches() -> Vec<Patch> {
    let two = |lower, upper, n: [usize; 2]| (vec![lower, upper], n.to_vec(), vec![0.0], vec![2]);
    let whole = [[4, 7], [9, 2], [5, 5], [1, 6], [3, 40], [40, 3]];
    let mut patches: Vec<Patch> = (whole.map(|n| two([0.0, 2.0], [0.0, 2.0], n))).to_vec();
    patches.extend([
        two([0.0, 3.0], [0.7, 2.1], [8, 5]),
        two([0.0, 3.0], [0.7, 2.1], [3, 11]),
        two([0.0, 2.0], [1.1, 3.3], [6, 5]),
        two([0.0, 2.0], [0.0, 1.001], [4, 3]),
        two([0.0, 2.0], [0.0, 1.0 + 1e-9], [4, 3]),
        two([0.0, 2.0], [0.9, 1.2], [2, 3]),
        two([0.0, 1.3], [-0.4, 2.0], [5, 2]),
    ]);
    for n in [[3, 8, 5], [8, 3, 10]] {
        let x = vec![[0.0, 2.0], [0.3, 1.9], [-0.2, 1.5]];
        patches.push((x, n.to_vec(), vec![0.0, 0.4, 2.0], vec![3, 7]));
    }
    patches
}

#[test]
fn a_uniform_pressure_passes_between_blocks_however_they_lie_on_each_other() {
    for (x, n, angles, counts) in patches() {
        for upside_down in [false, true] {
            let pile = Pile::new(&x, &n, upside_down);
            for &angle in &angles {
                let model = pile.model(angle);
                for &count in &counts {
                    let solution = solve(&model, count);
                    is_uniform(&solution, angle);
                    assert!(solution.points().all(|point| point.tags[1] == -1));
                }
            }
        }
    }
}

/// A plate with a crack along y = 0 from tip to tip, with n[0] facets on its lower and n[1] on its upper side.
fn cracked_plate(n: [usize; 2], text: &str, cells: Sort) -> Model {
    let mut blocks = Blocks::new();
    for (column, x, cells) in [
        ("left", [-3.0, -1.0], [4, 4]),
        ("middle", [-1.0, 1.0], n),
        ("right", [1.0, 3.0], [4, 4]),
    ] {
        for (half, y, cells) in [
            ("below", [-2.0, 0.0], cells[0]),
            ("above", [0.0, 2.0], cells[1]),
        ] {
            let name = format!("{column} {half}");
            blocks = block(blocks, &name, x, y, [cells, 4], cells as u64);
        }
    }
    let mesh = blocks.glued(|x, y| y != 0.0 || x.abs() > 1.0 - 1e-9).mesh;
    let columns = ["left", "middle", "right"];
    let list = |side: &str| columns.map(|c| format!("'{c} {side}'")).join(", ");
    let bodies = columns.map(|c| {
        format!("bodies.'{c} below'.material = 'm0'\nbodies.'{c} above'.material = 'm0'\n")
    });
    let text = format!(
        "plane = 'strain'
        materials.m0 = {{young = 210e9, poisson = 0.3}}
        {}
        [[bilateral]]
        on = [{}]
        [[bilateral]]
        on = ['left below left', 'left above left']
        [[pressure]]
        on = [{}]
        value = {PRESSURE}
        {text}",
        bodies.concat(),
        list("below bottom"),
        list("above top")
    );
    model(&text, cells.of(&mesh))
}

#[test]
fn a_uniform_pressure_passes_across_a_crack_whose_tips_are_shared() {
    let of_sizes = [[4, 7], [7, 4], [2, 9], [6, 6]].map(|n| (n, sort("triangle3"), vec![1, 2, 5]));
    let of_sorts = SORTS.map(|sort| ([4, 7], sort, vec![5]));
    for (n, cells, counts) in of_sizes.into_iter().chain(of_sorts) {
        for sides in [
            "'middle above bottom', 'middle below top'",
            "'middle below top', 'middle above bottom'",
        ] {
            let text = format!("[[contact]]\nname = 'crack'\nsides = [{sides}]\n");
            let model = cracked_plate(n, &text, cells);
            for &count in &counts {
                is_uniform(&solve(&model, count), 0.0);
            }
        }
    }
}

#[test]
fn a_uniform_pressure_passes_between_cells_of_any_kinds() {
    for (i, lower) in SORTS.into_iter().enumerate() {
        for (step, n, angle) in [(0, [3, 7], 0.0), (1, [7, 3], 0.4), (3, [5, 5], 2.0)] {
            let upper = SORTS[(i + step) % SORTS.len()];
            for upside_down in [false, true] {
                let model = two_sorts([lower, upper], n, 3, angle, upside_down);
                is_uniform(&solve(&model, 5), angle);
            }
        }
    }
}

/// The user's partition cuts through the contact: all subdomains around it form one group.
#[test]
fn a_uniform_pressure_passes_where_a_cut_meets_the_contact() {
    let blocks = block(Blocks::new(), "west", [0.0, 1.0], [0.0, 1.0], [3, 3], 5);
    let blocks = block(blocks, "east", [1.0, 2.0], [0.0, 1.0], [4, 3], 6);
    let blocks = block(blocks, "one", [0.0, 2.0], [1.0, 2.0], [4, 3], 7);
    let mesh = blocks.glued(|x, y| x == 1.0 && y <= 1.0).mesh;
    let (upper, lower) = ("['one bottom']", "['west top', 'east top']");
    for sides in [format!("{upper}, {lower}"), format!("{lower}, {upper}")] {
        let text = format!(
            "subdomains = ['west', 'east', 'one']
            plane = 'strain'
            materials.m = {{young = 20e9, poisson = 0.3}}
            bodies.west.material = 'm'
            bodies.east.material = 'm'
            bodies.one.material = 'm'
            [[bilateral]]
            on = ['west bottom', 'east bottom']
            [[bilateral]]
            on = ['west left', 'one left']
            [[pressure]]
            on = 'one top'
            value = {PRESSURE}
            [[contact]]
            name = 'joint'
            sides = [{sides}]"
        );
        is_uniform(&solve(&model(&text, mesh.clone()), 3), 0.0);
    }
}
