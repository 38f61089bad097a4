//! Kinds of values of a dataset.

/// Content of a dataset, and the law that each of its values keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Integers.
    Integers,
    /// Numbers from 0 on of what a letter counts; the word says what in messages.
    Indices(&'static str, char),
    /// Numbers from 0 on of so many things, which the meaning lists; the word says what in messages.
    Codes(&'static str, usize),
    /// Positive integers whose sum is what a letter counts.
    Sizes(char),
    /// Integers that rise from 0 to what a letter counts.
    Offsets(char),
    /// Finite numbers.
    Numbers,
    /// Finite numbers above 0.
    Positive,
    /// Finite numbers from 0 on.
    NotNegative,
    /// Finite numbers, or NaN where one isn't known.
    NumbersOrNan,
    /// Finite numbers, of which each row is a unit vector.
    UnitVectors,
    /// Lines of text.
    Lines,
    /// Names, one at least.
    Names,
    /// Names of groups in the result file, each another one.
    GroupNames,
}

impl Kind {
    /// The word for its values.
    pub fn word(self) -> &'static str {
        match self {
            Self::Integers
            | Self::Indices(..)
            | Self::Codes(..)
            | Self::Sizes(_)
            | Self::Offsets(_) => "integers",
            Self::Numbers
            | Self::Positive
            | Self::NotNegative
            | Self::NumbersOrNan
            | Self::UnitVectors => "numbers",
            Self::Lines | Self::Names | Self::GroupNames => "strings",
        }
    }
}
