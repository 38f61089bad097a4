//! Γ_c.

use crate::blocks::Blocks;
use crate::close::close;
use crate::says::says;
use contact_dd_partition::contact_point::{ContactPoint, Law};
use contact_dd_partition::mesh::Mesh;

const CONTACT: &str = "[[contact]]\nname = 'c'\nsides = ['lower top', 'upper bottom']\n";

/// Two blocks with a gap between them.
pub fn stack(gap: f64) -> Blocks {
    Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("upper", [0.0, 2.0], [1.0 + gap, 2.0], [4, 2])
}

/// The conditions of a scene's first contact.
pub fn conditions(blocks: &Blocks, text: &str) -> Result<Vec<ContactPoint<u32>>, String> {
    let mut model = blocks.model(text)?;
    Ok(model.contacts.remove(0).points)
}

#[test]
fn a_row_is_the_jump_along_the_outward_normal_of_side_a() {
    let rows = conditions(&stack(0.25), CONTACT).unwrap();
    assert_eq!(rows.len(), 5);
    for (i, row) in rows.iter().enumerate() {
        let [(a, plus), (b, minus)] = row.entries[..] else {
            panic!("two entries");
        };
        assert_eq!((plus, minus), (1.0, -1.0));
        assert_eq!(row.frame.normal, [0.0, 1.0, 0.0]);
        let points = stack(0.25).mesh.points;
        assert_eq!(points[a as usize], row.position);
        assert_eq!(points[b as usize][0], row.position[0]);
        assert_eq!(row.tag_a, stack(0.25).mesh.node_tags[a as usize]);
        assert_eq!(row.tag_b, stack(0.25).mesh.node_tags[b as usize]);
        close(row.gap, 0.25, 1e-15);
        close(row.area, if i == 0 || i == 4 { 0.25 } else { 0.5 }, 1e-15);
    }
    let steps: Vec<f64> = rows.iter().map(|row| row.position[0]).collect();
    assert_eq!(steps, [2.0, 1.5, 1.0, 0.5, 0.0]);
}

#[test]
fn a_given_gap_replaces_the_geometric_one() {
    let rows = conditions(&stack(0.25), &format!("{CONTACT}gap = '0.1*x+y'")).unwrap();
    for row in rows {
        close(row.gap, 0.1 * row.position[0] + 1.0, 1e-15);
    }
    let rows = conditions(&stack(0.25), &format!("{CONTACT}gap = 0")).unwrap();
    assert!(rows.iter().all(|row| row.gap == 0.0));
}

#[test]
fn friction_is_that_of_the_place() {
    let law = |keys: &str| {
        let rows = conditions(&stack(0.25), &format!("{CONTACT}{keys}")).unwrap();
        move |k: usize| (rows[k].position[0], rows[k].law)
    };
    for k in 0..5 {
        let (x, given) = law("tresca = '1e5*x'")(k);
        assert_eq!(given, Law::given(1e5 * x));
        let (x, coulomb) = law("friction = '0.25*x'\ncohesion = 2e5")(k);
        let expected = Law::Coulomb {
            coefficient: 0.25 * x,
            cohesion: 2e5,
        };
        assert_eq!(coulomb, expected);
    }
    // The last point is at x = 0.
    for none in [
        "",
        "tresca = '1e5*x'",
        "friction = '0.5*x'",
        "friction = 0\ncohesion = 0",
    ] {
        assert_eq!(law(none)(4).1, Law::Frictionless, "{none}");
    }
    let upright = stack(0.25).model(
        "[[contact]]\nname = 'floor'\nsides = ['lower bottom']\nfriction = '1-y'\n\
         obstacle = {point = [0, 0], normal = [0, 1]}",
    );
    let floor = &upright.unwrap().contacts[0];
    assert!((floor.points.iter()).all(|point| point.law == Law::coulomb(1.0, 0.0)));
}

#[test]
fn a_coefficient_of_friction_that_looks_like_an_angle_is_noted() {
    for (keys, is_noted) in [
        ("friction = '20 - 5*x'", true),
        ("friction = 1.5", false),
        ("tresca = 1e6", false),
    ] {
        let warnings = stack(0.25)
            .model(&format!("{CONTACT}{keys}"))
            .unwrap()
            .warnings;
        let noted = "contact 'c'.friction: a coefficient of";
        assert_eq!(
            warnings.iter().any(|w| w.starts_with(noted)),
            is_noted,
            "{keys}"
        );
    }
}

