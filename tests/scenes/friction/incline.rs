//! A block on an incline stands or slides.

use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, moved};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solver::{Case, solve};

/// A low block on a plane that rises with an angle, with its weight and `force` per volume in x and y.
fn block(angle: f64, law: &str, force: [f64; 2]) -> Model {
    let (sin, cos) = angle.sin_cos();
    let mesh = Blocks::new()
        .rectangle("block", [0.0, 2.0], [0.0, 0.4], [10, 3])
        .mesh;
    let mesh = moved(mesh, |[x, y]| [cos * x - sin * y, sin * x + cos * y]);
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 20e9, poisson = 0.22}}
        bodies.block = {{material = 'rock', body_force = [{:?}, {:?}]}}
        [[contact]]
        name = 'slope'
        sides = ['block bottom']
        obstacle = {{ point = [0.0, 0.0], normal = [{:?}, {cos:?}] }}
        gap = 0.0
        {law}",
        force[0], force[1], -sin
    );
    model(&text, mesh)
}

const WEIGHT: f64 = 25e3;

#[test]
fn a_block_stands_below_the_angle_of_friction_and_slides_above_it() {
    for angle in [0.1, 0.35, 0.9] {
        for (share, stands) in [
            (1.1, true),
            (1.0 + 1e-12, true),
            (1.0 - 1e-12, false),
            (0.9, false),
        ] {
            let law = format!("friction = {:?}", f64::tan(angle) * share);
            let ended = Case::of(&block(angle, &law, [0.0, -WEIGHT]), 3).run(&[]);
            let expected = if stands { 0 } else { 4 };
            assert_eq!(ended.code(), expected, "{angle}, {share}: {}", ended.stderr);
            assert!(stands || ended.stderr.contains("block"), "{}", ended.stderr);
        }
    }
}

#[test]
fn a_block_that_stands_is_carried_by_its_weight() {
    let angle: f64 = 0.3;
    let solution = solve(&block(angle, "friction = 0.4", [0.0, -WEIGHT]), 3);
    let weight = WEIGHT * 0.8;
    let normal: f64 = solution.points().map(|point| point.force).sum();
    close(normal, weight * angle.cos(), 1e-12 * weight);
    let upwards: f64 = solution.points().map(|p| p.tangential_force[1]).sum();
    close(upwards, weight * angle.sin().powi(2), 1e-12 * weight);
}

/// What a given bound or cohesion carries doesn't depend on the weight.
#[test]
fn a_bound_holds_up_to_what_it_is() {
    let angle: f64 = 0.2;
    let (pull, press) = (WEIGHT * 0.8 * angle.sin(), WEIGHT * 0.8 * angle.cos());
    for share in [0.99, 1.01] {
        let given = format!("tresca = {:?}", pull / 2.0 * share);
        let both = format!(
            "friction = 0.1\ncohesion = {:?}",
            (pull - 0.1 * press) / 2.0 * share
        );
        for law in [given, both] {
            let code = Case::of(&block(angle, &law, [0.0, -WEIGHT]), 3)
                .run(&[])
                .code();
            assert_eq!(code, if share > 1.0 { 0 } else { 4 }, "{law}");
        }
    }
}

/// A block that is pushed up a wedge with tan α = 0.1 at μ = 0.3 by F begins to slide at F/G = 0.412371, as
/// (tan α + μ)/(1 − μ tan α) says; NAFEMS benchmark CGS-4.
#[test]
fn a_wedge_begins_to_slide_as_the_nafems_benchmark_says() {
    let angle = 0.1_f64.atan();
    let limit = 0.4 / 0.97;
    close(limit, 0.412_371, 1e-6);
    for (share, stands) in [
        (1.0 - 1e-12, true),
        (1.0 + 1e-12, false),
        (0.9995, true),
        (1.0005, false),
    ] {
        let model = block(angle, "friction = 0.3", [WEIGHT * limit * share, -WEIGHT]);
        let code = Case::of(&model, 3).run(&[]).code();
        assert_eq!(code, if stands { 0 } else { 4 }, "{share}");
    }
}
