//! Quantities, parameters, and the nodal weights and forces of these.

use std::ops::Range;

use super::contents::Contents;
use super::slice::{NODE, Slice};
use crate::element::geometry::padded;
use crate::error::InputError;
use crate::quantity::{
    LoadForce, NodalShares, NodeWeight, Parameter, ParameterKind, Quantity, QuantityKind,
};

/// Reads all quantities.
pub(super) fn quantities(contents: &Contents) -> Result<Vec<Quantity>, InputError> {
    let rows = 0..contents.count('J');
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let names = contents.strings("/quantity/name")?;
    let kind = contents.integers("/quantity/kind", rows.clone())?;
    let direction = contents.numbers("/quantity/direction", rows.clone())?;
    let direction = direction.vectors(rows.clone());
    let point = contents.numbers("/quantity/point", rows.clone())?;
    let point = point.vectors(rows.clone());
    let length = contents.numbers("/quantity/length", rows.clone())?;
    let constant = contents.numbers("/quantity/constant", rows.clone())?;
    let node = contents.integers("/quantity/node", rows)?;
    let of = contents.all_integers("/quantity/of")?;
    let quantity = |(row, name): (usize, String)| {
        let kind = QuantityKind::ALL[kind.all()[row] as usize];
        let letters: &[(&str, char)] = match kind {
            QuantityKind::Displacement | QuantityKind::Energy => &[],
            QuantityKind::MeanStress => &[("material", 'M')],
            QuantityKind::Reaction => &[("condition", 'U')],
            QuantityKind::Opening => &[("contact", 'Q'), ("place", 'R')],
            QuantityKind::OpeningIntensity
            | QuantityKind::SlidingIntensity
            | QuantityKind::EnergyReleaseRate => &[("crack tip", 'A')],
            QuantityKind::LargestPressure => &[("contact", 'Q')],
            QuantityKind::ContactForce
            | QuantityKind::ContactMoment
            | QuantityKind::MeanPressure => &[("contact", 'Q'), ("place", 'R')],
        };
        let is_list = match kind {
            QuantityKind::MeanStress | QuantityKind::Reaction => true,
            // The places of the points beside shared nodes.
            _ => kind.adds_forces(),
        };
        Ok(Quantity {
            name,
            kind,
            direction: direction[row],
            point: point[row],
            length: length.all()[row],
            constants: constant.of(row..row + 1).to_vec(),
            of: numbers(contents, &of, contents.rows('D', row), (letters, is_list))?,
            node: node.all()[row],
        })
    };
    names.into_iter().enumerate().map(quantity).collect()
}

/// Reads all parameters.
pub(super) fn parameters(contents: &Contents) -> Result<Vec<Parameter>, InputError> {
    let rows = 0..contents.count('O');
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let names = contents.strings("/parameter/name")?;
    let kind = contents.integers("/parameter/kind", rows.clone())?;
    let value = contents.numbers("/parameter/value", rows)?;
    let of = contents.all_integers("/parameter/of")?;
    let parameter = |(row, name): (usize, String)| {
        let kind = ParameterKind::ALL[kind.all()[row] as usize];
        let letters: &[(&str, char)] = match kind {
            ParameterKind::Load => &[],
            ParameterKind::Stiffness => &[("material", 'M')],
            ParameterKind::Gap | ParameterKind::Friction => &[("contact", 'Q')],
            ParameterKind::Displacement => &[("condition", 'U'), ("axis", 'd')],
        };
        let is_list = kind == ParameterKind::Stiffness;
        Ok(Parameter {
            name,
            kind,
            value: value.all()[row],
            of: numbers(contents, &of, contents.rows('p', row), (letters, is_list))?,
        })
    };
    names.into_iter().enumerate().map(parameter).collect()
}

/// The numbers in some rows: one for each letter, or a list that ends with any number of the last letter.
fn numbers(
    contents: &Contents,
    of: &Slice<i64>,
    rows: Range<usize>,
    (letters, is_list): (&[(&str, char)], bool),
) -> Result<Vec<u32>, InputError> {
    let least = letters.len() - usize::from(is_list);
    if rows.len() < least || !is_list && rows.len() > least {
        let what = format!("{} numbers; expected {least}", rows.len());
        return Err(of.error(rows.start, &what));
    }
    let number = |(place, row): (usize, usize)| {
        let (what, letter) = letters[place.min(letters.len() - 1)];
        Ok(of.indices(row..row + 1, what, contents.count(letter))?[0])
    };
    rows.enumerate().map(number).collect()
}

/// The nodal weights and forces of consecutive subdomains.
pub(super) struct ShareSlices {
    quantities: Slice<i64>,
    weighted: Slice<i64>,
    weights: Slice<f64>,
    parameters: Slice<i64>,
    loaded: Slice<i64>,
    forces: Slice<f64>,
}

impl ShareSlices {
    /// Reads those of some `subdomains`.
    pub fn read(contents: &Contents, subdomains: Range<usize>) -> Result<Self, InputError> {
        let rows = |letter| contents.rows_of(letter, subdomains.clone());
        Ok(Self {
            quantities: contents.integers("/weight/quantity", rows('w'))?,
            weighted: contents.integers("/weight/node", rows('w'))?,
            weights: contents.numbers("/weight/value", rows('w'))?,
            parameters: contents.integers("/load/parameter", rows('f'))?,
            loaded: contents.integers("/load/node", rows('f'))?,
            forces: contents.numbers("/load/force", rows('f'))?,
        })
    }

    /// The rows of a subdomain with a number of `nodes`, in `dim` dimensions.
    pub fn take(
        &self,
        contents: &Contents,
        subdomain: usize,
        (nodes, dim): (usize, usize),
    ) -> Result<NodalShares, InputError> {
        let rows = contents.rows('w', subdomain);
        let of_nodes = self.weighted.indices(rows.clone(), NODE, nodes)?;
        let quantities = self.quantities.of(rows.clone()).iter();
        let values = self.weights.vectors(rows);
        let weights = quantities.zip(of_nodes).zip(values);
        let weights = weights.map(|((&quantity, node), value)| NodeWeight {
            quantity: quantity as u32,
            node,
            value,
        });
        let rows = contents.rows('f', subdomain);
        let of_nodes = self.loaded.indices(rows.clone(), NODE, nodes)?;
        let parameters = self.parameters.of(rows.clone()).iter();
        let width = dim * contents.count('L').max(1);
        let values = self.forces.of(rows).chunks_exact(width);
        let forces = parameters.zip(of_nodes).zip(values);
        let forces = forces.map(|((&parameter, node), of_steps)| LoadForce {
            parameter: parameter as u32,
            node,
            forces: of_steps.chunks_exact(dim).map(padded).collect(),
        });
        Ok(NodalShares {
            weights: weights.collect(),
            forces: forces.collect(),
        })
    }
}
