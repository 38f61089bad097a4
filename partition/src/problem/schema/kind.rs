//! Kinds of a dataset's values.

/// Type of a dataset's values, and the condition on each of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Integers.
    Integers,
    /// Indices, from 0, of the items that a letter counts; the word names them in messages.
    Indices(&'static str, char),
    /// Numbers, from 0, of a given number of cases, which the meaning lists; the word names them in messages.
    Codes(&'static str, usize),
    /// Positive integers whose sum is the count of a letter.
    Sizes(char),
    /// Integers that ascend from 0 to the count of a letter.
    Offsets(char),
    /// Finite numbers.
    Numbers,
    /// Positive finite numbers.
    Positive,
    /// Nonnegative finite numbers.
    NotNegative,
    /// Finite numbers, or NaN for unknown ones.
    NumbersOrNan,
    /// Finite numbers whose rows are unit vectors.
    UnitVectors,
    /// Lines of text.
    Lines,
    /// Names, at least one.
    Names,
    /// Names of groups in the result file, all different.
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
