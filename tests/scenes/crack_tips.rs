//! Stress intensity factors of crack tips.

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, moved};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};
use crate::support::sorts::sort;
use crate::support::validation::gather;

/// Pressure on faces, or tension far away (Pa).
const LOAD: f64 = 1e7;

/// A plate of 6 m × 6 m with a crack of `length` along x from its left side, in cells of a kind, refined by the factor
/// `finer`.
pub fn plate(length: f64, cells: &str, finer: usize) -> Mesh {
    let graded = |s: f64| s.powi(3);
    let x = move |column: &str, s: f64| match column {
        "crack" => length * (1.0 - graded(1.0 - s)),
        _ => length + (6.0 - length) * graded(s),
    };
    let mut blocks = Blocks::new();
    for column in ["crack", "rest"] {
        blocks = blocks
            .mapped(
                &format!("{column} below"),
                [8 * finer, 6 * finer],
                |[s, t]| [x(column, s), -3.0 * graded(1.0 - t)],
            )
            .mapped(
                &format!("{column} above"),
                [8 * finer, 6 * finer],
                |[s, t]| [x(column, s), 3.0 * graded(t)],
            );
    }
    let blocks = blocks.glued(|x, y| y != 0.0 || x > length - 1e-9);
    let mut mesh = sort(cells).of(&blocks.mesh);
    let pieces = ["crack below", "crack above", "rest below", "rest above"];
    gather(&mut mesh, "plate", &pieces);
    mesh
}

const ISOTROPIC: &str = "{young = 25e9, poisson = 0.25}";
const ORTHOTROPIC: &str = "{stiffness = [[90e9, 8e9, 2e9], [8e9, 30e9, -1e9], [2e9, -1e9, 9e9]], out_of_plane = [5e9, 5e9, 0]}";

/// The plate with a material and loads.
fn loaded(mesh: Mesh, material: &str, loads: &str) -> Model {
    let text = format!(
        "plane = 'strain'
        materials.rock = {material}
        bodies.plate.material = 'rock'
        [[contact]]
        name = 'crack'
        sides = ['crack below top', 'crack above bottom']
        gap = 0
        {loads}"
    );
    model(&text, mesh)
}

fn pressure(on: &str, value: f64) -> String {
    format!("[[pressure]]\non = [{on}]\nvalue = {value:e}\n")
}

const FACES: &str = "'crack below top', 'crack above bottom'";
const FAR: &str = "'crack below bottom', 'rest below bottom', 'crack above top', 'rest above top'";

/// The stress intensity factors of the single tip.
fn factors(solution: &Solution) -> [f64; 2] {
    let tips = solution.stress_intensity();
    assert_eq!(tips.len(), 1);
    tips[0]
}

/// The two differ by the uniform stress of the uncracked plate.
#[test]
fn pressure_on_the_faces_does_what_tension_far_away_does() {
    for material in [ISOTROPIC, ORTHOTROPIC] {
        for (cells, slack) in [("quad4", 5e-3), ("triangle6", 1e-3)] {
            let solved =
                |loads: &str| factors(&solve(&loaded(plate(3.0, cells, 1), material, loads), 4));
            let [inside, outside] = [
                solved(&pressure(FACES, LOAD)),
                solved(&pressure(FAR, -LOAD)),
            ];
            let size = outside[0].hypot(outside[1]);
            for (one, other) in inside.into_iter().zip(outside) {
                close(one, other, slack * size);
            }
        }
    }
}

/// The strain energy (J/m).
fn strain_energy(solution: &Solution) -> f64 {
    let norm = solution.report["error_estimate"]["energy_norm"].as_f64();
    0.5 * norm.unwrap().powi(2)
}

#[test]
fn the_energy_that_is_released_is_that_by_which_the_potential_falls() {
    for (material, cells, slack) in [
        (ISOTROPIC, "triangle6", 2e-3),
        (ORTHOTROPIC, "triangle6", 2e-3),
        (ISOTROPIC, "quad4", 1e-2),
    ] {
        let off = |finer: usize| {
            let at = |length: f64| {
                let loads = pressure(FAR, -LOAD);
                solve(&loaded(plate(length, cells, finer), material, &loads), 4)
            };
            let rate = &at(3.0).report["crack_tips"][0]["energy_release_rate"];
            // Constant loads do twice the work of the released energy.
            let released = (strain_energy(&at(3.02)) - strain_energy(&at(2.98))) / 0.04;
            (rate.as_f64().unwrap() / released - 1.0).abs()
        };
        let [coarse, fine] = [1, 2].map(off);
        assert!(
            fine < slack && fine < 0.7 * coarse,
            "{cells}: {coarse:e}, {fine:e}"
        );
    }
}

/// Shear of this size on all sides of the plate, which is rotated so that x points in the direction (c, s).
fn shear(size: f64, [c, s]: [f64; 2]) -> String {
    let sides = [
        ("'crack above top', 'rest above top'", [c, s]),
        ("'crack below bottom', 'rest below bottom'", [-c, -s]),
        ("'rest below right', 'rest above right'", [-s, c]),
        ("'crack below left', 'crack above left'", [s, -c]),
    ];
    let loads = sides.map(|(on, along)| {
        let [x, y] = along.map(|part| size * part);
        format!("[[traction]]\non = [{on}]\nvalue = [{x:e}, {y:e}]\n")
    });
    loads.concat()
}

