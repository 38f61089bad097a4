//! Comparison of numbers up to a tolerance.

/// Fails unless both agree to within `slack`.
#[track_caller]
pub fn close(a: f64, b: f64, slack: f64) {
    assert!((a - b).abs() <= slack, "{a:e}; expected {b:e} ± {slack:e}");
}
