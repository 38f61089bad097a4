//! Lists of numbers in messages, serialized as the bytes that represent them in memory.
//!
//! `#[serde(with = "crate::bytes")]` on a `Vec` of numbers, or [`Reals`] around it; [`mod@matrix`] and [`lower`] on
//! matrices. Serializing the numbers one by one would take many times as long for the largest messages.

use std::fmt;
use std::marker::PhantomData;

use bytemuck::Pod;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A list of reals, serialized as bytes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reals(#[serde(with = "self")] pub Vec<f64>);

/// Writes a list.
///
/// # Errors
/// Errors of the serializer.
pub fn serialize<T: Pod, S: Serializer>(list: &[T], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_bytes(bytemuck::cast_slice(list))
}

/// Reads a list.
///
/// # Errors
/// The data is missing, truncated, or of another length than expected.
pub fn deserialize<'de, T, D>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    T: Pod,
    D: Deserializer<'de>,
{
    // `deserialize_bytes` of a deserializer that reads a stream is limited to the length of its buffer.
    deserializer.deserialize_byte_buf(List(PhantomData))
}

struct List<T>(PhantomData<T>);

impl<T: Pod> Visitor<'_> for List<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the bytes of whole numbers")
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<T>, E> {
        if !bytes.len().is_multiple_of(size_of::<T>()) {
            return Err(E::invalid_length(bytes.len(), &self));
        }
        let mut list = vec![T::zeroed(); bytes.len() / size_of::<T>()];
        bytemuck::cast_slice_mut(&mut list).copy_from_slice(bytes);
        Ok(list)
    }
}

/// The lower triangle of a symmetric matrix, column by column; the upper triangle is read as zero.
pub mod lower {
    use faer::Mat;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::Reals;

    /// Writes the triangle.
    ///
    /// # Errors
    /// Errors of the serializer.
    pub fn serialize<S: Serializer>(matrix: &Mat<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        let size = matrix.nrows();
        // faer pads its columns, so that a matrix can't be sent as it lies in memory.
        let mut columns = Vec::with_capacity(size * (size + 1) / 2);
        for j in 0..size {
            columns.extend_from_slice(&matrix.col_as_slice(j)[j..]);
        }
        (size, Reals(columns)).serialize(serializer)
    }

    /// Reads the triangle.
    ///
    /// # Errors
    /// The data is missing, truncated, or of another length than expected.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Mat<f64>, D::Error> {
        let (size, Reals(columns)): (usize, Reals) = Deserialize::deserialize(deserializer)?;
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

/// A symmetric matrix, serialized as its lower triangle and read with both triangles.
pub mod symmetric {
    use faer::Mat;
    use serde::{Deserializer, Serializer};

    use super::lower;

    /// Writes the lower triangle.
    ///
    /// # Errors
    /// Errors of the serializer.
    pub fn serialize<S: Serializer>(matrix: &Mat<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        lower::serialize(matrix, serializer)
    }

    /// Reads the lower triangle and mirrors it.
    ///
    /// # Errors
    /// The data is missing, truncated, or of another length than expected.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Mat<f64>, D::Error> {
        let mut matrix = lower::deserialize(deserializer)?;
        for j in 0..matrix.ncols() {
            for i in j + 1..matrix.nrows() {
                matrix[(j, i)] = matrix[(i, j)];
            }
        }
        Ok(matrix)
    }
}

/// A matrix, column by column.
pub mod matrix {
    use faer::Mat;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::Reals;

    /// Writes the matrix.
    ///
    /// # Errors
    /// Errors of the serializer.
    pub fn serialize<S: Serializer>(matrix: &Mat<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        let (rows, columns) = matrix.shape();
        let mut values = Vec::with_capacity(rows * columns);
        for j in 0..columns {
            values.extend_from_slice(matrix.col_as_slice(j));
        }
        (rows, columns, Reals(values)).serialize(serializer)
    }

    /// Reads the matrix.
    ///
    /// # Errors
    /// The data is missing, truncated, or of another length than expected.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Mat<f64>, D::Error> {
        let (rows, columns, Reals(values)): (usize, usize, Reals) =
            Deserialize::deserialize(deserializer)?;
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
    fn what_was_kept_is_read_back_however_long_it_is() {
        // A reader of streams has a buffer of 4096 bytes.
        for size in [0, 1, 22, 23, 31, 32, 511, 512, 513, 1000] {
            let kept = Sent {
                name: "n".repeat(10 * size),
                list: (0..size).map(|i| 1.0 / i as f64).collect(),
                lower: Mat::from_fn(size, size, |i, j| if i < j { 0.0 } else { (i + j) as f64 }),
                matrix: Mat::from_fn(size, 2, |i, j| (10 * i + j) as f64),
            };
            let mut bytes = Vec::new();
            ciborium::into_writer(&kept, &mut bytes).unwrap();
            assert_eq!(ciborium::from_reader::<Sent, _>(&bytes[..]).unwrap(), kept);
        }
    }

    #[test]
    fn what_is_cut_short_is_an_error() {
        let bytes = postcard::to_stdvec(&sent()).unwrap();
        for length in 0..bytes.len() {
            assert!(postcard::from_bytes::<Sent>(&bytes[..length]).is_err());
        }
    }
}
