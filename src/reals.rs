//! Lists of reals in messages: their bytes as they lie in memory, copied in one piece.
//!
//! `#[serde(with = "crate::reals")]` on a `Vec<f64>`, [`reals::lower`](lower) on the matrix of a symmetric one, of
//! which the lower triangle travels. Number after number would take a run's largest messages many times as long.

use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserializer, Serializer};

/// Writes a list.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(list: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_bytes(bytemuck::cast_slice(list))
}

/// Reads a list.
///
/// # Errors
/// It isn't there, or cut short.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    deserializer.deserialize_bytes(List)
}

struct List;

impl Visitor<'_> for List {
    type Value = Vec<f64>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the bytes of reals")
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<f64>, E> {
        let (reals, rest) = bytes.as_chunks();
        match rest.is_empty() {
            true => Ok(reals.iter().map(|&real| f64::from_ne_bytes(real)).collect()),
            false => Err(E::invalid_length(bytes.len(), &self)),
        }
    }
}

/// The lower triangle of a symmetric matrix, column after column; the upper one arrives as zero.
pub mod lower {
    use faer::Mat;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Triangle {
        size: usize,
        #[serde(with = "super")]
        columns: Vec<f64>,
    }

    /// Writes the triangle.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(matrix: &Mat<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        let size = matrix.nrows();
        // faer pads its columns, so that a matrix can't be sent as it lies in memory.
        let mut columns = Vec::with_capacity(size * (size + 1) / 2);
        for j in 0..size {
            columns.extend_from_slice(&matrix.col_as_slice(j)[j..]);
        }
        Triangle { size, columns }.serialize(serializer)
    }

    /// Reads the triangle.
    ///
    /// # Errors
    /// It isn't there, or cut short.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Mat<f64>, D::Error> {
        let Triangle { size, columns } = Triangle::deserialize(deserializer)?;
        if columns.len() != size * (size + 1) / 2 {
            return Err(D::Error::invalid_length(columns.len(), &"a triangle"));
        }
        let mut matrix = Mat::zeros(size, size);
        let mut rest = &columns[..];
        for j in 0..size {
            let (column, after) = rest.split_at(size - j);
            matrix.col_as_slice_mut(j)[j..].copy_from_slice(column);
            rest = after;
        }
        Ok(matrix)
    }
}

/// A matrix, column after column.
pub mod matrix {
    use faer::Mat;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Columns {
        rows: usize,
        columns: usize,
        #[serde(with = "super")]
        values: Vec<f64>,
    }

    /// Writes the matrix.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(matrix: &Mat<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        let (rows, columns) = matrix.shape();
        let mut values = Vec::with_capacity(rows * columns);
        for j in 0..columns {
            values.extend_from_slice(matrix.col_as_slice(j));
        }
        let columns = Columns {
            rows,
            columns,
            values,
        };
        columns.serialize(serializer)
    }

    /// Reads the matrix.
    ///
    /// # Errors
    /// It isn't there, or cut short.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Mat<f64>, D::Error> {
        let Columns {
            rows,
            columns,
            values,
        } = Columns::deserialize(deserializer)?;
        if values.len() != rows * columns {
            return Err(D::Error::invalid_length(values.len(), &"a matrix"));
        }
        Ok(Mat::from_fn(rows, columns, |i, j| values[j * rows + i]))
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;
    use serde::{Deserialize, Serialize};

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Sent {
        name: String,
        #[serde(with = "super")]
        list: Vec<f64>,
        #[serde(with = "super::lower")]
        lower: Mat<f64>,
        #[serde(with = "super::matrix")]
        matrix: Mat<f64>,
    }

    fn sent() -> Sent {
        Sent {
            name: "some".into(),
            list: vec![1.5, -0.0, f64::INFINITY, 1e-300],
            lower: Mat::from_fn(5, 5, |i, j| if i < j { 0.0 } else { (i + 10 * j) as f64 }),
            matrix: Mat::from_fn(3, 5, |i, j| (10 * i + j) as f64),
        }
    }

    #[test]
    fn what_was_sent_arrives() {
        let bytes = postcard::to_stdvec(&sent()).unwrap();
        assert_eq!(postcard::from_bytes::<Sent>(&bytes).unwrap(), sent());
    }

    #[test]
    fn what_is_cut_short_is_an_error() {
        let bytes = postcard::to_stdvec(&sent()).unwrap();
        for length in 0..bytes.len() {
            assert!(postcard::from_bytes::<Sent>(&bytes[..length]).is_err());
        }
    }
}
