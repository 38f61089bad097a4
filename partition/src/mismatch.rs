//! Mismatches between a value of a text file and what is expected there: messages of serde in plain words.

/// The message of serde about a value in plain words, without names of Rust's types; other messages as they are.
pub fn in_plain_words(message: &str) -> String {
    match message {
        "wanted string or table" => return "expected a word in quotes".into(),
        "integer number overflowed" | "floating-point number overflowed" => {
            return "too large; expected a finite number".into();
        }
        _ => {}
    }
    if let Some(key) = message.strip_prefix("missing field ") {
        return format!("the key {} is missing", key.replace('`', "'"));
    }
    // The text that was found may hold any words, the expectation holds none of these.
    let Some((found, expected)) = message.rsplit_once(", expected ") else {
        return message.into();
    };
    let wrong = ["invalid type: ", "invalid value: "];
    if let Some(found) = wrong.iter().find_map(|head| found.strip_prefix(head)) {
        return format!("it is {}; expected {}", shown(found), wanted(expected));
    }
    if let Some(count) = found.strip_prefix("invalid length ") {
        let expected = wanted(expected);
        return format!("the number of entries is {count}; expected {expected}");
    }
    for (head, word) in [("unknown variant ", "value"), ("unknown field ", "key")] {
        if let Some(name) = found.strip_prefix(head) {
            return format!("unknown {word} {name}; expected {expected}").replace('`', "'");
        }
    }
    message.into()
}

/// The value that was found.
fn shown(found: &str) -> String {
    let quoted = |kind: &str| Some(found.strip_prefix(kind)?.split('`').nth(1)?.to_owned());
    if let Some(truth) = quoted("boolean ") {
        return truth;
    }
    if let Some(number) = quoted("integer ").or_else(|| quoted("floating point ")) {
        return format!("the number {number}");
    }
    if let Some(text) = found.strip_prefix("string ") {
        return format!("the text {text}");
    }
    match found {
        "sequence" => "a list",
        "map" => "a table",
        "unit value" => "null",
        other => other,
    }
    .into()
}

/// The value that was expected.
fn wanted(expected: &str) -> String {
    if let Some(count) = expected.strip_prefix("an array of length ") {
        return format!("a list of {count} entries");
    }
    match expected {
        "f64" | "f32" => "a number",
        "usize" | "u64" | "u32" | "u16" | "u8" => "a whole number, 0 or more",
        "isize" | "i64" | "i32" | "i16" | "i8" => "a whole number",
        "a boolean" => "true or false",
        "a string" => "a text in quotes",
        "path string" => "the name of a file in quotes",
        "a sequence" => "a list",
        "a map" => "a table",
        other if other.starts_with("struct ") => "a table",
        other => other,
    }
    .into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;
    use std::collections::BTreeMap;
    use std::path::PathBuf;

    fn printed<'de, T: Deserialize<'de>>(value: &'de str) -> String {
        match serde_json::from_str::<T>(value) {
            Ok(_) => "nothing".into(),
            Err(error) => {
                let message = error.to_string();
                let place = message.rfind(" at line ").unwrap();
                in_plain_words(&message[..place])
            }
        }
    }

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Table {
        #[serde(rename = "state")]
        _state: State,
    }

    #[derive(Debug, Deserialize)]
    #[serde(rename_all = "lowercase")]
    enum State {
        Open,
        Closed,
    }

    #[test]
    fn no_type_of_rust_is_named_to_a_user() {
        for (printed, expected) in [
            (printed::<f64>("true"), "it is true; expected a number"),
            (
                printed::<f64>("\"a, expected b\""),
                "it is the text \"a, expected b\"; expected a number",
            ),
            (
                printed::<usize>("-1"),
                "it is the number -1; expected a whole number, 0 or more",
            ),
            (
                printed::<u32>("1.5"),
                "it is the number 1.5; expected a whole number, 0 or more",
            ),
            (
                printed::<i64>("[]"),
                "it is a list; expected a whole number",
            ),
            (
                printed::<bool>("1"),
                "it is the number 1; expected true or false",
            ),
            (
                printed::<String>("{}"),
                "it is a table; expected a text in quotes",
            ),
            (
                printed::<String>("null"),
                "it is null; expected a text in quotes",
            ),
            (
                printed::<PathBuf>("7"),
                "it is the number 7; expected the name of a file in quotes",
            ),
            (
                printed::<Vec<f64>>("7"),
                "it is the number 7; expected a list",
            ),
            (
                printed::<BTreeMap<String, f64>>("7"),
                "it is the number 7; expected a table",
            ),
            (
                printed::<Table>("7"),
                "it is the number 7; expected a table",
            ),
            (printed::<Table>("{}"), "the key 'state' is missing"),
            (
                printed::<Table>("{\"stat\": 1}"),
                "unknown key 'stat'; expected 'state'",
            ),
            (
                printed::<State>("\"shut\""),
                "unknown value 'shut'; expected 'open' or 'closed'",
            ),
            (
                printed::<[f64; 3]>("[1]"),
                "the number of entries is 1; expected a list of 3 entries",
            ),
        ] {
            assert_eq!(printed, expected);
        }
    }
}
