//! The man page.

use std::io::{self, Write};

use clap::Command;
use clap_mangen::Man;
use roff::{Roff, bold, roman};

use super::Manual;

/// The man page of the program that `command` parses the options of.
pub(super) fn of(manual: &Manual, command: Command) -> String {
    let mut page = Vec::new();
    // Writing to memory doesn't fail.
    let _: io::Result<()> = write(manual, command, &mut page);
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

fn write(manual: &Manual, command: Command, out: &mut impl Write) -> io::Result<()> {
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
        ("EXAMPLES", manual.examples),
        ("EXIT STATUS", manual.exit_codes),
        ("FILES", manual.files),
        ("ENVIRONMENT", manual.environment),
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
    more.text([bold(manual.see_also), roman("(1)")]);
    more.to_writer(out)
}
