//! The text of a `scene.toml`.

use std::collections::BTreeSet;

/// A scene being written.
#[derive(Default)]
pub(super) struct Document(String);

impl Document {
    /// Writes a line that begins a table, after a blank one.
    pub(super) fn table(&mut self, head: &str) {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
        self.0 += &format!("{head}\n");
    }

    /// Writes a key and its value.
    pub(super) fn key(&mut self, key: &str, value: impl std::fmt::Display) {
        self.0 += &format!("{key} = {value}\n");
    }

    pub(super) fn text(self) -> String {
        self.0
    }
}

/// Unique names of contacts, ties and couplings.
#[derive(Default)]
pub(super) struct Names(BTreeSet<String>);

impl Names {
    /// A unique name: the plain one, or with a number.
    pub(super) fn unique(&mut self, plain: &str) -> String {
        let plain = plain.replace('/', " ");
        let numbered = (2..).map(|number: usize| format!("{plain} {number}"));
        let mut names = std::iter::once(plain.clone()).chain(numbered);
        let name = names.find(|name| self.0.insert(name.clone()));
        name.unwrap_or_default()
    }
}

/// A text in quotes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// A vector of as many components as the mesh has dimensions.
pub(super) fn vector(components: &[f64; 3], dim: usize) -> String {
    format!("{:?}", &components[..dim])
}

/// A force that is linear in the position, c + M x.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct Linear {
    pub(super) constant: [f64; 3],
    pub(super) slope: [[f64; 3]; 3],
}

impl Linear {
    /// The vector in the syntax of a scene, as numbers and expressions.
    pub(super) fn shown(&self, dim: usize) -> String {
        let component = |i: usize| {
            let mut text = format!("{:?}", self.constant[i]);
            for (slope, axis) in self.slope[i][..dim].iter().zip("xyz".chars()) {
                if *slope != 0.0 {
                    text += &format!(" + {slope:?}*{axis}");
                }
            }
            if text.contains('*') {
                quoted(&text)
            } else {
                text
            }
        };
        format!(
            "[{}]",
            (0..dim).map(component).collect::<Vec<_>>().join(", ")
        )
    }
}
