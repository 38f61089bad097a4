//! A page of the gallery.

use std::fs;
use std::path::PathBuf;

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

use super::expected::Expected;

/// The parts of a page.
pub struct Page {
    /// The lines of its scene on the page.
    pub scene: Vec<String>,
    /// The rows of its table.
    pub expected: Vec<Expected>,
}

/// The folder with the folders of the scenes.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("partition/src/example")
}

/// All pages, with the names of their scenes.
pub fn all() -> Vec<(Page, String)> {
    let mut pages: Vec<(Page, String)> = Vec::new();
    for entry in fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if let Ok(text) = fs::read_to_string(path.join("README.md")) {
            pages.push((Page::parse(&text), name));
        }
    }
    pages.sort_by(|(_, one), (_, other)| one.cmp(other));
    pages
}

impl Page {
    /// # Panics
    /// If a row of its table can't be read.
    pub fn parse(text: &str) -> Self {
        let mut page = Self {
            scene: Vec::new(),
            expected: Vec::new(),
        };
        let (mut words, mut language) = (String::new(), None);
        let mut row: Vec<String> = Vec::new();
        for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(of))) => {
                    language = Some(of.into_string());
                    words.clear();
                }
                Event::End(TagEnd::CodeBlock) if language.take().as_deref() == Some("toml") => {
                    page.scene.push(std::mem::take(&mut words));
                }
                Event::Start(Tag::TableCell) => words.clear(),
                Event::End(TagEnd::TableCell) => row.push(std::mem::take(&mut words)),
                Event::End(TagEnd::TableHead) => row.clear(),
                Event::End(TagEnd::TableRow) => {
                    // Tables of pictures and others have different numbers of columns.
                    if let Ok(cells) = <[String; 5]>::try_from(std::mem::take(&mut row)) {
                        page.expected.push(Expected::parse(&cells));
                    }
                }
                Event::Text(text) | Event::Code(text) => words.push_str(&text),
                _ => {}
            }
        }
        page
    }
}
