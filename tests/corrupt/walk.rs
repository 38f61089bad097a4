//! All datasets and attributes of a file.

use std::path::Path;

use hdf5::{File, FileBuilder, Group};

/// A dataset or an attribute.
#[derive(Clone, Debug)]
pub struct Place {
    /// The group that holds it.
    pub group: String,
    pub name: String,
    pub is_attribute: bool,
}

/// Access to files without locks: a process that another test is about to start has the lock of this one's file, too.
pub fn without_locks() -> FileBuilder {
    let mut options = File::with_options();
    options.with_fapl(|access| access.file_locking(false));
    options
}

/// Everything that a file holds.
pub fn places(path: &Path) -> Vec<Place> {
    let file = without_locks().open(path).unwrap();
    let mut places = Vec::new();
    collect(&file.group("/").unwrap(), &mut places);
    places
}

fn collect(group: &Group, places: &mut Vec<Place>) {
    let place = |name: String, is_attribute| Place {
        group: group.name(),
        name,
        is_attribute,
    };
    let attributes = group.attr_names().unwrap();
    places.extend(attributes.into_iter().map(|name| place(name, true)));
    for name in group.member_names().unwrap() {
        match group.group(&name) {
            Ok(inner) => collect(&inner, places),
            Err(_) => places.push(place(name, false)),
        }
    }
}
