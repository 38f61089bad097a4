//! Laws that every answer keeps: exact solutions, and what doesn't change it.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod support;

use std::collections::BTreeMap;

use contact_dd_mpi::fem::assembly::assemble;
use contact_dd_mpi::fem::block::Block;
use contact_dd_mpi::fem::dofs::Dofs;
use contact_dd_mpi::schur::local::LocalSchur;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use faer::{Par, Side};

use support::blocks::{Blocks, jittered, moved, shuffled};
use support::scenes::{
    JOINT, SUPPORTS, built_in, built_in_model, model, two_block_scene, two_blocks,
};
use support::solution::{ContactPoint, Solution};
use support::solver::{Case, problem, solve};

#[track_caller]
fn close(a: f64, b: f64, slack: f64) {
    assert!((a - b).abs() <= slack, "{a:e}; expected {b:e} ± {slack:e}");
}

/// Pressure, Young's modulus and Poisson's ratio of a uniform compression.
type Compression = [f64; 3];

/// u = −p (1+ν)(1−2ν)/E · (x − x_0).
fn compressed([p, young, poisson]: Compression, x_0: f64, x: [f64; 3]) -> [f64; 2] {
    let strain = -p * (1.0 + poisson) * (1.0 - 2.0 * poisson) / young;
    [strain * (x[0] - x_0), strain * (x[1] - x_0)]
}

/// Fails unless stress and contact pressure are those of the compression everywhere, with every
/// contact closed, all to within `slack`.
#[track_caller]
fn is_compressed(solution: &Solution, [p, _, poisson]: Compression, slack: f64) {
    for (_, stress) in &solution.cells {
        let expected = [-p, -p, -2.0 * poisson * p, 0.0, 0.0, 0.0];
        for (s, e) in stress.iter().zip(expected) {
            close(*s, e, 10.0 * slack * p);
        }
    }
    for point in solution.points() {
        close(point.pressure, p, 10.0 * slack * p);
        close(point.gap, 0.0, slack * solution.largest_displacement());
        assert!(point.closed, "{point:?}");
    }
}

#[test]
fn uniform_compression_through_an_inclined_contact_is_exact() {
    let model = built_in_model("patch", 0);
    let compression = [1e6, 20e9, 0.25];
    for count in [2, 4, 7] {
        let solution = solve(&model, count);
        is_compressed(&solution, compression, 1e-12);
        let slack = 1e-12 * solution.largest_displacement();
        for (tag, &x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            let expected = compressed(compression, 0.0, x);
            for (u, e) in solution.displacement[tag].iter().zip(expected) {
                close(*u, e, slack);
            }
        }
    }
}

/// The wedge may slide on the base and let the right block down, which costs nothing: the answer
/// has no part in that motion, the uniform compression has.
#[test]
fn three_contacts_that_meet_leave_uniform_compression_alone() {
    let model = built_in_model("junction", 0);
    let compression = [1e6, 100e6, 0.3];
    let motions = [
        ("base", [0.0, 0.0]),
        ("left block", [0.0, 0.0]),
        ("right block", [0.0, -3.0]),
        ("wedge", [5.0, -3.0]),
    ];
    for count in [4, 9] {
        let solution = solve(&model, count);
        is_compressed(&solution, compression, 1e-10);
        let slack = 1e-10 * solution.largest_displacement();
        let mut nodes: Vec<(usize, [f64; 2])> = Vec::new();
        for (body, motion) in motions {
            let cells = model.mesh.groups[body].members.iter();
            let all = cells.flat_map(|&cell| model.mesh.cells.nodes_of(cell as usize));
            nodes.extend(all.map(|&node| (node as usize, motion)));
        }
        nodes.sort_by_key(|&(node, _)| node);
        nodes.dedup_by_key(|&mut (node, _)| node);
        let u = |node: usize| solution.displacement[&model.mesh.node_tags[node]];
        let along = |f: &dyn Fn(usize) -> [f64; 2]| -> f64 {
            let terms = nodes
                .iter()
                .map(|&(node, z)| f(node)[0] * z[0] + f(node)[1] * z[1]);
            terms.sum()
        };
        let exact = |node: usize| compressed(compression, -5.0, model.mesh.points[node]);
        let length: f64 = nodes.iter().map(|(_, z)| z[0] * z[0] + z[1] * z[1]).sum();
        let part = along(&exact) / length;
        for &(node, z) in &nodes {
            for ((u, e), z) in u(node).into_iter().zip(exact(node)).zip(z) {
                close(u, e - part * z, slack);
            }
        }
        let warnings = &solution.report["warnings"];
        assert_eq!(warnings.as_array().unwrap().len(), 1, "{warnings:#}");
    }
}

