//! Non-matching sides in space.

mod space;

use std::collections::HashMap;

use self::space::{Point, Range, Space};
use crate::contact_point::ContactPoint;
use crate::element::ElementKind::{self, Quad4, Quad8, Quad9, Triangle3, Triangle6};
use crate::element::geometry::{advance, cross, difference, length};
use crate::mesh::Mesh;

const KINDS: [ElementKind; 5] = [Triangle3, Triangle6, Quad4, Quad8, Quad9];

fn turned([x, y, z]: Point) -> Point {
    let [x, y] = [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y];
    let [y, z] = [0.28 * y - 0.96 * z, 0.96 * y + 0.28 * z];
    [x + 0.3, y - 2.0, z]
}

/// Two sides over the same square, one above the other.
fn square(
    kinds: [ElementKind; 2],
    n: [[usize; 2]; 2],
    uneven: f64,
    gap: f64,
    map: fn(Point) -> Point,
) -> Space {
    let range = [[0.0, 2.0], [0.0, 3.0]];
    let lift = |[x, y, _]: Point| map([x, y, gap]);
    Space::new()
        .side(kinds[0], range, n[0], uneven, false, map)
        .side(kinds[1], range, n[1], uneven, true, lift)
}

/// All pairs of kinds of facets in which each kind occurs twice on either side.
fn pairs_of_kinds() -> impl Iterator<Item = [ElementKind; 2]> {
    [1, 3]
        .into_iter()
        .flat_map(|step| (0..5).map(move |i| [KINDS[i], KINDS[(i + step) % 5]]))
}

/// Σ over points of area·weight at every node.
fn forces(points: &[ContactPoint<u32>]) -> HashMap<u32, f64> {
    let mut forces = HashMap::new();
    for point in points {
        for &(node, weight) in &point.entries {
            *forces.entry(node).or_default() += point.area * weight;
        }
    }
    forces
}

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(
        error <= tolerance,
        "{what}: {found} instead of {expected}, {error:e}"
    );
}

#[test]
fn a_uniform_pressure_loads_both_sides_as_if_it_were_applied_to_them() {
    for kinds in pairs_of_kinds() {
        for (n, uneven) in [([[2, 3], [1, 2]], 0.0), ([[2, 2], [3, 2]], 0.2)] {
            let space = square(kinds, n, uneven, 0.0, turned);
            for [a, b] in [[0, 1], [1, 0]] {
                let what = format!("{kinds:?} {uneven} side {a}");
                let points = space.points(a, b);
                assert!(points.iter().all(|point| point.area > 0.0), "{what}");
                let forces = forces(&points);
                for (side, sign) in [(a, 1.0), (b, -1.0)] {
                    for (node, expected) in space.integrals(side) {
                        let found = forces.get(&node).copied().unwrap_or_default();
                        close(found, sign * expected, 1e-11, &what);
                    }
                }
            }
        }
    }
}

/// Partly overlapping sides: whole facets, parts of them, slivers, and narrow facets on the middle of a wide one.
fn overlaps() -> Vec<(Range, Range, [[usize; 2]; 2])> {
    let whole = [[0.0, 3.0], [0.0, 2.0]];
    let mut all = vec![
        (whole, [[0.7, 2.1], [0.3, 1.9]], [[5, 4], [3, 3]]),
        (whole, [[1.1, 4.4], [-0.7, 1.2]], [[3, 2], [4, 5]]),
        (whole, [[1.5, 3.0], [0.0, 2.0]], [[2, 2], [2, 3]]),
        (whole, [[0.2, 0.7], [0.3, 0.8]], [[2, 1], [2, 1]]),
    ];
    for exponent in [1, 2, 3, 6, 9] {
        // A facet of each side ends at x = 1.
        let sliver = 10.0_f64.powi(-exponent);
        all.push((
            whole,
            [[0.0, 1.0 + sliver], [0.0, 1.0 + sliver]],
            [[3, 2], [2, 2]],
        ));
    }
    all
}

