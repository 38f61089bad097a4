//! Γ_c between sides whose nodes don't match.

use std::f64::consts::PI;

use crate::blocks::Blocks;
use crate::close::close;
use crate::says::says;
use contact_dd_partition::contact_point::ContactPoint;

/// A contact of lower and upper block, `slave` being side a.
fn contact(slave: &str) -> String {
    let sides = match slave {
        "lower" => "['lower top', 'upper bottom']",
        _ => "['upper bottom', 'lower top']",
    };
    format!("[[contact]]\nname = 'c'\nsides = {sides}\n")
}

fn conditions(blocks: &Blocks, text: &str) -> Vec<ContactPoint<u32>> {
    let mut model = blocks.model(text).unwrap();
    model.contacts.remove(0).points
}

/// Blocks whose common side goes from `lower` and `upper`, with so many cells along it, a gap between
/// them, their nodes in irregular places.
fn uneven(lower: [f64; 2], upper: [f64; 2], n: [usize; 2], gap: f64) -> Blocks {
    let shift = |[from, to]: [f64; 2], n: usize, x: f64| {
        let s = (x - from) / (to - from);
        from + (to - from) * (s + 0.3 / n as f64 * (PI * 1.7 * n as f64 * s).sin() * (PI * s).sin())
    };
    let count = (n[0] + 1) * 2;
    let mut blocks = Blocks::new()
        .block("lower", lower, [0.0, 1.0], [n[0], 1])
        .block("upper", upper, [1.0 + gap, 2.0], [n[1], 1]);
    for (node, point) in blocks.mesh.points.iter_mut().enumerate() {
        point[0] = match node < count {
            true => shift(lower, n[0], point[0]),
            false => shift(upper, n[1], point[0]),
        };
    }
    blocks
}

/// Overlaps: whole, partial at one end and at both, less than a facet, nearly none of a facet.
fn overlaps() -> Vec<([f64; 2], [f64; 2], [usize; 2])> {
    let mut all = vec![
        ([0.0, 2.0], [0.0, 2.0], [4, 7]),
        ([0.0, 2.0], [0.0, 2.0], [9, 2]),
        ([0.0, 3.0], [0.7, 2.1], [8, 5]),
        ([0.0, 3.0], [0.7, 2.1], [3, 11]),
        ([0.0, 2.0], [1.1, 3.3], [6, 5]),
        ([0.0, 2.0], [0.9, 1.0], [1, 3]),
        ([0.0, 2.0], [0.55, 0.65], [4, 1]),
    ];
    for exponent in 1..=16 {
        // A facet of each ends at x = 1.
        let sliver = 10.0_f64.powi(-exponent);
        all.push(([0.0, 2.0], [0.0, 1.0 + sliver], [2, 3]));
        all.push(([0.0, 2.0], [1.0 - sliver, 2.0], [2, 5]));
    }
    all
}

/// ∫ of the shape function of every node on a side of `blocks` over `range`, by position.
fn consistent(blocks: &Blocks, side: &str, range: [f64; 2]) -> Vec<(u32, f64)> {
    let mesh = &blocks.mesh;
    let mut sums: Vec<(u32, f64)> = Vec::new();
    for &facet in &mesh.groups[side].members {
        let nodes = mesh.facets.nodes_of(facet as usize);
        for (i, &node) in nodes.iter().enumerate() {
            let (own, other) = (nodes[i], nodes[1 - i]);
            let [p, q] = [own, other].map(|n| mesh.points[n as usize][0]);
            let from = p.min(q).max(range[0]);
            let to = p.max(q).min(range[1]);
            let middle = 0.5 * (from + to);
            let integral = (to - from).max(0.0) * (q - middle) / (q - p);
            match sums.iter_mut().find(|(n, _)| *n == node) {
                Some((_, sum)) => *sum += integral,
                None => sums.push((node, integral)),
            }
        }
    }
    sums
}

/// Σ over points of force·weight·normal at a node.
fn force_at(
    rows: &[ContactPoint<u32>],
    node: u32,
    force: impl Fn(&ContactPoint<u32>) -> f64,
) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for row in rows {
        for (_, c) in row.row().filter(|(n, _)| *n == node) {
            (0..3).for_each(|i| sum[i] += force(row) * c[i]);
        }
    }
    sum
}

