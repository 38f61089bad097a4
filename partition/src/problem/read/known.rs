//! The names that a problem file may hold: one that isn't known was meant to be another, and none
//! leads out of the file.

use hdf5::LinkType;

use crate::error::InputError;
use crate::scene::suggest::nearest;
use crate::solver::SolverSettings;

/// Groups that may hold what they like for ParaView.
const FREE: [&str; 2] = ["/VTKHDF/PointData", "/VTKHDF/CellData"];

/// What each of the other groups may hold.
const KNOWN: [(&str, &[&str]); 12] = [
    (
        "/",
        &[
            "VTKHDF",
            "materials",
            "bodies",
            "subdomains",
            "hierarchy",
            "interface",
            "support",
            "force",
            "contact",
            "settings",
            "steps",
            "warnings",
        ],
    ),
    (
        "/VTKHDF",
        &[
            "NumberOfPoints",
            "NumberOfCells",
            "NumberOfConnectivityIds",
            "Points",
            "Connectivity",
            "Offsets",
            "Types",
            "PointData",
            "CellData",
            "FieldData",
        ],
    ),
    (
        "/materials",
        &["name", "stiffness", "out_of_plane", "poisson"],
    ),
    ("/bodies", &["name"]),
    ("/subdomains", &["body", "group"]),
    ("/hierarchy", &["parent"]),
    ("/interface", &["offset", "node", "interface"]),
    (
        "/support",
        &["offset", "node", "direction", "value", "condition", "name"],
    ),
    ("/force", &["offset", "node", "value"]),
    ("/settings", &[]),
    ("/steps", &["name", "time"]),
    (
        "/contact",
        &[
            "name",
            "group_offset",
            "contact",
            "place",
            "gap",
            "area",
            "position",
            "force_point",
            "normal",
            "node_a",
            "node_b",
            "entry_offset",
            "entry_subdomain",
            "entry_node",
            "entry_weight",
        ],
    ),
];

/// Attributes of the groups that have any.
const ATTRIBUTES: [(&str, &[&str]); 2] = [
    (
        "/",
        &["format", "version", "title", "dimension", "plane", "units"],
    ),
    ("/settings", &SolverSettings::NAMES),
];

/// Checks that the file holds nothing but what is known.
///
/// # Errors
/// The first name that isn't, with the nearest that is.
pub(super) fn check(file: &hdf5::File) -> Result<(), InputError> {
    let unreadable = |what: &str| InputError::new(format!("{what} can't be read"));
    for (path, known) in ATTRIBUTES {
        let Ok(group) = file.group(path) else {
            continue;
        };
        let attributes = group
            .attr_names()
            .map_err(|_| unreadable("the list of attributes"))?;
        let place = match path {
            "/" => "attribute ".to_owned(),
            _ => format!("attribute {path}/"),
        };
        refuse(&place, attributes, known)?;
    }
    let known = KNOWN.map(|(path, known)| (path, Some(known)));
    for (path, known) in known.into_iter().chain(FREE.map(|path| (path, None))) {
        // What is missing, or is no group, is found where its datasets are opened.
        let Ok(group) = file.group(path) else {
            continue;
        };
        let place = match path {
            "/" => "/".to_owned(),
            _ => format!("{path}/"),
        };
        let (mut names, mut leading_out) = (Vec::new(), None);
        let visited = group.iter_visit_default(|name, link| {
            names.push(name.to_owned());
            if link.link_type == LinkType::External {
                leading_out.get_or_insert_with(|| name.to_owned());
            }
            Ok(())
        });
        visited.map_err(|_| unreadable(&format!("the group {path}")))?;
        if let Some(name) = leading_out {
            return Err(InputError::new(format!(
                "{place}{name} is a link to another file; expected all data in this one"
            )));
        }
        if let Some(known) = known {
            refuse(&place, names, known)?;
        }
    }
    Ok(())
}

fn refuse(place: &str, mut names: Vec<String>, known: &[&str]) -> Result<(), InputError> {
    names.sort();
    let unknown = names.iter().find(|name| !known.contains(&name.as_str()));
    let Some(name) = unknown else {
        return Ok(());
    };
    let Some(near) = nearest(name, known.iter().copied()) else {
        return Err(InputError::new(format!(
            "{place}{name} isn't known; expected attributes alone"
        )));
    };
    Err(InputError::new(format!(
        "{place}{name} isn't known; did you mean '{near}'? Known here: {}",
        known.join(", ")
    )))
}
