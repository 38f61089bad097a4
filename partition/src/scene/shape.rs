//! Which keys of a scene hold one table, and which a list of them.

use toml::de::{DeTable, DeValue};

use super::place::Step;

/// Lists of a scene: `[[pressure]]`, once for each.
const LISTS: [&str; 6] = [
    "displacement",
    "bilateral",
    "traction",
    "pressure",
    "contact",
    "step",
];

/// Lists of a load step.
const LISTS_OF_STEP: [&str; 3] = ["traction", "pressure", "displacement"];

/// Tables of tables by name: `[materials.steel]`.
const NAMED: [&str; 2] = ["materials", "bodies"];

/// The first table where a list was expected or the other way round, and the key at which to say so.
pub(super) fn fault(text: &str) -> Option<(Vec<Step>, String)> {
    let root = DeTable::parse(text).ok()?.into_inner();
    for key in LISTS {
        match root.get(key).map(|value| value.get_ref()) {
            Some(DeValue::Table(_)) => return Some((vec![key.into()], one(key))),
            Some(DeValue::Array(steps)) if key == "step" => {
                for (index, step) in steps.iter().enumerate() {
                    let of_step = |key: &&str| match step.get_ref().get(*key) {
                        Some(value) => matches!(value.get_ref(), DeValue::Table(_)),
                        None => false,
                    };
                    if let Some(inner) = LISTS_OF_STEP.into_iter().find(of_step) {
                        let path = vec![key.into(), index.into(), inner.into()];
                        return Some((path, one(&format!("step.{inner}"))));
                    }
                }
            }
            _ => {}
        }
    }
    for key in NAMED {
        match root.get(key).map(|value| value.get_ref()) {
            Some(DeValue::Array(_)) => return Some((vec![key.into()], many(key, "NAME"))),
            Some(DeValue::Table(named)) => {
                for (name, value) in named {
                    if let DeValue::Array(_) = value.get_ref() {
                        let path = vec![key.into(), name.get_ref().as_ref().into()];
                        return Some((path, many(key, name.get_ref())));
                    }
                }
            }
            _ => {}
        }
    }
    None
}

fn one(list: &str) -> String {
    format!("there may be several; expected [[{list}]] in double brackets, once for each")
}

fn many(table: &str, name: &str) -> String {
    format!("there is one of a name; expected [{table}.{name}] in single brackets")
}
