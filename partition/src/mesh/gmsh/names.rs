//! Names of physical groups, `$PhysicalNames`, which are text in binary files too.

use std::collections::BTreeMap;

use super::cursor::{Cursor, shown};
use crate::error::InputError;
use crate::{mesh, name};

/// Reads the body of `$PhysicalNames`: names by dimension and number.
pub(super) fn read(cursor: &mut Cursor) -> Result<BTreeMap<(usize, i64), String>, InputError> {
    let line = cursor.line("the number of names")?;
    let Ok(count) = line.parse::<usize>() else {
        return Err(cursor.error(format!(
            "expected the number of names, found `{}`",
            shown(line.as_bytes())
        )));
    };
    let mut names = BTreeMap::new();
    for _ in 0..count {
        let line = cursor.line("dimension, number and \"name\" of a physical group")?;
        let Some((dim, number, name)) = entry(line) else {
            return Err(cursor.error(format!(
                "expected dimension, number and \"name\" of a physical group, found `{}`",
                shown(line.as_bytes())
            )));
        };
        if let Err(reason) = name::check_text(name) {
            return Err(cursor.error(format!("'{}' {reason}", shown(name.as_bytes()))));
        }
        if !name.is_empty() && names.insert((dim, number), name.to_string()).is_some() {
            return Err(cursor.error(format!(
                "physical group {number} of dimension {dim} has two names"
            )));
        }
    }
    Ok(names)
}

fn entry(line: &str) -> Option<(usize, i64, &str)> {
    let (head, quoted) = line.split_once('"')?;
    let name = quoted.strip_suffix('"')?;
    let mut words = head.split_whitespace();
    let dim = words.next()?.parse().ok().filter(|&dim| dim <= 3)?;
    let number: i64 = words.next()?.parse().ok()?;
    words
        .next()
        .is_none()
        .then_some((dim, number.checked_abs()?, name))
}

/// Members of groups by name, from those by dimension and number.
///
/// A group without a name is called by its number, and a name used in several dimensions gets the dimension appended.
pub(super) fn by_name(
    groups: BTreeMap<(usize, i64), Vec<u32>>,
    names: &BTreeMap<(usize, i64), String>,
) -> Result<BTreeMap<String, (usize, Vec<u32>)>, InputError> {
    let name_of = |key: &(usize, i64)| names.get(key).cloned().unwrap_or(key.1.to_string());
    let mut dims: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for key in groups.keys() {
        dims.entry(name_of(key)).or_default().push(key.0);
    }
    let mut named = BTreeMap::new();
    for (key, members) in groups {
        let mut name = name_of(&key);
        let dim = key.0;
        if dims[&name].iter().filter(|&&other| other == dim).count() > 1 {
            return Err(InputError::new(format!(
                "two physical groups of dimension {dim} are called \"{name}\", one of them by its \
                 number or both by name; give each a name of its own"
            )));
        }
        if dims[&name].len() > 1 {
            name = mesh::name_of_dim(&name, dim);
        }
        named.insert(name, (dim, members));
    }
    Ok(named)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_blanks_quotes_and_letters_of_any_script() {
        assert_eq!(entry("1 7 \"left crack\""), Some((1, 7, "left crack")));
        assert_eq!(entry("2 1 \"čelist \"A\"\""), Some((2, 1, "čelist \"A\"")));
        assert_eq!(entry("4 1 \"x\""), None);
        assert_eq!(entry("1 1 x"), None);
    }
}
