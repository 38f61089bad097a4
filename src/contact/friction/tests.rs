use std::f64::consts::PI;

use faer::Mat;

use super::points::{COULOMB, GIVEN, Points};
use super::*;

#[test]
fn equilibrium_and_every_law_hold_at_random_points() {
    let mut seen = [0; 4];
    for seed in 0..200 {
        let bound = [COULOMB, GIVEN][seed % 2];
        let points = Points::new(1 + seed % 9, 17 * seed, bound);
        let (_, status) = points.solved(&format!("seed {seed}"), 1e-11);
        for status in &status[points.tangents.len()..] {
            seen[*status as usize] += 1;
        }
    }
    assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
}

/// Cohesion acts in closed contacts alone, so that a solution exists with all in compression.
#[test]
fn cohesion_holds_what_is_pressed() {
    let bound = ForceBound {
        cohesion: 0.2,
        ..COULOMB
    };
    for seed in 0..60 {
        let mut points = Points::new(1 + seed % 9, 17 * seed, bound);
        for c in &mut points.c[..1 + seed % 9] {
            *c += 12.0;
        }
        points.solved(&format!("seed {seed}"), 1e-11);
    }
}

/// Cohesion lost on opening leaves some contacts about to open: without pressure, under a part of it.
#[test]
fn cohesion_that_is_lost_as_contacts_open_leaves_a_solution() {
    let bound = ForceBound {
        cohesion: 1.5,
        ..COULOMB
    };
    let make: [fn(usize, usize, ForceBound) -> Points; 2] = [Points::new, Points::in_space];
    for make in make {
        let mut parting = 0;
        for seed in 0..120 {
            let points = make(5 + seed % 12, 17 * seed, bound);
            let (_, status) = points.solved(&format!("seed {seed}"), 1e-11);
            parting += usize::from(status.contains(&Status::Parting));
        }
        assert!(parting > 5, "{parting}");
    }
}

/// Given friction has one solution: that of the least energy, which coordinate descent finds, too.
#[test]
fn given_friction_has_the_solution_of_least_energy() {
    for seed in 0..16 {
        let points = Points::new(2 + seed % 4, 31 * seed + 5, GIVEN);
        let (n, m) = (points.tangents.len(), points.c.len());
        let mut t: Vec<f64> = points.bounds.clone();
        for _ in 0..4_000 {
            for i in 0..m {
                let others: f64 = (0..m).map(|j| points.h[(i, j)] * t[j]).sum();
                let (h, at) = (points.h[(i, i)], points.bounds[i]);
                let c = points.c[i] - others + h * t[i];
                t[i] = match i < n {
                    true => (c / h).min(at),
                    false => {
                        let force = c - h * at;
                        let over = (force.abs() - GIVEN.cohesion).max(0.0).copysign(force);
                        at + over / h
                    }
                };
            }
        }
        let mut status = vec![Status::Open; m];
        let solution = points.solve(&mut status);
        for (found, expected) in solution.jumps.iter().zip(&t) {
            assert!((found - expected).abs() < 1e-9, "seed {seed}");
        }
    }
}

/// A node before two walls at right angles: the tangent of either is the other's normal.
#[test]
fn laws_of_dependent_jumps_hold_too() {
    let mut slipping = 0;
    for seed in 0..100 {
        let mut points = Points::new(2, 13 * seed, COULOMB);
        let h = points.h.clone();
        points.set_stiffness(2, |i, j| h[(i, j)]);
        points.c.truncate(2);
        points.rows.push(vec![(1, -1.0)]);
        points.rows.push(vec![(0, 1.0)]);
        points.bounds.fill(0.0);
        let (_, status) = points.solved(&format!("seed {seed}"), 1e-9);
        let slips = |status: &&Status| status.sign() != 0.0;
        slipping += status.iter().filter(slips).count();
    }
    assert!(slipping > 10, "{slipping}");
}

#[test]
fn a_block_slides_where_the_slope_is_steeper_than_its_friction() {
    let mut points = Points::new(1, 3, COULOMB);
    points.set_stiffness(2, |i, j| if i == j { 10.0 } else { 0.0 });
    points.bounds = vec![0.0; 2];
    for (pull, expected) in [
        (0.3 - 1e-10, Status::Closed),
        (0.3 + 1e-10, Status::Forward),
        (-0.3 - 1e-10, Status::Backward),
    ] {
        points.c = vec![1.0, pull];
        let mut status = vec![Status::Open; 2];
        points.solve(&mut status);
        assert_eq!(status[1], expected);
    }
}

