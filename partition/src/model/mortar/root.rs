//! Roots of a function on the reference line.

/// Ends of the reference line.
pub(super) const ENDS: [f64; 2] = [-1.0, 1.0];

/// Number of steps after which even bisection has converged.
const STEPS: usize = 100;

/// The ξ in (−1, 1) at which `function`, a value and its derivative, changes sign: Newton's method, with bisection
/// where it would leave the bracket. `None` where both ends have the same sign.
pub(super) fn root(function: impl Fn(f64) -> [f64; 2]) -> Option<f64> {
    let [mut low, mut high] = ENDS;
    let [at_low, at_high] = ENDS.map(|end| function(end)[0]);
    let rises = at_low < 0.0 && at_high > 0.0;
    let falls = at_low > 0.0 && at_high < 0.0;
    if !rises && !falls {
        return None;
    }
    // The secant gives the root of a linear function directly.
    let mut xi = (at_low + at_high) / (at_low - at_high);
    for _ in 0..STEPS {
        let [value, slope] = function(xi);
        if value == 0.0 {
            break;
        }
        if (value > 0.0) == rises {
            high = xi;
        } else {
            low = xi;
        }
        let newton = xi - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - xi).abs() <= 2.0 * f64::EPSILON {
            return Some(next);
        }
        xi = next;
    }
    Some(xi)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_is_found_however_crooked_the_function() {
        for at in [-0.999, -0.4, 0.0, 0.3, 0.999_999] {
            let straight = root(|x| [3.0 * (x - at), 3.0]).unwrap();
            assert!((straight - at).abs() < 1e-15);
            let cubic = root(|x| [(x - at).powi(3), 3.0 * (x - at).powi(2)]).unwrap();
            assert!((cubic - at).abs() < 1e-5, "{cubic} and {at}");
            let steep = root(|x| {
                let far = 50.0 * (x - at);
                [far.atan(), 50.0 / (1.0 + far * far)]
            });
            assert!((steep.unwrap() - at).abs() < 1e-14);
        }
    }

    #[test]
    fn there_is_none_without_a_change_of_sign() {
        assert_eq!(root(|x| [x * x + 0.1, 2.0 * x]), None);
        assert_eq!(root(|x| [x - 1.0, 1.0]), None);
    }
}
