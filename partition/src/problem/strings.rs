//! Strings in a file, of variable or fixed length.

use std::fmt::Display;
use std::str::FromStr;

use hdf5::H5Type;
use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenAscii, VarLenUnicode};

/// Longest fixed-length string that is read or written (bytes).
const LONGEST_FIXED: usize = 1024;

/// The type of written texts: one of fixed length unless they are too long, as HDF5 stores strings of variable length
/// in a heap without checksums.
pub(super) fn type_of(texts: &[String]) -> TypeDescriptor {
    // HDF5 has no strings of length 0.
    match texts.iter().map(String::len).max().unwrap_or(0).max(1) {
        length if length <= LONGEST_FIXED => TypeDescriptor::FixedUnicode(length),
        _ => TypeDescriptor::VarLenUnicode,
    }
}

/// Writes texts without NUL to a dataset or attribute of their [type](type_of).
pub(super) fn write_strings(container: &hdf5::Container, texts: &[String]) -> hdf5::Result<()> {
    match type_of(texts) {
        _ if texts.is_empty() => Ok(()),
        TypeDescriptor::FixedUnicode(_) => {
            write_as::<FixedUnicode<LONGEST_FIXED>>(container, texts)
        }
        _ => write_as::<VarLenUnicode>(container, texts),
    }
}

fn write_as<T>(container: &hdf5::Container, texts: &[String]) -> hdf5::Result<()>
where
    T: H5Type + FromStr<Err: Display>,
{
    let texts = texts.iter().map(|text| text.parse::<T>());
    let texts: Result<Vec<T>, _> = texts.collect();
    let texts = texts.map_err(|reason| hdf5::Error::Internal(reason.to_string()))?;
    container.write_raw(&texts)
}

/// Reads the strings of a dataset or attribute.
pub(super) fn read_strings(container: &hdf5::Container) -> Result<Vec<String>, String> {
    if container.size() == 0 {
        return Ok(Vec::new());
    }
    let descriptor = container.dtype().and_then(|dtype| dtype.to_descriptor());
    match descriptor.map_err(unreadable)? {
        TypeDescriptor::VarLenUnicode => read_as::<VarLenUnicode>(container),
        TypeDescriptor::VarLenAscii => read_as::<VarLenAscii>(container),
        TypeDescriptor::FixedUnicode(size) if size <= LONGEST_FIXED => {
            read_as::<FixedUnicode<LONGEST_FIXED>>(container)
        }
        TypeDescriptor::FixedAscii(size) if size <= LONGEST_FIXED => {
            read_as::<FixedAscii<LONGEST_FIXED>>(container)
        }
        other => Err(format!("holds {other}; expected strings")),
    }
}

fn read_as<T: H5Type + AsRef<[u8]>>(container: &hdf5::Container) -> Result<Vec<String>, String> {
    let raw = container.read_raw::<T>().map_err(unreadable)?;
    let texts = raw.iter().map(|s| String::from_utf8(s.as_ref().to_vec()));
    let texts = texts.collect::<Result<_, _>>();
    texts.map_err(|_| "holds a string that isn't UTF-8".to_owned())
}

fn unreadable(reason: hdf5::Error) -> String {
    format!("can't be read: {reason}")
}