#[test]
fn friction_below_zero_is_named_with_its_node() {
    for (keys, expected) in [
        (
            "friction = '1-x'",
            "contact 'c'.friction: '1-x' is -1e0 at x = 2, y = 1; expected 0 or more (node ",
        ),
        (
            "tresca = '1/x'",
            "contact 'c'.tresca: '1/x' is inf at x = 0, y = 1; expected a finite number (node ",
        ),
        (
            "friction = 1\ncohesion = 'y-2'",
            "contact 'c'.cohesion: 'y-2' is -1e0 at x = 2, y = 1; expected 0 or more (node ",
        ),
    ] {
        for pairing in ["nodes", "mortar"] {
            let text = format!("{CONTACT}pairing = '{pairing}'\n{keys}");
            let message = conditions(&stack(0.25), &text).unwrap_err();
            says(&message, expected);
        }
    }
}

#[test]
fn interference_is_allowed_with_a_note() {
    let model = stack(-0.01).model(CONTACT).unwrap();
    assert!(model.warnings[0].contains("contact 'c': 5 of 5 gaps are negative"));
    close(model.contacts[0].points[2].gap, -0.01, 1e-15);
    let model = stack(0.0)
        .model(&format!("{CONTACT}gap = '-1e-3'"))
        .unwrap();
    assert!(model.warnings[0].contains("interference fit of up to 0.001 m"));
    assert!(stack(0.0).model(CONTACT).unwrap().warnings.is_empty());
    let intended = format!("{CONTACT}interference = true");
    assert!(stack(-0.01).model(&intended).unwrap().warnings.is_empty());
}

#[test]
fn nodes_beyond_the_end_of_the_overlap_carry_no_condition() {
    let blocks = Blocks::new()
        .block("lower", [-1.0, 3.0], [0.0, 1.0], [8, 2])
        .block("upper", [0.0, 2.0], [1.0, 2.0], [4, 2]);
    assert_eq!(conditions(&blocks, CONTACT).unwrap().len(), 5);
    let turned = "[[contact]]\nname = 'c'\nsides = ['upper bottom', 'lower top']";
    let rows = conditions(&blocks, turned).unwrap();
    assert_eq!(rows.len(), 5);
    assert!(rows.iter().all(|row| row.frame.normal == [0.0, -1.0, 0.0]));
}

#[test]
fn sides_whose_nodes_dont_match_cant_be_paired_by_nodes() {
    let other = |n: usize, x: [f64; 2]| {
        Blocks::new()
            .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
            .block("upper", x, [1.0, 2.0], [n, 2])
    };
    for blocks in [
        other(5, [0.0, 2.0]),
        other(2, [0.0, 2.0]),
        other(8, [0.0, 2.0]),
        other(4, [0.1, 2.1]),
        other(1, [-0.5, 2.5]),
    ] {
        let error = conditions(&blocks, &format!("{CONTACT}pairing = 'nodes'")).unwrap_err();
        says(&error, "contact 'c': the sides don't match at");
        says(&error, "tags 1");
    }
}

#[test]
fn sides_that_dont_face_each_other_are_an_error() {
    let text = |a: &str, b: &str| format!("[[contact]]\nname = 'c'\nsides = ['{a}', '{b}']");
    for (a, b, expected) in [
        ("lower top", "upper top", "the sides face the same way"),
        ("lower bottom", "upper top", "no node of side a"),
        ("lower left", "upper top", "no node of side a"),
    ] {
        let error = conditions(&stack(0.5), &text(a, b)).unwrap_err();
        says(&error, expected);
    }
    let mut blocks = stack(0.0);
    let copy = blocks.mesh.groups["lower top"].clone();
    blocks.mesh.groups.insert("copy".into(), copy);
    let error = conditions(&blocks, &text("lower top", "copy")).unwrap_err();
    says(&error, "is on both sides");
}

