//! What travels.

use faer::{Mat, MatRef};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The bytes of a value.
pub(super) fn encode<T: Serialize>(value: &T) -> postcard::Result<Vec<u8>> {
    postcard::to_stdvec(value)
}

/// The value that `bytes` stand for, all of them.
pub(super) fn decode<T: DeserializeOwned>(bytes: &[u8]) -> postcard::Result<T> {
    match postcard::take_from_bytes(bytes)? {
        (value, []) => Ok(value),
        _ => Err(postcard::Error::DeserializeBadEncoding),
    }
}

/// A message.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Message {
    /// Integers.
    pub integers: Vec<i64>,
    /// Reals.
    #[serde(with = "crate::reals")]
    pub reals: Vec<f64>,
}

impl Message {
    /// Appends the lower triangle of a symmetric matrix, column after column.
    ///
    /// faer pads its columns, so that a matrix can't be sent as it lies in memory.
    pub fn push_lower(&mut self, matrix: MatRef<'_, f64>) {
        let n = matrix.nrows();
        self.reals.reserve(n * (n + 1) / 2);
        for j in 0..matrix.ncols() {
            self.reals.extend(matrix.col(j).subrows(j, n - j).iter());
        }
    }

    /// Appends a matrix, column after column.
    pub fn push_matrix(&mut self, matrix: MatRef<'_, f64>) {
        self.reals.reserve(matrix.nrows() * matrix.ncols());
        for column in matrix.col_iter() {
            self.reals.extend(column.iter());
        }
    }
}

/// Reads a message in the order in which it was filled. The sender and the reader are the same
/// program, so what is read is there; a list that is too short yields zeros.
#[derive(Debug)]
pub struct MessageReader {
    integers: std::vec::IntoIter<i64>,
    reals: std::vec::IntoIter<f64>,
}

impl Message {
    /// Starts to read.
    pub fn read(self) -> MessageReader {
        MessageReader {
            integers: self.integers.into_iter(),
            reals: self.reals.into_iter(),
        }
    }
}

impl MessageReader {
    /// The next integer.
    pub fn integer(&mut self) -> i64 {
        self.integers.next().unwrap_or_default()
    }

    /// The next integer, which is a count.
    pub fn count(&mut self) -> usize {
        self.integer() as usize
    }

    /// The next `n` integers.
    pub fn integers(&mut self, n: usize) -> Vec<i64> {
        self.integers.by_ref().take(n).collect()
    }

    /// The next real.
    pub fn real(&mut self) -> f64 {
        self.reals.next().unwrap_or_default()
    }

    /// The next `n` reals.
    pub fn reals(&mut self, n: usize) -> Vec<f64> {
        self.reals.by_ref().take(n).collect()
    }

    /// The lower triangle of the next symmetric matrix of size `n`; the upper one is zero.
    pub fn lower(&mut self, n: usize) -> Mat<f64> {
        let mut matrix = Mat::zeros(n, n);
        for j in 0..n {
            for (a, value) in matrix.col_as_slice_mut(j)[j..]
                .iter_mut()
                .zip(&mut self.reals)
            {
                *a = value;
            }
        }
        matrix
    }

    /// The next symmetric matrix of size `n`, sent as its lower triangle.
    pub fn symmetric(&mut self, n: usize) -> Mat<f64> {
        let mut matrix = self.lower(n);
        for j in 0..n {
            for i in j + 1..n {
                matrix[(j, i)] = matrix[(i, j)];
            }
        }
        matrix
    }

    /// The next matrix.
    pub fn matrix(&mut self, rows: usize, columns: usize) -> Mat<f64> {
        let mut matrix = Mat::zeros(rows, columns);
        for j in 0..columns {
            for i in 0..rows {
                matrix[(i, j)] = self.real();
            }
        }
        matrix
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_arrive_as_they_were_sent() {
        let full = Mat::from_fn(3, 5, |i, j| (10 * i + j) as f64);
        let symmetric = Mat::from_fn(4, 4, |i, j| (i * j + i + j) as f64);
        let mut message = Message::default();
        message.push_matrix(full.as_ref());
        message.push_lower(symmetric.as_ref());
        let mut reader = message.read();
        assert_eq!(reader.matrix(3, 5), full);
        assert_eq!(reader.symmetric(4), symmetric);
    }
}