#[test]
fn factors_are_the_same_wherever_the_plate_lies_and_sliding_is_turned_round_in_a_mirror() {
    let plate = || plate(3.0, "quad9", 1);
    let solved = |mesh: Mesh, loads: &str| factors(&solve(&loaded(mesh, ISOTROPIC, loads), 4));
    let first = solved(plate(), &shear(LOAD, [1.0, 0.0]));
    // The side on the left of the crack's direction is pulled along it.
    assert!(first[1] > 0.0);
    let [c, s] = [0.6, 0.8];
    let turned = moved(plate(), |[x, y]| [c * x - s * y + 5.0, s * x + c * y]);
    let turned = solved(turned, &shear(LOAD, [c, s]));
    let mirrored = solved(plate(), &shear(-LOAD, [1.0, 0.0]));
    for (other, sense) in [(turned, 1.0), (mirrored, -1.0)] {
        close(other[0], first[0], 1e-9 * first[1]);
        close(other[1], sense * first[1], 1e-9 * first[1]);
    }
}

#[test]
fn factors_have_the_same_bits_on_any_number_of_ranks_and_none_are_there_without_stresses() {
    let model = loaded(plate(3.0, "quad4", 1), ISOTROPIC, &pressure(FACES, LOAD));
    let case = Case::of(&model, 6);
    let tips = |ranks: usize| {
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert!(ended.stdout.contains("crack, tip 1"), "{}", ended.stdout);
        Solution::read(&case.result()).report["crack_tips"].clone()
    };
    let alone = tips(0);
    assert_eq!(alone[0]["tip"], "crack, tip 1");
    for ranks in [2, 3] {
        assert_eq!(tips(ranks), alone);
    }
    assert_eq!(case.run(&["--no-stress"]).code(), 0);
    let without = Solution::read_report(&case.result());
    assert_eq!(without["crack_tips"].as_array().unwrap().len(), 0);
}

#[test]
fn a_mesh_that_is_too_coarse_at_a_tip_is_remarked_on_once() {
    let blocks = Blocks::new()
        .rectangle("crack below", [0.0, 1.0], [-1.0, 0.0], [2, 2])
        .rectangle("crack above", [0.0, 1.0], [0.0, 1.0], [2, 2])
        .rectangle("rest below", [1.0, 2.0], [-1.0, 0.0], [2, 2])
        .rectangle("rest above", [1.0, 2.0], [0.0, 1.0], [2, 2])
        .glued(|x, y| y != 0.0 || x > 1.0 - 1e-9);
    let mut mesh = blocks.mesh;
    let pieces = ["crack below", "crack above", "rest below", "rest above"];
    gather(&mut mesh, "plate", &pieces);
    let model = loaded(mesh, ISOTROPIC, &pressure(FACES, LOAD));
    assert!(model.tips.is_empty());
    assert_eq!(model.found.len(), 1, "{:?}", model.found);
    assert!(model.found[0].contains("1 crack tip without stress intensity"));
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

/// A plate of 3 m × 2 m with a crack from (0, 0) to (1, 0), whose facets `grade` grades.
fn inner_crack(grade: impl Fn(f64) -> f64 + Copy) -> Mesh {
    let x = move |column: &str, s: f64| match column {
        "left" => s - 1.0,
        "crack" => grade(s),
        _ => 1.0 + s,
    };
    let mut blocks = Blocks::new();
    for column in ["left", "crack", "right"] {
        blocks = blocks
            .mapped(&format!("{column} below"), [8, 4], |[s, t]| {
                [x(column, s), t - 1.0]
            })
            .mapped(&format!("{column} above"), [8, 4], |[s, t]| {
                [x(column, s), t]
            });
    }
    let blocks = blocks.glued(|x, y| y != 0.0 || !(1e-9..1.0 - 1e-9).contains(&x));
    let mut mesh = blocks.mesh;
    let columns =
        ["left", "crack", "right"].map(|of| [format!("{of} below"), format!("{of} above")]);
    let pieces: Vec<&str> = columns.iter().flatten().map(String::as_str).collect();
    gather(&mut mesh, "plate", &pieces);
    mesh
}

/// Facets that are small at the right end of the crack only, so that the other tip has no stress intensity factors.
#[test]
fn tips_without_factors_are_named_and_count() {
    let mesh = inner_crack(|s| 1.0 - (1.0 - s).powi(3));
    let model = loaded(mesh, ISOTROPIC, &pressure(FACES, LOAD));
    let names: Vec<&str> = model.tips.iter().map(|(_, tip)| &tip.name[..]).collect();
    assert_eq!(names, ["crack, tip 2"]);
    let expected = "1 crack tip without stress intensity factors, 'crack, tip 1' at (0, 0): fewer";
    assert!(model.found[0].starts_with(expected), "{:?}", model.found);
}

#[test]
fn tips_above_each_other_arent_numbered_by_round_off() {
    let mesh = inner_crack(|s| 0.5 - 0.5 * (std::f64::consts::PI * s).cos());
    for tilt in [-1e-14, 0.0, 1e-14] {
        let upright = moved(mesh.clone(), |[x, y]| [tilt * x - y, x]);
        let model = loaded(upright, ISOTROPIC, &pressure(FACES, LOAD));
        let tips = model.tips.iter().map(|(_, tip)| tip);
        let heights: Vec<f64> = tips.map(|tip| tip.position[1].round()).collect();
        assert_eq!(heights, [0.0, 1.0], "{tilt}");
    }
}
