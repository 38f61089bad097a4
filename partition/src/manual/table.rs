//! The table of options that the README shows.

use clap::{Arg, Command};

/// How the help of an option that the parser knows no default of ends.
const DEFAULT: &str = " [default: ";

/// A row for each option: how it is written, what it means, what holds without it.
pub(super) fn of_options(mut command: Command) -> String {
    command.build();
    let rows = command.get_arguments().filter(|option| {
        let id = option.get_id();
        !option.is_hide_set() && id != "help" && id != "version"
    });
    let rows = rows.map(|option| {
        let (meaning, default) = meaning(option);
        let default = match default.is_empty() {
            true => " ".to_owned(),
            false => format!(" {default} "),
        };
        format!("| `{}` | {meaning} |{default}|\n", written(option))
    });
    let head = "| option | meaning | default |\n|---|---|---|\n";
    head.to_owned() + &rows.collect::<String>()
}

/// How an option is written, as in `-o, --output FILE`.
fn written(option: &Arg) -> String {
    let names = [
        option.get_short().map(|short| format!("-{short}")),
        option.get_long().map(|long| format!("--{long}")),
    ];
    let names: Vec<String> = names.into_iter().flatten().collect();
    let values = option.get_value_names().unwrap_or_default();
    let values = values
        .iter()
        .map(|name| name.as_str())
        .collect::<Vec<_>>()
        .join(" ");
    let takes_values = option.get_num_args().unwrap_or_default();
    match (names.is_empty(), takes_values.takes_values()) {
        (true, _) => values,
        (false, false) => names.join(", "),
        (false, true) if takes_values.min_values() == 0 => {
            format!("{}[={values}]", names.join(", "))
        }
        (false, true) => format!("{} {values}", names.join(", ")),
    }
}

/// What an option means, and what holds without it.
fn meaning(option: &Arg) -> (String, String) {
    let help = option.get_help().map(ToString::to_string);
    let help = help.unwrap_or_default();
    // A flag that isn't there says no: that goes without saying.
    let values = match option.get_action().takes_values() {
        true => option.get_default_values(),
        false => &[],
    };
    let given: Vec<_> = values.iter().map(|value| value.to_string_lossy()).collect();
    let split = help
        .strip_suffix(']')
        .and_then(|all| all.split_once(DEFAULT));
    let (meaning, default) = match split {
        Some((meaning, default)) => (meaning.to_owned(), default.to_owned()),
        None => (help, given.join(" ")),
    };
    (meaning + &choice(option), default)
}

/// The values that an option may have, where it is one of a few.
fn choice(option: &Arg) -> String {
    let values = match option.get_action().takes_values() {
        true => option.get_possible_values(),
        false => Vec::new(),
    };
    let names: Vec<String> = (values.iter())
        .map(|value| format!("`{}`", value.get_name()))
        .collect();
    match names.split_last() {
        Some((last, others)) => format!(": {} or {last}", others.join(", ")),
        None => String::new(),
    }
}