#[test]
fn sides_that_overlap_in_part_pass_forces_and_moments() {
    for (i, (one, other, n)) in overlaps().into_iter().enumerate() {
        for kinds in pairs_of_kinds().skip(i % 2).step_by(2) {
            let space = Space::new()
                .side(kinds[0], one, n[0], 0.1, false, turned)
                .side(kinds[1], other, n[1], 0.1, true, |[x, y, z]| {
                    turned([x, y, z + 0.125])
                });
            let common: f64 = (0..2)
                .map(|k| one[k][1].min(other[k][1]) - one[k][0].max(other[k][0]))
                .product();
            for [a, b] in [[0, 1], [1, 0]] {
                let what = format!("{kinds:?} {other:?} side {a}");
                let points = space.points(a, b);
                let area: f64 = points.iter().map(|point| point.area).sum();
                // Slivers of 1e-12 of a facet are left out.
                close(area, common, 1e-11, &what);
                for point in &points {
                    assert!(point.area > 0.0, "{what}");
                    close(point.gap, 0.125, 1e-10, &what);
                    let (mut force, mut moment, mut size) = (0.0, [0.0; 3], 1.0_f64);
                    for &(node, weight) in &point.entries {
                        let arm = difference(space.mesh.points[node as usize], point.position);
                        moment = advance(moment, weight, cross(arm, point.normal()));
                        force += weight;
                        size = size.max(weight.abs());
                    }
                    close(force, 0.0, 1e-11 * size, &what);
                    close(length(moment), 0.0, 1e-10 * size, &what);
                }
            }
        }
    }
}

/// Rows of fully covered sides are dual: on a linear field they give its value at the node, or, for a node on an edge,
/// the value implied by the corners around it.
#[test]
fn a_row_takes_linear_displacements_to_the_jump_at_its_node() {
    let u = |[x, y, z]: Point| 0.3 * x - 0.2 * y + 0.7 * z + 1.0;
    let v = |[x, y, z]: Point| -0.6 * x + 0.9 * y - 0.1 * z + 0.2;
    for kinds in pairs_of_kinds() {
        let space = square(kinds, [[3, 4], [2, 3]], 0.2, 0.25, turned);
        let below = space.sides[0].iter().flat_map(|(_, nodes)| nodes).max();
        for point in space.points(0, 1) {
            let jump: f64 = (point.entries.iter())
                .map(|&(node, weight)| {
                    let x = space.mesh.points[node as usize];
                    weight * if Some(&node) <= below { u(x) } else { v(x) }
                })
                .sum();
            let x = point.position;
            let expected = u(x) - v(advance(x, 0.25, point.normal()));
            close(jump, expected, 1e-10, &format!("{kinds:?}"));
            close(point.gap, 0.25, 1e-11, "gap");
        }
    }
}

#[test]
fn where_nodes_match_a_row_has_the_same_of_both_sides() {
    for kind in KINDS {
        let bent = |[x, y, z]: Point| turned([x, y, z + 0.05 * x * x - 0.1 * x * y]);
        let maps: [fn(Point) -> Point; 2] = [turned, bent];
        for (map, gap) in maps.into_iter().zip([0.1, 0.0]) {
            let space = square([kind; 2], [[3, 4]; 2], 0.2, gap, map);
            let points = space.points(0, 1);
            let at = |node: u32| space.mesh.points[node as usize];
            for point in &points {
                for &(node, weight) in &point.entries {
                    let is_partner = |&&(other, _): &&(u32, f64)| {
                        let away = length(difference(at(other), at(node)));
                        other != node && (away - gap).abs() < 1e-9
                    };
                    let (_, partner) = point.entries.iter().find(is_partner).unwrap();
                    close(*partner, -weight, 1e-10, &format!("{kind:?}"));
                }
                if kind.is_linear() || kind == Quad9 {
                    assert_eq!(point.entries.len(), 2, "{kind:?}");
                }
            }
            let nodes = space.integrals(0).len();
            assert_eq!(points.len(), nodes, "{kind:?}");
        }
    }
}

/// A part of a ball of radius 1 and a larger part of the cavity around it.
fn balls(kinds: [ElementKind; 2], n: usize, gap: f64) -> Space {
    let on = |radius: f64| {
        move |[x, y, _]: Point| {
            let far = length([x, y, 1.0]);
            turned([x, y, 1.0].map(|c| c * radius / far))
        }
    };
    let range = |end: f64| [[-end, end]; 2];
    Space::new()
        .side(kinds[0], range(0.5), [n, n], 0.1, false, on(1.0))
        .side(kinds[1], range(0.7), [n, n + 1], 0.1, true, on(1.0 + gap))
}

