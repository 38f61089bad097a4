//! Summary of a problem file for the user.

use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::path::Path;

use crate::element::geometry::{advance, cross};
use crate::error::InputError;
use crate::model::{Material, PlaneState};
use crate::problem::read::ProblemFile;
use crate::problem::{Catalog, Problem, VERSION};

/// Most lines about items of one kind.
const MOST: usize = 20;

/// The content of a problem file; its `Display` is what `contact-dd-partition --info` prints.
#[derive(Clone, Debug)]
pub struct Info {
    problem: Problem,
    /// Name of the file.
    name: String,
    /// Size (bytes).
    bytes: u64,
}

impl Info {
    /// Reads and checks all of a problem file.
    ///
    /// # Errors
    /// Another kind of file, or the dataset and the invalid row.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let problem = ProblemFile::open(path)?.problem()?;
        Ok(Self {
            problem,
            name: path.display().to_string(),
            bytes: fs::metadata(path).map_or(0, |data| data.len()),
        })
    }

    /// Resultant force of a load step (N, in the plane per metre of thickness), and moment about the origin; in a
    /// problem without steps those of all loads.
    pub fn load(&self, step: usize) -> ([f64; 3], [f64; 3]) {
        let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
        for subdomain in &self.problem.subdomains {
            for (node, force) in subdomain.forces_in(step) {
                sum = advance(sum, 1.0, force);
                moment = advance(moment, 1.0, cross(subdomain.points[node as usize], force));
            }
        }
        (sum, moment)
    }

    /// Number of nodes that each boundary condition of the scene supports, by name.
    pub fn supported_nodes(&self) -> Vec<(&str, usize)> {
        let names = &self.problem.catalog.supports;
        let mut nodes = vec![BTreeSet::new(); names.len()];
        for subdomain in &self.problem.subdomains {
            for support in &subdomain.supports {
                if let Some(nodes) = nodes.get_mut(support.condition as usize) {
                    nodes.insert(subdomain.node_tags[support.node as usize]);
                }
            }
        }
        let names = names.iter().map(String::as_str);
        names.zip(nodes.iter().map(BTreeSet::len)).collect()
    }

    fn bodies(&self) -> Vec<String> {
        let catalog = &self.problem.catalog;
        let bodies = catalog.bodies.iter().enumerate().map(|(index, body)| {
            let of_body = || catalog.subdomains.iter().filter(|s| s.body == index);
            format!(
                "{}: {} cells in {} subdomains",
                body.name,
                of_body().map(|s| s.cells).sum::<usize>(),
                of_body().count()
            )
        });
        bodies.collect()
    }

    /// The resultant of every load step, or of all loads without steps.
    fn loads(&self) -> Vec<String> {
        let resultant = |step: usize| {
            let Catalog { dim, units, .. } = self.problem.catalog;
            let (force, moment) = self.load(step);
            if self.problem.catalog.plane == Some(PlaneState::Axisymmetric) {
                return format!("{} N in sum along the axis", rounded(force[1]));
            }
            let (force, moment) = (&force[..dim], &moment[if dim == 2 { 2 } else { 0 }..]);
            let listed = |of: &[f64]| {
                of.iter()
                    .map(|&x| rounded(x))
                    .collect::<Vec<_>>()
                    .join(", ")
            };
            format!(
                "{} {} in sum, moment {} {} about the origin",
                listed(force),
                units.force(dim),
                listed(moment),
                units.moment(dim)
            )
        };
        let steps = &self.problem.catalog.steps;
        if steps.is_empty() {
            return vec![resultant(0)];
        }
        let steps = steps.iter().enumerate();
        steps
            .map(|(k, step)| format!("{} at {}: {}", step.name, step.time, resultant(k)))
            .collect()
    }

    /// The least and the largest gap of every contact (m).
    fn gaps(&self) -> Vec<String> {
        let unit = self.problem.catalog.units.length();
        let contacts = self.problem.catalog.contacts.iter().enumerate();
        let gaps = contacts.filter_map(|(index, contact)| {
            let points = self.problem.catalog.points.iter();
            let gaps = points
                .filter(|point| point.contact as usize == index)
                .map(|point| point.gap);
            let least = gaps.clone().reduce(f64::min).map(rounded)?;
            let most = gaps.reduce(f64::max).map(rounded)?;
            let to = if least == most {
                String::new()
            } else {
                format!(" to {most}")
            };
            Some(format!("{least}{to} {unit} on {}", contact.name))
        });
        gaps.collect()
    }
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let catalog = &self.problem.catalog;
        let entry =
            |f: &mut fmt::Formatter<'_>, name: &str, value: &str| writeln!(f, "{name:<13} {value}");
        if !catalog.title.is_empty() {
            entry(f, "title", &catalog.title)?;
        }
        let size = format!(
            "{}, {:.1} MB, version {VERSION} of the format",
            self.name,
            self.bytes as f64 / 1e6
        );
        entry(f, "file", &size)?;
        if let Some(plane) = catalog.plane {
            entry(f, "plane", plane.name())?;
        }
        writeln!(f, "{}", self.problem.summary())?;
        let unit = catalog.units.stress();
        let materials = catalog.materials.iter().map(|m| elastic(m, unit));
        let supports = self.supported_nodes().into_iter();
        let supports = supports.map(|(name, nodes)| format!("{name}: {nodes} nodes"));
        for (name, lines) in [
            ("gap", self.gaps()),
            ("body", self.bodies()),
            ("material", materials.collect()),
            ("support", supports.collect()),
            ("load", self.loads()),
        ] {
            for line in lines.iter().take(MOST) {
                entry(f, name, line)?;
            }
            if lines.len() > MOST {
                entry(f, name, &format!("and {} more", lines.len() - MOST))?;
            }
        }
        let settings = match catalog.solver.is_empty() {
            true => "none".to_owned(),
            false => catalog.solver.to_string(),
        };
        entry(f, "settings", &settings)?;
        for warning in &catalog.warnings {
            entry(f, "warning", warning)?;
        }
        write!(
            f,
            "next          contact-dd-mpi --check {0} tells what solving it takes",
            self.name
        )
    }
}

/// A material in plain words: by modulus and ratio if it is isotropic, otherwise by its stiffness.
fn elastic(material: &Material, unit: &str) -> String {
    let (name, c) = (&material.name, &material.stiffness);
    match material.poisson {
        // G = E / (2 (1 + ν)) in both plane states and in space.
        Some(ratio) => {
            let shear = c[c.size() - 1][c.size() - 1];
            let young = rounded(2.0 * (1.0 + ratio) * shear);
            format!("{name}: E {young} {unit}, ν {ratio}")
        }
        None => format!(
            "{name}: C11 {}, C22 {}, C12 {}, C33 {} {unit}",
            rounded(c[0][0]),
            rounded(c[1][1]),
            rounded(c[0][1]),
            rounded(c[2][2])
        ),
    }
}

/// A number with six digits, without trailing zeros.
fn rounded(value: f64) -> String {
    let digits = format!("{value:.5e}");
    let (digits, exponent) = digits.split_once('e').unwrap_or((&digits, "0"));
    let digits = match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.'),
        false => digits,
    };
    match exponent {
        "0" => digits.to_owned(),
        _ => format!("{digits}e{exponent}"),
    }
}
