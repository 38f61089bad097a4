use super::*;
use crate::contact::friction::ForceBound;
use crate::contact::friction::points::{COULOMB, GIVEN, Points, noise};
use crate::contact::tangent::TangentialLimit;

#[test]
fn equilibrium_and_every_law_hold_at_random_points_in_space() {
    let (mut seen, mut steps) = ([0; 3], 0);
    for seed in 0..200 {
        let steep = ForceBound {
            coefficient: 1.2,
            ..COULOMB
        };
        let points = Points::in_space(1 + seed % 9, 17 * seed, [COULOMB, GIVEN, steep][seed % 3]);
        let (solution, mut status) = points.solved(&format!("seed {seed}"), 1e-11);
        for tangent in &points.tangents {
            seen[match status[tangent.limit] {
                Status::Open => 0,
                Status::Closed => 1,
                _ => 2,
            }] += 1;
        }
        steps = steps.max(solution.steps);
        // A restart from its own statuses keeps the solution.
        let known = status.clone();
        let again = points.solve(&mut status);
        assert!(again.converged && status == known, "seed {seed}");
    }
    assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
}

#[test]
fn slips_that_turn_about_are_found_by_newton_s_method_however_stiff_points_are() {
    for seed in 0..60 {
        let count = 6 + seed % 7;
        let mut points = Points::in_space(count, 29 * seed, COULOMB);
        let (h, m) = (points.h.clone(), points.c.len());
        // The springs between neighbours are a thousand times as stiff as the body.
        let of = |i: usize| (i - count) / 2;
        let coupled = |i: usize, j: usize| match i.min(j) >= count && (i ^ j) & 1 == 0 {
            true if i == j => 2e4,
            true if of(i).abs_diff(of(j)) == 1 => -1e4,
            _ => 0.0,
        };
        points.set_stiffness(m, |i, j| h[(i, j)] + coupled(i, j));
        points.c[..count].iter_mut().for_each(|c| *c += 5.0);
        let (solution, _) = points.solved(&format!("seed {seed}"), 1e-8);
        assert!(!solution.fell_back, "seed {seed}: {} steps", solution.steps);
    }
}

#[test]
fn lemke_s_path_ends_near_solutions() {
    let mut ended = [0; 3];
    for seed in 0..150 {
        let steep = ForceBound {
            coefficient: 1.2,
            ..COULOMB
        };
        let mut points =
            Points::in_space(2 + seed % 6, 23 * seed, [COULOMB, GIVEN, steep][seed % 3]);
        if seed % 2 == 0 {
            // Friction alone resists an equal slip of all.
            let (h, m) = (points.h.clone(), points.c.len());
            let mean = |i: usize| (0..m).map(|j| h[(i, j)]).sum::<f64>() / m as f64;
            let all = (0..m).map(mean).sum::<f64>() / m as f64;
            points.set_stiffness(m, |i, j| h[(i, j)] - mean(i) - mean(j) + all);
            let load = points.c.iter().sum::<f64>() / m as f64;
            points.c.iter_mut().for_each(|c| *c -= load);
        }
        points.with(|problem| {
            let cones = FrictionCones::new(problem);
            let Some(found) = cones.along_lemke_s_path(problem, &mut 0) else {
                return;
            };
            let (jumps, forces) = cones.exact(&found);
            let violation = points.violation(&ContactSolution {
                jumps,
                forces,
                steps: found.steps,
                fell_back: true,
                converged: true,
                slides: false,
            });
            assert!(violation < 1e-9, "seed {seed}: {violation:e}");
            ended[seed % 3] += 1;
        });
    }
    // Given bounds make a convex problem.
    assert!(
        ended[1] == 50 && ended.iter().sum::<usize>() > 115,
        "{ended:?}"
    );
}