#[test]
fn round_sides_are_covered_whole_and_turn_together() {
    for kinds in pairs_of_kinds() {
        let (n, gap) = (4, 0.05);
        let space = balls(kinds, n, gap);
        let surface = space.surface(0);
        let points = space.points(0, 1);
        let what = format!("{kinds:?}");
        let area: f64 = points.iter().map(|point| point.area).sum();
        let expected: f64 = space.integrals(0).values().sum();
        close(area, expected, 1e-6, &what);
        // Chords deviate from the curve by as much.
        let is_linear = kinds.iter().any(|kind| kind.is_linear());
        let off = if is_linear { 4e-2 } else { 4e-3 };
        for point in &points {
            close(point.gap, gap, off, &what);
            let mut moment = [0.0; 3];
            for &(node, weight) in &point.entries {
                let arm = space.mesh.points[node as usize];
                moment = advance(moment, weight, cross(arm, point.normal()));
            }
            close(length(moment), 0.0, 1e-12, &what);
        }
        assert!(points.len() <= surface.nodes().len());
    }
}

#[test]
fn numbers_and_reflections_change_nothing() {
    let key = |x: Point| x.map(|c| (c * 1e6).round() as i64);
    for kinds in [[Triangle6, Quad8], [Quad9, Triangle3], [Quad4, Triangle6]] {
        let space = balls(kinds, 4, 0.01);
        let mirrored = Space {
            mesh: Mesh {
                points: space
                    .mesh
                    .points
                    .iter()
                    .map(|&[x, y, z]| [-x, y, z])
                    .collect(),
                ..space.mesh.clone()
            },
            sides: (space.sides.iter())
                .map(|side| {
                    let turn = |(kind, nodes): &(ElementKind, Vec<u32>)| {
                        let order = kind.reversed();
                        (*kind, order.iter().map(|&i| nodes[i]).collect())
                    };
                    side.iter().rev().map(turn).collect()
                })
                .collect(),
        };
        let others = mirrored.points(0, 1);
        let points = space.points(0, 1);
        assert_eq!(points.len(), others.len());
        for point in points {
            let [x, y, z] = point.position;
            let other = others
                .iter()
                .find(|other| key(other.position) == key([-x, y, z]));
            let other = other.unwrap();
            close(point.gap, other.gap, 1e-12, "gap");
            close(point.area, other.area, 1e-12, "area");
            assert_eq!(point.entries.len(), other.entries.len());
            for (node, weight) in &point.entries {
                let twin = other.entries.iter().find(|(twin, _)| twin == node);
                close(*weight, twin.unwrap().1, 1e-9, "weight");
            }
        }
    }
}

/// The averted side of a closed surface doesn't contribute; a layer behind another one is hidden.
#[test]
fn what_lies_behind_is_not_seen() {
    let range = [[0.0, 2.0], [0.0, 3.0]];
    let at = |height: f64| move |[x, y, _]: Point| turned([x, y, height]);
    let mut space = Space::new()
        .side(Quad4, range, [2, 2], 0.0, false, at(0.0))
        .side(Triangle3, range, [3, 2], 0.0, true, at(0.1))
        .side(Triangle3, range, [2, 3], 0.0, false, at(0.4))
        .side(Triangle3, range, [3, 3], 0.0, true, at(0.7));
    let hidden: Vec<_> = space.sides.drain(2..).flatten().collect();
    space.sides[1].extend(hidden);
    let points = space.points(0, 1);
    let area: f64 = points.iter().map(|point| point.area).sum();
    close(area, 6.0, 1e-12, "area");
    points
        .iter()
        .for_each(|point| close(point.gap, 0.1, 1e-12, "gap"));
}

#[test]
fn many_facets_take_no_quadratic_time() {
    let n = 40;
    let bent = |lift: f64| move |[x, y, _]: Point| [x, y, lift + 0.1 * (3.0 * x).sin() * y];
    let space = Space::new()
        .side(Triangle3, [[0.0, 1.0]; 2], [n, n], 0.1, false, bent(0.0))
        .side(
            Triangle3,
            [[0.0, 1.0]; 2],
            [n + 1, n + 1],
            0.1,
            true,
            bent(0.01),
        );
    let start = std::time::Instant::now();
    assert_eq!(space.points(0, 1).len(), (n + 1) * (n + 1));
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}
