//! Random scenes in space with friction, judged by an independent check of the discrete law.

use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::model::Model;
use serde_json::Value;

use super::vector;
use crate::support::assembled::Assembled;
use crate::support::blocks::joined;
use crate::support::random::Random;
use crate::support::scenes::{at_step, model};
use crate::support::solids::{SOLIDS, moved, solid, turned};
use crate::support::solution::Solution;
use crate::support::solver::Case;
use crate::support::stress::judge::Findings;

/// A stack of blocks with tilted joints on a base, pressed, pushed and turned, in one or more steps.
fn stack(seed: u64) -> Model {
    let mut random = Random::new(seed);
    let kind = random.pick(&SOLIDS);
    let matching = random.chance(0.5);
    let blocks = random.count(1, 2);
    let most = if kind.is_linear() { 4 } else { 2 };
    let n = [random.count(1, most), random.count(1, most)];
    let wide = random.within(0.5, 2.0);
    // Joints are planes z = level + a x + b y.
    let slopes = |random: &mut Random| [0; 2].map(|_: usize| random.within(-0.08, 0.08));
    // Quadratic cells stay straight.
    let mut low = (slopes(&mut random), 0.0);
    let mut mesh = None;
    let mut text = "materials.rock = {young = 20e9, poisson = 0.25}\nmaterials.clay = {young = 1e8, poisson = 0.4}\n".to_string();
    let mut contacts = String::new();
    let turns = random.chance(0.5);
    let straight = |x: [f64; 3]| x;
    let to: &dyn Fn([f64; 3]) -> [f64; 3] = if turns { &turned } else { &straight };
    for i in 0..=blocks {
        let name = format!("b{i}");
        let high = (
            if kind.is_linear() {
                slopes(&mut random)
            } else {
                low.0
            },
            low.1 + random.within(0.3, 0.9),
        );
        let (from, upto) = (low, high);
        let place = move |[x, y, s]: [f64; 3]| {
            let [x, y] = [x, wide * y];
            let at =
                |([a, b], level): ([f64; 2], f64)| level + a * (x - 0.5) + b * (y - 0.5 * wide);
            [x, y, at(from) * (1.0 - s) + at(upto) * s]
        };
        let own = match matching {
            true => n,
            false => [random.count(1, most), random.count(1, most)],
        };
        let block = solid(&name, kind, [own[0], own[1], 1], place);
        mesh = Some(match mesh {
            None => block,
            Some(mesh) => joined(mesh, block),
        });
        let material = random.pick(&["rock", "rock", "clay"]);
        let weight = to([0.0, 0.0, -random.magnitude(3.0, 5.0)]);
        text += &format!(
            "bodies.{name} = {{material = '{material}', body_force = {}}}\n",
            vector(weight)
        );
        if i > 0 {
            let law = match random.below(4) {
                0 => format!("tresca = {:e}", random.magnitude(3.0, 6.5)),
                1 => format!(
                    "friction = {:e}\ncohesion = {:e}",
                    random.within(0.0, 0.8),
                    random.magnitude(3.0, 5.5)
                ),
                2 => format!(
                    "friction = '{:e}*(0.75+0.25*sin(7*(x+2*y-z)))'",
                    random.within(0.1, 1.0)
                ),
                _ => format!("friction = {:e}", random.within(0.05, 1.5)),
            };
            let gap = random.pick(&["gap = 0.0", "gap = '1e-5*(x-0.5)^2'", "gap = 0.0"]);
            contacts += &format!(
                "[[contact]]\nname = 'joint {i}'\nsides = ['b{i} z0', 'b{} z1']\n{gap}\n{law}\n",
                i - 1
            );
        }
        low = high;
    }
    text += &contacts;
    text += "[[displacement]]\non = 'b0 z0'\nx = 0\ny = 0\nz = 0\n";
    if random.chance(0.3) {
        text += &format!("[[bilateral]]\non = 'b{blocks} y0'\n[[bilateral]]\non = 'b0 y0'\n");
    }
    let top = format!("b{blocks} z1");
    let pressure = random.magnitude(4.0, 6.0);
    let slopes = [0; 2].map(|_: usize| random.within(-0.4, 0.4));
    let mut traction = |size: f64| to([0; 3].map(|_: usize| size * pressure * random.signed()));
    if !turns {
        text += &format!(
            "[[pressure]]\non = '{top}'\nvalue = '{pressure:e}*(1+({:e})*(x-0.5)+({:e})*(y-0.5))'\n",
            slopes[0], slopes[1]
        );
    } else {
        text += &format!("[[pressure]]\non = '{top}'\nvalue = {pressure:e}\n");
    }
    let driven = Random::new(seed + 1).chance(0.3);
    match driven {
        true => {
            let way = to([0.0, 0.0, -1e-6 * pressure / 1e5]);
            text += &format!(
                "[[displacement]]\non = '{top}'\nx = {:e}\ny = {:e}\nz = {:e}\n",
                way[0], way[1], way[2]
            );
            text = text.replace(&format!("[[bilateral]]\non = 'b{blocks} y0'\n"), "");
        }
        false => {
            text += &format!(
                "[[traction]]\non = '{top}'\nvalue = {}\n",
                vector(traction(0.35))
            )
        }
    }
    let mut random = Random::new(seed + 2);
    if random.chance(0.6) {
        for _ in 0..random.count(1, 4) {
            text += "[[step]]\n";
            if driven {
                let way = to([0; 3].map(|_: usize| 1e-5 * pressure / 1e5 * random.signed()));
                text += &format!(
                    "[[step.displacement]]\non = '{top}'\nx = {:e}\ny = {:e}\nz = {:e}\n",
                    way[0], way[1], way[2]
                );
                text += "[[step.displacement]]\non = 'b0 z0'\nx = 0\ny = 0\nz = 0\n";
            } else {
                let way = to([0; 3].map(|_: usize| 0.3 * pressure * random.signed()));
                text += &format!("[[step.traction]]\non = '{top}'\nvalue = {}\n", vector(way));
            }
        }
    }
    let mesh = mesh.unwrap_or_default();
    model(&text, moved(mesh, to))
}

