//! A contact law is added.

use contact_dd_mpi::contact::pair::PairResponse;
use nalgebra::{DMatrix, DVector};

use super::small::{APPROACHES, Cluster, Exact, Small, exact};
use crate::support::close::close;
use crate::support::random::Random;

const M: usize = APPROACHES;

/// What a pair answers to U, found by trying all sets: t, λ, and the forces that hold U.
fn by_trial(pair: &Cluster, u: &[f64]) -> (Exact, Vec<f64>) {
    let s = &pair.condensed.s;
    let h = DMatrix::from_fn(M, M, |i, j| s[(i, j)]);
    let driven = |i: usize| pair.load[i] - along(pair, i, u);
    let c = DVector::from_fn(M, |i, _| driven(i));
    let answer = exact(&h, &c, &pair.gaps, &pair.compliances);
    let reaction = (M..s.nrows()).map(|i| {
        let by_t: f64 = (0..M).map(|j| s[(i, j)] * answer.x[j]).sum();
        along(pair, i, u) + by_t - pair.load[i]
    });
    let reaction = reaction.collect();
    (answer, reaction)
}

/// Row i of S times U.
fn along(pair: &Cluster, i: usize, u: &[f64]) -> f64 {
    let terms = u.iter().enumerate();
    terms.map(|(j, u)| pair.condensed.s[(i, M + j)] * u).sum()
}

/// Traces that open and close contacts in many ways, and what a pair answers to them.
fn answers(pair: &Cluster) -> Vec<(Vec<f64>, PairResponse, Vec<f64>)> {
    let (mut random, mut of_program) = (Random::new(2), pair.pair());
    let ask = |_| {
        let u: Vec<f64> = (0..pair.condensed.interface_dofs.len())
            .map(|_| 2.0 * random.signed())
            .collect();
        let response = of_program.evaluate(&u, None);
        let (forces, _) = of_program.conditions();
        (u, response, forces)
    };
    (0..100).map(ask).collect()
}

#[test]
fn a_pair_behind_a_layer_answers_as_the_law_says() {
    for seed in 0..20 {
        let [_, pair] = Small::with_layers(seed).pairs;
        let mut counts = [0; 2];
        for (u, response, forces) in answers(&pair) {
            assert!(response.converged);
            let (exact, reaction) = by_trial(&pair, &u);
            for (a, b) in response.reaction.iter().zip(&reaction) {
                close(*a, *b, 1e-11);
            }
            for (i, &force) in forces.iter().enumerate() {
                close(force, exact.forces[i], 1e-11);
                // What the report calls the gap is τ's; t is beyond it by what the layer gives way.
                let t = pair.gaps[i] - response.gaps[i] + pair.compliances[i] * force;
                close(t, exact.x[i], 1e-11);
                close(
                    pair.compliances[i] * force,
                    (t - pair.gaps[i]).max(0.0),
                    1e-11,
                );
                let is_closed = response.status[i].is_closed();
                assert_eq!(is_closed, force != 0.0);
                counts[usize::from(is_closed)] += 1;
            }
        }
        assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
    }
}

/// The equilibrium that the certificate checks is that of the pair without the layer.
#[test]
fn forces_balance_the_pair_itself() {
    let [_, pair] = Small::with_layers(5).pairs;
    for (u, response, forces) in answers(&pair) {
        let t: Vec<f64> = (0..M)
            .map(|i| pair.gaps[i] - response.gaps[i] + pair.compliances[i] * forces[i])
            .collect();
        for (i, &force) in forces.iter().enumerate() {
            let held: f64 = (0..M).map(|j| pair.condensed.s[(i, j)] * t[j]).sum();
            close(held + along(&pair, i, &u) + force, pair.load[i], 2e-11);
        }
    }
}

#[test]
fn the_derivative_is_that_of_the_answers() {
    let [_, pair] = Small::with_layers(6).pairs;
    let (mut random, mut of_program) = (Random::new(3), pair.pair());
    let mut compared = 0;
    for (u, ..) in answers(&pair) {
        let before = of_program.evaluate(&u, None);
        let direction: Vec<f64> = u.iter().map(|_| random.signed()).collect();
        let slope = of_program.derivative(&direction);
        let step = 1e-3;
        let there: Vec<f64> = u
            .iter()
            .zip(&direction)
            .map(|(u, d)| u + step * d)
            .collect();
        let after = of_program.evaluate(&there, None);
        // Between two kinks the answers are linear.
        if before.status != after.status {
            continue;
        }
        compared += 1;
        let change = after.reaction.iter().zip(&before.reaction);
        for ((after, before), slope) in change.zip(slope) {
            close((after - before) / step, slope, 1e-9);
        }
    }
    assert!(compared > 50, "{compared}");
}

#[test]
fn a_layer_that_gives_nothing_way_is_none() {
    let [_, mut pair] = Small::with_layers(7).pairs;
    pair.compliances = vec![0.0; M];
    for (u, response, forces) in answers(&pair) {
        let (exact, reaction) = by_trial(&pair, &u);
        for (a, b) in response.reaction.iter().zip(&reaction) {
            close(*a, *b, 1e-11);
        }
        for (force, exact) in forces.iter().zip(&exact.forces) {
            close(*force, *exact, 1e-11);
        }
        assert!(response.gaps.iter().all(|&gap| gap >= 0.0));
    }
}
