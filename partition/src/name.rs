//! Rules for names, which appear in messages and as groups of the result file.

/// Longest name (bytes).
const LONGEST: usize = 255;

/// Checks the name of a body, a material or a contact.
///
/// # Errors
/// The fault of a name, as the end of a sentence that starts with the name.
pub fn check(name: &str) -> Result<(), &'static str> {
    check_text(name)?;
    if name.trim().is_empty() {
        Err("is empty; expected a name")
    } else if name.len() > LONGEST {
        Err("is longer than 255 bytes")
    } else {
        Ok(())
    }
}

/// Checks the name of a contact, which is also that of a group in the result file.
///
/// # Errors
/// The fault of a name, as the end of a sentence that starts with the name.
pub fn check_contact(name: &str) -> Result<(), &'static str> {
    if name.contains('/') {
        Err("holds a '/'; a contact's name is that of a group in the result file")
    } else if name == "." || name == ".." {
        Err("means a place in a path; a contact's name is that of a group in the result file")
    } else {
        check(name)
    }
}

/// Checks a title or a remark, which is printed on a separate line.
///
/// # Errors
/// The fault of a text, as the end of a sentence that starts with the text.
pub fn check_text(text: &str) -> Result<(), &'static str> {
    match text.chars().any(char::is_control) {
        true => Err("holds a control character; expected one line of text"),
        false => Ok(()),
    }
}

/// The beginning of a name for a message, on one line.
pub fn shown(name: &str) -> String {
    const SHOWN: usize = 60;
    match name.char_indices().nth(SHOWN) {
        None => in_a_line(name),
        Some((end, _)) => format!("{}…", in_a_line(&name[..end])),
    }
}

/// A text on one line, without control characters.
pub fn in_a_line(text: &str) -> String {
    let mut line = String::new();
    for letter in text.chars() {
        match letter.is_control() {
            true => line.extend(letter.escape_default()),
            false => line.push(letter),
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_line_of_at_most_255_bytes_and_a_contacts_no_path() {
        for name in ["joint", "levá spára", "VTKHDF", "a\\b", "..."] {
            assert_eq!(check_contact(name), Ok(()), "{name}");
        }
        assert_eq!(check("a/b"), Ok(()));
        assert_eq!(check(&"x".repeat(255)), Ok(()));
        for name in ["", " ", "a\nb", "a\0", "\u{1b}[1m", &"é".repeat(128)] {
            assert!(check(name).is_err(), "{name:?}");
        }
        for name in ["/abs", "../x", "a/b", ".", ".."] {
            assert!(check_contact(name).is_err(), "{name:?}");
        }
    }
}
