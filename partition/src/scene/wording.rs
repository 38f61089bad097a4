//! What serde says of a value, in words for somebody who doesn't know Rust.

use super::suggest::hint_and_known;

/// Kinds of values by serde's word: that of a value that was found, and what was expected instead.
const KINDS: [(&str, &str, &str); 8] = [
    ("map", "a table", "a table"),
    ("sequence", "a list", "a list in brackets, [ … ]"),
    ("string", "text", "text in quotes"),
    ("boolean", "", "true or false"),
    ("integer", "the number", "a whole number"),
    ("floating point", "the number", "a number"),
    ("f64", "a number", "a number"),
    ("u64", "a number", "a whole number"),
];

/// `message` reworded: keys that are missing or unknown, values that are of another kind than expected.
pub(super) fn of(message: &str) -> String {
    if let Some(key) = message.strip_prefix("missing field ") {
        return format!("the key {} is missing", key.replace('`', "'"));
    }
    if let Some(kinds) = message.strip_prefix("invalid type: ")
        && let Some((found, expected)) = kinds.split_once(", expected ")
    {
        return format!(
            "found {}; expected {}",
            found_kind(found),
            expected_kind(expected)
        );
    }
    let word = if message.starts_with("unknown field") {
        "key"
    } else if message.starts_with("unknown variant") {
        "value"
    } else {
        return message.replace('`', "'");
    };
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let Some((found, known)) = quoted.split_first() else {
        return message.to_owned();
    };
    match known {
        [] => format!("unknown {word} '{found}'"),
        _ => format!(
            "unknown {word} '{found}'{}",
            hint_and_known(found, known.iter().copied())
        ),
    }
}

/// A value as serde calls it, ``floating point `1.5` ``, in plain words.
fn found_kind(found: &str) -> String {
    for (kind, word, _) in KINDS {
        let Some(value) = found.strip_prefix(kind) else {
            continue;
        };
        let value = value.trim().replace('`', "");
        return format!("{word} {value}").trim().to_owned();
    }
    found.replace('`', "'")
}

fn expected_kind(expected: &str) -> String {
    let bare = expected.trim_start_matches("a ").trim_start_matches("an ");
    let known = KINDS.into_iter().find(|(kind, ..)| *kind == bare);
    match known {
        Some((_, _, word)) => word.to_owned(),
        None if bare.starts_with("array of length") || bare.starts_with("tuple of size") => {
            let count = bare.rsplit(' ').next().unwrap_or_default();
            format!("{count} values in brackets, [ … ]")
        }
        None => expected.replace('`', "'"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_of_values_have_plain_names() {
        for (message, expected) in [
            (
                "invalid type: string \"bottom\", expected a sequence",
                "found text \"bottom\"; expected a list in brackets, [ … ]",
            ),
            (
                "invalid type: floating point `-25000.0`, expected a sequence",
                "found the number -25000.0; expected a list in brackets, [ … ]",
            ),
            (
                "invalid type: map, expected a string",
                "found a table; expected text in quotes",
            ),
            (
                "invalid type: boolean `true`, expected f64",
                "found true; expected a number",
            ),
            (
                "invalid type: integer `1`, expected a boolean",
                "found the number 1; expected true or false",
            ),
            (
                "invalid type: string \"a\", expected an array of length 3",
                "found text \"a\"; expected 3 values in brackets, [ … ]",
            ),
            ("missing field `mesh`", "the key 'mesh' is missing"),
            (
                "unknown field `frictoin`, expected one of `name`, `gap`",
                "unknown key 'frictoin'. Known here: name, gap",
            ),
        ] {
            assert_eq!(of(message), expected);
        }
    }
}