/// A block with a crack along y = 0 from x = 0 to its tip at x = 1.
fn cracked() -> Blocks {
    let mut blocks = Blocks::new()
        .block("lower", [0.0, 2.0], [-1.0, 0.0], [4, 2])
        .block("upper", [0.0, 2.0], [0.0, 1.0], [4, 2]);
    // Weld the blocks from the tip on.
    let points = blocks.mesh.points.clone();
    let half = points.len() / 2;
    let weld = |node: u32| {
        let at = points[node as usize];
        if node as usize >= half && at[1] == 0.0 && at[0] >= 1.0 {
            points.iter().position(|p| *p == at).unwrap() as u32
        } else {
            node
        }
    };
    for e in 0..blocks.mesh.cells.len() {
        let nodes = blocks.mesh.cells.nodes_of_mut(e);
        nodes.iter_mut().for_each(|node| *node = weld(*node));
    }
    for e in 0..blocks.mesh.facets.len() {
        let nodes = blocks.mesh.facets.nodes_of_mut(e);
        nodes.iter_mut().for_each(|node| *node = weld(*node));
    }
    let on_crack = |mesh: &Mesh, facet: u32| {
        let nodes = mesh.facets.nodes_of(facet as usize);
        nodes.iter().all(|&n| mesh.points[n as usize][0] <= 1.0)
    };
    for name in ["lower top", "upper bottom"] {
        let mut group = blocks.mesh.groups[name].clone();
        group.members.retain(|&facet| on_crack(&blocks.mesh, facet));
        blocks.mesh.groups.insert(name.into(), group);
    }
    blocks
}

#[test]
fn a_crack_tip_carries_no_condition() {
    let rows = conditions(&cracked(), CONTACT).unwrap();
    let places: Vec<f64> = rows.iter().map(|row| row.position[0]).collect();
    assert_eq!(places, [0.5, 0.0]);
    assert!(
        rows.iter()
            .all(|row| row.gap == 0.0 && row.tag_a != row.tag_b)
    );
}

#[test]
fn a_normal_that_goes_through_the_crack_tip_passes_it_by() {
    // A notch below the tip: the normal of its deepest node is that of the chord between its
    // neighbours, and leads from there to the tip.
    let (tip, deepest, last) = ([1.0, 0.0], [0.5, -0.4], [0.2, 1.0]);
    let chord = [tip[0] - last[0], tip[1] - last[1]];
    let way = [tip[0] - deepest[0], tip[1] - deepest[1]];
    close(chord[0] * way[0] + chord[1] * way[1], 0.0, 1e-15);
    // On the normal of the last facet.
    let partner = [last[0] + 0.4 * 1.4, last[1] + 0.4 * 0.3];
    let mut blocks = cracked();
    let half = blocks.mesh.points.len() / 2;
    for (node, [x, y, _]) in blocks.mesh.points.iter_mut().enumerate() {
        let lower = node < half;
        let to = match (lower, *x) {
            (true, 0.5) if *y == 0.0 => deepest,
            (true, 0.0) if *y == 0.0 => last,
            (false, 0.5) => [partner[0], partner[1] + *y],
            (false, 0.0) => [0.5, 2.2 + *y],
            _ => continue,
        };
        [*x, *y] = to;
    }
    let rows = conditions(&blocks, CONTACT).unwrap();
    let ends: Vec<_> = (rows.iter())
        .flat_map(|row| &row.entries)
        .map(|&(node, _)| blocks.mesh.points[node as usize])
        .collect();
    assert_eq!(ends, [last, partner].map(|[x, y]| [x, y, 0.0]));
}

#[test]
fn facets_of_an_undoubled_crack_are_refused_with_advice() {
    let mut blocks = cracked();
    let (a, b) = (blocks.node(1.0, 0.0), blocks.node(1.5, 0.0));
    blocks.facets("glued", [a, b].into_iter());
    let error = conditions(
        &blocks,
        "[[contact]]\nname = 'c'\nsides = ['glued', 'upper top']",
    )
    .unwrap_err();
    says(&error, "side 'glued': the facet of nodes … twice");
}

#[test]
fn several_contacts_may_meet_in_one_node() {
    let blocks = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("left", [0.0, 1.0], [1.0, 2.0], [2, 2])
        .block("right", [1.0, 2.0], [1.0, 2.0], [2, 2]);
    let apart = blocks
        .model("[[contact]]\nname = '1'\nsides = ['lower top', 'left bottom']\n[[contact]]\nname = '2'\nsides = ['lower top', 'right bottom']\n[[contact]]\nname = '3'\nsides = ['left right', 'right left']")
        .unwrap();
    let counts: Vec<usize> = apart.contacts.iter().map(|c| c.points.len()).collect();
    assert_eq!(counts, [3, 3, 3]);
    let as_one = "[[contact]]\nname = 'c'\nsides = ['lower top', ['left bottom', 'right bottom']]";
    let rows = conditions(&blocks, as_one).unwrap();
    assert_eq!(rows.len(), 6);
    close(rows.iter().map(|row| row.area).sum(), 2.0, 1e-15);
    assert_eq!(rows[2].tag_a, rows[3].tag_a);
    assert_ne!(rows[2].tag_b, rows[3].tag_b);
}