#[test]
fn a_uniform_pressure_loads_both_sides_as_if_it_were_applied_to_them() {
    for (lower, upper, n) in overlaps() {
        let blocks = uneven(lower, upper, n, 0.0);
        let range = [lower[0].max(upper[0]), lower[1].min(upper[1])];
        for slave in ["lower", "upper"] {
            let rows = conditions(&blocks, &contact(slave));
            assert!(rows.iter().all(|row| row.area > 0.0 && row.tag_b == -1));
            for (side, sign) in [("lower top", 1.0), ("upper bottom", -1.0)] {
                for (node, expected) in consistent(&blocks, side, range) {
                    let [x, y, _] = force_at(&rows, node, |row| row.area);
                    close(x, 0.0, 1e-13);
                    close(y, sign * expected, 1e-13);
                }
            }
        }
    }
}

#[test]
fn forces_and_moments_of_any_pressure_balance_across_a_straight_gap() {
    let turned = |[x, y, z]: [f64; 3]| [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y, z];
    for (lower, upper, n) in overlaps() {
        let blocks = uneven(lower, upper, n, 0.125).moved(turned);
        for slave in ["lower", "upper"] {
            for row in conditions(&blocks, &contact(slave)) {
                let (mut force, mut moment, mut size) = ([0.0; 3], 0.0, 1.0_f64);
                for (node, c) in row.row() {
                    let x = blocks.mesh.points[node as usize];
                    (0..3).for_each(|i| force[i] += c[i]);
                    moment += x[0] * c[1] - x[1] * c[0];
                    size = size.max(c[0].abs()).max(c[1].abs());
                }
                (0..3).for_each(|i| close(force[i], 0.0, 1e-13 * size));
                close(moment, 0.0, 1e-11 * size);
            }
        }
    }
}

/// A fifth of a facet is covered, a half, a quarter: round-off may not decide which nodes carry.
#[test]
fn the_same_nodes_carry_however_a_side_lies() {
    for (from, facets) in [(0.4, 4), (0.1, 4), (0.25, 4), (0.3, 2), (0.9, 2), (0.48, 4)] {
        let blocks = Blocks::new()
            .block("lower", [0.0, 2.0], [0.0, 1.0], [facets, 1])
            .block("upper", [from, 2.5], [1.0, 2.0], [7, 1]);
        let tags = |blocks: &Blocks| -> Vec<i64> {
            let rows = conditions(blocks, &contact("lower"));
            rows.iter().map(|row| row.tag_a).collect()
        };
        let here = tags(&blocks);
        for step in 1..20 {
            let (sin, cos) = f64::sin_cos(0.3 * f64::from(step));
            let turned = |[x, y, z]: [f64; 3]| [cos * x - sin * y, sin * x + cos * y, z];
            assert_eq!(tags(&blocks.clone().moved(turned)), here, "{from} {step}");
        }
    }
}

#[test]
fn no_weight_is_large_however_little_of_a_facet_is_covered() {
    for (lower, upper, n) in overlaps() {
        let blocks = uneven(lower, upper, n, 0.0);
        for slave in ["lower", "upper"] {
            for row in conditions(&blocks, &contact(slave)) {
                let own = row.entries[0].1;
                // On partly covered facets forces act beside the node; weights below 1 % are added to the neighbour's.
                assert!(own > 0.009_8, "{row:?}");
                // Both ends of a facet carry the pressure of a narrow block on its middle.
                if n != [4, 1] && n != [1, 3] {
                    assert!(row.row().all(|(_, c)| c[1].abs() < 8.0), "{row:?}");
                }
            }
        }
    }
}

