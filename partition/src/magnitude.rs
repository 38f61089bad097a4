//! Admissible magnitudes of numbers, and numbers as text.

/// The largest absolute value: its square is still far from overflow.
pub const LARGEST: f64 = 1e120;

/// The smallest stiffness (Pa).
pub const SMALLEST_STIFFNESS: f64 = 1e-120;

/// The smallest area of a cell (m²), below which squares of its edges lose digits.
pub const SMALLEST_AREA: f64 = 1e-250;

/// Checks that a number is finite and at most [`LARGEST`].
///
/// # Errors
/// The expectation.
pub fn check(value: f64) -> Result<f64, String> {
    if !value.is_finite() {
        Err("a finite number".into())
    } else if value.abs() > LARGEST {
        Err(format!("a number of at most {LARGEST:e} in size"))
    } else {
        Ok(value)
    }
}

/// A number with at most four digits.
pub fn short(number: f64) -> String {
    // A formatted number can be parsed.
    let rounded = format!("{number:.3e}").parse().unwrap_or(number);
    match rounded.abs() {
        size if size != 0.0 && !(1e-3..1e5).contains(&size) => format!("{rounded:e}"),
        _ => format!("{rounded}"),
    }
}

/// A number with all of its digits, and with an exponent where these would begin or end in many zeros.
pub fn plain(number: f64) -> String {
    match number.abs() {
        size if size != 0.0 && !(1e-6..1e15).contains(&size) => format!("{number:e}"),
        _ => format!("{number}"),
    }
}

/// A point with `dim` coordinates of at most four digits: `(1, -0.5)`.
pub fn short_point(at: [f64; 3], dim: usize) -> String {
    let coordinates: Vec<String> = at.iter().take(dim).map(|&c| short(c)).collect();
    format!("({})", coordinates.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_overflows_when_it_is_squared_is_no_number() {
        for value in [0.0, -1e120, 5e-324] {
            assert_eq!(check(value), Ok(value));
        }
        for value in [f64::NAN, f64::INFINITY, 1.1e120, -1e300] {
            assert!(check(value).is_err(), "{value}");
        }
    }

    #[test]
    fn numbers_of_any_size_are_short() {
        for (number, expected) in [
            (0.0, "0"),
            (-0.00123456, "-0.001235"),
            (0.000123456, "1.235e-4"),
            (99999.0, "1e5"),
            (12345.6, "12350"),
            (5.646e9, "5.646e9"),
        ] {
            assert_eq!(short(number), expected);
        }
        assert_eq!(plain(0.500000001), "0.500000001");
        assert_eq!(plain(1e-300), "1e-300");
        assert_eq!(short_point([1.0, -0.123456, 0.0], 2), "(1, -0.1235)");
    }
}
