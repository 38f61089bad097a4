//! Load cycles: their work equals the dissipation by friction.

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::energy::{Works, checked_works};
use crate::support::scenes::{BODIES, HELD, JOINT, model};
use crate::support::solver::solve_steps;

/// A block pressed on another one and moved back and forth by its top, with `steps` steps for a quarter of the cycle.
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

/// From the second cycle on the initial and final states are equal, so that no energy is stored in the bodies.
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
        let works = checked_works(&model, &solutions);
        let [first, second] = [1, 2].map(|cycle| {
            let part = &works[4 * steps * cycle + 1..][..4 * steps];
            part.iter().fold([0.0; 2], |[outside, friction], work| {
                [outside + work.outside(), friction + work.friction]
            })
        });
        for [outside, friction] in [first, second] {
            assert!(friction > 0.0, "{law}");
            close(outside, friction, 1e-10 * friction);
        }
        close(first[1], second[1], 1e-9 * first[1]);
    }
}

/// With slip everywhere, the dissipation in every increment is the bound times the slip distance.
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

/// Pressure during a part of the opening or closing of a gap does work, too.
#[test]
fn a_report_says_where_energy_goes_where_gaps_open() {
    let mut text = format!("{BODIES}{HELD}{JOINT}\ngap = 1e-6\nfriction = 0.4\n");
    for (push, y) in [(0.0, -2e-5), (4e5, -1.5e-5), (3e5, 1e-6), (-2e5, -1e-5)] {
        text += &format!(
            "[[step]]
            [[step.displacement]]
            on = 'lower bottom'
            x = 0.0
            y = 0.0
            [[step.displacement]]
            on = 'upper top'
            x = {:e}
            y = {y:e}
            [[step.traction]]
            on = 'upper right'
            value = [{push:e}, 0.0]\n",
            1e-11 * push
        );
    }
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 4])
        .rectangle("upper", [0.5, 1.5], [1.0, 1.5], [4, 3]);
    let model = model(&text, blocks.mesh);
    let works = checked_works(&model, &solve_steps(&model, 4));
    let is_much =
        |part: fn(&Works) -> f64| works.iter().any(|w| part(w).abs() > 1e-3 * w.elastic.abs());
    assert!(
        is_much(|w| w.pressure) && is_much(|w| w.friction) && is_much(|w| w.loads),
        "{works:?}"
    );
}
