//! Invariance of solutions under motion, scaling and renumbering of a scene.

use std::collections::BTreeMap;

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, moved, shuffled};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::{ContactPoint, Solution};
use crate::support::solver::solve;
use crate::support::sorts::sort;

/// A block with a curved lower side on a longer one, pressed down at one end: with cells of equal size, or of different
/// size, so that it covers a fifth of the last facet.
fn mesh(cells: &str, is_even: bool) -> Mesh {
    let (start, length, n) = match is_even {
        true => (0.5, 1.5, 3),
        false => (0.4, 2.1, 7),
    };
    let bent = |[s, t]: [f64; 2]| {
        let x = start + length * s;
        [x, 1.0 + 0.6 * t + 2e-5 * (x - 1.2).powi(2) * (1.0 - t)]
    };
    let blocks = Blocks::new()
        .rectangle("zero", [0.0, 2.0], [0.0, 1.0], [4, 3])
        .mapped("one", [n, 3], bent);
    sort(cells).of(&blocks.mesh)
}

fn text(upside_down: bool) -> String {
    let sides = match upside_down {
        true => "'zero top', 'one bottom'",
        false => "'one bottom', 'zero top'",
    };
    format!(
        "plane = 'strain'
        materials.m0 = {{young = 20e9, poisson = 0.3}}
        materials.m1 = {{young = 210e9, poisson = 0.22}}
        bodies.zero.material = 'm0'
        bodies.one.material = 'm1'
        [[bilateral]]
        on = ['zero bottom', 'zero left', 'one left']
        [[contact]]
        name = 'joint'
        sides = [{sides}]\n"
    )
}

/// The model of a mesh with forces by node tag.
fn loaded(text: &str, mesh: Mesh, force: impl Fn(i64) -> [f64; 2]) -> Model {
    let mut model = model(text, mesh);
    model.forces = (0_u32..)
        .zip(&model.mesh.node_tags)
        .map(|(node, &tag)| (node, force(tag)))
        .filter(|(_, f)| *f != [0.0; 2])
        .map(|(node, [x, y])| (node, [x, y, 0.0]))
        .collect();
    model
}

/// A transformation of the scene: rotation (and reflection), scaling and translation.
#[derive(Clone, Copy)]
struct Place {
    angle: f64,
    mirrored: bool,
    factor: f64,
    way: [f64; 2],
}

const HERE: Place = Place {
    angle: 0.0,
    mirrored: false,
    factor: 1.0,
    way: [0.0; 2],
};

impl Place {
    fn turned(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        let x = if self.mirrored { -x } else { x };
        [cos * x - sin * y, sin * x + cos * y]
    }

    fn point(self, at: [f64; 2]) -> [f64; 2] {
        let turned = self.turned(at);
        [0, 1].map(|i| self.factor * (turned[i] + self.way[i]))
    }
}

/// Fails unless the scene has the same solution at all `places`, with nodes renumbered by `seed` if given.
#[track_caller]
fn is_the_same_at(places: &[Place], seed: Option<u64>) {
    for (cells, is_even, upside_down) in [
        ("triangle3", true, false),
        ("triangle3", false, false),
        ("triangle3", false, true),
        ("triangle6, quad8 and quad9", false, true),
    ] {
        let text = text(upside_down);
        let here = mesh(cells, is_even);
        let pressed = |tag: i64| {
            let [x, y, _] = here.points[tag as usize - 1];
            let on_top = (y - 1.6).abs() < 1e-9;
            [0.0, if on_top { -1e5 * (1.6 - x) } else { 0.0 }]
        };
        let first = solve(&loaded(&text, here.clone(), pressed), 4);
        assert!(first.closed() > 0 && first.closed() < first.points().count());
        for &place in places {
            let there = moved(here.clone(), |at| place.point(at));
            let (there, old) = match seed {
                Some(seed) => shuffled(&there, seed),
                None => (there, here.node_tags.iter().map(|&t| (t, t)).collect()),
            };
            let largest = there.points.iter().flatten();
            let largest = largest.fold(0.0, |m: f64, c| m.max(c.abs()));
            let force = |tag: i64| place.turned(pressed(old[&tag])).map(|f| place.factor * f);
            let second = solve(&loaded(&text, there, force), 4);
            // Gaps are differences of coordinates.
            let round_off = 20.0 * f64::EPSILON * largest / second.largest_displacement();
            agree(&first, &second, place, &old, 1e-10 + round_off);
        }
    }
}

