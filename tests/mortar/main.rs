//! Contact of sides whose nodes don't match.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod patch;
mod round;
mod sorts;
#[path = "../support/mod.rs"]
mod support;
mod system;

use support::blocks::Blocks;
use support::random::Random;

/// Two materials, and bodies of them in turn.
fn materials(bodies: &[&str]) -> String {
    let mut text = "plane = 'strain'
        materials.m0 = {young = 210e9, poisson = 0.3}
        materials.m1 = {young = 20e9, poisson = 0.22}\n"
        .to_owned();
    for (i, body) in bodies.iter().enumerate() {
        text += &format!("bodies.'{body}'.material = 'm{}'\n", i % 2);
    }
    text
}

/// A block of n[0] × n[1] cells whose nodes lie along x as they happen to.
fn block(blocks: Blocks, name: &str, x: [f64; 2], y: [f64; 2], n: [usize; 2], seed: u64) -> Blocks {
    let mut random = Random::new(seed);
    let columns: Vec<f64> = (0..=n[0])
        .map(|i| match i == 0 || i == n[0] {
            true => i as f64 / n[0] as f64,
            false => (i as f64 + 0.35 * random.signed()) / n[0] as f64,
        })
        .collect();
    blocks.mapped(name, n, |[s, t]| {
        let column = columns[(s * n[0] as f64).round() as usize];
        [x[0] + column * (x[1] - x[0]), y[0] + t * (y[1] - y[0])]
    })
}