#[test]
fn a_slip_that_supports_prescribe_along_one_tangent_turns_the_force_along_the_other() {
    for seed in 0..60 {
        let mut points = Points::in_space(3, 13 * seed, [COULOMB, GIVEN][seed % 2]);
        // The second tangents have no unknowns any more.
        points.tangents.retain(|tangent| tangent.limit % 2 == 1);
        let kept: Vec<usize> = [0, 1, 2].into_iter().chain([3, 5, 7]).collect();
        let h = points.h.clone();
        points.set_stiffness(6, |i, j| h[(kept[i], kept[j])]);
        points.c = kept.iter().map(|&i| points.c[i]).collect();
        points.bounds = kept.iter().map(|&i| points.bounds[i]).collect();
        for (k, tangent) in points.tangents.iter_mut().enumerate() {
            tangent.limit = 3 + k;
            tangent.other = match k {
                0 => OtherTangent::Nothing,
                _ => OtherTangent::Prescribed(0.2 * noise(seed + k)),
            };
        }
        points.solved(&format!("seed {seed}"), 1e-10);
    }
}

/// Tangential jumps of the last point as sums of those of two others, as at a node of several contacts.
#[test]
fn tangential_jumps_that_depend_on_others_have_their_laws_too() {
    let mut converged = 0;
    for seed in 0..60 {
        let mut points = Points::in_space(3, 29 * seed, GIVEN);
        points.rows.push(vec![(3, 0.6), (5, 0.8)]);
        points.rows.push(vec![(4, 0.6), (6, 0.8)]);
        points
            .bounds
            .extend([noise(seed), noise(seed + 1)].map(|x| 0.1 * x));
        points.tangents.extend([9, 10].map(|limit| TangentialLimit {
            limit,
            normal: Some(2),
            bound: GIVEN,
            other: OtherTangent::Limit(19 - limit),
        }));
        let solution = points.solve(&mut [Status::Closed; 11]);
        if solution.converged {
            let violation = points.violation(&solution);
            assert!(violation < 1e-10, "seed {seed}: {violation:e}");
            converged += 1;
        }
    }
    assert!(converged > 55, "{converged}");
}

