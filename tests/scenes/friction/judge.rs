//! The judge of random scenes, which is independent of the program, accepts correct solutions and finds every violation
//! of a law.

use contact_dd_partition::model::Model;

use crate::support::assembled::Assembled;
use crate::support::blocks::Blocks;
use crate::support::scenes::{BODIES, HELD, JOINT, at_step, model};
use crate::support::solution::ContactPoint;
use crate::support::solver::solve_steps;
use crate::support::stress::Balance;
use crate::support::stress::judge::Findings;

/// A block pushed back and forth on another one.
fn pushed(law: &str) -> Model {
    let text = format!(
        "{BODIES}{HELD}
        [[pressure]]
        on = 'upper top'
        value = '1e6*(1.6-x)'
        [[traction]]
        on = 'upper top'
        value = [1e5, 0.0]
        {JOINT}
        gap = '1e-5*(x-0.5)^4'
        {law}
        [[step]]
        [[step]]
        scale = {{ traction = -1.0 }}"
    );
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 4])
        .rectangle("upper", [0.5, 1.5], [1.0, 1.5], [4, 2]);
    model(&text, blocks.mesh)
}

/// Findings of the judge in the second step after `tamper`.
fn faults(law: &str, tamper: impl Fn(&mut Vec<ContactPoint>)) -> Vec<String> {
    let whole = pushed(law);
    let [before, mut after] = <[_; 2]>::try_from(solve_steps(&whole, 3)).unwrap();
    let kinds = after.points().fold([0; 3], |mut kinds, point| {
        kinds[usize::from(point.closed) + usize::from(point.slipping)] += 1;
        kinds
    });
    assert!(kinds[1] > 0 && kinds[2] > 0, "{kinds:?}");
    after.contacts.values_mut().for_each(tamper);
    let model = at_step(&whole, 1);
    Findings::after(Some(&before), &model, &Assembled::new(&model), &after, true).faults()
}

#[test]
fn the_judge_finds_an_answer_right() {
    for law in [
        "friction = 0.25",
        "tresca = 2e5",
        "friction = 0.2\ncohesion = 1e4",
    ] {
        let found = faults(law, |_| {});
        assert!(found.is_empty(), "{law}: {found:?}");
    }
}

#[test]
fn the_judge_finds_every_breach_of_the_law_of_friction() {
    type Is = fn(&ContactPoint) -> bool;
    type Tamper = fn(&mut ContactPoint);
    let slips: Is = |point| point.slipping;
    let sticks: Is = |point| point.closed && !point.slipping;
    let cases: [(&str, Is, Tamper); 8] = [
        ("bound", slips, |p| {
            p.tangential_force = p.tangential_force.map(|f| f * (1.0 + 1e-7))
        }),
        ("direction", slips, |p| {
            p.tangential_force = p.tangential_force.map(|f| -f)
        }),
        ("direction", slips, |p| {
            p.tangential_force = p.tangential_force.map(|f| f * (1.0 - 1e-7))
        }),
        ("stuck", slips, |p| p.slipping = false),
        ("status", sticks, |p| p.slipping = true),
        ("slip", slips, |p| p.slip[0] += 1e-12),
        ("off the tangent", sticks, |p| p.tangential_force[1] += 1.0),
        ("backward error", sticks, |p| p.tangential_force[0] += 1.0),
    ];
    for law in ["friction = 0.25", "tresca = 2e5"] {
        for (name, of, tamper) in cases {
            let found = faults(law, |points| {
                let point = points.iter_mut().filter(|point| of(point));
                point
                    .max_by(|a, b| a.force.total_cmp(&b.force))
                    .map(tamper)
                    .unwrap();
            });
            assert!(
                found.iter().any(|fault| fault.starts_with(name)),
                "{law}: {found:?}"
            );
        }
    }
}

/// The law uses the slip since the previous step: with the slip from the start the second step would be wrong.
#[test]
fn the_judge_looks_at_increments() {
    let whole = pushed("friction = 0.25");
    let after = &solve_steps(&whole, 3)[1];
    let model = at_step(&whole, 1);
    let found = Findings::after(None, &model, &Assembled::new(&model), after, false).faults();
    assert!(
        found.iter().any(|fault| fault.starts_with("stuck")),
        "{found:?}"
    );
}

#[test]
fn the_linear_program_knows_what_friction_holds() {
    // 1.1e6 · 1 m by its own pressure, pushed by 1e5.
    let total: f64 = 1e6 * 0.6;
    for (law, expected) in [
        (
            format!("friction = {}", 1e5 / total * 1.001),
            Balance::Holds,
        ),
        (
            format!("friction = {}", 1e5 / total * 0.999),
            Balance::Fails,
        ),
        ("tresca = 1.001e5".into(), Balance::Holds),
        ("tresca = 0.999e5".into(), Balance::Fails),
        ("friction = 0.1\ncohesion = 0.401e5".into(), Balance::Holds),
        ("friction = 0.1\ncohesion = 0.399e5".into(), Balance::Fails),
    ] {
        let model = pushed(&law);
        let assembled = Assembled::new(&model);
        assert_eq!(Balance::new(&model, &assembled), expected, "{law}");
        assert_eq!(
            Balance::without_friction(&model, &assembled),
            Balance::Fails
        );
    }
}