#[test]
fn a_pair_that_is_prescribed_on_both_sides_carries_no_condition() {
    let text = |y: f64| {
        format!(
            "{CONTACT}[[bilateral]]\non = 'lower bottom'\n[[displacement]]\non = ['lower left', 'upper left']\nx = 0\n[[displacement]]\non = 'upper left'\ny = {y}\n[[displacement]]\non = 'lower left'\ny = 0"
        )
    };
    let rows = conditions(&stack(0.25), &text(-0.25)).unwrap();
    assert_eq!(rows.len(), 4);
    assert!(rows.iter().all(|row| row.position[0] > 0.0));
    let lost = "contact 'c': 1 of its 5 nodes are prescribed along the normal";
    for (keys, is_lost) in [("", false), ("friction = 0.5\n", true)] {
        let rough = text(-0.25).replacen("[[bilateral]]", &format!("{keys}[[bilateral]]"), 1);
        let warnings = stack(0.25).model(&rough).unwrap().warnings;
        let printed = warnings.iter().any(|warning| warning.starts_with(lost));
        assert_eq!(printed, is_lost, "{warnings:?}");
    }
    let error = conditions(&stack(0.25), &text(-0.26)).unwrap_err();
    says(&error, "contact 'c': at node … by 0.26 m");
}

#[test]
fn the_end_of_a_curved_gap_still_finds_its_partner() {
    // A quarter of a ring around a quarter of a ring, with a clearance of a thousandth.
    let ring = |[x, y, z]: [f64; 3]| {
        let angle = 0.5 * std::f64::consts::PI * x / 2.0;
        [(1.0 + y) * angle.sin(), (1.0 + y) * angle.cos(), z]
    };
    let blocks = Blocks::new()
        .block("lower", [0.0, 2.0], [-0.5, 0.0], [20, 2])
        .block("upper", [0.0, 2.0], [1e-3, 0.5], [20, 2])
        .moved(ring);
    let rows = conditions(&blocks, CONTACT).unwrap();
    assert_eq!(rows.len(), 21);
    assert!(rows.iter().all(|row| (row.gap - 1e-3).abs() < 1e-6));
}

#[test]
fn a_nodes_normal_is_the_average_weighted_by_length() {
    let blocks = stack(0.0).moved(|[x, y, z]| [x * x, y + 0.2 * x.powi(3), z]);
    let points = &blocks.mesh.points;
    let rows = conditions(&blocks, CONTACT).unwrap();
    assert_eq!(rows.len(), 5);
    // Lengths times normals of a chain of facets add up to its chord, turned.
    for (x, row) in [1.5, 1.0, 0.5].into_iter().zip(&rows[1..4]) {
        let top = |x: f64| [x * x, 1.0 + 0.2 * x.powi(3)];
        assert_eq!(points[row.entries[0].0 as usize][0], x * x);
        let (before, after) = (top(x - 0.5), top(x + 0.5));
        let chord = [after[0] - before[0], after[1] - before[1]];
        let size = chord[0].hypot(chord[1]);
        close(row.frame.normal[0], -chord[1] / size, 1e-15);
        close(row.frame.normal[1], chord[0] / size, 1e-15);
    }
}

#[test]
fn many_nodes_a_side_take_no_quadratic_time() {
    let n = 20_000;
    let blocks = Blocks::new()
        .block("lower", [0.0, 100.0], [0.0, 1.0], [n, 1])
        .block("upper", [0.0, 100.0], [1.0, 2.0], [n, 1])
        .moved(|[x, y, z]| [x, y + (0.1 * x).sin(), z]);
    let start = std::time::Instant::now();
    assert_eq!(conditions(&blocks, CONTACT).unwrap().len(), n + 1);
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}

#[test]
fn shares_end_where_the_other_side_does() {
    let blocks = Blocks::new()
        .block("lower", [0.0, 4.0], [0.0, 1.0], [8, 2])
        .block("upper", [1.0, 3.0], [1.0, 2.0], [4, 2]);
    for blocks in [blocks.clone(), blocks.quadratic()] {
        let forth = conditions(&blocks, CONTACT).unwrap();
        let turned = CONTACT.replace("'lower top', 'upper bottom'", "'upper bottom', 'lower top'");
        let back = conditions(&blocks, &turned).unwrap();
        assert_eq!(forth.len(), back.len());
        for (a, b) in forth.iter().zip(back.iter().rev()) {
            assert_eq!(a.position, b.position);
            close(a.area, b.area, 1e-15);
        }
        close(forth.iter().map(|row| row.area).sum(), 2.0, 1e-14);
    }
}
