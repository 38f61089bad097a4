//! Laws of every solution: invariances, and costs.

use std::collections::BTreeMap;

use clap::ValueEnum;
use contact_dd_mpi::fem::assembly::assemble;
use contact_dd_mpi::fem::block::Block;
use contact_dd_mpi::fem::dofs::Dofs;
use contact_dd_mpi::fem::load::BlockLoads;
use contact_dd_mpi::schur::local::LocalSchur;
use contact_dd_mpi::sweep::Method;
use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use faer::{Mat, Par, Side};

use crate::support::blocks::{Blocks, jittered, joined, moved};
use crate::support::close::close;
use crate::support::scenes::{built_in, built_in_model, model, two_block_scene, two_blocks};
use crate::support::solution::{ContactPoint, Solution};
use crate::support::solver::{Case, problem, solve};

/// Factors between the numbers of two runs.
struct Likeness {
    /// Contact force of the second over that of the first.
    force: f64,
    /// Displacement and gap of the second over those of the first.
    length: f64,
}

const SAME: Likeness = Likeness {
    force: 1.0,
    length: 1.0,
};

/// Allowed difference relative to the largest displacement; for forces it is ten times as large.
const SLACK: f64 = 1e-11;

/// Fails unless `second` is `first` scaled by `likeness`.
#[track_caller]
fn alike(first: &Solution, second: &Solution, likeness: &Likeness) {
    let size = second.largest_displacement();
    assert_eq!(first.displacement.len(), second.displacement.len());
    for (new, u) in &second.displacement {
        for (a, b) in u.iter().zip(first.displacement[new]) {
            close(*a, likeness.length * b, SLACK * size);
        }
    }
    let force = second.largest_force();
    for (name, points) in &second.contacts {
        let by_tags: BTreeMap<[i64; 2], &ContactPoint> =
            (first.contacts[name].iter().map(|p| (p.tags, p))).collect();
        assert_eq!(by_tags.len(), points.len());
        for point in points {
            let other = by_tags[&point.tags];
            close(point.gap, likeness.length * other.gap, SLACK * size);
            let expected = likeness.force * other.force;
            close(point.force, expected, 10.0 * SLACK * force);
            if expected > 1e-9 * force || point.gap > 1e-9 * size {
                assert_eq!(point.closed, other.closed, "{point:?} {other:?}");
            }
        }
    }
}

/// Granite with a mesh without symmetry.
fn rough_granite() -> (&'static str, Mesh) {
    let (text, mesh) = built_in("granite", 0);
    (text, jittered(mesh, 0.02, 3))
}

#[test]
fn units_do_not_change_the_answer() {
    let (text, mesh) = rough_granite();
    let first = solve(&model(text, mesh.clone()), 8);
    // Millimetres and megapascals, micrometres and gigapascals.
    for (length, stress) in [(1e3, 1e-6), (1e6, 1e-9)] {
        let number = |pascal: f64| format!("{:e}", stress * pascal);
        let text = text
            .replace("5.2e9", &number(5.2e9))
            .replace("0.6e7", &number(0.6e7))
            .replace("0.3e7", &number(0.3e7));
        let scaled = moved(mesh.clone(), |[x, y]| [length * x, length * y]);
        let second = solve(&model(&text, scaled), 8);
        let likeness = Likeness {
            force: length * stress,
            length,
        };
        alike(&first, &second, &likeness);
        assert_eq!(first.sweeps(), second.sweeps());
    }
}

#[test]
fn loads_of_any_size_give_the_same_answer() {
    let (text, mesh) = rough_granite();
    let first = solve(&model(text, mesh.clone()), 8);
    for exponent in [-100, 100] {
        let larger = |load: &str, e: i32| format!("{load}e{}", e + exponent);
        let text = text
            .replace("0.6e7", &larger("0.6", 7))
            .replace("0.3e7", &larger("0.3", 7));
        let text = format!("large_strains = true\n{text}");
        let second = solve(&model(&text, mesh.clone()), 8);
        let factor = 10f64.powi(exponent);
        let likeness = Likeness {
            force: factor,
            length: factor,
        };
        alike(&first, &second, &likeness);
        assert_eq!(first.sweeps(), second.sweeps());
    }
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
    alike(&first, &second, &SAME);
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
        alike(&first, &second, &SAME);
    }
}

#[test]
fn the_number_of_subdomains_does_not_change_the_answer() {
    let model = built_in_model("granite", 0);
    let first = solve(&model, 8);
    for count in [1, 2, 5, 20] {
        alike(&first, &solve(&model, count), &SAME);
    }
}

/// Compliant layers on both sides of a joint between stiff blocks, each layer a subdomain.
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
    model(text, joined(mesh, upper))
}

#[test]
fn all_methods_find_the_same_answer_between_soft_layers() {
    let case = Case::new(&problem(&soft_layers(), None));
    let first = case.solve(&["--tolerance", "1e-13"]);
    let closed = first.closed();
    assert!(0 < closed && closed < 17, "{closed}");
    let others = (Method::value_variants().iter())
        .filter(|&&method| method != Method::Newton)
        .map(|method| vec!["--method", method.name()]);
    let literal = vec!["--method", "picard", "--relaxation", "1"];
    for method in others.chain([literal]) {
        let second = case.solve(&[&["--tolerance", "1e-13"], &method[..]].concat());
        assert!(second.sweeps() > first.sweeps());
        alike(&first, &second, &SAME);
    }
}

#[test]
fn newton_and_anderson_find_the_same_answer_on_granite() {
    let case = Case::of(&built_in_model("granite", 0), 8);
    let first = case.solve(&[]);
    let second = case.solve(&["--method", "anderson", "--tolerance", "1e-13"]);
    alike(&first, &second, &SAME);
}

#[test]
fn newton_needs_one_sweep_whatever_the_mesh_and_the_partition() {
    for (refine, counts) in [(0, &[8, 16, 32][..]), (1, &[8])] {
        let model = built_in_model("granite", refine);
        for &count in counts {
            let sweeps = solve(&model, count).sweeps();
            assert_eq!(sweeps, 1, "at {refine}, {count}");
        }
    }
}

#[test]
fn a_schur_complement_is_positive_and_rigid_motions_cost_nothing() {
    let model = built_in_model("granite", 0);
    let problem = problem(&model, Some(20));
    let mut floating = 0;
    for (subdomain, summary) in problem.subdomains.iter().zip(&problem.catalog.subdomains) {
        if summary.group.is_some() {
            continue;
        }
        let is_held = !subdomain.supports.is_empty();
        let block = Block::new(subdomain.clone(), &Tree::default(), 2);
        let dofs = Dofs::new(&block, &BlockLoads::new(&block, 0)).unwrap();
        let (stiffness, _) = assemble(&block, &dofs, &model.materials, &[]).unwrap();
        let (_, lower) = LocalSchur::new(&stiffness, dofs.interior, Par::Seq).unwrap();
        let s = Mat::from_fn(lower.nrows(), lower.nrows(), |i, j| {
            lower[(i.max(j), i.min(j))]
        });
        let largest = s.norm_max();
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
                let trace = dofs.interface_dofs[i];
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