/// Sticking and opening are both in equilibrium, as slip in any direction relieves the contact.
#[test]
fn a_second_start_finds_other_solutions_in_space() {
    let strong = ForceBound {
        coefficient: 1.5,
        ..COULOMB
    };
    for angle in [0.0_f64, 0.7, 2.5] {
        let direction = [1.0, angle.cos(), angle.sin()];
        for (coupling, opened) in [(0.9, Some(0.5 / 0.19)), (0.3, None)] {
            let mut points = Points::in_space(1, 3, strong);
            points.set_stiffness(3, |i, j| match (i, j) {
                (0, 0) => 1.0,
                (0, k) | (k, 0) => coupling * direction[k],
                (i, j) => f64::from(u8::from(i == j)),
            });
            points.bounds = vec![0.0; 3];
            points.c = [1.0, 1.4, 1.4]
                .iter()
                .zip(direction)
                .map(|(c, d)| c * d)
                .collect();
            let known = points.solve(&mut [Status::Closed; 3]).jumps;
            assert_eq!(known, [0.0; 3]);
            let other = points.with(|problem| problem.other_solution(&known, 1.0));
            assert_eq!(other.is_some(), opened.is_some(), "{angle}");
            // The largest of its jumps: that of the gap, or the larger part of the slip.
            let slip = opened.map(|slip| slip * direction[1].abs().max(direction[2].abs()));
            let expected = slip.map_or(0.0, |slip| slip.max(0.26 / 0.19));
            let found = other.unwrap_or_default();
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
}

/// A contact that opens where it sticks or slips under all of its cohesion, and penetrates without any.
#[test]
fn a_contact_about_to_open_slips_under_part_of_its_cohesion_in_any_direction() {
    let bound = ForceBound {
        coefficient: 0.0,
        cohesion: 1.0,
        only_closed: true,
    };
    for angle in [0.0_f64, 0.7, 2.5, 4.0] {
        let direction = [1.0, angle.cos(), angle.sin()];
        let mut points = Points::in_space(1, 3, bound);
        points.set_stiffness(3, |i, j| match (i, j) {
            (0, k) | (k, 0) if k > 0 => -0.5 * direction[k],
            (i, j) => f64::from(u8::from(i == j)),
        });
        points.bounds = vec![0.0; 3];
        points.c = vec![-0.75, 2.0 * direction[1], 2.0 * direction[2]];
        let mut status = vec![Status::Closed; 3];
        let solution = points.solve(&mut status);
        assert!(solution.converged, "{angle}");
        assert_eq!(status, [Status::Closed, Status::Parting, Status::Parting]);
        assert_eq!(solution.forces[0], 0.0);
        for k in [1, 2] {
            assert!(
                (solution.jumps[k] - 1.5 * direction[k]).abs() < 1e-14,
                "{angle}"
            );
            assert!(
                (solution.forces[k] - 0.5 * direction[k]).abs() < 1e-14,
                "{angle}"
            );
        }
        // A restart from its own statuses keeps the solution.
        let again = points.solve(&mut status);
        assert!(again.converged && again.jumps == solution.jumps, "{angle}");
    }
}

/// A load beyond what friction holds, along a motion that nothing else resists.
#[test]
fn what_slides_on_and_on_is_seen() {
    for (pull, slides) in [(0.29, false), (0.31, true)] {
        let mut points = Points::in_space(1, 3, COULOMB);
        points.set_stiffness(3, |i, j| f64::from(u8::from(i == 0 && j == 0)));
        points.diagonal = vec![1.0; 3];
        points.bounds = vec![0.0; 3];
        points.c = vec![1.0, 0.6 * pull, 0.8 * pull];
        let solution = points.solve(&mut [Status::Closed; 3]);
        assert_eq!(
            (solution.converged, solution.slides),
            (!slides, slides),
            "{pull}"
        );
    }
}

/// The same with a wall in the direction of the slip, however far: an equilibrium exists.
#[test]
fn what_slides_to_a_wall_does_not_slide_on_and_on() {
    let mut points = Points::in_space(1, 3, COULOMB);
    points.set_stiffness(3, |i, j| f64::from(u8::from(i == 0 && j == 0)));
    points.diagonal = vec![1.0; 3];
    points.rows.push(vec![(1, 1.0)]);
    points.bounds = vec![0.0, 0.0, 0.0, 1e9];
    points.c = vec![1.0, 0.6 * 0.31, 0.8 * 0.31];
    let [stuck, open] = [Status::Closed, Status::Open];
    assert!(!points.solve(&mut [stuck, stuck, stuck, open]).slides);
}

/// One of two tangents of a point as a jump with a small weight: its stiffness is far above that of the other.
#[test]
fn tangents_of_a_point_may_differ_in_stiffness_by_far() {
    for seed in 0..60 {
        let count = 2 + seed % 6;
        let bound = [COULOMB, GIVEN][seed % 2];
        let mut points = Points::in_space(count, 31 * seed, bound);
        let (h, m) = (points.h.clone(), points.c.len());
        let weight = |i: usize| if i == count + 1 { 1e-7 } else { 1.0 };
        points.set_stiffness(m, |i, j| h[(i, j)] / weight(i) / weight(j));
        points.bounds[count + 1] *= 1e-7;
        points.c[count + 1] *= 1e7;
        points.solved(&format!("seed {seed}"), 1e-7);
    }
}

#[test]
fn newton_s_method_finds_the_solution_of_given_friction_from_the_interior_point() {
    for seed in 0..60 {
        let make = [Points::new, Points::in_space][seed % 2];
        let mut points = make(1 + seed % 9, 37 * seed, GIVEN);
        for (k, tangent) in points.tangents.iter_mut().enumerate() {
            tangent.bound.cohesion *= 10.0_f64.powi(-((k / 2 * seed) as i32 % 7));
        }
        let (solution, _) = points.solved(&format!("seed {seed}"), 1e-11);
        points.with(|problem| {
            let cones = FrictionCones::new(problem);
            let mut steps = 0;
            let found = cones.after_interior_point(&mut steps).expect("a solution");
            let apart = found.place.jumps.iter().zip(&solution.jumps);
            let apart = apart.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            assert!(apart < 1e-10, "seed {seed}: {apart:e}");
            assert!(steps < 100, "seed {seed}: {steps} steps");
        });
    }
}
