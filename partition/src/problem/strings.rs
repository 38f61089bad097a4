//! Strings of a file, of variable or fixed length.

use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenAscii, VarLenUnicode};

/// Longest fixed-length string that is read (bytes).
const LONGEST_FIXED: usize = 1024;

/// Reads the strings of a dataset or attribute.
pub(super) fn read_strings(container: &hdf5::Container) -> Result<Vec<String>, String> {
    let text = |bytes: &[u8]| {
        String::from_utf8(bytes.to_vec()).map_err(|_| "holds a string that isn't UTF-8".to_owned())
    };
    let failed = |reason: hdf5::Error| format!("can't be read: {reason}");
    if container.size() == 0 {
        return Ok(Vec::new());
    }
    let descriptor = container
        .dtype()
        .and_then(|dtype| dtype.to_descriptor())
        .map_err(failed)?;
    match descriptor {
        TypeDescriptor::VarLenUnicode => {
            let raw = container.read_raw::<VarLenUnicode>().map_err(failed)?;
            raw.iter().map(|s| text(s.as_bytes())).collect()
        }
        TypeDescriptor::VarLenAscii => {
            let raw = container.read_raw::<VarLenAscii>().map_err(failed)?;
            raw.iter().map(|s| text(s.as_bytes())).collect()
        }
        TypeDescriptor::FixedUnicode(size) if size <= LONGEST_FIXED => {
            let raw = container.read_raw::<FixedUnicode<LONGEST_FIXED>>();
            let raw = raw.map_err(failed)?;
            raw.iter().map(|s| text(s.as_bytes())).collect()
        }
        TypeDescriptor::FixedAscii(size) if size <= LONGEST_FIXED => {
            let raw = container.read_raw::<FixedAscii<LONGEST_FIXED>>();
            let raw = raw.map_err(failed)?;
            raw.iter().map(|s| text(s.as_bytes())).collect()
        }
        other => Err(format!("holds {other}; expected strings")),
    }
}
