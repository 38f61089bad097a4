//! Strings of a file, of variable or fixed length.

use hdf5::H5Type;
use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenAscii, VarLenUnicode};

/// Longest fixed-length string that is read (bytes).
const LONGEST_FIXED: usize = 1024;

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