/// What two runs are to agree in.
struct Likeness {
    /// Displacement of the second for one of the first.
    displacement: fn([f64; 3]) -> [f64; 3],
    /// Contact force of the second over that of the first.
    force: f64,
    /// Gap of the second over that of the first.
    gap: f64,
    /// Allowed difference relative to the largest displacement; that of forces is ten times
    /// as large.
    slack: f64,
}

const SAME: Likeness = Likeness {
    displacement: |u| u,
    force: 1.0,
    gap: 1.0,
    slack: 1e-11,
};

/// Fails unless `second` is `first` by `likeness`, by the tags of the first that `tag` gives for
/// those of the second.
#[track_caller]
fn alike(first: &Solution, second: &Solution, likeness: &Likeness, tag: impl Fn(i64) -> i64) {
    let size = second.largest_displacement();
    assert_eq!(first.displacement.len(), second.displacement.len());
    for (new, u) in &second.displacement {
        let expected = (likeness.displacement)(first.displacement[&tag(*new)]);
        for (a, b) in u.iter().zip(expected) {
            close(*a, b, likeness.slack * size);
        }
    }
    let force = second.largest_force();
    for (name, points) in &second.contacts {
        let by_tags: BTreeMap<[i64; 2], &ContactPoint> =
            (first.contacts[name].iter().map(|p| (p.tags, p))).collect();
        assert_eq!(by_tags.len(), points.len());
        for point in points {
            let other = by_tags[&point.tags.map(&tag)];
            close(point.gap, likeness.gap * other.gap, likeness.slack * size);
            let expected = likeness.force * other.force;
            close(point.force, expected, 10.0 * likeness.slack * force);
            if expected > 1e-9 * force || point.gap > 1e-9 * size {
                assert_eq!(point.closed, other.closed, "{point:?} {other:?}");
            }
        }
    }
}

/// Granite with a mesh that has no symmetry of its own.
fn rough_granite() -> (&'static str, Mesh) {
    let (text, mesh) = built_in("granite", 0);
    (text, jittered(mesh, 0.02, 3))
}

#[test]
fn a_mirrored_scene_has_the_mirrored_answer() {
    let (text, mesh) = rough_granite();
    let first = solve(&model(text, mesh.clone()), 8);
    let second = solve(&model(text, moved(mesh, |[x, y]| [-x, y])), 8);
    let mirrored = Likeness {
        displacement: |[u, v, w]| [-u, v, w],
        ..SAME
    };
    alike(&first, &second, &mirrored, |tag| tag);
}

/// An angle at which nothing is along an axis.
const TURN: f64 = 0.7;

