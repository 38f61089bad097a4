//! Scenes with a solution chosen first, and loads and gaps computed from it.

use contact_dd_partition::element::geometry::padded;
use contact_dd_partition::model::Model;

use super::super::assembled::Assembled;
use super::super::random::Random;

/// Replaces forces, gaps and prescribed displacements by those of a smooth displacement with contact forces at any
/// conditions: K u + Bᵀ λ = f, B u = g where λ > 0.
pub fn manufacture(model: &mut Model, random: &mut Random) {
    let assembled = Assembled::new(model);
    let dim = model.mesh.dim;
    let size = random.magnitude(-9.0, 0.0);
    let mut wave = || -> Vec<f64> { (0..dim + 1).map(|_| random.within(0.1, 3.0)).collect() };
    let waves: Vec<Vec<f64>> = (0..dim).map(|_| wave()).collect();
    let u: Vec<f64> = (model.mesh.points.iter())
        .flat_map(|p| {
            let along = |wave: &Vec<f64>| {
                let (slopes, shift) = wave.split_at(dim);
                let phase: f64 = slopes.iter().zip(p).map(|(a, x)| a * x).sum();
                size * (phase + shift[0]).sin()
            };
            waves.iter().map(along).collect::<Vec<f64>>()
        })
        .collect();
    let mut force = assembled.times(&u);
    let largest = force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    let share_closed = random.pick(&[0.1, 0.5, 0.9]);
    let small = random.pick(&[0.0, -3.0, -6.0]);
    let conditions = model.contacts.iter_mut().flat_map(|c| &mut c.points);
    for (condition, (row, _)) in conditions.zip(&assembled.conditions) {
        let jump: f64 = row.iter().map(|&(dof, c)| c * u[dof]).sum();
        let (mut left, mut pressed) = (0.0, 0.0);
        match random.chance(share_closed) {
            true => pressed = largest * random.magnitude(small, 0.0),
            false => left = size * random.magnitude(small, 0.0),
        }
        condition.gap = jump + left;
        condition.is_gap_given = true;
        for &(dof, c) in row {
            force[dof] += c * pressed;
        }
    }
    for (support, (row, _)) in model.supports.iter_mut().zip(&assembled.supports) {
        support.value = row.iter().map(|&(dof, c)| c * u[dof]).sum();
    }
    model.forces = (force.chunks(dim).enumerate())
        .map(|(node, f)| (node as u32, padded(f)))
        .collect();
}
