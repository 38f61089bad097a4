//! Halving of the increments of a load step.

/// Smallest increment tried, as a fraction of the load step.
pub const SMALLEST: f64 = 1.0 / 8.0;

/// Progress of a load step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepHalving {
    done: f64,
    part: f64,
    /// Number of accepted increments.
    pub increments: usize,
}

impl Default for StepHalving {
    fn default() -> Self {
        Self {
            done: 0.0,
            part: 0.5,
            increments: 0,
        }
    }
}

impl StepHalving {
    /// Fraction of the load at the end of the next increment.
    pub fn next(&self) -> f64 {
        f64::min(1.0, self.done + self.part)
    }

    /// Accepts the next increment; returns true if it was the last.
    pub fn accept(&mut self) -> bool {
        self.done = self.next();
        self.increments += 1;
        self.done >= 1.0
    }

    /// Halves the next increment; returns false if that is too small.
    pub fn halve(&mut self) -> bool {
        self.part *= 0.5;
        self.part >= SMALLEST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_in_halves_ends_where_the_load_step_does() {
        let mut halving = StepHalving::default();
        assert!(!halving.accept());
        assert!(halving.halve());
        assert_eq!(halving.next(), 0.75);
        assert!(!halving.accept());
        assert!(halving.accept());
        assert_eq!(halving.increments, 3);
        assert!(halving.halve() && !halving.halve());
    }
}