fn turned([x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = TURN.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

const TURNED: Likeness = Likeness {
    displacement: |[u, v, w]| {
        let [u, v] = turned([u, v]);
        [u, v, w]
    },
    ..SAME
};

#[test]
fn a_turned_scene_has_the_turned_answer() {
    let (text, mesh) = rough_granite();
    let first = solve(&model(text, mesh.clone()), 8);
    let second = solve(&model(text, moved(mesh, turned)), 8);
    alike(&first, &second, &TURNED, |tag| tag);
}

#[test]
fn a_turned_scene_with_bilateral_supports_and_gaps_has_the_turned_answer() {
    let text = two_block_scene().replace(
        "[[displacement]]\non = 'upper left'\nx = 0.0",
        "[[bilateral]]\non = 'upper left'",
    );
    let mesh = moved(two_blocks().mesh, |[x, y]| match y > 1.5 {
        true => [x, y + 1e-5 * x],
        false => [x, y],
    });
    let first = solve(&model(&text, mesh.clone()), 6);
    let (sin, cos) = TURN.sin_cos();
    let text = text.replace("1.9*x", &format!("1.9*({cos}*x + {sin}*y)"));
    let second = solve(&model(&text, moved(mesh, turned)), 6);
    alike(&first, &second, &TURNED, |tag| tag);
}

#[test]
fn a_renumbered_mesh_has_the_same_answer() {
    let (text, mesh) = rough_granite();
    let first = solve(&model(text, mesh.clone()), 8);
    let (renumbered, tags) = shuffled(&mesh, 11);
    let second = solve(&model(text, renumbered), 8);
    alike(&first, &second, &SAME, |tag| tags[&tag]);
}

#[test]
fn millimetres_and_megapascals_give_the_same_answer() {
    let (text, mesh) = rough_granite();
    let first = solve(&model(text, mesh.clone()), 8);
    let text = text
        .replace("5.2e9", "5.2e3")
        .replace("0.6e7", "0.6e1")
        .replace("0.3e7", "0.3e1");
    let millimetres = moved(mesh, |[x, y]| [1e3 * x, 1e3 * y]);
    let second = solve(&model(&text, millimetres), 8);
    let scaled = Likeness {
        displacement: |u| u.map(|u| 1e3 * u),
        force: 1e-3,
        gap: 1e3,
        ..SAME
    };
    alike(&first, &second, &scaled, |tag| tag);
}

#[test]
fn sides_that_change_places_give_the_same_answer() {
    let text = two_block_scene();
    let first = solve(&model(&text, two_blocks().mesh), 6);
    let swapped = text.replace(
        "['upper bottom', 'lower top']",
        "['lower top', 'upper bottom']",
    );
    assert_ne!(text, swapped);
    let mut second = solve(&model(&swapped, two_blocks().mesh), 6);
    for point in second.contacts.values_mut().flatten() {
        point.tags.reverse();
    }
    alike(&first, &second, &SAME, |tag| tag);
}

#[test]
fn a_contact_that_is_far_away_changes_nothing() {
    let text = two_block_scene();
    let first = solve(&model(&text, two_blocks().mesh), 6);
    for distance in ["1e2", "1e6"] {
        let text = format!(
            "{text}
            [[contact]]
            name = 'far away'
            sides = ['lower right']
            obstacle = {{ point = [{distance}, 0.0], normal = [-1.0, 0.0] }}"
        );
        let mut second = solve(&model(&text, two_blocks().mesh), 6);
        let far = second.contacts.remove("far away").unwrap();
        assert!(far.iter().all(|point| !point.closed && point.force == 0.0));
        alike(&first, &second, &SAME, |tag| tag);
    }
}

#[test]
fn the_number_of_subdomains_does_not_change_the_answer() {
    let model = built_in_model("granite", 0);
    let first = solve(&model, 8);
    for count in [1, 2, 5, 20] {
        alike(&first, &solve(&model, count), &SAME, |tag| tag);
    }
}

/// Soft layers on both sides of a joint between stiff blocks, each layer a subdomain.
fn soft_layers() -> Model {
    let mesh = Blocks::new()
        .rectangle("base", [0.0, 2.0], [0.0, 1.0], [16, 6])
        .rectangle("lower layer", [0.0, 2.0], [1.0, 1.5], [16, 4])
        .glued(|_, y| y == 1.0)
        .mesh;
    let upper = Blocks::new()
        .rectangle("upper layer", [0.0, 2.0], [1.5, 2.0], [16, 4])
        .rectangle("head", [0.0, 2.0], [2.0, 3.0], [16, 6])
        .glued(|_, y| y == 2.0)
        .mesh;
    let text = "
        plane = 'strain'
        subdomains = ['base', 'lower layer', 'upper layer', 'head']
        materials.stiff = {young = 20e9, poisson = 0.25}
        materials.soft = {young = 0.2e9, poisson = 0.25}
        bodies.base.material = 'stiff'
        bodies.head.material = 'stiff'
        bodies.'lower layer'.material = 'soft'
        bodies.'upper layer'.material = 'soft'
        [[displacement]]
        on = 'base bottom'
        x = 0.0
        y = 0.0
        [[displacement]]
        on = 'head top'
        x = 0.0
        y = '-1e-3*(1.2 - x)'
        [[contact]]
        name = 'joint'
        sides = ['lower layer top', 'upper layer bottom']";
    model(text, support::blocks::joined(mesh, upper))
}

#[test]
fn all_methods_find_the_same_answer_between_soft_layers() {
    let case = Case::new(&problem(&soft_layers(), None));
    let first = case.solve(&["--tolerance", "1e-13"]);
    let closed = first.closed();
    assert!(0 < closed && closed < 17, "{closed}");
    let methods: [&[&str]; 3] = [
        &["--method", "anderson"],
        &["--method", "picard"],
        &["--method", "picard", "--relaxation", "1"],
    ];
    for method in methods {
        let second = case.solve(&[&["--tolerance", "1e-13"], method].concat());
        assert!(second.sweeps() > first.sweeps());
        alike(&first, &second, &SAME, |tag| tag);
    }
}

#[test]
fn newton_and_anderson_find_the_same_answer_on_granite() {
    let case = Case::of(&built_in_model("granite", 0), 8);
    let first = case.solve(&[]);
    let second = case.solve(&["--method", "anderson", "--tolerance", "1e-13"]);
    alike(&first, &second, &SAME, |tag| tag);
}

#[test]
fn newton_needs_few_sweeps_whatever_the_mesh_and_the_partition() {
    for (refine, counts) in [(0, &[8, 16, 32][..]), (1, &[8])] {
        let model = built_in_model("granite", refine);
        for &count in counts {
            let sweeps = solve(&model, count).sweeps();
            assert!(sweeps <= 5, "{sweeps} sweeps at {refine}, {count}");
        }
    }
}

#[test]
fn a_schur_complement_is_symmetric_and_rigid_motions_cost_nothing() {
    let model = built_in_model("granite", 0);
    let problem = problem(&model, Some(20));
    let mut floating = 0;
    for (subdomain, summary) in problem.subdomains.iter().zip(&problem.catalog.subdomains) {
        if summary.group.is_some() {
            continue;
        }
        let is_held = !subdomain.supports.is_empty();
        let block = Block::new(vec![subdomain.clone()], 2, |_| true);
        let dofs = Dofs::new(&block, &[]).unwrap();
        let system = assemble(&block, &dofs, &model.materials, &[]).unwrap();
        let schur = LocalSchur::new(&system, dofs.interior, Par::Seq).unwrap();
        let s = &schur.s;
        let largest = s.norm_max();
        assert!((s - s.transpose()).norm_max() == 0.0);
        let eigenvalues = s.self_adjoint_eigenvalues(Side::Lower).unwrap();
        assert!(eigenvalues[0] >= -1e-13 * largest, "{:e}", eigenvalues[0]);
        let zeros = eigenvalues.iter().filter(|&&e| e < 1e-9 * largest).count();
        assert_eq!(zeros, if is_held { 0 } else { 3 });
        if is_held {
            continue;
        }
        floating += 1;
        let motions: [fn([f64; 3]) -> [f64; 2]; 3] =
            [|_| [1.0, 0.0], |_| [0.0, 1.0], |x| [-x[1], x[0]]];
        for motion in motions {
            let value = |i: usize| {
                let trace = dofs.traces[i];
                let on = subdomain.interface.iter();
                let node = on.clone().find(|on| on.interface == trace.node).unwrap();
                motion(subdomain.points[node.node as usize])[trace.axis as usize]
            };
            for row in 0..s.nrows() {
                let terms = (0..s.ncols()).map(|j| s[(row, j)] * value(j));
                let scale: f64 = terms.clone().map(f64::abs).sum();
                close(terms.sum(), 0.0, 1e-12 * scale);
            }
        }
    }
    assert!(floating > 0);
}

/// A plate with a crack from (−1, 0) to (1, 0) of `cells` cells, graded away from it.
fn cracked_plate(cells: usize) -> Mesh {
    const HALF: f64 = 20.0;
    let graded = |t: f64| (HALF - 1.0) * (0.15 * t + 0.85 * t.powi(3));
    let x = |column: &str, s: f64| match column {
        "left" => -1.0 - graded(1.0 - s),
        "middle" => 2.0 * s - 1.0,
        _ => 1.0 + graded(s),
    };
    let mut blocks = Blocks::new();
    for (column, n) in [("left", cells / 2), ("middle", cells), ("right", cells / 2)] {
        let up = |t: f64| HALF * (0.05 * t + 0.95 * t.powi(3));
        blocks = blocks
            .mapped(&format!("{column} below"), [n, cells], |[s, t]| {
                [x(column, s), -up(1.0 - t)]
            })
            .mapped(&format!("{column} above"), [n, cells], |[s, t]| {
                [x(column, s), up(t)]
            });
    }
    blocks.glued(|x, y| y != 0.0 || x.abs() > 1.0 - 1e-9).mesh
}

/// Largest slip over the exact one, and largest error of the pressure over the exact one.
fn closed_crack(cells: usize) -> [f64; 2] {
    let (young, poisson, load, psi) = (25e9, 0.25, 100e6, 20_f64.to_radians());
    let (sin, cos) = psi.sin_cos();
    let stress = [-cos * cos, -sin * sin, -sin * cos].map(|s| load * s);
    let [xx, yy, xy] = stress;
    let sides = |side: &str, names: [&str; 3]| {
        let list: Vec<String> = names.iter().map(|n| format!("'{n} {side}'")).collect();
        list.join(", ")
    };
    let bodies = ["left", "middle", "right"]
        .map(|c| format!("bodies.'{c} below'.material = 'm'\nbodies.'{c} above'.material = 'm'\n"))
        .concat();
    let across = ["left", "middle", "right"];
    let text = format!(
        "plane = 'strain'
        materials.m = {{young = {young}, poisson = {poisson}}}
        {bodies}
        [[traction]]
        on = ['right below right', 'right above right']
        value = [{xx}, {xy}]
        [[traction]]
        on = ['left below left', 'left above left']
        value = [{}, {}]
        [[traction]]
        on = [{}]
        value = [{xy}, {yy}]
        [[traction]]
        on = [{}]
        value = [{}, {}]
        [[contact]]
        name = 'crack'
        sides = ['middle above bottom', 'middle below top']",
        -xx,
        -xy,
        sides("above top", across),
        sides("below bottom", across),
        -xy,
        -yy,
    );
    let solution = solve(&model(&text, cracked_plate(cells)), 6);
    let exact = 4.0 * (1.0 - poisson * poisson) / young * load * sin * cos;
    let pressure = load * sin * sin;
    close(exact, 4.8209e-3, 1e-7);
    close(pressure, 11.698e6, 1e3);
    let points = &solution.contacts["crack"];
    assert_eq!(points.len(), cells - 1);
    let mut slip = 0.0_f64;
    let mut error = 0.0_f64;
    for point in points {
        assert!(point.closed);
        let [a, b] = point.tags.map(|tag| solution.displacement[&tag][0]);
        slip = slip.max((a - b).abs());
        error = error.max((point.pressure / pressure - 1.0).abs());
    }
    [slip / exact, error]
}

#[test]
fn a_closed_inclined_crack_slips_as_the_formula_says() {
    let errors = [12, 24, 48].map(|cells| {
        let [slip, pressure] = closed_crack(cells);
        assert!(pressure < 1e-9, "{pressure}");
        (slip - 1.0).abs()
    });
    assert!(errors[1] < 0.6 * errors[0], "{errors:?}");
    assert!(errors[2] < 0.6 * errors[1], "{errors:?}");
    assert!(errors[2] < 0.03, "{errors:?}");
}

#[test]
fn blocks_held_by_contact_alone_carry_their_weight() {
    let model = built_in_model("stack", 0);
    for count in [4, 6, 11] {
        let solution = solve(&model, count);
        let warnings = solution.report["warnings"].to_string();
        assert!(warnings.contains("middle block") || warnings.contains("upper block"));
        for (name, load) in [
            ("upper joint", 25e3 * 2.0 + 2e6),
            ("lower joint", 25e3 * 5.0 + 2e6),
        ] {
            let forces = solution.contacts[name].iter().map(|p| p.force);
            close(forces.sum(), load, 1e-11 * load);
        }
    }
}

#[test]
fn reactions_of_a_joint_are_its_load() {
    let text = format!(
        "{}{SUPPORTS}
        [[traction]]
        on = 'upper top'
        value = ['0', '-1e6*x^2']
        {JOINT}",
        support::scenes::BODIES
    );
    let solution = solve(&model(&text, two_blocks().mesh), 5);
    let load = 1e6 / 3.0 * (1.5_f64.powi(3) - 0.5_f64.powi(3));
    close(solution.points().map(|p| p.force).sum(), load, 1e-12 * load);
}
