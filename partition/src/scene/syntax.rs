//! Messages for a line with a syntax error: toml's message, and advice on common mistakes.

use toml::de::Error;

/// The names of lists of a scene, as in `[[contact]]`.
const LISTS: [&str; 11] = [
    "coupling",
    "displacement",
    "bilateral",
    "traction",
    "pressure",
    "force",
    "spring",
    "contact",
    "tie",
    "equation",
    "step",
];

/// Largest length of a displayed line.
const LONGEST: usize = 200;

/// The message of `toml` on `text`, advice, and the line with a caret below it.
pub(super) fn described(text: &str, start: usize, error: &Error) -> String {
    let from = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let line = text[from..].lines().next().unwrap_or_default();
    let is_repeated = error.message().contains("duplicate key");
    let advice = match line.trim().trim_start_matches('[').split_once(']') {
        Some((table, _)) if is_repeated => double_brackets(table.trim()),
        _ => decimal_comma(line).or_else(|| {
            let (key, value) = line.split_once('=')?;
            let value = value.split('#').next().unwrap_or_default();
            of_value(key.trim(), value.trim())
        }),
    };
    let message = error.message();
    let mut message = match advice {
        Some(advice) => format!("{message}; {advice}"),
        None if is_repeated => message.to_owned(),
        None => format!("this isn't valid TOML: {message}"),
    };
    if line.chars().count() <= LONGEST {
        let shown = error.to_string();
        for line in shown.lines().skip(1).take(3) {
            message += &format!("\n{line}");
        }
    }
    message
}

/// Advice for a table in place of a list, or for several tables of the same name.
pub(super) fn double_brackets(table: &str) -> Option<String> {
    let last = table.rsplit('.').next()?;
    LISTS
        .contains(&last)
        .then(|| format!("expected [[{table}]] in double brackets, once for each"))
}

/// Advice for a number with a decimal comma after any `key =` of the line, as in a table `{ … }`.
fn decimal_comma(line: &str) -> Option<String> {
    let line = line.split('#').next().unwrap_or_default();
    line.match_indices('=').find_map(|(at, _)| {
        let is_of_key = |c: char| c.is_alphanumeric() || "_-".contains(c);
        let before = line[..at].trim_end();
        let key = before.trim_end_matches(is_of_key).len();
        let (whole, behind) = line[at + 1..].trim_start().split_once(',')?;
        whole.parse::<f64>().ok()?;
        let end = behind.find(|c: char| !(c.is_ascii_digit() || "eE+-".contains(c)));
        let digits = &behind[..end.unwrap_or(behind.len())];
        let pointed = format!("{whole}.{digits}");
        let is_number =
            digits.starts_with(|c: char| c.is_ascii_digit()) && pointed.parse::<f64>().is_ok();
        is_number.then(|| format!("expected a decimal point: {} = {pointed}", &before[key..]))
    })
}

/// Advice for the text after `key =`.
fn of_value(key: &str, value: &str) -> Option<String> {
    if matches!(value, "True" | "TRUE" | "False" | "FALSE") {
        return Some(format!("expected {}", value.to_lowercase()));
    }
    let is_of_number = |c: char| c.is_ascii_digit() || "+-._eE".contains(c);
    let end = value.find(|c| !is_of_number(c)).unwrap_or(value.len());
    let (number, rest) = value.split_at(end);
    let is_number = number.parse::<f64>().is_ok();
    let mut rest = rest.trim_start().chars();
    match (rest.next()?, rest.next()) {
        (letter, _) if is_number && (letter.is_alphabetic() || "%°".contains(letter)) => {
            Some(format!("a number has no unit: {key} = {number}"))
        }
        ('"' | '\'' | '[' | '{', _) if end == 0 => None,
        (sign, _) if end == 0 || "*^/(".contains(sign) => {
            let plain = value.trim_matches(|c: char| "“”„‟‘’".contains(c));
            Some(format!("expected quotes: {key} = \"{plain}\""))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::de::DeTable;

    #[test]
    fn frequent_slips_are_answered_with_advice() {
        for (text, expected) in [
            ("young = 210e9Pa", "a number has no unit: young = 210e9"),
            ("young = 210 GPa # E", "a number has no unit: young = 210"),
            ("young = 5,2e9", "expected a decimal point: young = 5.2e9"),
            (
                "m = { young = 5.2e9, poisson = 0,18 }",
                "expected a decimal point: poisson = 0.18",
            ),
            (
                "m = { young = 5,2e9, poisson = 0.18 }",
                "expected a decimal point: young = 5.2e9",
            ),
            ("poisson = -0,18 # granite", "point: poisson = -0.18"),
            ("young = 5.2*10^9", "expected quotes: young = \"5.2*10^9\""),
            ("value = sin(x)", "expected quotes: value = \"sin(x)\""),
            ("on = top", "expected quotes: on = \"top\""),
            ("on = “top”", "expected quotes: on = \"top\""),
            ("no_stress = True", "expected true"),
            (
                "[contact]\nname = 'a'\n[contact]\nname = 'b'",
                "expected [[contact]] in double brackets",
            ),
            (
                "[contact]\nname = 'a'\n[[contact]]\nname = 'b'",
                "expected [[contact]] in double brackets",
            ),
            ("a = 1\na = 2", "duplicate key\n  |\n2 | a = 2"),
            ("on = \"top", "\n1 | on = \"top\n"),
        ] {
            let error = DeTable::parse(text).unwrap_err();
            let message = described(text, error.span().unwrap().start, &error);
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
