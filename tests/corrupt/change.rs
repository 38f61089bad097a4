//! Changes of a dataset or an attribute.

use std::fmt;
use std::path::Path;

use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenUnicode};
use hdf5::{Container, Group, H5Type};

use super::walk::{Place, without_locks};

/// A change of a dataset or an attribute.
#[derive(Clone, Debug)]
pub enum Change {
    Drop,
    /// No row is left.
    Empty,
    /// One row less.
    Shorten,
    /// The last row twice.
    Lengthen,
    /// One dimension more.
    Deepen,
    /// The same numbers as another numeric type, or as strings.
    Retype(Type),
    /// Another integer in one place.
    Integer(usize, i64),
    /// Another real number in one place.
    Real(usize, f64),
    /// Another string in one place.
    Text(usize, String),
    /// A group of the same name.
    Group,
}

#[derive(Clone, Copy, Debug)]
pub enum Type {
    I8,
    I32,
    U64,
    F32,
    F64,
    Bool,
    Text,
    Bytes,
}

/// The rows of a dataset or an attribute.
#[derive(Clone, Debug)]
enum Data {
    Integers(Vec<i64>),
    Reals(Vec<f64>),
    Texts(Vec<String>),
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown: String = format!("{self:?}").chars().take(60).collect();
        f.write_str(&shown)
    }
}

/// All changes of the dataset or attribute at `place`.
pub fn changes(path: &Path, place: &Place) -> Vec<Change> {
    let file = without_locks().open(path).unwrap();
    let container = open(&file.group(&place.group).unwrap(), place);
    let mut changes = vec![
        Change::Drop,
        Change::Empty,
        Change::Shorten,
        Change::Lengthen,
        Change::Deepen,
        Change::Group,
    ];
    let types = [
        Type::I8,
        Type::I32,
        Type::U64,
        Type::F32,
        Type::F64,
        Type::Bool,
        Type::Text,
        Type::Bytes,
    ];
    changes.extend(types.map(Change::Retype));
    let size = container.size();
    let mut at = vec![0, size.saturating_sub(1)];
    at.dedup();
    match read(&container) {
        Data::Integers(_) => {
            for value in [-1, -7, 0, 1, 1 << 31, 1 << 62, i64::MIN] {
                changes.extend(at.iter().map(|&at| Change::Integer(at, value)));
            }
        }
        Data::Reals(_) => {
            for value in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 1e-3, 7.0, 1e300] {
                changes.extend(at.iter().map(|&at| Change::Real(at, value)));
            }
        }
        Data::Texts(_) => {
            let long = "x".repeat(100_000);
            for text in [
                "",
                "../x",
                "a/b",
                ".",
                "VTKHDF",
                "a\nb",
                "naïve 漢字",
                &long,
            ] {
                changes.extend(at.iter().map(|&at| Change::Text(at, text.into())));
            }
        }
    }
    changes
}

impl Change {
    /// Makes the change in a file.
    pub fn apply(&self, path: &Path, place: &Place) {
        let file = without_locks().open_rw(path).unwrap();
        let group = file.group(&place.group).unwrap();
        let container = open(&group, place);
        let mut shape = container.shape();
        let mut data = read(&container);
        drop(container);
        match place.is_attribute {
            true => group.delete_attr(&place.name).unwrap(),
            false => group.unlink(&place.name).unwrap(),
        }
        let rows = shape.first().copied().unwrap_or(1);
        let mut kind = None;
        match self {
            Self::Drop => return,
            Self::Group => {
                if !place.is_attribute {
                    group.create_group(&place.name).unwrap();
                }
                return;
            }
            Self::Empty => reshape(&mut shape, &mut data, 0),
            Self::Shorten => reshape(&mut shape, &mut data, rows.saturating_sub(1)),
            Self::Lengthen => reshape(&mut shape, &mut data, rows + 1),
            Self::Deepen => shape.push(1),
            Self::Retype(other) => kind = Some(*other),
            Self::Integer(at, value) => {
                if let Data::Integers(values) = &mut data {
                    values[*at] = *value;
                }
            }
            Self::Real(at, value) => {
                if let Data::Reals(values) = &mut data {
                    values[*at] = *value;
                }
            }
            Self::Text(at, value) => {
                if let Data::Texts(values) = &mut data {
                    values[*at].clone_from(value);
                }
            }
        }
        let target = Target {
            group: &group,
            place,
            shape: &shape,
        };
        target.write(data, kind);
        file.close().unwrap();
    }
}

fn open(group: &Group, place: &Place) -> Container {
    match place.is_attribute {
        true => (*group.attr(&place.name).unwrap()).clone(),
        false => (*group.dataset(&place.name).unwrap()).clone(),
    }
}

