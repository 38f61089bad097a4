//! Further solutions: Coulomb friction may have several.

use super::{FrictionProblem, Status};

/// Difference of distinct solutions, relative to the displacements: more than round-off.
const ANOTHER: f64 = 1e-7;

impl FrictionProblem<'_> {
    /// Largest difference (m) between the `known` jumps and another solution, sought from contacts that all slip, in
    /// either direction, or are all open; `scale` is that of the displacements.
    pub fn other_solution(&self, known: &[f64], scale: f64) -> Option<f64> {
        let limits = self.contact.bounds.len();
        let all_slip = |slipping: Status| {
            let mut status = vec![Status::Closed; limits];
            for tangent in self.tangents {
                status[tangent.limit] = slipping;
            }
            status
        };
        let starts = [
            all_slip(Status::Forward),
            all_slip(Status::Backward),
            vec![Status::Open; limits],
        ];
        let differences = starts.into_iter().filter_map(|mut status| {
            let solution = self.solve(&mut status);
            let differences = solution.jumps.iter().zip(known);
            let largest = differences.fold(0.0, |m: f64, (t, known)| m.max((t - known).abs()));
            (solution.converged && largest > ANOTHER * scale).then_some(largest)
        });
        differences.reduce(f64::max)
    }
}
