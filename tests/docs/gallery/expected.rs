//! A row of a page's table of numbers.

/// A number from a run.
pub struct Expected {
    /// Description.
    name: String,
    /// The number.
    found: f64,
    /// One unit in its last digit.
    last_digit: f64,
    /// A number from theory, and the allowed relative deviation from it.
    theory: Option<(f64, f64)>,
    /// Position in the run's output.
    pub place: String,
}

impl Expected {
    /// # Panics
    /// If a cell can't be read.
    pub fn parse([name, found, theory, off, place]: &[String; 5]) -> Self {
        let (value, last_digit) = number(found);
        let theory = match (theory.as_str(), off.as_str()) {
            ("", "") => None,
            (theory, off) => {
                let percent = off.strip_suffix(" %");
                let percent = percent.unwrap_or_else(|| panic!("{name}: '{off}' isn't n %"));
                Some((number(theory).0, number(percent).0 / 100.0))
            }
        };
        Self {
            name: name.clone(),
            found: value,
            last_digit,
            theory,
            place: place.clone(),
        }
    }

    /// The error of a run's number, if any.
    pub fn fault(&self, number: f64) -> Option<String> {
        let Self { name, found, .. } = self;
        // A difference of one in the last digit of a whole number isn't allowed.
        let is_found = (number - found).abs() < (1.0 - 1e-9) * self.last_digit;
        let is_theory =
            (self.theory).is_none_or(|(theory, off)| (number - theory).abs() <= off * theory.abs());
        match (is_found, is_theory) {
            (true, true) => None,
            (false, _) => Some(format!("{name}: {number:e}, on the page {found:e}")),
            (true, false) => Some(format!("{name}: {number:e} is off from theory by more")),
        }
    }
}

/// A number, and one unit in its last digit.
fn number(text: &str) -> (f64, f64) {
    let text = text.replace('−', "-");
    let value = text.parse();
    let value: f64 = value.unwrap_or_else(|_| panic!("'{text}' isn't a number"));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i32);
    (
        value,
        10_f64.powi(exponent.parse::<i32>().unwrap() - decimals),
    )
}

fn row(found: &str, theory: &str, off: &str) -> Expected {
    Expected::parse(&["a number", found, theory, off, "somewhere"].map(str::to_owned))
}

/// A test: results agree with the last digit.
pub fn to_the_last_digit() {
    assert_eq!(row("31", "", "").fault(31.0), None);
    assert_eq!(row("8.32e6", "", "").fault(8.3249e6), None);
    assert_eq!(row("−1.80e7", "-1.8e7", "0.1 %").fault(-1.80001e7), None);
}

/// A test: deviations from theory are bounded.
pub fn off() {
    assert!(row("31", "", "").fault(32.0).is_some());
    assert!(row("8.32e6", "", "").fault(8.331e6).is_some());
    assert!(row("-1.80e7", "", "").fault(1.80e7).is_some());
    assert!(row("8.32e6", "8.30e6", "0.1 %").fault(8.32e6).is_some());
    assert!(row("8.32e6", "", "").fault(f64::NAN).is_some());
}
