//! Scenes in space: blocks on and next to each other, wedges, layers, and obstacles, upright or tilted.

pub mod friction;

use std::collections::HashSet;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::mesh::Mesh;

use super::super::blocks::joined;
use super::super::random::Random;
use super::super::solids::{SOLIDS, moved, solid, turned};
use super::draft::{Draft, noise};
use super::friction::Friction;
use super::trial::has_no_equilibrium;
use super::{Drawn, Family, drawn, matching};

/// Share of the scenes without equilibrium that are kept.
const KEPT: f64 = 0.2;

/// The families of scenes in space.
pub const FAMILIES: [Family; 6] = [
    matching("stack in space", stack),
    matching("packing in space", packing),
    matching("layers in space", layers),
    matching("wedge in space", wedge),
    matching("corner in space", corner),
    matching("indenter in space", indenter),
];

/// The scene of a seed, with blocks of at most `cells` linear cells per side, or half as many quadratic ones.
#[track_caller]
pub fn draw_in_space(seed: u64, cells: usize) -> Drawn {
    draw_from(&FAMILIES, seed, cells)
}

/// A scene with friction, with seeds numbered anew; most without equilibrium are drawn again until one is kept.
#[track_caller]
pub fn draw_frictional_in_space(seed: u64, cells: usize) -> Drawn {
    let mut random = Random::new(seed.rotate_left(32));
    let mut numbers = seed;
    loop {
        let drawn = draw_from(&friction::FAMILIES, numbers, cells);
        if random.chance(KEPT) || !has_no_equilibrium(&drawn) {
            return Drawn { seed, ..drawn };
        }
        // The next numbers give the same family.
        numbers += (friction::FAMILIES.len() as u64) << 32;
    }
}

#[track_caller]
fn draw_from(families: &[Family], seed: u64, cells: usize) -> Drawn {
    let family = families[(seed % families.len() as u64) as usize];
    let mut random = Random::new(seed);
    let kind = random.pick(&SOLIDS);
    let cells = match kind.is_linear() {
        true => cells.min(4),
        false => cells.min(4).div_ceil(2),
    };
    let mut draft = Draft::in_space(random, kind, cells);
    if family.frictional {
        draft.friction = Some(Friction::new(Random::new(!seed), draft.load));
    }
    (family.make)(&mut draft);
    let mut mesh = std::mem::take(&mut draft.blocks.mesh);
    if draft.tilted {
        mesh = moved(mesh, turned);
    }
    drawn(seed, family.name, kind.name(), draft, mesh)
}

impl Draft {
    /// Adds the image of the unit cube under `map`, its inner nodes moved a little, as a body with `force` per volume.
    fn solid(
        &mut self,
        name: &str,
        n: [usize; 3],
        force: [f64; 3],
        map: impl Fn([f64; 3]) -> [f64; 3],
    ) {
        let amount = self.random.pick(&[0.0, 0.05, 0.15]);
        let seed = self.random.below(1 << 20) as f64;
        let kind = self.kind;
        let mesh = solid(name, kind, n, |x| {
            let is_inner = x.iter().all(|c| (1e-9..1.0 - 1e-9).contains(c));
            let at = seed + 17.0 * x[0] + 3.0 * x[1] + 29.0 * x[2];
            let apart = if kind.is_linear() { 1.0 } else { 2.0 };
            let shift = |k: usize| amount / (apart * n[k] as f64) * noise(at + 7.0 * k as f64);
            map([0, 1, 2].map(|k| x[k] + if is_inner { shift(k) } else { 0.0 }))
        });
        let mesh = straightened(mesh);
        let before = std::mem::take(&mut self.blocks.mesh);
        self.blocks.mesh = match before.points.is_empty() {
            true => mesh,
            false => joined(before, mesh),
        };
        let force = self.turned(force);
        self.body(name, &[name], force);
    }

    /// Adds a box.
    fn cuboid(
        &mut self,
        name: &str,
        low: [f64; 3],
        high: [f64; 3],
        n: [usize; 3],
        force: [f64; 3],
    ) {
        let map = move |x: [f64; 3]| [0, 1, 2].map(|k| low[k] * (1.0 - x[k]) + high[k] * x[k]);
        self.solid(name, n, force, map);
    }

    fn turned(&self, v: [f64; 3]) -> [f64; 3] {
        if self.tilted { turned(v) } else { v }
    }

    fn counts(&mut self) -> [usize; 3] {
        [0; 3].map(|_| self.side_cells())
    }

