//! Invariance of solutions under motion, scaling, change of stiffness and renumbering of a scene.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::element::geometry::length;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use super::is_near;
use crate::support::blocks::{joined, shuffled};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, moved, solid, turned};
use crate::support::solution::{ContactPoint, Solution};
use crate::support::solver::solve;

/// Two blocks under pressure and shear; the lower side of the upper one is curved.
struct Blocks {
    kinds: [ElementKind; 2],
    /// True for matching nodes; otherwise the upper block covers a part of the lower one.
    is_even: bool,
    friction: &'static str,
}

impl Blocks {
    fn mesh(&self) -> Mesh {
        let is_linear = self.kinds[0].is_linear();
        let [lower, uneven] = match is_linear {
            true => [[4, 3, 2], [5, 3, 2]],
            false => [[2, 2, 1], [3, 2, 1]],
        };
        let low = between([0.0; 3], [2.0, 1.5, 1.0]);
        let (upper, high) = match self.is_even {
            true => (lower, between([0.0, 0.0, 1.0], [2.0, 1.5, 1.6])),
            false => (uneven, between([0.3, 0.2, 1.0], [2.4, 1.3, 1.6])),
        };
        let lower = solid("lower", self.kinds[0], lower, low);
        let upper = solid("upper", self.kinds[1], upper, high);
        let bent = |[x, y, z]: [f64; 3]| {
            let bend = (x - 0.6).powi(2) + 0.5 * (y - 0.4).powi(2);
            [x, y, z + 2e-5 * bend * (1.6 - z) / 0.6]
        };
        joined(lower, moved(upper, bent))
    }

    fn text(&self, stiffer: f64) -> String {
        let (rock, steel) = (20e9 * stiffer, 210e9 * stiffer);
        format!(
            "materials.rock = {{young = {rock:?}, poisson = 0.3}}
            materials.steel = {{young = {steel:?}, poisson = 0.22}}
            bodies.lower.material = 'rock'
            bodies.upper.material = 'steel'
            [[bilateral]]
            on = ['lower z0', 'lower x0', 'lower y0', 'upper x0', 'upper y0']
            [[contact]]
            name = 'joint'
            sides = ['upper z0', 'lower z1']
            {}",
            self.friction
        )
    }
}

/// A change of a scene.
#[derive(Clone, Copy, Debug)]
struct Change {
    is_turned: bool,
    is_mirrored: bool,
    larger: f64,
    stiffer: f64,
    seed: Option<u64>,
}

const NONE: Change = Change {
    is_turned: false,
    is_mirrored: false,
    larger: 1.0,
    stiffer: 1.0,
    seed: None,
};

impl Change {
    fn vector(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let mirrored = [if self.is_mirrored { -x } else { x }, y, z];
        match self.is_turned {
            true => turned(mirrored),
            false => mirrored,
        }
    }

    fn point(self, x: [f64; 3]) -> [f64; 3] {
        self.vector(x).map(|c| self.larger * c)
    }

    /// Factor of forces.
    fn forces(self) -> f64 {
        self.stiffer * self.larger.powi(2)
    }

    /// Solves the scene with forces on the upper side, and the old tag of every new one.
    fn solved(self, blocks: &Blocks) -> (Solution, BTreeMap<i64, i64>) {
        let here = blocks.mesh();
        let force = |tag: i64| {
            let [x, y, z] = here.points[tag as usize - 1];
            let down = -2e4 * (1.7 - 0.8 * x);
            match (z - 1.6).abs() < 1e-9 {
                true => [8e3 * (PI * y).cos() + 4e3, 2e3, down],
                false => [0.0; 3],
            }
        };
        let there = moved(here.clone(), |x| self.point(x));
        let (there, old) = match self.seed {
            Some(seed) => shuffled(&there, seed),
            None => (there, here.node_tags.iter().map(|&t| (t, t)).collect()),
        };
        let mut model: Model = model(&blocks.text(self.stiffer), there);
        model.forces = (0_u32..)
            .zip(&model.mesh.node_tags)
            .map(|(node, tag)| (node, force(old[tag])))
            .filter(|(_, force)| *force != [0.0; 3])
            .map(|(node, force)| (node, self.vector(force).map(|f| self.forces() * f)))
            .collect();
        (solve(&model, 4), old)
    }
}

#[track_caller]
fn is_the_same_after(changes: &[Change]) {
    let friction = "friction = 0.2";
    for (kinds, is_even, friction) in [
        ([Hexahedron8; 2], true, ""),
        ([Hexahedron8; 2], true, friction),
        ([Hexahedron8, Tetrahedron4], false, friction),
        ([Hexahedron20, Tetrahedron10], false, ""),
        ([Tetrahedron10, Hexahedron27], false, friction),
    ] {
        let blocks = Blocks {
            kinds,
            is_even,
            friction,
        };
        let (first, _) = NONE.solved(&blocks);
        assert!((1..first.points().count()).contains(&first.closed()));
        assert_eq!(
            (1..first.closed()).contains(&first.slipping()),
            !friction.is_empty()
        );
        for &change in changes {
            let (second, old) = change.solved(&blocks);
            agree(&first, &second, change, &old);
        }
    }
}

#[track_caller]
fn agree(first: &Solution, second: &Solution, change: Change, old: &BTreeMap<i64, i64>) {
    let slack = 1e-10;
    let size = change.larger * first.largest_displacement();
    for (tag, u) in &second.displacement {
        let expected = change
            .vector(first.displacement[&old[tag]])
            .map(|u| change.larger * u);
        is_near(u, &expected, slack * size);
    }
    let by_tag: BTreeMap<i64, &ContactPoint> = first.points().map(|p| (p.tags[0], p)).collect();
    assert_eq!(by_tag.len(), second.points().count());
    let scale = change.forces();
    let largest = 10.0 * slack * scale * first.largest_force();
    for point in second.points() {
        let other = by_tag[&old[&point.tags[0]]];
        assert_eq!(
            [point.closed, point.slipping],
            [other.closed, other.slipping],
            "{change:?} at {:?}: {:?} and {:?}",
            point.position,
            (point.force, point.tangential_force, point.slip),
            (other.force, other.tangential_force, other.slip)
        );
        close(point.force, scale * other.force, largest);
        close(point.gap, change.larger * other.gap, slack * size);
        let tangential = change.vector(other.tangential_force).map(|f| scale * f);
        is_near(&point.tangential_force, &tangential, largest);
        let slip = change.vector(other.slip).map(|s| change.larger * s);
        is_near(&point.slip, &slip, slack * size);
        assert!((length(point.normal) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_scene_in_space_has_the_same_answer_wherever_it_is_whatever_its_size_stiffness_and_numbers() {
    is_the_same_after(&[
        Change {
            is_turned: true,
            ..NONE
        },
        Change {
            is_mirrored: true,
            seed: Some(1),
            ..NONE
        },
        Change {
            larger: 1e-6,
            stiffer: 1e6,
            ..NONE
        },
        Change {
            larger: 1e6,
            stiffer: 1e-6,
            seed: Some(2),
            ..NONE
        },
    ]);
}