/// Sticking, slipping and opening are all in equilibrium, as slip relieves the contact.
#[test]
fn coulomb_s_friction_may_have_several_solutions() {
    let strong = ForceBound {
        coefficient: 1.5,
        ..COULOMB
    };
    for (coupling, opened) in [(0.9, Some(0.5 / 0.19)), (0.3, None)] {
        let mut points = Points::new(1, 3, strong);
        points.set_stiffness(2, |i, j| if i == j { 1.0 } else { coupling });
        points.bounds = vec![0.0; 2];
        points.c = vec![1.0, 1.4];
        let mut status = vec![Status::Closed; 2];
        let known = points.solve(&mut status).jumps;
        assert_eq!(known, [0.0; 2]);
        let other = points.with(|problem| problem.other_solution(&known, 1.0));
        assert_eq!(other.is_some(), opened.is_some());
        let (found, expected) = (other.unwrap_or_default(), opened.unwrap_or_default());
        assert!((found - expected).abs() < 1e-12, "{found}");
    }
}

#[test]
fn points_under_any_coefficient_find_a_solution() {
    for seed in 0..120 {
        let bound = ForceBound {
            coefficient: 0.5 + 0.04 * (seed % 50) as f64,
            cohesion: if seed % 3 == 0 { 0.3 } else { 0.0 },
            only_closed: seed % 3 != 0,
        };
        let mut points = Points::new(6 + seed % 15, 29 * seed + 3, bound);
        (0..points.c.len()).for_each(|i| points.h[(i, i)] -= 1.9);
        points.solved(&format!("seed {seed}"), 1e-10);
    }
}

/// A contact that would open if it stuck or slipped under all of its cohesion, and penetrate without any.
#[test]
fn a_contact_about_to_open_slips_under_part_of_its_cohesion() {
    let bound = ForceBound {
        coefficient: 0.0,
        cohesion: 1.0,
        only_closed: true,
    };
    let mut points = Points::new(1, 3, bound);
    points.set_stiffness(2, |i, j| if i == j { 1.0 } else { -0.5 });
    points.bounds = vec![0.0; 2];
    points.c = vec![-0.75, 2.0];
    let mut status = vec![Status::Closed; 2];
    let solution = points.solve(&mut status);
    assert!(solution.converged);
    assert_eq!(status, [Status::Closed, Status::Parting]);
    assert!((solution.jumps[1] - 1.5).abs() < 1e-14);
    assert_eq!(solution.forces[0], 0.0);
    assert!((solution.forces[1] - 0.5).abs() < 1e-14);
}

/// A body with an unresisted motion that has next to nothing of the last unknowns: elimination leaves round-off of
/// either sign for its stiffness, and no pivot is small.
#[test]
fn a_body_that_only_contact_stops_falls_until_it_does() {
    for seed in 0..40 {
        let mut points = Points::new(3, 41 * seed, COULOMB);
        let motion = [1.0, 1.0, 1.0, 1e-3, -3e-5, 2e-5];
        let pushed: Vec<f64> = (0..6)
            .map(|i| (0..6).map(|j| points.h[(i, j)] * motion[j]).sum())
            .collect();
        let resists: f64 = motion.iter().zip(&pushed).map(|(z, f)| z * f).sum();
        points.h = Mat::from_fn(6, 6, |i, j| {
            points.h[(i, j)] - pushed[i] * pushed[j] / resists
        });
        points.bounds[..3].copy_from_slice(&[0.0, 1e-3, 2e-3]);
        points.c = vec![0.4, 0.5, 0.6, 0.01, 0.02, -0.01];
        let mut status = vec![Status::Open; 6];
        let solution = points.solve(&mut status);
        assert!(solution.converged, "seed {seed}");
        let violation = points.violation(&solution);
        assert!(violation < 1e-11, "seed {seed}: {violation}");
    }
}

/// A free body between points that all slip, in either direction.
#[test]
fn given_friction_lets_a_free_body_slip_both_ways() {
    for seed in 0..100 {
        let mut points = Points::new(
            4,
            53 * seed,
            ForceBound {
                cohesion: 1e-3,
                ..GIVEN
            },
        );
        let mean = |h: &Mat<f64>, i: usize| (4..8).map(|j| h[(i, j)]).sum::<f64>() / 4.0;
        for _ in 0..2 {
            let h = &points.h;
            let without = Mat::from_fn(8, 8, |i, j| {
                h[(i, j)] - if j < 4 { 0.0 } else { mean(h, i) }
            });
            points.h = without.transpose().to_owned();
        }
        points.bounds.fill(0.0);
        points.c = vec![2.0, 2.0, 2.0, 2.0, 1.0, 1.2, -0.9, -1.3];
        points.solved(&format!("seed {seed}"), 1e-10);
    }
}

