//! Places where bodies touch, and where they only seem to.

use super::*;

#[test]
fn a_corner_parts_contacts() {
    // A block in a corner of two others, which are one body.
    let blocks = Blocks::new()
        .block("floor", [0.0, 3.0], [0.0, 1.0], [6, 2])
        .block("wall", [0.0, 1.0], [1.0, 3.0], [2, 4])
        .block("block", [1.0, 2.0], [1.0, 2.0], [2, 2]);
    let between = |bodies: &str| ALL.replace("'all'", bodies);
    let model = blocks
        .model(&between("['wall', 'floor', 'block']"))
        .unwrap();
    let expected = [
        "joints block-floor",
        "joints block-wall",
        "joints floor-wall",
    ];
    assert_eq!(names(&model), expected);
    let mut mesh = blocks.mesh;
    let wall = mesh.groups.remove("wall").unwrap();
    let floor = mesh.groups.get_mut("floor").unwrap();
    floor.members.extend(wall.members);
    floor.members.sort_unstable();
    let glued = Blocks { mesh };
    let model = glued.model(&between("['floor', 'block']")).unwrap();
    assert_eq!(
        names(&model),
        ["joints block-floor 1", "joints block-floor 2"]
    );
    assert_eq!(model.contacts[0].points.len(), 3);
    assert!(
        model
            .warnings
            .iter()
            .any(|text| text.contains("'floor' touches itself"))
    );
}

#[test]
fn bodies_that_touch_at_a_point_have_no_contact() {
    let blocks = Blocks::new()
        .block("lower", [0.0, 1.0], [0.0, 1.0], [2, 2])
        .block("upper", [1.0, 2.0], [1.0, 2.0], [2, 2]);
    let error = blocks.model(ALL).unwrap_err();
    says(
        &error,
        "contact 'joints': no facets … 'lower' and 'upper' touch at a point or an edge only",
    );
    // Rotated by 20°, so that only a corner touches the top of the other block.
    let mut tipped = Blocks::new()
        .block("lower", [-2.0, 2.0], [-1.0, 0.0], [4, 2])
        .block("upper", [0.0, 1.0], [0.0, 1.0], [2, 2]);
    let (sine, cosine) = 0.35_f64.sin_cos();
    for x in tipped.mesh.points.iter_mut().skip(15) {
        let [a, b, z] = *x;
        *x = [cosine * a - sine * b, sine * a + cosine * b, z];
    }
    let error = tipped.model(ALL).unwrap_err();
    says(
        &error,
        "no facets face each other within 0.05 of their size",
    );
    let near = tipped.model(&format!("{ALL}within = 0.2")).unwrap();
    assert_eq!(near.contacts.len(), 1);
}

/// A block whose lower and upper halves are bodies that share the nodes between them, as fragments of a geometry do.
fn fragments() -> Blocks {
    let mut blocks = Blocks::new().block("lower", [0.0, 1.0], [0.0, 2.0], [2, 4]);
    let upper = blocks.mesh.groups["lower"].members.clone();
    let (lower, upper) = upper.split_at(8);
    for (name, members) in [("lower", lower), ("upper", upper)] {
        let (dim, members) = (2, members.to_vec());
        blocks
            .mesh
            .groups
            .insert(name.into(), Group { dim, members });
    }
    blocks
}

#[test]
fn bodies_that_share_nodes_are_tied_and_that_is_said() {
    let tied = "contact 'joints': … 'lower' and 'upper' share the nodes of 2 facets and are tied there; expected \
                … mesh each by itself, in Gmsh without BooleanFragments";
    says(&fragments().model(ALL).unwrap_err(), tied);
    let named = ALL.replace("'all'", "['lower', 'upper']");
    says(&fragments().model(&named).unwrap_err(), tied);
    // If only other bodies touch, bodies that share nodes are still bonded, with a warning.
    let more = fragments().block("lid", [0.0, 1.0], [2.0, 3.0], [2, 2]);
    let model = more.model(ALL).unwrap();
    assert_eq!(names(&model), ["joints"]);
    says(&model.warnings.join("\n"), tied);
    let named = ALL.replace("'all'", "['lid', 'upper']");
    let model = more.model(&named).unwrap();
    assert!(!model.warnings.join("\n").contains("tied"));
}

#[test]
fn what_is_apart_is_said_with_the_distance() {
    let error = stack(0.5).model(ALL).unwrap_err();
    says(
        &error,
        "contact 'joints': no facets … the nearest nodes, of 'lower' and 'upper', are 0.5 m apart; expected",
    );
    let shifted = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("upper", [0.2, 2.2], [1.1, 2.0], [4, 2]);
    let error = shifted.model(ALL).unwrap_err();
    says(&error, "the nearest that face each other are 0.1 m apart");
    let near = stack(0.5).model(&format!("{ALL}within = 0.51")).unwrap();
    are_same(
        &near,
        &stack(0.5)
            .model("[[contact]]\nname = 'c'\nsides = ['lower top', 'upper bottom']\n")
            .unwrap(),
    );
    let error = stack(0.5)
        .model(&format!("{ALL}within = 0.49"))
        .unwrap_err();
    says(&error, "within 0.49 m");
    let itself = ALL.replace("'all'", "'lower'");
    let error = stack(0.0).model(&itself).unwrap_err();
    says(
        &error,
        "within 0.05 of their size between its bodies; expected",
    );
}

