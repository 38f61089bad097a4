//! All datasets and attributes of a file.

use std::path::Path;

use hdf5::{File, Group};

/// A dataset or an attribute.
#[derive(Clone, Debug)]
pub struct Place {
    /// The group that holds it.
    pub group: String,
    pub name: String,
    pub is_attribute: bool,
}

/// Everything that a file holds.
pub fn places(path: &Path) -> Vec<Place> {
    let file = File::open(path).unwrap();
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
