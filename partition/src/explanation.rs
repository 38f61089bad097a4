//! Explanations of messages: the rows of docs/troubleshooting.md, which are built into both programs.

use std::sync::LazyLock;

use crate::error::InputError;

/// The page; each row of its tables of messages begins with its name as an anchor and with the message in backticks.
const PAGE: &str = include_str!("../../docs/troubleshooting.md");

/// Beginning of a row that explains a message.
const ROW: &str = "| <a id=\"";

/// The explanation of a message.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// Name: the anchor of the page.
    pub name: &'static str,
    heading: &'static str,
    /// Columns of the row: the message, its meaning, in most tables the remedy.
    columns: Vec<&'static str>,
    /// Forms of the message, each split into its fixed parts in their order.
    forms: Vec<Vec<&'static str>>,
}

static ALL: LazyLock<Vec<Explanation>> = LazyLock::new(|| {
    let mut heading = "";
    let mut all = Vec::new();
    for line in PAGE.lines() {
        heading = line
            .strip_prefix('#')
            .map_or(heading, |rest| rest.trim_start_matches('#').trim());
        all.extend(Explanation::of_row(line, heading));
    }
    all
});

impl Explanation {
    /// The explanation of a message: the one with the longest matching form.
    pub fn of(message: &str) -> Option<&'static Self> {
        let all = ALL
            .iter()
            .filter_map(|one| Some((one.words_in(message)?, one)));
        all.max_by_key(|(words, _)| *words).map(|(_, one)| one)
    }

    /// The explanation with a name.
    ///
    /// # Errors
    /// An unknown name.
    pub fn named(name: &str) -> Result<&'static Self, InputError> {
        let found = ALL.iter().find(|one| one.name == name);
        found.ok_or_else(|| {
            InputError::new(format!(
                "--explain: there is no message of the name '{name}'; expected a name in brackets at the end of a message"
            ))
        })
    }

    /// The explanation as lines for a terminal.
    pub fn text(&self) -> String {
        let mut text = format!("{} ({})\n", self.name, self.heading);
        for (title, column) in ["message", "means", "do"].iter().zip(&self.columns) {
            text += &format!("\n{title:<9} {}\n", without_links(column));
        }
        text + "\nAll messages: docs/troubleshooting.md\n"
    }

    fn of_row(line: &'static str, heading: &'static str) -> Option<Self> {
        let (name, rest) = line.strip_prefix(ROW)?.split_once("\"></a>")?;
        let columns: Vec<&str> = rest
            .trim_end_matches('|')
            .split(" | ")
            .map(str::trim)
            .collect();
        Some(Self {
            name,
            heading,
            forms: forms(columns.first()?),
            columns,
        })
    }

    /// The number of fixed characters of the best matching form of a message; `None` if no form matches.
    fn words_in(&self, message: &str) -> Option<usize> {
        let of_form = |form: &Vec<&str>| {
            let mut rest = message;
            let mut words = 0;
            for part in form {
                rest = rest.split_once(part)?.1;
                words += part.len();
            }
            Some(words)
        };
        self.forms.iter().filter_map(of_form).max()
    }
}

/// The message with the name of its explanation, if there is one.
pub fn with_name(message: &str) -> String {
    match Explanation::of(message) {
        Some(explanation) => format!("{message} [--explain {}]", explanation.name),
        None => message.to_owned(),
    }
}

/// The forms of a message in a cell: the texts in backticks; after dots the same form continues.
fn forms(cell: &'static str) -> Vec<Vec<&'static str>> {
    let mut forms: Vec<Vec<&str>> = Vec::new();
    let mut goes_on = false;
    for (k, text) in cell.split('`').enumerate() {
        if k % 2 == 0 {
            goes_on = text.contains('…');
            continue;
        }
        let parts = text
            .split('…')
            .map(str::trim)
            .filter(|part| !part.is_empty());
        match forms.last_mut().filter(|_| goes_on) {
            Some(form) => form.extend(parts),
            None => forms.push(parts.collect()),
        }
    }
    forms
}

/// Text without backticks, its links followed by their targets.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, from)) = rest.split_once("](") {
        let (start, words) = before.rsplit_once('[').unwrap_or((before, ""));
        let (target, after) = from.split_once(')').unwrap_or((from, ""));
        let file = if target.starts_with('#') {
            "troubleshooting.md"
        } else {
            ""
        };
        plain += &format!("{start}{words} (docs/{file}{target})");
        rest = after;
    }
    (plain + rest).replace('`', "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_finds_the_row_that_has_most_of_it() {
        let name = |message: &str| Explanation::of(message).map(|one| one.name);
        let free = "body 'punch' is under-constrained: its rigid-body motion, translation along (0, 1), is loaded, and ";
        let held = name(&format!(
            "{free}contact doesn't resist it; expected supports"
        ));
        let loose = name(&format!("{free}nothing resists it; expected supports"));
        assert!(held.is_some() && loose.is_some());
        assert_ne!(held, loose);
        assert_eq!(name("Hello, world."), None);
        let named = with_name("scene.toml: the mesh has no physical group 'top'");
        let group = name("the mesh has no physical group 'top'").unwrap();
        assert!(
            named.ends_with(&format!("'top' [--explain {group}]")),
            "{named}"
        );
    }

    #[test]
    fn every_name_is_one_of_its_own_and_explains_its_message() {
        assert!(ALL.len() > 200, "{}", ALL.len());
        for (k, one) in ALL.iter().enumerate() {
            assert!(
                !one.forms.is_empty() && one.columns.len() > 1,
                "{}",
                one.name
            );
            assert!(
                ALL[..k].iter().all(|other| other.name != one.name),
                "{}",
                one.name
            );
            let text = Explanation::named(one.name).unwrap().text();
            assert!(!text.contains("](") && !text.contains('`'), "{text}");
            for form in &one.forms {
                let message = form.join(" 7 ");
                let found = Explanation::of(&message).unwrap();
                assert!(
                    found.words_in(&message) == one.words_in(&message),
                    "{message}: {}",
                    found.name
                );
            }
        }
        let unknown = Explanation::named("no-such-nam").unwrap_err().to_string();
        assert!(
            unknown.contains("there is no message of the name 'no-such-nam'"),
            "{unknown}"
        );
    }

    #[test]
    fn links_say_where_they_lead() {
        assert_eq!(
            without_links("take `x`, [how](a.md#b), or [below](#c)"),
            "take x, how (docs/a.md#b), or below (docs/troubleshooting.md#c)"
        );
    }
}