#[test]
fn a_plate_does_not_touch_itself_and_keeps_others_apart() {
    let plates = |thickness: f64| {
        Blocks::new()
            .block("lower", [0.0, 4.0], [-1.0, 0.0], [4, 2])
            .block("plate", [0.0, 4.0], [0.0, thickness], [4, 1])
            .block("upper", [0.0, 4.0], [thickness, 1.0], [4, 2])
    };
    for thickness in [0.3, 0.01, 1e-4] {
        for within in ["", "within = 0.5\n"] {
            let model = plates(thickness).model(&format!("{ALL}{within}")).unwrap();
            assert_eq!(names(&model), ["joints lower-plate", "joints plate-upper"]);
            assert_eq!(model.contacts[0].points.len(), 5);
        }
    }
    // Two free plates on each other: their outer sides face each other through both.
    let two = Blocks::new()
        .block("first", [0.0, 4.0], [0.0, 0.02], [4, 1])
        .block("second", [0.0, 4.0], [0.02, 0.04], [4, 1]);
    let model = two.model(ALL).unwrap();
    assert_eq!(
        model.found,
        ["joints: 4 facets of 'first' on 4 of 'second', 4 m"]
    );
}

#[test]
fn a_wedge_keeps_its_neighbours_apart() {
    let turned = |x: [f64; 3], angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        [
            cosine * x[0] - sine * x[1],
            sine * x[0] + cosine * x[1],
            x[2],
        ]
    };
    // Squares of the unit square around the origin as sectors of 10° and 85°.
    let sectors = [
        ("below", -85.0, 0.0),
        ("wedge", 0.0, 10.0),
        ("above", 10.0, 95.0),
    ];
    let mut blocks = Blocks::new();
    for (i, (name, ..)) in sectors.into_iter().enumerate() {
        let x = 10.0 * i as f64;
        blocks = blocks.block(name, [x, x + 1.0], [0.0, 1.0], [3, 3]);
    }
    let blocks = blocks.moved(|[x, y, z]| {
        let (_, from, to) = sectors[(x / 10.0) as usize];
        let (s, t) = (x % 10.0, y);
        let angle = f64::to_radians(from + (to - from) * t);
        turned([0.5 + s, 0.0, z], angle)
    });
    // The neighbours' sides are 0.3 m apart at the far end.
    for within in ["", "within = 0.3\n"] {
        let model = blocks.model(&format!("{ALL}{within}")).unwrap();
        let expected = ["joints above-wedge", "joints below-wedge"];
        assert_eq!(names(&model), expected);
        assert_eq!(model.warnings, Vec::<String>::new());
    }
}

#[test]
fn a_plate_however_thin_keeps_its_faces_apart() {
    for (height, layers) in [(1.0, 1), (1.0, 2), (30.0, 3), (1e-3, 1)] {
        let wide = 1e6;
        let plate = Blocks::new()
            .block("plate", [0.0, wide], [0.0, height], [1, layers])
            .block("upper", [0.0, wide], [height, 2.0 * wide], [1, 1]);
        let model = plate.model(ALL).unwrap();
        assert_eq!(names(&model), ["joints"], "{height} {layers}");
        says(&model.found[0], "1 facet of 'plate' on 1 of 'upper'");
    }
}

#[test]
fn a_clearance_goes_on_between_smaller_facets() {
    let graded = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [8, 2])
        .block("upper", [0.0, 2.0], [1.0, 2.0], [8, 2])
        .moved(|[x, y, z]| [if x < 1.0 { 3.2 * x } else { 2.4 + 0.8 * x }, y, z]);
    let mut graded = graded;
    let first = graded.mesh.points.len() / 2;
    (graded.mesh.points[first..].iter_mut()).for_each(|x| x[1] += 0.03);
    let model = graded.model(ALL).unwrap();
    says(
        &model.found[0],
        "8 facets of 'lower' on 8 of 'upper', 4 m, gap up to 0.03 m",
    );
    assert_eq!(model.warnings, Vec::<String>::new());
}

#[test]
fn a_gap_that_opens_slowly_is_warned_of() {
    let round = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [16, 8])
        .block("upper", [0.0, 2.0], [1.0, 2.0], [16, 8]);
    let mut round = round;
    let first = round.mesh.points.len() / 2;
    for x in &mut round.mesh.points[first..] {
        x[1] += 0.1 * (x[0] - 1.0).powi(2);
    }
    let model = round.model(ALL).unwrap();
    says(
        &model.warnings[0],
        "contact 'joints': beyond its end, as near node … the gap opens slowly, to … in the middle of the next facets; ",
    );
    says(&model.found[0], ", gap up to");
    let all = round.model(&format!("{ALL}within = 0.11")).unwrap();
    assert_eq!((all.warnings.len(), all.contacts[0].points.len()), (0, 17));
}

