//! Cases of a study: values of parameters on which no factorization depends.

use std::path::Path;

use contact_dd_partition::contact_point::{ContactPoint, Law};
use contact_dd_partition::id::{OnBlocks, OnGroups};
use contact_dd_partition::mismatch::in_plain_words;
use contact_dd_partition::problem::Catalog;
use contact_dd_partition::quantity::{Parameter, ParameterKind};
use serde::{Deserialize, Serialize};

use crate::context::Context;
use crate::error::Failure;
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;

/// The parameters that a study varies, and the values in every case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cases {
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// Values of these in every case: factors of loads, additions to gaps (m), coefficients of friction.
    pub cases: Vec<Vec<f64>>,
}

impl Cases {
    /// Reads the cases of a file, for a problem with this `catalog`.
    ///
    /// # Errors
    /// A malformed file, a parameter that doesn't exist or that a factorization depends on, an invalid value.
    pub fn read(path: &Path, catalog: &Catalog) -> Result<Self, Failure> {
        let wrong = |why: String| Failure::input(format!("--study {}: {why}", path.display()));
        let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
        let cases: Self = serde_json::from_str(&text).map_err(|error| {
            wrong(format!(
                "{}; the file's form is {{\"parameters\": [names], \"cases\": [[values], …]}}",
                described(&error)
            ))
        })?;
        let parameters = cases.of(catalog).map_err(wrong)?;
        for (case, values) in cases.cases.iter().enumerate() {
            if values.len() != parameters.len() {
                let expected = parameters.len();
                return Err(wrong(format!(
                    "case {} has {} values; expected {expected}, one a parameter",
                    case + 1,
                    values.len()
                )));
            }
            for (parameter, value) in parameters.iter().zip(values) {
                let least = match parameter.kind {
                    ParameterKind::Friction => 0.0,
                    _ => f64::NEG_INFINITY,
                };
                if !value.is_finite() || *value < least {
                    return Err(wrong(format!(
                        "case {}: {value} isn't a value of parameter \"{}\"; expected a finite one, of friction 0 or more",
                        case + 1,
                        parameter.name
                    )));
                }
            }
        }
        Ok(cases)
    }

    /// The parameters.
    ///
    /// # Errors
    /// One doesn't exist, or a factorization depends on it.
    pub fn of<'a>(&self, catalog: &'a Catalog) -> Result<Vec<&'a Parameter>, String> {
        let can_vary = |parameter: &&Parameter| {
            !matches!(
                parameter.kind,
                ParameterKind::Stiffness | ParameterKind::Displacement
            )
        };
        let find = |name: &String| {
            let found = catalog.parameters.iter().find(|of| of.name == *name);
            match found {
                Some(parameter) if can_vary(&parameter) => Ok(parameter),
                Some(parameter) => Err(format!(
                    "parameter \"{name}\" is a {}: a study varies loads, gaps and friction; other changes are runs of their own",
                    parameter.kind.word()
                )),
                None => {
                    let known = catalog.parameters.iter().filter(can_vary);
                    let known: Vec<String> = known.map(|of| format!("\"{}\"", of.name)).collect();
                    Err(match known.is_empty() {
                        true => format!(
                            "there is no parameter \"{name}\": the scene asks for no [[quantity]], or has neither loads nor contacts"
                        ),
                        false => format!(
                            "there is no parameter \"{name}\"; known are {}",
                            known.join(", ")
                        ),
                    })
                }
            }
        };
        self.parameters.iter().map(find).collect()
    }
}

/// The error in a file in JSON, with its line.
fn described(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let message = (text.rsplit_once(" at line ")).map_or(text.as_str(), |(message, _)| message);
    let line = error.line();
    match error.is_data() {
        true => format!("line {line}: {}", in_plain_words(message)),
        false => format!("line {line}: this isn't valid JSON: {message}"),
    }
}

/// The parts of a problem that vary from case to case.
pub struct Varied {
    catalog: Catalog,
    blocks: OnBlocks<Block>,
    groups: OnGroups<ContactGroup>,
}

impl Varied {
    /// The case with these values of some parameters.
    pub fn new(base: &Context<'_>, parameters: &[&Parameter], values: &[f64]) -> Self {
        let mut varied = Self {
            catalog: base.catalog.clone(),
            blocks: base.blocks.clone(),
            groups: base.groups.clone(),
        };
        for (parameter, &value) in parameters.iter().zip(values) {
            if parameter.kind == ParameterKind::Load {
                let number = base
                    .catalog
                    .parameters
                    .iter()
                    .position(|of| of == *parameter);
                varied.scale_load(number, value);
                continue;
            }
            let catalog = varied.catalog.points.iter_mut();
            catalog.for_each(|point| vary(point, parameter, value));
            let groups = varied.groups.values_mut();
            let points = groups.flat_map(|group| &mut group.points);
            points.for_each(|point| vary(point, parameter, value));
        }
        varied
    }

    /// Multiplies the load of parameter `number` by a factor.
    fn scale_load(&mut self, number: Option<usize>, factor: f64) {
        // With a factor of 1 the load must keep all of its bits.
        if factor == 1.0 {
            return;
        }
        for block in self.blocks.values_mut() {
            let subdomain = &mut block.subdomain;
            let shares = subdomain.shares.forces.iter();
            let own = shares.filter(|share| Some(share.parameter as usize) == number);
            let added = own.filter_map(|share| {
                let force = share.forces.first()?;
                Some((share.node, force.map(|f| (factor - 1.0) * f)))
            });
            subdomain.forces.extend(added);
        }
    }

    /// The context of the case.
    pub fn context<'a>(&'a self, base: Context<'a>) -> Context<'a> {
        Context {
            catalog: &self.catalog,
            blocks: &self.blocks,
            groups: &self.groups,
            ..base
        }
    }
}

/// Changes the gap or the coefficient of friction of a contact point.
fn vary<N>(point: &mut ContactPoint<N>, parameter: &Parameter, value: f64) {
    if Some(&point.contact) != parameter.of.first() {
        return;
    }
    match (parameter.kind, &mut point.law) {
        (ParameterKind::Gap, _) => point.gap += value,
        (ParameterKind::Friction, Law::Coulomb { coefficient, .. }) => *coefficient = value,
        _ => {}
    }
}