    /// Cell counts of a block in contact with one of `n`.
    fn facing_counts(&mut self, n: [usize; 3]) -> [usize; 3] {
        match self.matching {
            true => n,
            false => self.counts(),
        }
    }

    fn hold_all(&mut self, on: &str) {
        self.add(&format!(
            "[[displacement]]\non = '{on}'\nx = 0\ny = 0\nz = 0\n"
        ));
    }

    /// Adds a wall through `point` for a side, which lies where `normal` points.
    fn wall(&mut self, side: &str, point: [f64; 3], normal: [f64; 3], gap: Option<&str>) {
        let [point, normal] = [point, normal].map(|v| self.turned(v));
        let obstacle = format!("{{point = {point:?}, normal = {normal:?}}}");
        self.obstacle(&[side.to_owned()], &obstacle, gap);
    }

    fn joint(&mut self, a: &str, b: &str, gap: Option<&str>) {
        self.contact(&[a.to_owned()], &[b.to_owned()], gap);
    }

    /// A gap along one of the axes, or no given one.
    fn some_gap(&mut self) -> Option<String> {
        let axis = self.random.pick(&["x", "y", "z"]);
        self.random.chance(0.5).then(|| self.drawn_gap(axis))
    }

    fn some_pressure(&mut self, on: &str) {
        let axis = self.random.pick(&["x", "y", "z"]);
        let pressure = self.drawn_pressure(axis, [0.0, 1.0]);
        self.pressure(on, &pressure);
        self.pressed.push(on.to_owned());
    }

    fn own_weight(&mut self, height: f64) -> [f64; 3] {
        [0.0, 0.0, self.weight(height)]
    }
}

/// The mesh with straight edges of quadratic tetrahedra, for which the judge's quadrature rule is exact, too.
fn straightened(mut mesh: Mesh) -> Mesh {
    let mut done = HashSet::new();
    for cell in 0..mesh.cells.len() {
        if mesh.cells.kind(cell) != ElementKind::Tetrahedron10 {
            continue;
        }
        let nodes = mesh.cells.nodes_of(cell).to_vec();
        for (place, [a, b]) in (4..).zip([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]) {
            if done.insert(nodes[place]) {
                let ends = [a, b].map(|i: usize| mesh.points[nodes[i] as usize]);
                mesh.points[nodes[place] as usize] =
                    [0, 1, 2].map(|k| 0.5 * (ends[0][k] + ends[1][k]));
            }
        }
    }
    mesh
}

/// Blocks on each other, the lowest held or on a wall.
fn stack(draft: &mut Draft) {
    let count = draft.random.count(2, 4);
    let mut n = draft.counts();
    let mut low = 0.0;
    for i in 0..count {
        let name = format!("b{i}");
        let height = draft.random.within(0.3, 1.0);
        n = draft.facing_counts(n);
        let [from, to] = match draft.matching {
            true => [[0.0; 2], [1.0; 2]],
            false => [0.2, 1.0].map(|at| [0; 2].map(|_: i32| at + draft.random.within(-0.2, 0.2))),
        };
        let force = draft.own_weight(height);
        let low_corner = [from[0], from[1], low];
        draft.cuboid(&name, low_corner, [to[0], to[1], low + height], n, force);
        let gap = draft.some_gap();
        match i {
            0 if draft.random.chance(0.5) => draft.hold_all("b0 z0"),
            0 => draft.wall("b0 z0", [0.0; 3], [0.0, 0.0, 1.0], gap.as_deref()),
            _ => draft.joint(
                &format!("b{} z1", i - 1),
                &format!("{name} z0"),
                gap.as_deref(),
            ),
        }
        low += height;
    }
    draft.some_pressure(&format!("b{} z1", count - 1));
    if draft.random.chance(0.1) {
        // Only friction, which is absent, could hold it.
        let push = draft
            .turned([draft.load, 0.0, -draft.load])
            .map(|c| format!("{c:e}"));
        draft.add(&format!(
            "[[traction]]\non = 'b{} z1'\nvalue = {push:?}\n",
            count - 1
        ));
    }
}

/// Two by two blocks in a corner, pressed from the right and from above.
fn packing(draft: &mut Draft) {
    let deep = draft.random.within(0.4, 1.0);
    let n = draft.counts();
    for (i, k) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let n = draft.facing_counts(n);
        let force = draft.own_weight(1.0);
        let low = [i as f64, 0.0, k as f64];
        let high = [low[0] + 1.0, deep, low[2] + 1.0];
        draft.cuboid(&format!("b{i}{k}"), low, high, n, force);
    }
    for k in 0..2 {
        let gap = draft.some_gap();
        draft.joint(&format!("b0{k} x1"), &format!("b1{k} x0"), gap.as_deref());
        let gap = draft.some_gap();
        draft.joint(&format!("b{k}0 z1"), &format!("b{k}1 z0"), gap.as_deref());
        draft.some_pressure(&format!("b1{k} x1"));
        draft.some_pressure(&format!("b{k}1 z1"));
        draft.roll(&format!("b0{k} x0"));
        draft.wall(&format!("b{k}0 z0"), [0.0; 3], [0.0, 0.0, 1.0], None);
        for i in 0..2 {
            draft.roll(&format!("b{i}{k} y0"));
        }
    }
}

