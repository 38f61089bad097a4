//! Text that isn't TOML, in words for somebody who doesn't know TOML.

/// Longest piece of a line that is shown.
const LONGEST: usize = 60;

/// What is wrong in `text`, where the parser gave up at `start` and said `message`.
pub(super) fn described(text: &str, start: usize, message: &str) -> String {
    let before = text.get(..start).unwrap_or(text);
    let from = before.rfind('\n').map_or(0, |at| at + 1);
    let line = text[from..].lines().next().unwrap_or_default().trim();
    let line = without_comment(line);
    let found = shown(line);
    if message.contains("duplicate key") {
        return repeated(text, line);
    }
    if line.starts_with('[') {
        return format!(
            "found {found}; expected [table] or [[list of tables]], closed on the line"
        );
    }
    let Some((key, value)) = line.split_once('=') else {
        return format!("found {found}; expected key = value");
    };
    value_fault(key.trim(), value.trim(), message)
}

/// What is wrong with what stands behind `key =`.
fn value_fault(key: &str, value: &str, message: &str) -> String {
    let found = shown(value);
    let behind = |rest: &str| {
        let rest = shown(rest.trim());
        format!(
            "found {rest} behind the value; expected the end of the line, or a comment that begins with #"
        )
    };
    let Some(first) = value.chars().next() else {
        return format!("'{key}' has no value; expected key = value");
    };
    if first == '"' || first == '\'' {
        let inside = &value[1..];
        return match inside.find(first) {
            None => format!("the text {found} isn't closed; expected {first} at its end"),
            Some(_) if message.contains("escape") => format!(
                "{found} holds a backslash, which means something else in double quotes; \
                 expected / in its place, or single quotes"
            ),
            Some(end) => behind(&inside[end + 1..]),
        };
    }
    if first == '[' || first == '{' {
        return format!("found {found}; expected [value, value] or {{ key = value, key = value }}");
    }
    if matches!(value, "True" | "TRUE" | "False" | "FALSE") {
        return format!("found {value}; expected {}", value.to_lowercase());
    }
    let (number, rest) = value.split_at(number_length(value));
    if number.is_empty() {
        let plain = shown(value.trim_matches(|c: char| "“”„‟‘’".contains(c)));
        return format!("found {found}; expected it in quotes: {key} = \"{plain}\"");
    }
    let rest = rest.trim();
    let mut after = rest.chars();
    match (after.next(), after.next()) {
        (Some(','), Some(next)) if next.is_ascii_digit() => {
            let pointed = shown(&format!("{number}.{}", &rest[1..]));
            format!("found {found}; expected a point in the number: {pointed}")
        }
        (Some('*' | '^' | '+' | '-' | '/' | '('), next) if next != Some('/') => {
            format!("found {found}; expected an expression in quotes: {key} = \"{found}\"")
        }
        (Some(letter), _) if letter.is_alphabetic() || "%°".contains(letter) => {
            format!("found {found}; expected a number without a unit: {key} = {number}")
        }
        (Some(_), _) => behind(rest),
        (None, _) => format!("found {found}; expected a number, as 5.2e9 or 0.3 ({message})"),
    }
}

/// What is wrong with a key or a table that is there before this `line`.
fn repeated(text: &str, line: &str) -> String {
    let name = line.trim_start_matches('[').trim_end_matches(']');
    let [one, list] = [format!("[{name}]"), format!("[[{name}]]")];
    let is_there = |header: &str| {
        text.lines()
            .any(|line| without_comment(line.trim()) == header)
    };
    if line.starts_with('[') && is_there(&one) && is_there(&list) {
        return format!(
            "{} stands here, and elsewhere {}; expected double brackets for all, or one in single brackets",
            shown(line),
            if line == one { list } else { one }
        );
    }
    let what = match line.starts_with('[') {
        true => shown(line),
        false => format!(
            "'{}'",
            shown(line.split('=').next().unwrap_or_default().trim())
        ),
    };
    format!("{what} stands here for the second time; expected it once")
}