/// A model in so many subdomains, or as many as it can have.
fn cut(model: &Model, count: usize) -> Case {
    let counts = [count, 3, 2];
    let can_be = |&&count: &&usize| Decomposition::new(model, Some(count)).is_ok();
    Case::of(model, *counts.iter().find(can_be).unwrap())
}

/// Judges what friction does in a random scene, and looks at its report; whether it was solved.
fn judged(model: &Model, count: usize, look: impl FnOnce(&Value)) -> Option<Vec<String>> {
    let case = cut(model, count);
    let ended = case.run(&[]);
    if ended.code() == 3 || ended.code() == 4 {
        return None;
    }
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    look(&Solution::read_report(&case.result()));
    let all = Solution::increments(&case.result(), !model.steps.is_empty());
    let mut faults = Vec::new();
    let mut before: Option<&Solution> = None;
    for (k, solution) in all.iter().enumerate() {
        solution.check_certificate();
        let of_step = match model.steps.is_empty() {
            true => model.clone(),
            false => at_step(model, k),
        };
        let parts = solution.report["friction"]["increments"].as_u64();
        let findings = Findings::after(before, &of_step, &Assembled::new(&of_step), solution, true);
        let findings = if parts.is_some_and(|parts| parts > 1) {
            findings.in_parts()
        } else {
            findings
        };
        faults.extend(findings.faults());
        before = Some(solution);
    }
    Some(faults)
}

#[test]
fn a_random_scene_in_space_with_friction_is_not_answered_wrongly() {
    let mut solved = 0;
    let seeds = 0..20;
    for seed in seeds.clone() {
        if let Some(faults) = judged(&stack(seed), 3 + seed as usize % 5, |_| {}) {
            assert!(faults.is_empty(), "{seed}: {faults:?}");
            solved += 1;
        }
    }
    assert!(2 * solved > seeds.end, "{solved}");
}

#[test]
fn an_answer_with_friction_in_space_is_the_same_on_any_ranks() {
    let mut compared = 0;
    for seed in 0..6 {
        let model = stack(seed);
        let case = cut(&model, 8);
        if case.run(&[]).code() != 0 {
            continue;
        }
        let read = || Solution::increments(&case.result(), !model.steps.is_empty());
        let alone = read();
        for ranks in [2, 3] {
            assert_eq!(case.run_on(ranks, &[]).code(), 0);
            for (alone, there) in alone.iter().zip(read()) {
                assert_eq!(alone.displacement, there.displacement, "{seed}");
                assert_eq!(alone.contacts, there.contacts, "{seed}");
            }
        }
        compared += 1;
    }
    assert!(compared > 2, "{compared}");
}

/// What would open where it sticks or slips under all of its cohesion, and penetrate without any.
#[test]
fn what_is_about_to_open_in_space_slips_under_a_part_of_its_cohesion() {
    for seed in [299, 354, 376] {
        let faults = judged(&stack(seed), 4, |report| {
            let warnings = report["warnings"].as_array().unwrap().iter();
            let parts = |words: &&Value| words.as_str().unwrap().contains("about to open");
            assert!(warnings.filter(parts).count() > 0, "{seed}");
        });
        assert_eq!(faults, Some(Vec::new()), "{seed}");
    }
}

/// Rigid blocks could be held: their pressures are a matter of choice, those of elastic ones aren't.
#[test]
fn a_block_in_space_that_friction_does_not_hold_is_named() {
    for seed in [55, 388] {
        let ended = cut(&stack(seed), 4).run(&[]);
        assert_eq!(ended.code(), 4, "{seed}: {}", ended.stderr);
        assert!(
            ended.stderr.contains("friction can't hold it"),
            "{}",
            ended.stderr
        );
    }
}