/// The multiplier's weight is dual: it takes a linear field to its value at the node.
#[test]
fn a_row_takes_linear_displacements_to_the_jump_at_its_node() {
    let u = |[x, y, _]: [f64; 3]| [0.3 * x - 0.2 * y + 1.0, 0.7 * x + 0.1 * y - 0.4];
    let v = |[x, y, _]: [f64; 3]| [0.1 * x + 0.5 * y, -0.6 * x + 0.9 * y + 0.2];
    for n in [[4, 7], [9, 2], [5, 5]] {
        let blocks = uneven([0.0, 2.0], [0.0, 2.0], n, 0.25);
        for (slave, offset) in [("lower", 0.25), ("upper", -0.25)] {
            let rows = conditions(&blocks, &contact(slave));
            let lower_nodes = 2 * (n[0] as u32 + 1);
            for row in &rows {
                let jump: f64 = row
                    .row()
                    .map(|(node, c)| {
                        let x = blocks.mesh.points[node as usize];
                        let [s, t] = if node < lower_nodes { u(x) } else { v(x) };
                        c[0] * s + c[1] * t
                    })
                    .sum();
                let [x, y, z] = row.position;
                let across = [x, y + offset, z];
                let expected = match slave {
                    "lower" => u([x, y, z])[1] - v(across)[1],
                    _ => u(across)[1] - v([x, y, z])[1],
                };
                close(jump, expected, 1e-13);
                close(row.gap, 0.25, 1e-14);
            }
        }
    }
}

#[test]
fn a_gap_that_widens_linearly_is_measured_at_the_nodes() {
    let blocks = uneven([0.0, 2.0], [0.0, 2.0], [4, 7], 0.0)
        .moved(|[x, y, z]| [x, if y > 1.0 { y + 0.1 * x } else { y }, z]);
    let lower_nodes = 10;
    let mut lifted = blocks.clone();
    for (node, point) in lifted.mesh.points.iter_mut().enumerate() {
        if node >= lower_nodes && point[1] == 1.0 {
            point[1] += 0.1 + 0.2 * point[0];
        }
    }
    for row in conditions(&lifted, &contact("lower")) {
        close(row.gap, 0.1 + 0.2 * row.position[0], 1e-14);
    }
    let text = contact("lower") + "gap = '0.5+x'";
    for row in conditions(&lifted, &text) {
        close(row.gap, 0.5 + row.position[0], 1e-15);
    }
}

#[test]
fn nodes_decide_unless_the_scene_does() {
    let text = contact("lower");
    let matching = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("upper", [0.0, 2.0], [1.0, 2.0], [4, 2]);
    assert!(
        conditions(&matching, &text)
            .iter()
            .all(|row| row.tag_b != -1)
    );
    let other = uneven([0.0, 2.0], [0.0, 2.0], [4, 3], 0.0);
    assert!(conditions(&other, &text).iter().all(|row| row.tag_b == -1));
    let error = other
        .model(&(text.clone() + "pairing = 'nodes'"))
        .unwrap_err();
    says(&error, "the sides don't match at");
    // Where nodes match both pairings give the same constraints.
    let nodes = conditions(&matching, &(text.clone() + "pairing = 'nodes'"));
    let mortar = conditions(&matching, &(text + "pairing = 'mortar'"));
    assert_eq!(nodes.len(), mortar.len());
    for (one, other) in nodes.iter().zip(&mortar) {
        assert_eq!((one.tag_a, other.tag_b), (other.tag_a, -1));
        assert_eq!(other.entries.len(), 2);
        for ((p, c), (q, d)) in one.entries.iter().zip(&other.entries) {
            assert_eq!(p, q);
            close(*c, *d, 1e-14);
        }
        close(one.area, other.area, 1e-15);
        close(one.gap, other.gap, 1e-15);
    }
}

#[test]
fn sides_that_dont_face_each_other_are_an_error() {
    let blocks = uneven([0.0, 2.0], [0.0, 2.0], [4, 3], 0.5);
    for (a, b, expected) in [
        ("lower top", "upper top", "the sides face the same way"),
        ("lower bottom", "upper top", "no node of side a"),
        ("lower left", "upper right", "no node of side a"),
    ] {
        let text = format!("[[contact]]\nname = 'c'\nsides = ['{a}', '{b}']\npairing = 'mortar'");
        let error = blocks.model(&text).unwrap_err();
        says(&error, &format!("contact 'c' … {expected}"));
    }
}

#[test]
fn interference_is_allowed_with_a_note() {
    let blocks = uneven([0.0, 2.0], [0.0, 2.0], [4, 3], -0.01);
    let model = blocks.model(&contact("lower")).unwrap();
    assert!(model.warnings[0].contains("5 of 5 gaps are negative, an interference fit of up to"));
    model.contacts[0]
        .points
        .iter()
        .for_each(|row| close(row.gap, -0.01, 1e-15));
}

