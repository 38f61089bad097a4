//! The patch test: a uniform stress passes through cells and contacts of any kinds.

use super::close::close;
use super::solution::Solution;

impl Solution {
    /// Fails unless cells have this stress, to within `slack` (Pa).
    #[track_caller]
    pub fn check_cells(&self, stress: [f64; 6], slack: f64) {
        for (_, found) in &self.cells {
            (found.iter().zip(stress)).for_each(|(found, exact)| close(*found, exact, slack));
        }
    }

    /// Fails unless cells and nodes have this stress, to within `slack` (Pa).
    #[track_caller]
    pub fn check_stress(&self, stress: [f64; 6], slack: f64) {
        self.check_cells(stress, slack);
        for found in self.nodal_stress.values() {
            (found.iter().zip(stress)).for_each(|(found, exact)| close(*found, exact, slack));
        }
    }

    /// Fails unless all contact points are closed under this pressure, to within `slack` (Pa).
    #[track_caller]
    pub fn check_pressure(&self, pressure: f64, slack: f64) {
        for point in self.points() {
            assert!(point.closed, "{point:?}");
            close(point.pressure, pressure, slack);
        }
    }
}
