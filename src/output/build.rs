//! What a program was made of: the same of everything gives the same bits.

use schemars::JsonSchema;
use serde::Serialize;

/// The build of this program.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Build {
    /// Commit of its source, with `-dirty` behind it where files were changed; `null` in a debug
    /// build and where the source was no repository.
    pub commit: Option<String>,
    /// `release` or `debug`.
    pub profile: String,
    /// The compiler.
    pub compiler: String,
    /// What it was compiled for.
    pub target: String,
    /// The MPI library that it runs with.
    pub mpi: String,
    /// The version of the HDF5 library that it runs with.
    pub hdf5: String,
}

impl Build {
    /// This program's, with `mpi` for the MPI library.
    pub fn of_this_program(mpi: String) -> Self {
        let (major, minor, release) = hdf5::library_version();
        Self {
            commit: option_env!("BUILD_COMMIT").map(str::to_owned),
            profile: env!("BUILD_PROFILE").into(),
            compiler: env!("BUILD_COMPILER").into(),
            target: env!("BUILD_TARGET").into(),
            mpi,
            hdf5: format!("{major}.{minor}.{release}"),
        }
    }
}
