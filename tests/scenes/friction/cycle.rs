//! Cycles of load: what they take is what friction dissipates.

use contact_dd_partition::model::Model;

use crate::support::assembled::Assembled;
use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::{BODIES, HELD, JOINT, at_step, model};
use crate::support::solution::Solution;
use crate::support::solver::solve_steps;

/// A block that is pressed on another one and moved to and fro by its top, so many steps a quarter.
fn driven(law: &str, largest: f64, steps: usize, cycles: usize) -> Model {
    let mut text = format!(
        "{BODIES}{HELD}
        [[displacement]]
        on = 'upper top'
        x = 0.0
        y = -2e-5
        {JOINT}
        gap = 0.0
        {law}\n"
    );
    for k in 0..=4 * steps * cycles {
        let (quarter, share) = (k / steps % 4, (k % steps) as f64 / steps as f64);
        let aside = [share, 1.0 - share, -share, share - 1.0][quarter] * largest;
        text += &format!(
            "[[step]]
            [[step.displacement]]
            on = 'lower bottom'
            x = 0.0
            y = 0.0
            [[step.displacement]]
            on = 'upper top'
            x = {aside:e}
            y = -2e-5\n"
        );
    }
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [12, 6])
        .rectangle("upper", [0.5, 1.5], [1.0, 1.5], [6, 3]);
    model(&text, blocks.mesh)
}

/// Work of supports and loads and of friction in every increment, by the mean of the forces at both its ends; without
/// normal forces at moving gaps their difference is the energy of the bodies.
fn works(model: &Model, solutions: &[Solution]) -> Vec<[f64; 2]> {
    let assembled: Vec<Assembled> = (0..solutions.len())
        .map(|k| Assembled::new(&at_step(model, k)))
        .collect();
    let forces = |solution: &Solution, assembled: &Assembled| -> (Vec<f64>, Vec<f64>) {
        let points: Vec<_> = model
            .contacts
            .iter()
            .flat_map(|c| &solution.contacts[&c.name])
            .collect();
        let tangents = assembled.tangents.iter();
        let along = tangents.map(|t| {
            let force = points[t.condition].tangential_force;
            -(0..3).map(|i| force[i] * t.direction[i]).sum::<f64>()
        });
        (
            points.iter().map(|point| point.force).collect(),
            along.collect(),
        )
    };
    (1..solutions.len())
        .map(|k| {
            let ends = [k - 1, k].map(|k| (&solutions[k], &assembled[k]));
            let u = ends.map(|(solution, _)| solution.dofs(model));
            let by = ends.map(|(solution, assembled)| forces(solution, assembled));
            // K u + Bᵀ λ + Tᵀ λ_t: loads and reactions together.
            let outer = [0, 1].map(|end| {
                let residual = ends[end].1.residual(&u[end], &by[end].0, &by[end].1).value;
                (residual.iter().zip(&ends[end].1.load))
                    .map(|(r, f)| r + f)
                    .collect::<Vec<f64>>()
            });
            let moved = u[1].iter().zip(&u[0]).map(|(a, b)| a - b);
            let done = moved.zip(outer[0].iter().zip(&outer[1]));
            let outside = done.map(|(du, (a, b))| du * (a + b) / 2.0).sum();
            let tangents = ends[0].1.tangents.iter().enumerate();
            let friction = tangents.map(|(t, tangent)| {
                let slip = tangent.jump(&u[1]) - tangent.jump(&u[0]);
                slip * (by[0].1[t] + by[1].1[t]) / 2.0
            });
            [outside, friction.sum()]
        })
        .collect()
}

/// From the second cycle on every cycle ends where it began, so that no energy is left in the bodies.
#[test]
fn what_a_cycle_takes_is_what_friction_dissipates() {
    for law in ["friction = 0.3", "tresca = 1e5"] {
        let (steps, cycles) = (3, 3);
        let model = driven(law, 2e-5, steps, cycles);
        let solutions = solve_steps(&model, 5);
        assert!(
            solutions.iter().all(|s| s.closed() == s.points().count()),
            "{law}"
        );
        assert!(solutions.iter().any(|s| s.slipping() > 0), "{law}");
        let works = works(&model, &solutions);
        let [first, second] = [1, 2].map(|cycle| {
            let part = &works[4 * steps * cycle..4 * steps * (cycle + 1)];
            part.iter()
                .fold([0.0; 2], |sum, work| [0, 1].map(|i| sum[i] + work[i]))
        });
        for [outside, friction] in [first, second] {
            assert!(friction > 0.0, "{law}");
            close(outside, friction, 1e-10 * friction);
        }
        close(first[1], second[1], 1e-9 * first[1]);
    }
}

/// Beyond the bound everywhere, the friction of every increment is the bound times the way.
#[test]
fn a_block_that_slides_back_and_forth_dissipates_force_times_way() {
    let model = driven("tresca = 1e5", 1e-3, 1, 2);
    let solutions = solve_steps(&model, 5);
    for pair in solutions.windows(2).skip(1) {
        let slips = pair[0]
            .points()
            .zip(pair[1].points())
            .zip(&model.contacts[0].points);
        let work: f64 = slips
            .map(|((a, b), point)| {
                let slip = b.slip[0] - a.slip[0];
                close(
                    b.tangential_force[0],
                    -1e5 * point.area * slip.signum(),
                    1e-9 * 1e5 * point.area,
                );
                -b.tangential_force[0] * slip
            })
            .sum();
        let reported = pair[1].report["friction"]["dissipated_work"].as_f64();
        close(reported.unwrap(), work, 1e-9 * work);
        assert!(work > 0.0);
    }
}
