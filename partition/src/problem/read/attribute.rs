//! Attributes: reads one value, and names it in errors.

use hdf5::types::TypeDescriptor;
use toml::Value;

use crate::error::InputError;
use crate::problem::strings::read_strings;

/// Reads the attribute `name` of a group: a text, an integer, a number or a Boolean.
///
/// # Errors
/// A missing attribute, or one of another type.
pub(super) fn read(group: &hdf5::Group, name: &str) -> Result<Value, InputError> {
    let refused = |what: &str| {
        let place = group.name();
        InputError::new(format!(
            "attribute {}/{name} {what}",
            place.trim_end_matches('/')
        ))
    };
    let attribute = group.attr(name).map_err(|_| refused("is missing"))?;
    if attribute.size() != 1 {
        return Err(refused(&format!(
            "holds {} values; expected one",
            attribute.size()
        )));
    }
    let unreadable = |reason: hdf5::Error| refused(&format!("can't be read: {reason}"));
    let descriptor = attribute.dtype().and_then(|dtype| dtype.to_descriptor());
    Ok(match descriptor.map_err(unreadable)? {
        TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
            Value::Integer(attribute.read_raw().map_err(unreadable)?[0])
        }
        TypeDescriptor::Float(_) => Value::Float(attribute.read_raw().map_err(unreadable)?[0]),
        TypeDescriptor::Boolean => Value::Boolean(attribute.read_raw().map_err(unreadable)?[0]),
        _ => {
            let strings = read_strings(&attribute).map_err(|reason| refused(&reason))?;
            Value::String(strings.concat())
        }
    })
}

/// True if a group has an attribute.
pub(super) fn is_there(group: &hdf5::Group, name: &str) -> bool {
    let names = group.attr_names().unwrap_or_default();
    names.iter().any(|known| known == name)
}
