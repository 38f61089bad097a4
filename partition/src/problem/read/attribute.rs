//! An attribute that knows its name: reads one value and says what is wrong with it.

use hdf5::types::TypeDescriptor;

use crate::error::InputError;
use crate::problem::strings::read_strings;

/// An open attribute of one value.
pub(super) struct Attribute {
    /// As in "attribute tolerance of /settings".
    shown: String,
    inner: hdf5::Attribute,
}

impl Attribute {
    /// Opens the attribute called `name`.
    pub fn open(group: &hdf5::Group, name: &str) -> Result<Self, InputError> {
        let shown = match group.name().as_str() {
            "/" => format!("attribute {name}"),
            place => format!("attribute {name} of {place}"),
        };
        let inner = group
            .attr(name)
            .map_err(|_| InputError::new(format!("{shown} is missing")))?;
        match inner.size() {
            1 => Ok(Self { shown, inner }),
            size => Err(InputError::new(format!(
                "{shown} holds {size} values; expected one"
            ))),
        }
    }

    /// Opens the attribute called `name`; `None` where there is none.
    pub fn find(group: &hdf5::Group, name: &str) -> Result<Option<Self>, InputError> {
        let names = group
            .attr_names()
            .map_err(|_| InputError::new("the list of attributes can't be read"))?;
        match names.iter().any(|known| known == name) {
            true => Self::open(group, name).map(Some),
            false => Ok(None),
        }
    }

    /// An error about the attribute, which goes on after its name.
    pub fn error(&self, what: &str) -> InputError {
        InputError::new(format!("{} {what}", self.shown))
    }

    /// Its text.
    pub fn text(&self) -> Result<String, InputError> {
        let mut strings = read_strings(&self.inner).map_err(|reason| self.error(&reason))?;
        Ok(strings.pop().unwrap_or_default())
    }

    /// Its integer.
    pub fn integer(&self) -> Result<i64, InputError> {
        use TypeDescriptor::{Integer, Unsigned};
        match self.descriptor() {
            Some(Integer(_) | Unsigned(_)) => self.value(),
            _ => Err(self.error("isn't an integer")),
        }
    }

    /// Its number, which may be an integer.
    pub fn number(&self) -> Result<f64, InputError> {
        use TypeDescriptor::{Float, Integer, Unsigned};
        match self.descriptor() {
            Some(Integer(_) | Unsigned(_) | Float(_)) => self.value(),
            _ => Err(self.error("isn't a number")),
        }
    }

    /// Whether it says yes: as h5py writes `True` and `False`, or as 1 and 0.
    pub fn truth(&self) -> Result<bool, InputError> {
        match self.descriptor() {
            Some(TypeDescriptor::Boolean) => self.value(),
            _ => match self.integer() {
                Ok(0) => Ok(false),
                Ok(1) => Ok(true),
                _ => Err(self.error("isn't true or false; expected one of them, or 1 or 0")),
            },
        }
    }

    fn descriptor(&self) -> Option<TypeDescriptor> {
        let dtype = self.inner.dtype().ok()?;
        dtype.to_descriptor().ok()
    }

    fn value<T: hdf5::H5Type + Copy>(&self) -> Result<T, InputError> {
        let values = self.inner.read_raw::<T>().ok();
        let value = values.and_then(|values| values.first().copied());
        value.ok_or_else(|| self.error("can't be read"))
    }
}