/// Thin layers on each other.
fn layers(draft: &mut Draft) {
    let n = draft.counts();
    let count = draft.random.count(2, 4);
    let mut low = 0.0;
    for i in 0..=count {
        let height = if i % 2 == 0 {
            0.5
        } else {
            draft.random.magnitude(-3.0, -1.0)
        };
        let mut n = draft.facing_counts(n);
        n[2] = n[2].min(2);
        let force = draft.own_weight(height);
        draft.cuboid(
            &format!("b{i}"),
            [0.0, 0.0, low],
            [1.0, 1.0, low + height],
            n,
            force,
        );
        if i > 0 {
            let gap = draft.some_gap();
            draft.joint(
                &format!("b{} z1", i - 1),
                &format!("b{i} z0"),
                gap.as_deref(),
            );
        }
        low += height;
    }
    draft.hold_all("b0 z0");
    draft.some_pressure(&format!("b{count} z1"));
}

/// A wedge on an inclined face, against a wall or not.
fn wedge(draft: &mut Draft) {
    let [a, b] = [0; 2].map(|_: i32| draft.random.within(-0.3, 0.3));
    let joint = move |x: f64, y: f64| 0.8 + a * x + b * y;
    let n = draft.counts();
    draft.solid("b0", n, [0.0; 3], |[x, y, z]| [x, y, z * joint(x, y)]);
    let n = draft.facing_counts(n);
    let force = draft.own_weight(1.0);
    draft.solid("b1", n, force, |[x, y, z]| {
        [x, y, joint(x, y) * (1.0 - z) + 2.0 * z]
    });
    draft.hold_all("b0 z0");
    let gap = draft.some_gap();
    draft.joint("b0 z1", "b1 z0", gap.as_deref());
    draft.some_pressure("b1 z1");
    let walls = [("b1 x0", [1.0, 0.0, 0.0]), ("b1 y0", [0.0, 1.0, 0.0])];
    for (side, normal) in walls {
        match draft.random.below(3) {
            0 => draft.roll(side),
            1 => draft.wall(side, [0.0; 3], normal, None),
            _ => {}
        }
    }
}

/// A block pressed into a corner of three walls.
fn corner(draft: &mut Draft) {
    let n = draft.counts();
    let force = draft.own_weight(1.0);
    draft.cuboid("b", [0.0; 3], [1.0; 3], n, force);
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let mut normal = [0.0; 3];
        normal[axis] = 1.0;
        let gap = draft.some_gap();
        draft.wall(&format!("b {letter}0"), [0.0; 3], normal, gap.as_deref());
        if axis == 2 || draft.random.chance(0.7) {
            draft.some_pressure(&format!("b {letter}1"));
        }
    }
}

/// A ball or a bar pressed into a block on another one.
fn indenter(draft: &mut Draft) {
    let n = draft.counts();
    draft.cuboid("b0", [0.0; 3], [1.0, 1.0, 0.6], n, [0.0; 3]);
    let n = draft.facing_counts(n);
    draft.cuboid("b1", [0.0, 0.0, 0.6], [1.0, 1.0, 1.0], n, [0.0; 3]);
    draft.hold_all("b0 z0");
    let gap = draft.some_gap();
    draft.joint("b0 z1", "b1 z0", gap.as_deref());
    let radius = draft.random.within(0.5, 3.0);
    let deep = draft.compression() * draft.random.magnitude(-1.0, 1.0);
    let middle = [0; 2].map(|_: i32| draft.random.within(0.3, 0.7));
    let center = draft.turned([middle[0], middle[1], 1.0 + radius - deep]);
    let obstacle = match draft.random.chance(0.5) {
        true => format!("{{center = {center:?}, radius = {radius}}}"),
        false => {
            let axis = draft.turned([0.6, 0.8, 0.0]);
            format!("{{point = {center:?}, axis = {axis:?}, radius = {radius}}}")
        }
    };
    draft.obstacle(&["b1 z1".to_owned()], &obstacle, None);
}
