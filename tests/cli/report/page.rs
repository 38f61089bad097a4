//! The part of docs/report.md that is generated from the types.

use std::fmt::Write as _;
use std::iter;

use serde_json::Value;

/// Mark after which the page is generated.
pub const MARK: &str = "<!-- From here on: WRITE_DOCS=1 cargo test --test cli report -->\n";

/// Number of fields of another part from which on they aren't repeated.
const MANY: usize = 6;

/// The page: the text `above` the mark, and a table for every part of the report.
pub fn below(above: &str, schema: &Value) -> String {
    let mut page = format!("{above}{MARK}\n## The report\n\n{}", table(schema));
    let names = parts(schema);
    for (k, name) in names.iter().enumerate() {
        let mut part = schema["$defs"][name].clone();
        let text = part["description"].as_str().unwrap_or_default();
        let _ = write!(page, "\n## {}\n\n{text}\n\n", heading(name));
        // A part that has most fields of the report or of an earlier part refers to it.
        let report = ("report", "the-report", schema);
        let earlier = (names[..k].iter()).map(|name| (&**name, "", &schema["$defs"][name]));
        for (earlier, link, other) in iter::once(report).chain(earlier) {
            let shared = leave_out(&mut part, other);
            if !shared.is_empty() {
                let (heading, own) = (heading(earlier).to_lowercase(), anchor(earlier));
                let link = if link.is_empty() { &own } else { link };
                let _ = write!(
                    page,
                    "As in [{heading}](#{link}): `{}`; and\n\n",
                    shared.join("`, `")
                );
            }
        }
        if fields(&part).next().is_some() || !part["oneOf"].is_null() {
            page += &table(&part);
        }
    }
    page
}

/// Removes the fields that another part has, too, and returns their names, if they are many.
fn leave_out(part: &mut Value, other: &Value) -> Vec<String> {
    let names = |part: &Value| fields(part).map(|(name, _)| name.to_owned()).collect();
    let (own, others): (Vec<String>, Vec<String>) = (names(part), names(other));
    let shared: Vec<String> = (own.into_iter())
        .filter(|name| others.contains(name))
        .collect();
    if shared.len() < MANY {
        return Vec::new();
    }
    if let Some(names) = part["required"].as_array_mut() {
        names.retain(|name| !shared.iter().any(|shared| name == shared));
    }
    shared
}

/// `PhaseSeconds` as a heading.
fn heading(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
            words.extend(letter.to_lowercase());
        } else {
            words.push(letter);
        }
    }
    words
}

fn anchor(name: &str) -> String {
    heading(name).to_lowercase().replace(' ', "-")
}

/// Fields in the order of the report.
fn fields(part: &Value) -> impl Iterator<Item = (&str, &Value)> {
    let names = part["required"].as_array().into_iter().flatten();
    names.map(|name| {
        let name = name.as_str().unwrap();
        (name, &part["properties"][name])
    })
}

fn table(part: &Value) -> String {
    if let Some(choices) = part["oneOf"].as_array() {
        let mut table = String::from("| word | meaning |\n|---|---|\n");
        for choice in choices {
            let text = choice["description"].as_str().unwrap_or_default();
            let _ = writeln!(
                table,
                "| `{}` | {text} |",
                choice["const"].as_str().unwrap()
            );
        }
        return table;
    }
    let mut table = String::from("| field | | meaning |\n|---|---|---|\n");
    for (name, field) in fields(part) {
        let text = field["description"].as_str().unwrap_or_default();
        // ‖ |K| |u| ‖ would become three cells.
        let text = text.replace('|', "\\|");
        let _ = writeln!(table, "| `{name}` | {} | {text} |", kind(field));
    }
    table
}

/// The type of a field in plain words.
fn kind(field: &Value) -> String {
    if let Some(name) = reference(field) {
        return format!("[{}](#{})", heading(name).to_lowercase(), anchor(name));
    }
    if let Some(choices) = field["anyOf"].as_array() {
        let words: Vec<String> = choices.iter().map(kind).collect();
        return words.join(" or ");
    }
    match &field["type"] {
        // The page explains infinity in a single place.
        Value::Array(types) if types[0] == "number" => word("number").to_owned(),
        Value::Array(types) => {
            let words: Vec<&str> = types.iter().filter_map(Value::as_str).map(word).collect();
            words.join(" or ")
        }
        Value::String(name) if name == "array" => match field["maxItems"].as_u64() {
            Some(count) => format!("{count} {}s", kind(&field["items"])),
            None => format!("list of {}", kind(&field["items"])),
        },
        Value::String(name) => word(name).to_owned(),
        _ => String::new(),
    }
}

fn word(name: &str) -> &str {
    match name {
        "string" => "text",
        "boolean" => "true or false",
        "null" => "`null`",
        other => other,
    }
}

fn reference(field: &Value) -> Option<&str> {
    field["$ref"].as_str()?.strip_prefix("#/$defs/")
}

/// The parts of the report in the order of their first reference.
fn parts(schema: &Value) -> Vec<String> {
    fn visit(schema: &Value, part: &Value, names: &mut Vec<String>) {
        for (_, field) in fields(part) {
            let choices = field["anyOf"].as_array().into_iter().flatten();
            for field in [field, &field["items"]].into_iter().chain(choices) {
                if let Some(name) = reference(field).map(str::to_owned)
                    && !names.contains(&name)
                {
                    names.push(name.clone());
                    visit(schema, &schema["$defs"][&name], names);
                }
            }
        }
    }
    let mut names = Vec::new();
    visit(schema, schema, &mut names);
    names
}
