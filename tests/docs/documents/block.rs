//! A block of code on a page, and its treatment.

use super::page::{Inline, Page};

/// The mark immediately before a block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Preface {
    #[default]
    None,
    /// `<!-- not run: reason -->`
    NotRun(String),
    /// A paragraph that ends with a file's name in backticks and a colon.
    File(String),
    /// A paragraph that ends with "prints:".
    Prints,
}

pub struct Block {
    pub line: usize,
    pub language: String,
    pub text: String,
    pub preface: Preface,
}

/// Treatment of a block.
#[derive(Debug, PartialEq, Eq)]
pub enum Action<'a> {
    /// Not run, for a reason given on the page.
    Skip(&'a str),
    /// Not run, as it isn't code.
    Read,
    /// Written to this file.
    Write(&'a str),
    /// Compared with the output of the block before.
    Compare,
    /// Run by a shell; it has to end with 0.
    Script,
    /// Run as commands in a shell, whose output has to be that below them.
    Session,
    /// Run by the documents' Python.
    Python,
}

impl Preface {
    /// The mark in an HTML comment; `None` for any other HTML.
    pub fn of_comment(html: &str) -> Option<Self> {
        Self::not_run("not run:", html)
    }

    /// The mark in a comment that applies to all following blocks.
    pub fn of_page(html: &str) -> Option<Self> {
        Self::not_run("none of this page is run:", html)
    }

    fn not_run(mark: &str, html: &str) -> Option<Self> {
        let comment = html.trim().strip_prefix("<!--")?.strip_suffix("-->")?;
        let reason = comment.trim().strip_prefix(mark)?;
        Some(Self::NotRun(reason.trim().to_owned()))
    }

    pub fn of_paragraph(inline: &[Inline]) -> Self {
        match inline {
            [.., Inline::Code(name), Inline::Text(colon)] if colon.trim() == ":" => {
                Self::File(name.clone())
            }
            [.., Inline::Text(text)] if text.ends_with("prints:") => Self::Prints,
            _ => Self::None,
        }
    }
}

impl Block {
    /// Treatment of the block.
    ///
    /// # Errors
    /// A block whose treatment the page doesn't determine.
    pub fn action(&self) -> Result<Action<'_>, String> {
        match (&self.preface, self.language.as_str()) {
            (Preface::NotRun(reason), _) if reason.is_empty() => {
                Err("'not run' without a reason".to_owned())
            }
            (Preface::NotRun(reason), _) => Ok(Action::Skip(reason)),
            (_, "") => {
                Err("code without a language; expected ```sh, ```text or the like".to_owned())
            }
            (Preface::Prints, "text") => Ok(Action::Compare),
            (_, "text") => Ok(Action::Read),
            (Preface::File(name), _) => Ok(Action::Write(name)),
            (_, "sh" | "bash") => Ok(Action::Script),
            (_, "console") => Ok(Action::Session),
            (_, "python") => Ok(Action::Python),
            (_, language) => Err(format!(
                "nothing is done with this {language}; expected a paragraph before it that ends with \
                 the name of its file, `name`:, or <!-- not run: reason -->"
            )),
        }
    }

    pub fn needs_python(&self) -> bool {
        let calls = ["python", "gmsh", "scripts/"];
        match self.action() {
            Ok(Action::Python) => true,
            Ok(Action::Script | Action::Session) => calls.iter().any(|c| self.text.contains(c)),
            _ => false,
        }
    }
}

/// A test: blocks are treated as the page requests.
pub fn are_split() {
    let text = "# Title\n\nA scene, `scene.toml`:\n\n```toml\na = 1\n```\n\n```sh\nls\n```\n\nIt prints:\n\n\
                ```text\nscene.toml\n```\n\n<!-- not run: needs a\n     cluster -->\n```sh\nsrun\n```\n\n\
                A list of `one` thing: and\n\n```console\n$ ls\n```\n\n```python\nprint(1)\n```\n\n```text\nx\n```\n";
    let page = Page::parse("page.md", text);
    let actions: Vec<_> = page.blocks.iter().map(|b| b.action().unwrap()).collect();
    assert_eq!(
        actions,
        [
            Action::Write("scene.toml"),
            Action::Script,
            Action::Compare,
            Action::Skip("needs a\n     cluster"),
            Action::Session,
            Action::Python,
            Action::Read,
        ]
    );
    assert_eq!(page.blocks[0].text, "a = 1\n");
    let lines: Vec<_> = page.blocks.iter().map(|block| block.line).collect();
    assert_eq!(lines, [5, 9, 15, 21, 27, 31, 35]);
    assert_eq!(page.headings[0], "Title");

    let text = "```sh\nls\n```\n\n<!-- none of this page is run: needs Slurm -->\n\nWords.\n\n```sh\nsrun\n```\n\nA `file`:\n\n```c\n```\n";
    let page = Page::parse("page.md", text);
    let actions: Vec<_> = page.blocks.iter().map(|b| b.action().unwrap()).collect();
    let skip = Action::Skip("needs Slurm");
    assert_eq!(actions, [Action::Script, skip, Action::Skip("needs Slurm")]);
}

/// A test: a block that is neither run nor marked is an error.
pub fn refuse_unmarked() {
    for text in [
        "```toml\na = 1\n```\n",
        "    ls\n",
        "```\nls\n```\n",
        "```rust\nfn main() {}\n```\n",
        "<!-- not run: -->\n```sh\nls\n```\n",
        "<!-- not run: a reason -->\n\nWords.\n\n```toml\na = 1\n```\n",
    ] {
        let page = Page::parse("page.md", text);
        assert!(page.blocks[0].action().is_err(), "{text}");
    }
}
