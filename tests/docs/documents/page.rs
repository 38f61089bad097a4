//! A page of the documents: its blocks of code, links and headings.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

use super::block::{Block, Preface};

/// A link within the repository.
pub struct Link {
    pub line: usize,
    /// The printed text, if it is only code.
    pub code: Option<String>,
    /// The file, relative to the page; empty for the page itself.
    pub file: String,
    /// Text after `#`.
    pub anchor: Option<String>,
}

pub struct Page {
    /// The path from the repository's root.
    pub name: String,
    pub blocks: Vec<Block>,
    pub links: Vec<Link>,
    pub headings: Vec<String>,
}

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The pages in the root, all under `docs`, and those of the built-in scenes, by name.
pub fn all() -> Vec<Page> {
    let mut paths = Vec::new();
    pages_in(root(), false, &mut paths);
    for folder in ["docs", "partition/src/example"] {
        pages_in(&root().join(folder), true, &mut paths);
    }
    paths.sort();
    let page = |path: &PathBuf| {
        let name = path.strip_prefix(root()).unwrap();
        Page::parse(&name.to_string_lossy(), &fs::read_to_string(path).unwrap())
    };
    paths.iter().map(page).collect()
}

fn pages_in(folder: &Path, with_folders: bool, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && with_folders {
            pages_in(&path, true, paths);
        } else if path.extension().is_some_and(|ending| ending == "md") {
            paths.push(path);
        }
    }
}

impl Page {
    /// Parses the text of a page.
    pub fn parse(name: &str, text: &str) -> Self {
        let mut page = Self {
            name: name.to_owned(),
            blocks: Vec::new(),
            links: Vec::new(),
            headings: Vec::new(),
        };
        let line_at = |range: &Range<usize>| 1 + text[..range.start].matches('\n').count();
        let mut inline: Vec<Inline> = Vec::new();
        let mut preface = Preface::None;
        let mut language = String::new();
        let mut html = String::new();
        let mut elsewhere = None;
        let mut link = (String::new(), 0);
        for (event, range) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
            let line = line_at(&range);
            match event {
                Event::Text(text) => inline.push(Inline::Text(text.into_string())),
                Event::Code(code) => inline.push(Inline::Code(code.into_string())),
                Event::SoftBreak => inline.push(Inline::Text(" ".to_owned())),
                Event::Start(Tag::HtmlBlock) => html.clear(),
                Event::Html(line) => html.push_str(&line),
                Event::End(TagEnd::HtmlBlock) => {
                    preface = Preface::of_comment(&html).unwrap_or(preface);
                    elsewhere = elsewhere.or(Preface::of_page(&html));
                }
                Event::Start(Tag::Link { dest_url, .. }) => {
                    link = (dest_url.into_string(), inline.len());
                }
                Event::End(TagEnd::Link) if !link.0.contains("://") => {
                    page.links.push(Link::new(line, &link.0, &inline[link.1..]));
                }
                Event::Start(Tag::Image { dest_url, .. }) if !dest_url.contains("://") => {
                    page.links.push(Link::new(line, &dest_url, &[]));
                }
                Event::Start(Tag::CodeBlock(kind)) => {
                    inline.clear();
                    language = match kind {
                        CodeBlockKind::Fenced(language) => language.into_string(),
                        CodeBlockKind::Indented => String::new(),
                    };
                }
                Event::End(TagEnd::CodeBlock) => page.blocks.push(Block {
                    line,
                    language: std::mem::take(&mut language),
                    text: inline.drain(..).map(Inline::into_text).collect(),
                    preface: match std::mem::take(&mut preface) {
                        marked @ Preface::NotRun(_) => marked,
                        other => elsewhere.clone().unwrap_or(other),
                    },
                }),
                Event::End(TagEnd::Paragraph) => {
                    preface = Preface::of_paragraph(&inline);
                    inline.clear();
                }
                Event::End(TagEnd::Heading(_)) => {
                    let text = inline.drain(..).map(Inline::into_text).collect();
                    page.headings.push(text);
                    preface = Preface::None;
                }
                Event::End(TagEnd::Item | TagEnd::TableCell) => {
                    inline.clear();
                    preface = Preface::None;
                }
                _ => {}
            }
        }
        page
    }

    /// True if a block can't be run without the documents' Python.
    pub fn needs_python(&self) -> bool {
        self.blocks.iter().any(Block::needs_python)
    }
}

impl Link {
    fn new(line: usize, target: &str, printed: &[Inline]) -> Self {
        let (file, anchor) = match target.split_once('#') {
            Some((file, anchor)) => (file, Some(anchor.to_owned())),
            None => (target, None),
        };
        Self {
            line,
            code: match printed {
                [Inline::Code(code)] => Some(code.clone()),
                _ => None,
            },
            file: file.to_owned(),
            anchor,
        }
    }
}

/// A piece of a paragraph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Inline {
    Text(String),
    Code(String),
}

impl Inline {
    pub fn into_text(self) -> String {
        match self {
            Self::Text(text) | Self::Code(text) => text,
        }
    }
}