#[track_caller]
fn agree(first: &Solution, second: &Solution, place: Place, old: &BTreeMap<i64, i64>, slack: f64) {
    let size = second.largest_displacement();
    for (tag, u) in &second.displacement {
        let [x, y, _] = first.displacement[&old[tag]];
        let expected = place.turned([x, y]).map(|u| place.factor * u);
        (0..2).for_each(|k| close(u[k], expected[k], slack * size));
    }
    // The node that carries the constraint, on either side.
    let named = |point: &ContactPoint| match point.tags {
        [-1, b] => b,
        [a, _] => a,
    };
    let by_tag: BTreeMap<i64, &ContactPoint> = first.points().map(|p| (named(p), p)).collect();
    assert_eq!(by_tag.len(), second.points().count());
    for point in second.points() {
        let other = by_tag[&old[&named(point)]];
        let force = place.factor * other.force;
        close(point.force, force, 10.0 * slack * second.largest_force());
        close(point.gap, place.factor * other.gap, slack * size);
    }
}

#[test]
fn a_scene_that_is_mirrored_or_turned_has_the_same_answer() {
    let turned = |angle, mirrored| Place {
        angle,
        mirrored,
        ..HERE
    };
    is_the_same_at(
        &[turned(0.7, false), turned(0.0, true), turned(2.0, true)],
        None,
    );
}

#[test]
fn a_scene_of_any_size_has_the_same_answer() {
    is_the_same_at(
        &[1e-3, 1e3, 1e6].map(|factor| Place { factor, ..HERE }),
        None,
    );
}

#[test]
fn a_scene_far_away_has_the_same_answer() {
    let far = |angle, way| Place { angle, way, ..HERE };
    is_the_same_at(&[far(0.0, [3e3, 0.0]), far(0.7, [-1e3, 2e3])], None);
}

#[test]
fn a_renumbered_scene_has_the_same_answer() {
    is_the_same_at(&[HERE], Some(1));
}

/// A plank on two stops whose given gaps differ, under loads that move it by less than the round-off of its coordinates:
/// the node between the stops rests on the nearer one.
#[test]
fn given_gaps_count_however_small_they_are() {
    const FACTOR: f64 = 1e-20;
    let blocks = Blocks::new()
        .rectangle("left", [0.0, 1.0], [0.0, 0.5], [3, 2])
        .rectangle("right", [1.0, 2.0], [0.0, 0.5], [3, 2])
        .glued(|_, _| true);
    let scene = |factor: f64| {
        let stop = |side: &str, gap: f64| {
            format!(
                "[[contact]]
                name = '{side}'
                sides = [['{side} bottom']]
                obstacle = {{ point = [0, 0], normal = [0, 1] }}
                gap = {:e}\n",
                gap * factor
            )
        };
        let text = format!(
            "plane = 'strain'
            materials.steel = {{ young = 210e9, poisson = 0.3 }}
            bodies.left.material = 'steel'
            bodies.right.material = 'steel'
            [[displacement]]
            on = 'left left'
            x = 0
            [[pressure]]
            on = ['left top', 'right top']
            value = {:e}\n{}{}",
            1e6 * factor,
            stop("left", 3e-6),
            stop("right", 5e-6),
        );
        model(&text, blocks.mesh.clone())
    };
    let [whole, small] = [1.0, FACTOR].map(|factor| solve(&scene(factor), 4));
    assert_eq!(whole.closed(), small.closed());
    for (one, other) in whole.points().zip(small.points()) {
        assert_eq!(one.closed, other.closed);
        close(
            other.force,
            one.force * FACTOR,
            1e-9 * whole.largest_force() * FACTOR,
        );
    }
}