/// A line up to a comment, which begins with # outside of quotes.
fn without_comment(line: &str) -> &str {
    let mut quote = None;
    for (at, c) in line.char_indices() {
        match (quote, c) {
            (None, '#') => return line[..at].trim_end(),
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), _) if open == c => quote = None,
            _ => {}
        }
    }
    line
}

/// Length of the number that a value begins with, in bytes; 0 where it begins with something else.
fn number_length(value: &str) -> usize {
    let digits = |from: usize| {
        let rest = value[from..].bytes();
        rest.take_while(|c| c.is_ascii_digit() || *c == b'_')
            .count()
    };
    let mut end = usize::from(value.starts_with(['+', '-']));
    let whole = digits(end);
    if whole == 0 {
        return 0;
    }
    end += whole;
    if value[end..].starts_with('.') {
        end += 1 + digits(end + 1);
    }
    if value[end..].starts_with(['e', 'E']) {
        let sign = end + 1 + usize::from(value[end + 1..].starts_with(['+', '-']));
        if digits(sign) > 0 {
            end = sign + digits(sign);
        }
    }
    end
}

/// The beginning of a piece of text, without what would spoil the terminal.
fn shown(piece: &str) -> String {
    let mut shown: String = (piece.chars().take(LONGEST))
        .filter(|c| !c.is_control())
        .collect();
    if piece.chars().count() > LONGEST {
        shown.push('…');
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::de::DeTable;

    #[test]
    fn slips_are_named_in_plain_words() {
        for (line, expected) in [
            (
                "young = 210e9Pa",
                "found 210e9Pa; expected a number without a unit: young = 210e9",
            ),
            (
                "young = 210 GPa # steel",
                "found 210 GPa; expected a number without a unit: young = 210",
            ),
            (
                "young = 5,2e9   # Pa",
                "found 5,2e9; expected a point in the number: 5.2e9",
            ),
            (
                "young = 5.2*10^9",
                "found 5.2*10^9; expected an expression in quotes: young = \"5.2*10^9\"",
            ),
            (
                "value = sin(x)",
                "found sin(x); expected it in quotes: value = \"sin(x)\"",
            ),
            ("on = top", "found top; expected it in quotes: on = \"top\""),
            (
                "on = “top”",
                "found “top”; expected it in quotes: on = \"top\"",
            ),
            (
                "on = \"top",
                "the text \"top isn't closed; expected \" at its end",
            ),
            (
                "on = \"top\" // above",
                "found // above behind the value; expected the end of the line",
            ),
            ("x = 0.0, y = 0.0", "found , y = 0.0 behind the value"),
            ("x = 0.0;", "found ; behind the value"),
            ("x = 0.0 // held", "found // held behind the value"),
            ("on \"top\"", "found on \"top\"; expected key = value"),
            ("on: \"top\"", "found on: \"top\"; expected key = value"),
            ("x =", "'x' has no value"),
            ("no_stress = True", "found True; expected true"),
            ("mesh = \"C:\\meshes\\a.msh\"", "holds a backslash"),
            ("[contact", "found [contact; expected [table]"),
            (
                "value = [0.0 1.0]",
                "found [0.0 1.0]; expected [value, value]",
            ),
            ("a = 1\na = 2", "'a' stands here for the second time"),
            (
                "[contact]\na = 1\n[[contact]]",
                "[[contact]] stands here, and elsewhere [contact]; expected double brackets for all",
            ),
            ("[a]\n[a]", "[a] stands here for the second time"),
        ] {
            let text = format!("{line}\n");
            let error = DeTable::parse(&text).unwrap_err();
            let start = error.span().unwrap().start;
            let said = described(&text, start, error.message());
            assert!(
                said.starts_with(expected) || said.contains(expected),
                "{line}: {said}"
            );
        }
    }

    #[test]
    fn a_number_ends_where_it_ends() {
        for (value, number) in [
            ("210e9Pa", "210e9"),
            ("-1.5e-3 m", "-1.5e-3"),
            ("5 m", "5"),
            ("3e", "3"),
            ("2.", "2."),
            ("e9", ""),
            ("", ""),
        ] {
            assert_eq!(&value[..number_length(value)], number);
        }
    }
}