/// More than a hundred points, few of them in contact: the open ones are condensed out, whatever is closed at first.
#[test]
fn a_patch_has_the_solution_of_the_whole() {
    for seed in 0..4 {
        let mut points = Points::in_space(120, 1_000 * seed, COULOMB);
        for c in &mut points.c[..90] {
            *c -= 8.0;
        }
        // A row keeps its jumps in the patch, and so does friction without pressure.
        points.rows.push(vec![(0, 1.0), (1, -0.5)]);
        points.bounds.push(0.05);
        points.tangents[4].bound = GIVEN;
        points.tangents[5].bound = GIVEN;
        for begin in [Status::Closed, Status::Open] {
            let what = format!("seed {seed}, {begin:?}");
            let mut status = vec![begin; points.bounds.len()];
            let found = points.with(|problem| problem.solve_on_patch(&mut status));
            let found = found.expect(&what);
            let violation = points.violation(&found);
            assert!(violation < 1e-10, "{what}: {violation:e}");
            let open = status.iter().filter(|status| **status == Status::Open);
            assert!(open.count() > 150, "{what}");
            let mut whole = vec![begin; points.bounds.len()];
            let of_whole = points.with(|problem| problem.solve_whole(&mut whole));
            for (found, expected) in found.jumps.iter().zip(&of_whole.jumps) {
                assert!(
                    (found - expected).abs() < 1e-10,
                    "{what}: {found} {expected}"
                );
            }
            let fixed = |(i, status): (usize, &Status)| match status {
                Status::Open => FixedStatus::Open,
                Status::Closed => FixedStatus::Closed {
                    distance: points.bounds[i],
                },
                _ => FixedStatus::Slips {
                    share: [0.6, 0.8][i % 2],
                    turning: 0.5,
                },
            };
            let fixed: Vec<FixedStatus> = status.iter().enumerate().map(fixed).collect();
            let change = points.with(|problem| problem.change_on_patch(&fixed));
            let change = change.expect(&what);
            let of_whole = points.with(|problem| problem.change_whole(&fixed));
            let changes = [change.jumps, change.forces].concat();
            let expected = [of_whole.jumps, of_whole.forces].concat();
            for (change, expected) in changes.iter().zip(&expected) {
                assert!(
                    (change - expected).abs() < 1e-10,
                    "{what}: {change} {expected}"
                );
            }
        }
    }
}

/// The force on a side of a polygon is up to half of the angle between sides off the slip, which a stiffness of 2 and
/// more reduces to less than half of that; in the plane polygons and friction cones are the same.
#[test]
fn lemke_s_path_ends_near_the_solution_the_nearer_the_finer_polygons_are() {
    let make: [fn(usize, usize, ForceBound) -> Points; 2] = [Points::new, Points::in_space];
    for (dim, make) in (2..).zip(make) {
        for seed in 0..60 {
            let points = make(1 + seed % 12, 29 * seed + 3, [COULOMB, GIVEN][seed % 2]);
            let (solution, _) = points.solved(&format!("seed {seed}"), 1e-11);
            let tangents = points.tangents.iter();
            let forces = tangents.map(|tangent| solution.forces[tangent.limit].powi(2));
            let force = forces.sum::<f64>().sqrt();
            let mut ends = Vec::new();
            points.with(|problem| {
                problem.try_paths(usize::MAX, |end, _| {
                    ends.push(end.map_or_else(Vec::new, |end| end.jumps.clone()));
                    (ends.len() == 4).then_some(())
                })
            });
            // Polygons of 16 sides, then of 4 times as many in every round.
            for (round, jumps) in (0..).zip(&ends) {
                assert_eq!(jumps.len(), solution.jumps.len(), "{seed}");
                let known = solution.jumps.iter().zip(jumps);
                let off = known.fold(0.0, |m: f64, (known, t)| m.max((known - t).abs()));
                let apart = match dim {
                    2 => 1e-7,
                    _ => 0.5 * PI / (16.0 * 4.0_f64.powi(round)) * force + 1e-7,
                };
                assert!(off < apart, "{dim}, {seed}, {round}: {off:e}");
            }
        }
    }
}

/// Points before a body that isn't there yet, from statuses of a bilateral problem.
#[test]
fn nothing_moves_without_load_and_overlap() {
    for seed in 0..20 {
        let mut points = Points::in_space(4, 61 * seed, [COULOMB, GIVEN][seed % 2]);
        points.c.fill(0.0);
        points.bounds.fill(0.0);
        points.bounds[..3].copy_from_slice(&[0.1, 0.2, 1e-3]);
        let mut status = vec![Status::Closed; 12];
        let solution = points.solve(&mut status);
        assert!(solution.converged);
        assert_eq!(solution.jumps, [0.0; 12]);
        assert_eq!(solution.forces, [0.0; 12]);
        let open = status.iter().filter(|status| **status == Status::Open);
        assert_eq!(open.count(), [9, 3][seed % 2]);
    }
}
