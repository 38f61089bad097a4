//! The tables of docs/problem-file.md are those of the schema.
//!
//! `WRITE_DOCS=1 cargo test -p contact-dd-partition --test library problem::page` writes them anew.

use std::path::Path;
use std::{env, fs};

use contact_dd_partition::problem::schema::{ATTRIBUTES, FIELDS, Field, LETTERS};

/// Mark before a table of the page; the name of the table follows it.
const MARK: &str = "<!-- table of the schema: ";

/// The table for a mark: letters, the attributes of a group, or the datasets below a path.
fn table(what: &str) -> String {
    let (head, rows): (&str, Vec<String>) = match what.strip_prefix("attributes of ") {
        Some(group) => {
            let of_group = ATTRIBUTES.iter().filter(|a| a.group == group);
            let row = of_group.map(|a| format!("| `{}` | {} |", a.name, a.value));
            ("| attribute | value |\n|---|---|", row.collect())
        }
        None if what == "letters" => {
            let row = |(letter, noun): &(char, &str)| format!("| {letter} | {noun} |");
            (
                "| letter | number of |\n|---|---|",
                LETTERS.iter().map(row).collect(),
            )
        }
        None => {
            let below = FIELDS.iter().filter(|field| field.path.starts_with(what));
            (
                "| dataset | shape | holds | meaning |\n|---|---|---|---|",
                below.map(row).collect(),
            )
        }
    };
    assert!(!rows.is_empty(), "the schema has nothing for '{what}'");
    format!("{head}\n{}\n", rows.join("\n"))
}

fn row(field: &Field) -> String {
    let shape = match field.shape.contains('?') {
        true => format!(
            "({}); with load steps ({})",
            field.shape.replace(", L?", ""),
            field.shape.replace('?', "")
        ),
        false => format!("({})", field.shape),
    };
    let optional = if field.optional { ", optional" } else { "" };
    let (path, word) = (field.path, field.kind.word());
    format!(
        "| `{path}` | {shape} | {word}{optional} | {} |",
        field.meaning
    )
}

/// The page with the tables of today.
fn renewed(page: &str) -> String {
    let mut parts = page.split(MARK);
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (what, rest) = part.split_once(" -->\n").unwrap();
        let rows = rest
            .split_inclusive('\n')
            .take_while(|l| l.starts_with('|'));
        let end: usize = rows.map(str::len).sum();
        text += &format!("{MARK}{what} -->\n{}{}", table(what), &rest[end..]);
    }
    text
}

#[test]
fn the_tables_of_the_page_are_those_of_the_schema() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/problem-file.md");
    let page = fs::read_to_string(&path).unwrap();
    let expected = renewed(&page);
    if env::var_os("WRITE_DOCS").is_some() {
        fs::write(&path, &expected).unwrap();
        return;
    }
    assert!(
        page == expected,
        "the tables of docs/problem-file.md aren't those of the schema; write them anew: \
         WRITE_DOCS=1 cargo test -p contact-dd-partition --test library problem::page"
    );
}

#[test]
fn every_dataset_stands_in_a_table_of_the_page() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/problem-file.md");
    let page = fs::read_to_string(path).unwrap();
    let names = FIELDS.iter().map(|field| field.path);
    let missing: Vec<&str> = names
        .filter(|path| page.matches(&format!("| `{path}` |")).count() != 1)
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
    for attribute in ATTRIBUTES {
        assert!(
            page.contains(&format!("| `{}` |", attribute.name)),
            "{attribute:?}"
        );
    }
}