/// A block with a crack along y = 0 between its tips at x = 1 and x = 3, `n` facets on its sides.
fn cracked(n: [usize; 2]) -> Blocks {
    let mut blocks = Blocks::new()
        .block("west", [0.0, 1.0], [-1.0, 0.0], [1, 1])
        .block("lower", [1.0, 3.0], [-1.0, 0.0], [n[0], 1])
        .block("upper", [1.0, 3.0], [0.0, 1.0], [n[1], 1]);
    // Of nodes in one place at the tips the first is that of both sides.
    let points = std::mem::take(&mut blocks.mesh.points);
    let mut number: Vec<u32> = Vec::new();
    let mesh = &mut blocks.mesh;
    for (node, at) in points.iter().enumerate() {
        let same = points[..node].iter().position(|p| p == at);
        let first = same.filter(|_| at[0] == 1.0 || at[0] == 3.0);
        number.push(first.map_or(mesh.points.len() as u32, |first| number[first]));
        if first.is_none() {
            mesh.points.push(*at);
        }
    }
    mesh.node_tags.truncate(mesh.points.len());
    for elements in [&mut mesh.cells, &mut mesh.facets] {
        for e in 0..elements.len() {
            let nodes = elements.nodes_of_mut(e).iter_mut();
            nodes.for_each(|node| *node = number[*node as usize]);
        }
    }
    blocks
}

#[test]
fn crack_tips_carry_no_condition_and_pressure_loads_all_other_nodes_as_it_should() {
    for n in [[4, 7], [7, 4], [2, 3], [2, 9], [1, 2]] {
        let blocks = cracked(n);
        for slave in ["lower", "upper"] {
            let text = contact(slave) + "gap = 0.0";
            // A crack whose side is one facet has no node to carry a condition.
            if n == [1, 2] && slave == "lower" {
                assert!(blocks.model(&text).is_err());
                continue;
            }
            let rows = conditions(&blocks, &text);
            let is_tip = |x: f64| x == 1.0 || x == 3.0;
            assert!(rows.iter().all(|row| !is_tip(row.position[0])));
            let total: f64 = rows.iter().map(|row| row.area).sum();
            close(total, 2.0, 1e-14);
            for (side, sign) in [("lower top", 1.0), ("upper bottom", -1.0)] {
                for (node, expected) in consistent(&blocks, side, [1.0, 3.0]) {
                    let force = force_at(&rows, node, |row| row.area)[1];
                    let at_tip = is_tip(blocks.mesh.points[node as usize][0]);
                    // A tip is pressed from both sides.
                    let half = 1.0 / n[0] as f64 - 1.0 / n[1] as f64;
                    close(force, if at_tip { half } else { sign * expected }, 1e-13);
                }
            }
        }
    }
}

#[test]
fn other_units_change_lengths_alone() {
    let text = contact("lower");
    let blocks = uneven([0.0, 3.0], [0.7, 2.1], [8, 5], 0.25)
        .moved(|[x, y, z]| [x, y + 0.1 * (x + y).sin(), z]);
    let rows = conditions(&blocks, &text);
    for unit in [1e3, 1e-9, 1e100] {
        let scaled = conditions(&blocks.clone().moved(|x| x.map(|c| c * unit)), &text);
        assert_eq!(rows.len(), scaled.len());
        for (one, other) in rows.iter().zip(&scaled) {
            close(other.gap / unit, one.gap, 1e-14);
            close(other.area / unit, one.area, 1e-14);
            assert_eq!(one.entries.len(), other.entries.len());
            for ((p, c), (q, d)) in one.entries.iter().zip(&other.entries) {
                assert_eq!(p, q);
                close(*c, *d, 1e-12);
            }
        }
    }
}

#[test]
fn many_nodes_a_side_take_no_quadratic_time() {
    let n = 10_000;
    let blocks = Blocks::new()
        .block("lower", [0.0, 100.0], [0.0, 1.0], [n, 1])
        .block("upper", [0.0, 100.0], [1.0, 2.0], [n + 1, 1])
        .moved(|[x, y, z]| [x, y + (0.1 * x).sin(), z]);
    let start = std::time::Instant::now();
    assert_eq!(conditions(&blocks, &contact("lower")).len(), n + 1);
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}
