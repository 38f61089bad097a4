//! A cursor over the bytes of an MSH file, which reads numbers in either encoding.

use crate::error::InputError;
use crate::{magnitude, name};

/// Encoding of the numbers of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Words between blanks.
    Ascii,
    /// Numbers in their memory representation.
    Binary {
        /// Most significant byte first.
        big_endian: bool,
        /// Bytes of a `size_t`.
        size_bytes: usize,
    },
}

/// A position in the bytes of an MSH file.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Offset of the last number or line read.
    last: usize,
    section: &'a str,
    encoding: Encoding,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            at: 0,
            last: 0,
            section: "",
            encoding: Encoding::Ascii,
        }
    }

    pub(super) fn encoding(&self) -> Encoding {
        self.encoding
    }

    pub(super) fn set_encoding(&mut self, encoding: Encoding) {
        self.encoding = encoding;
    }

    /// An error at the last value read: the line of an ASCII file, section and byte of a binary one.
    pub(super) fn error(&self, message: impl std::fmt::Display) -> InputError {
        self.error_at(self.last, message)
    }

    fn error_at(&self, at: usize, message: impl std::fmt::Display) -> InputError {
        let section = match self.section {
            "" => String::new(),
            name => format!(" in ${}", shown(name.as_bytes())),
        };
        let place = match self.encoding {
            Encoding::Ascii => {
                let before = &self.bytes[..at.min(self.bytes.len())];
                let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
                format!("line {line}")
            }
            Encoding::Binary { .. } => format!("byte {at}"),
        };
        InputError::new(format!("{place}{section}: {message}"))
    }

    /// Moves to the next section and returns its name, without `$`; `None` at the end of the file.
    pub(super) fn next_section(&mut self) -> Result<Option<&'a str>, InputError> {
        self.section = "";
        loop {
            self.skip_blanks();
            if self.at == self.bytes.len() {
                return Ok(None);
            }
            let line = self.rest_of_line();
            let Some(name) = line.strip_prefix(b"$") else {
                continue;
            };
            let name = std::str::from_utf8(name).map(str::trim);
            let Ok(name) = name else {
                return Err(self.error("expected the name of a section"));
            };
            self.section = name;
            return Ok(Some(name));
        }
    }

    /// Reads the end of the section `name`.
    pub(super) fn end_section(&mut self, name: &str) -> Result<(), InputError> {
        self.skip_blanks();
        let line = self.rest_of_line().trim_ascii();
        if line.strip_prefix(b"$End") == Some(name.as_bytes()) {
            return Ok(());
        }
        let found = match line.is_empty() {
            true => "the end of the file".into(),
            false => format!("`{}`", shown(line)),
        };
        Err(self.error(format!("expected $End{name}, found {found}")))
    }

    /// Moves behind the end of the section `name`.
    pub(super) fn skip_section(&mut self, name: &str) -> Result<(), InputError> {
        let end = format!("$End{name}");
        let rest = &self.bytes[self.at..];
        let found = rest.windows(end.len()).position(|w| w == end.as_bytes());
        let Some(offset) = found else {
            let end = shown(end.as_bytes());
            return Err(self.error(format!("the file ends before {end}")));
        };
        self.at += offset + end.len();
        Ok(())
    }

    /// The rest of the line as text, without its terminator.
    pub(super) fn line(&mut self, what: &str) -> Result<&'a str, InputError> {
        if self.at == self.bytes.len() {
            return Err(self.ended(what));
        }
        let line = self.rest_of_line();
        std::str::from_utf8(line)
            .map(str::trim)
            .map_err(|_| self.error(format!("expected {what} in UTF-8")))
    }

    /// Moves to the start of the next line.
    pub(super) fn skip_line(&mut self) {
        self.rest_of_line();
    }

    /// Reads the integer 1, which determines the byte order of a binary file; true if the most significant byte is
    /// first.
    pub(super) fn byte_order(&mut self) -> Result<bool, InputError> {
        match self.take::<4>("the integer 1 that tells the byte order")? {
            [1, 0, 0, 0] => Ok(false),
            [0, 0, 0, 1] => Ok(true),
            _ => Err(self.error("expected the integer 1 that tells the byte order")),
        }
    }

    /// A C `int`, the type of tags of entities and physical groups.
    pub(super) fn int(&mut self, what: &str) -> Result<i64, InputError> {
        match self.encoding {
            Encoding::Ascii => self.word(what, "an integer"),
            Encoding::Binary { .. } => Ok(i32::from_le_bytes(self.take(what)?).into()),
        }
    }

    /// A C `size_t`, the type of counts and tags of version 4.1.
    pub(super) fn size(&mut self, what: &str) -> Result<i64, InputError> {
        let value: u64 = match self.encoding {
            Encoding::Ascii => self.word(what, "a whole number")?,
            Encoding::Binary { size_bytes: 4, .. } => u32::from_le_bytes(self.take(what)?).into(),
            Encoding::Binary { .. } => u64::from_le_bytes(self.take(what)?),
        };
        i64::try_from(value).map_err(|_| self.error(format!("{what} is too large: {value}")))
    }

    /// A real number, finite and of admissible magnitude.
    pub(super) fn real(&mut self, what: &str) -> Result<f64, InputError> {
        let value: f64 = match self.encoding {
            Encoding::Ascii => self.word(what, "a number")?,
            Encoding::Binary { .. } => f64::from_le_bytes(self.take(what)?),
        };
        magnitude::check(value)
            .map_err(|expected| self.error(format!("{what} is {value:e}; expected {expected}")))
    }

    /// Three coordinates.
    pub(super) fn point(&mut self) -> Result<[f64; 3], InputError> {
        Ok([
            self.real("the x coordinate")?,
            self.real("the y coordinate")?,
            self.real("the z coordinate")?,
        ])
    }

    /// A `size_t` as a count of items of at least `values` numbers each, checked against the rest of the file.
    pub(super) fn count(&mut self, what: &str, values: usize) -> Result<usize, InputError> {
        let count = self.size(what)?;
        self.checked(what, count, values)
    }

    /// A C `int` as a count.
    pub(super) fn int_count(&mut self, what: &str, values: usize) -> Result<usize, InputError> {
        let count = self.int(what)?;
        self.checked(what, count, values)
    }

    /// Checks that `count` items of at least `values` numbers each fit into the rest of the file.
    pub(super) fn checked(
        &self,
        what: &str,
        count: i64,
        values: usize,
    ) -> Result<usize, InputError> {
        // The shortest number is a digit and a blank, or a C int.
        let shortest = match self.encoding {
            Encoding::Ascii => 2,
            Encoding::Binary { .. } => 4,
        };
        let left = self.bytes.len() - self.at + 1;
        match usize::try_from(count) {
            Ok(count) if count.saturating_mul(shortest * values) <= left => Ok(count),
            Ok(_) => Err(self.error(format!(
                "{what} is {count}, but the file ends long before: it is truncated"
            ))),
            Err(_) => Err(self.error(format!("{what} is negative: {count}"))),
        }
    }

    fn skip_blanks(&mut self) {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| b == b'\n');
        self.last = self.at;
        self.at += length.map_or(rest.len(), |n| n + 1);
        &rest[..length.unwrap_or(rest.len())]
    }

    fn word<T: std::str::FromStr>(&mut self, what: &str, kind: &str) -> Result<T, InputError> {
        self.skip_blanks();
        let start = self.at;
        let rest = &self.bytes[start..];
        let length = rest.iter().position(u8::is_ascii_whitespace);
        let word = &rest[..length.unwrap_or(rest.len())];
        if word.is_empty() {
            return Err(self.ended(what));
        }
        self.last = start;
        self.at += word.len();
        let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
        parsed.ok_or_else(|| {
            let found = shown(word);
            self.error(format!("expected {what}, {kind}, found `{found}`"))
        })
    }

    /// The bytes of a number in little-endian order, whatever the file's order.
    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N], InputError> {
        let rest = &self.bytes[self.at..];
        let Some(mut bytes) = rest.first_chunk::<N>().copied() else {
            return Err(self.ended(what));
        };
        self.last = self.at;
        self.at += N;
        if let Encoding::Binary {
            big_endian: true, ..
        } = self.encoding
        {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn ended(&self, what: &str) -> InputError {
        self.error_at(self.at, format!("the file ends where {what} was expected"))
    }
}

/// Bytes of a file for a message: text, or hexadecimal numbers of the first ones.
pub(super) fn shown(bytes: &[u8]) -> String {
    const FIRST: usize = 8;
    match std::str::from_utf8(bytes) {
        Ok(text) if !text.chars().any(char::is_control) => name::shown(text),
        _ => {
            let first = bytes.iter().take(FIRST);
            let words: Vec<String> = first.map(|byte| format!("{byte:02x}")).collect();
            let more = if bytes.len() > FIRST { " …" } else { "" };
            format!("bytes {}{more}", words.join(" "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_are_no_text_are_shown_by_the_first_of_them() {
        for (bytes, expected) in [
            (&b"$EndNodes"[..], "$EndNodes"),
            (&[0, 255, 16][..], "bytes 00 ff 10"),
            (
                &[b'a', 200, 200, 0, 0, 0, 0, 7, 8][..],
                "bytes 61 c8 c8 00 00 00 00 07 …",
            ),
        ] {
            assert_eq!(shown(bytes), expected);
        }
        assert!(shown(&[b'x'; 200]).len() < 70);
        assert!(shown(&[0xfe; 200]).len() < 40);
    }
}