fn read(container: &Container) -> Data {
    match container.dtype().unwrap().to_descriptor().unwrap() {
        TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
            Data::Integers(container.read_raw().unwrap())
        }
        TypeDescriptor::Boolean => {
            let truths: Vec<bool> = container.read_raw().unwrap();
            Data::Integers(truths.into_iter().map(i64::from).collect())
        }
        TypeDescriptor::Float(_) => Data::Reals(container.read_raw().unwrap()),
        TypeDescriptor::VarLenUnicode => {
            let texts = container.read_raw::<VarLenUnicode>().unwrap();
            Data::Texts(texts.iter().map(|text| text.as_str().into()).collect())
        }
        TypeDescriptor::FixedUnicode(_) => {
            let texts = container.read_raw::<FixedUnicode<1024>>().unwrap();
            Data::Texts(texts.iter().map(|text| text.as_str().into()).collect())
        }
        TypeDescriptor::FixedAscii(_) => {
            let texts = container.read_raw::<FixedAscii<64>>().unwrap();
            Data::Texts(texts.iter().map(|text| text.as_str().into()).collect())
        }
        other => panic!("{other} isn't known here"),
    }
}

/// Cuts off rows, or repeats the last one.
fn reshape(shape: &mut Vec<usize>, data: &mut Data, rows: usize) {
    if shape.is_empty() {
        shape.push(1);
    }
    shape[0] = rows;
    let size = shape.iter().product();
    match data {
        Data::Integers(values) => resize(values, size, 0),
        Data::Reals(values) => resize(values, size, 0.0),
        Data::Texts(values) => resize(values, size, String::new()),
    }
}

fn resize<T: Clone>(values: &mut Vec<T>, size: usize, none: T) {
    let last = values
        .len()
        .saturating_sub(size.saturating_sub(values.len()));
    let more: Vec<T> = values[last..].to_vec();
    values.extend(more);
    values.resize(size, none);
}

/// The place that data are written to.
struct Target<'a> {
    group: &'a Group,
    place: &'a Place,
    shape: &'a [usize],
}

impl Target<'_> {
    fn write(&self, data: Data, kind: Option<Type>) {
        let numbers: Vec<f64> = match &data {
            Data::Integers(values) => values.iter().map(|&v| v as f64).collect(),
            Data::Reals(values) => values.clone(),
            Data::Texts(values) => vec![1.0; values.len()],
        };
        let words = || match &data {
            Data::Texts(values) => values.clone(),
            _ => numbers.iter().map(f64::to_string).collect(),
        };
        let cast = |to: fn(f64) -> i64| numbers.iter().map(move |&v| to(v));
        match kind {
            Some(Type::I8) => self.put(&cast(|v| v as i64).map(|v| v as i8).collect::<Vec<_>>()),
            Some(Type::I32) => self.put(&cast(|v| v as i64).map(|v| v as i32).collect::<Vec<_>>()),
            Some(Type::U64) => self.put(&cast(|v| v as i64).map(|v| v as u64).collect::<Vec<_>>()),
            Some(Type::F32) => self.put(&numbers.iter().map(|&v| v as f32).collect::<Vec<_>>()),
            Some(Type::F64) => self.put(&numbers),
            Some(Type::Bool) => self.put(&numbers.iter().map(|&v| v != 0.0).collect::<Vec<_>>()),
            Some(Type::Text) => self.texts(&words()),
            Some(Type::Bytes) => {
                let bytes = words().into_iter().map(|word| {
                    let start: String = word.chars().filter(char::is_ascii).take(64).collect();
                    FixedAscii::<64>::from_ascii(&start).unwrap()
                });
                self.put(&bytes.collect::<Vec<_>>());
            }
            None => match data {
                Data::Integers(values) => self.put(&values),
                Data::Reals(values) => self.put(&values),
                Data::Texts(values) => self.texts(&values),
            },
        }
    }

    fn texts(&self, texts: &[String]) {
        let texts: Vec<VarLenUnicode> = texts.iter().map(|text| text.parse().unwrap()).collect();
        self.put(&texts);
    }

    fn put<T: H5Type>(&self, values: &[T]) {
        let (name, shape) = (self.place.name.as_str(), self.shape);
        let container: Container = match self.place.is_attribute {
            true => {
                let made = self.group.new_attr::<T>().shape(shape).create(name);
                (*made.unwrap()).clone()
            }
            false => {
                let made = self.group.new_dataset::<T>().shape(shape).create(name);
                (*made.unwrap()).clone()
            }
        };
        if !values.is_empty() {
            container.write_raw(values).unwrap();
        }
    }
}
