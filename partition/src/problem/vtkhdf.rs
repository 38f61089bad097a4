//! VTKHDF: the attributes that mark a group as an unstructured grid of VTK's HDF format for ParaView.

use hdf5::types::FixedAscii;

/// The type of dataset.
pub const GRID: &str = "UnstructuredGrid";

/// Version of the layout.
const VERSION: [i64; 2] = [2, 0];

/// ParaView compares all bytes of the attribute, so that its length is exactly that of the word: null-padded, without
/// the terminator, which VTK's reader can't handle.
type GridType = FixedAscii<{ GRID.len() }>;

/// Marks a group as an unstructured grid.
///
/// # Errors
/// The file can't be written.
pub fn mark(group: &hdf5::Group) -> hdf5::Result<()> {
    (group.new_attr::<i64>().shape(VERSION.len()))
        .create("Version")?
        .write_raw(&VERSION)?;
    let kind = GridType::from_ascii(GRID).map_err(|error| error.to_string())?;
    (group.new_attr::<GridType>())
        .create("Type")?
        .write_scalar(&kind)
}
