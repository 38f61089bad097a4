//! What a program says of itself beyond its options: in `--help`, in its man page, in the README.

mod page;
mod table;

use clap::{Command, ValueEnum};
use clap_complete::{Shell, generate};

/// What stands in a program's manual beside its options, which the parser knows.
#[derive(Clone, Copy, Debug)]
pub struct Manual {
    /// Commands, each with what it does.
    pub examples: &'static [(&'static str, &'static str)],
    /// Exit codes and what they mean.
    pub exit_codes: &'static [(&'static str, &'static str)],
    /// Files and what they hold.
    pub files: &'static [(&'static str, &'static str)],
    /// Environment variables and what they change.
    pub environment: &'static [(&'static str, &'static str)],
    /// The other program.
    pub see_also: &'static str,
}

/// A document that is made from the parser's options.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Document {
    /// The man page
    Man,
    /// Completions for bash
    CompleteBash,
    /// Completions for zsh
    CompleteZsh,
    /// Completions for fish
    CompleteFish,
    /// The table of options that the README shows
    Markdown,
}

impl Manual {
    /// What ends the short help.
    pub fn in_short(&self) -> String {
        let examples = self.examples.iter().map(|(command, _)| *command);
        format!(
            "Examples:\n{}\n\n--help tells more.",
            indented(examples.take(2))
        )
    }

    /// What ends the long help.
    pub fn at_length(&self) -> String {
        let examples = self
            .examples
            .iter()
            .map(|(command, what)| format!("{command}\n      {what}"));
        let sections = [
            ("Exit codes", self.exit_codes),
            ("Files", self.files),
            ("Environment", self.environment),
        ];
        let mut text = format!("Examples:\n{}", indented(examples));
        for (title, entries) in sections {
            let width = entries.iter().map(|(name, _)| name.len()).max();
            let width = width.unwrap_or(0);
            let lines = entries
                .iter()
                .map(|(name, meaning)| format!("{name:<width$}  {meaning}"));
            text += &format!("\n\n{title}:\n{}", indented(lines));
        }
        text
    }

    /// Writes a document of the program that `command` parses the options of.
    pub fn write(&self, document: Document, mut command: Command) -> String {
        let name = command.get_name().to_owned();
        let mut complete = |shell| {
            let mut script = Vec::new();
            generate(shell, &mut command, &name, &mut script);
            String::from_utf8_lossy(&script).into_owned()
        };
        match document {
            Document::Man => page::of(self, command),
            Document::Markdown => table::of_options(command),
            Document::CompleteBash => complete(Shell::Bash),
            Document::CompleteZsh => complete(Shell::Zsh),
            Document::CompleteFish => complete(Shell::Fish),
        }
    }
}

fn indented(lines: impl Iterator<Item = impl AsRef<str>>) -> String {
    let lines = lines.map(|line| format!("  {}", line.as_ref()));
    lines.collect::<Vec<_>>().join("\n")
}
