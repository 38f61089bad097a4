//! The manual of a program: its help, its man page, completions for shells, and the output of command lines that only
//! request documentation or are invalid.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Command, ValueEnum};
use clap_complete::{Shell, generate};
use clap_mangen::Man;
use roff::{Roff, bold, roman};

use crate::message;

/// Exit code of bad usage.
pub const BAD_USAGE: u8 = 2;

/// Exit code of output that can't be written.
const UNWRITABLE: u8 = 5;

/// The parts of a program's manual other than its options, which the parser describes.
#[derive(Clone, Copy, Debug)]
pub struct Manual {
    /// Commands with descriptions.
    pub examples: &'static [(&'static str, &'static str)],
    /// Exit codes with their meanings.
    pub exit_codes: &'static [(&'static str, &'static str)],
    /// Files with their contents.
    pub files: &'static [(&'static str, &'static str)],
    /// Environment variables with their effects.
    pub environment: &'static [(&'static str, &'static str)],
    /// The page of the other program.
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
}

/// The output of a program for a command line that only requests documentation or is invalid.
#[derive(Clone, Debug)]
pub enum Answer {
    /// Text for stdout, with escape codes of colours.
    Text(String),
    /// Error in a command line.
    Refusal(String),
}

impl Answer {
    /// The output for a result of the parser: help, the version, or an error.
    pub fn of(error: &clap::Error) -> Self {
        let text = error.render();
        match error.kind() {
            ErrorKind::DisplayHelp
            | ErrorKind::DisplayVersion
            | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
                Self::Text(text.ansi().to_string())
            }
            _ => {
                let text = text.to_string();
                let text = text.strip_prefix("error: ").unwrap_or(&text);
                Self::Refusal(text.trim_end().to_owned())
            }
        }
    }

    /// Prints the output; returns the exit code of the program.
    pub fn print(&self) -> ExitCode {
        match self {
            Self::Text(text) => match message::print(text) {
                Ok(()) => ExitCode::SUCCESS,
                Err(error) => {
                    message::error(&error.to_string());
                    ExitCode::from(UNWRITABLE)
                }
            },
            Self::Refusal(why) => {
                message::error(why);
                ExitCode::from(BAD_USAGE)
            }
        }
    }
}

impl Manual {
    /// End of the short help.
    pub fn in_short(&self) -> String {
        let examples = self.examples.iter().map(|(command, _)| *command);
        format!(
            "Examples:\n{}\n\n--help tells more.",
            indented(examples.take(2))
        )
    }

    /// End of the long help.
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
            Document::Man => self.page(command),
            Document::CompleteBash => complete(Shell::Bash),
            Document::CompleteZsh => complete(Shell::Zsh),
            Document::CompleteFish => complete(Shell::Fish),
        }
    }

    /// The man page of the program that `command` parses the options of.
    fn page(&self, command: Command) -> String {
        let mut page = Vec::new();
        // Writing to memory doesn't fail.
        let _: io::Result<()> = self.write_page(command, &mut page);
        // Where a list of values begins, an empty line is meant.
        let page = String::from_utf8_lossy(&page).replace("\n.br\n\n.br\n", "\n.sp\n");
        let mut text = String::new();
        for c in page.chars() {
            // Not every reader of man pages takes more than ASCII.
            match c.is_ascii() {
                true => text.push(c),
                false => text += &format!("\\[u{:04X}]", u32::from(c)),
            }
        }
        text
    }

    fn write_page(&self, command: Command, out: &mut impl Write) -> io::Result<()> {
        // What they hold comes in sections of their own.
        let command = command
            .after_help(None::<&str>)
            .after_long_help(None::<&str>);
        let name = command.get_name().to_owned();
        let version = command.get_version().unwrap_or_default().to_owned();
        let page = Man::new(command);
        // Without a date: a page of one version is the same whenever it is made.
        writeln!(out, r#".TH {name} 1 "" "{name} {version}" "User Commands""#)?;
        page.render_name_section(out)?;
        page.render_synopsis_section(out)?;
        page.render_description_section(out)?;
        page.render_options_section(out)?;
        let mut more = Roff::new();
        let sections = [
            ("EXAMPLES", self.examples),
            ("EXIT STATUS", self.exit_codes),
            ("FILES", self.files),
            ("ENVIRONMENT", self.environment),
        ];
        for (title, entries) in sections {
            more.control("SH", [title]);
            for (name, meaning) in entries {
                more.control("TP", []);
                more.text([bold(*name)]);
                more.text([roman(*meaning)]);
            }
        }
        more.control("SH", ["SEE ALSO"]);
        more.text([bold(self.see_also), roman("(1)")]);
        more.to_writer(out)
    }
}

fn indented(lines: impl Iterator<Item = impl AsRef<str>>) -> String {
    let lines = lines.map(|line| format!("  {}", line.as_ref()));
    lines.collect::<Vec<_>>().join("\n")
}
