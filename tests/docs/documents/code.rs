//! Names of code on the pages: a link from code to a Rust file has to name an item defined there.

use std::fs;

use super::links::in_repository;
use super::page::{Page, root};

/// A test: the names are defined in the linked files.
pub fn names_exist(page: &Page) {
    for link in page.links.iter().filter(|link| link.file.ends_with(".rs")) {
        let Some(name) = link.code.as_ref().filter(|name| !name.contains('/')) else {
            continue;
        };
        let file = in_repository(page, &link.file);
        let code = fs::read_to_string(root().join(&file)).unwrap();
        let place = format!(
            "{}:{}: {} has no {name}",
            page.name,
            link.line,
            file.display()
        );
        // The type of `Type::function` may be defined elsewhere.
        match name.split_once("::") {
            Some((kind, function)) => {
                assert!(
                    words(&code).any(|word| word == kind) && defines(&code, function),
                    "{place}"
                );
            }
            None => assert!(defines(&code, name), "{place}"),
        }
    }
}

/// True if a Rust source defines a name.
fn defines(code: &str, name: &str) -> bool {
    const KEYWORDS: [&str; 8] = [
        "fn", "struct", "enum", "trait", "type", "const", "static", "mod",
    ];
    let lines = code
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    lines.into_iter().any(|line| {
        let words: Vec<&str> = words(line).collect();
        words
            .windows(2)
            .any(|pair| KEYWORDS.contains(&pair[0]) && pair[1] == name)
    })
}

fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
}