#[test]
fn a_flank_is_warned_of_up_to_the_slope_that_small_strains_close() {
    for (slope, is_said) in [(0.15, true), (0.25, false), (0.45, false)] {
        for cells in [8, 32] {
            let mut punch = Blocks::new()
                .block("lower", [0.0, 4.0], [0.0, 1.0], [cells, 2])
                .block("upper", [0.0, 4.0], [1.0, 2.0], [cells, 2]);
            let first = punch.mesh.points.len() / 2;
            for x in &mut punch.mesh.points[first..] {
                x[1] += slope * (x[0] - 2.0).max(0.0);
            }
            let warnings = punch.model(ALL).unwrap().warnings.concat();
            let found = warnings.contains("opens slowly");
            assert_eq!(found, is_said, "{slope} {cells}: {warnings}");
        }
    }
}

#[test]
fn the_coarser_of_curved_sides_is_first_whatever_the_name() {
    let mut round = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [40, 8])
        .block("upper", [0.0, 2.0], [1.0, 2.0], [16, 8])
        .block("zero", [0.0, 2.0], [-1.0, 0.0], [40, 8]);
    for x in &mut round.mesh.points[41 * 9..][..17 * 9] {
        x[1] += 0.1 * (x[0] - 1.0).powi(2);
    }
    let model = round.model(&format!("{ALL}within = 0.11")).unwrap();
    assert_eq!(names(&model), ["joints lower-upper", "joints lower-zero"]);
    says(&model.found[0], "16 facets of 'upper' on 40 of 'lower'");
    // Side a can't see where curves touch as early as the finer side does.
    let points = &model.contacts[0].points;
    assert_eq!((points.len(), points[0].tag_a), (41, -1));
}

#[test]
fn what_is_held_on_both_sides_is_left_out() {
    let held = "[[displacement]]\non = ['left right', 'right left']\nx = 0\ny = 0\n";
    let model = uneven().model(&format!("{held}{ALL}")).unwrap();
    assert_eq!(names(&model), ["joints left-upper"]);
    says(
        &model.warnings[0],
        "contact 'joints left-right': all its nodes are prescribed; it has no condition",
    );
    let one = "[[displacement]]\non = 'right left'\nx = 0\ny = 0\n";
    let model = uneven().model(&format!("{one}{ALL}")).unwrap();
    assert_eq!(names(&model), ["joints left-right", "joints left-upper"]);
    let rollers = "[[bilateral]]\non = ['left right', 'right left']\n";
    let model = uneven().model(&format!("{rollers}{ALL}")).unwrap();
    assert_eq!(names(&model), ["joints left-upper"]);
}

#[test]
fn a_crack_of_one_facet_cannot_open() {
    // Two blocks that share all nodes but one where they meet, or none but the ends of one facet.
    let joined = |parted: &[f64]| {
        let mut blocks = stack(0.0);
        let mesh = &mut blocks.mesh;
        let place = |p: &[f64; 3]| (p[1] == 1.0 && !parted.contains(&p[0])).then(|| p[0]);
        let half = mesh.points.len() / 2;
        for twin in half..mesh.points.len() {
            let Some(x) = place(&mesh.points[twin]) else {
                continue;
            };
            let other = mesh.points[..half]
                .iter()
                .position(|p| place(p) == Some(x))
                .unwrap();
            for e in 0..mesh.cells.len() {
                let nodes = mesh.cells.nodes_of_mut(e).iter_mut();
                nodes
                    .filter(|n| **n == twin as u32)
                    .for_each(|n| *n = other as u32);
            }
        }
        mesh.facets = Default::default();
        mesh.groups.retain(|_, group| group.dim == 2);
        Blocks {
            mesh: as_one_body(blocks.mesh),
        }
    };
    let model = joined(&[1.0]).model(ALL).unwrap();
    assert_eq!(model.found[0], "joints: 2 on 2 facets of 'rock', 1 m");
    assert_eq!(model.contacts[0].points.len(), 1);
    let error = joined(&[]).model(ALL).unwrap_err();
    says(&error, "contact 'joints': no facets face each other");
}

#[test]
fn names_are_those_of_groups_and_taken_once() {
    let blocks = Blocks::new()
        .block("a/b", [0.0, 1.0], [0.0, 1.0], [2, 2])
        .block("c", [1.0, 2.0], [0.0, 1.0], [2, 2])
        .block("d", [0.0, 1.0], [1.0, 2.0], [2, 2]);
    let given = "[[contact]]\nname = 'joints a-b-c'\nsides = ['c top']
        obstacle = {point = [0, 1], normal = [0, -1]}\n";
    let model = blocks.model(&format!("{given}{ALL}")).unwrap();
    assert_eq!(
        names(&model),
        ["joints a-b-c", "joints a-b-c (2)", "joints a-b-d"]
    );
}
