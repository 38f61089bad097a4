//! Loads too large for the stiffness, and displacements too large for the bodies: their units are probably
//! inconsistent.

use super::Contact;
use super::Diagnostics;
use crate::element::geometry::length;
use crate::error::InputError;
use crate::magnitude::short;
use crate::mesh::topology::CellFacet;
use crate::model::groups;
use crate::scene::condition::{Force, ForceAmount, Names};
use crate::scene::initial::Thermal;
use crate::scene::loading::Loading;
use crate::scene::material::PlaneState;

/// Strain above which a warning is given: there the theory of small strains fails.
const LARGE: f64 = 0.1;

/// Strain that is an error unless the scene allows it. A wrong unit of length or stress results in a factor of a
/// thousand or a million; scenes of arbitrary round numbers reach ten.
const REFUSED_STRAIN: f64 = 100.0;

/// An estimated strain and its cause.
struct Estimate {
    strain: f64,
    words: String,
}

impl Diagnostics<'_> {
    /// Warnings of loads comparable to the stiffness, and of displacements beyond the bodies' size.
    ///
    /// # Errors
    /// A load far beyond the stiffness, or such a gap, unless the scene has `large_strains`.
    pub(super) fn strains(&self) -> Result<Vec<String>, InputError> {
        let mut estimates = self.of_bodies();
        for loading in self.scene.loadings() {
            for (index, traction) in loading.traction.iter().enumerate() {
                let size = |x| Ok(loading.scale.traction * length(traction.value.at(x)?));
                let label = loading.traction_label(index, &traction.on);
                estimates.extend(self.of_side(&label, &traction.on, size));
            }
            for (index, pressure) in loading.pressure.iter().enumerate() {
                let size = |x| Ok(loading.scale.pressure * pressure.value.at(x)?);
                let label = loading.pressure_label(index, &pressure.on);
                estimates.extend(self.of_side(&label, &pressure.on, size));
            }
            for (index, force) in loading.force.iter().enumerate() {
                let label = loading.force_label(index, &force.on);
                estimates.extend(self.of_force(&label, force, loading.scale.force));
            }
        }
        estimates.extend(self.of_gaps());
        let is_absurd = |estimate: &&Estimate| estimate.strain > REFUSED_STRAIN;
        if let Some(absurd) = estimates
            .iter()
            .find(is_absurd)
            .filter(|_| !self.scene.large_strains)
        {
            // The expectation replaces the warning's question.
            let fact = absurd.words.rsplit_once("; ");
            return Err(InputError::new(format!(
                "{}; expected loads and gaps in the units of stiffness and mesh, or large_strains = true in the scene, where this is \
                 meant",
                fact.map_or(&*absurd.words, |(fact, _)| fact)
            )));
        }
        let large = estimates
            .into_iter()
            .filter(|estimate| estimate.strain > LARGE);
        let mut warnings: Vec<String> = large.map(|estimate| estimate.words).collect();
        let (extent, unit) = (self.extent(), self.scene.units.length());
        for (i, support) in self.loads.supports.iter().enumerate() {
            let values = self.loads.values(i).into_iter();
            let largest = values.map(f64::abs).fold(0.0, f64::max);
            if largest > extent {
                warnings.push(format!(
                    "{}: a displacement of {} {unit}, and the bodies measure {} {unit}; are their units consistent?",
                    self.loads.names[support.condition as usize],
                    short(largest),
                    short(extent)
                ));
            }
        }
        // A single warning for all nodes and steps.
        warnings.sort();
        warnings.dedup_by_key(|warning| warning.split(": ").next().map(str::to_owned));
        Ok(warnings)
    }

    /// The strain from forces on nodes, multiplied by `factor`, as if they were spread over the size of the bodies.
    fn of_force(&self, label: &str, force: &Force, factor: f64) -> Option<Estimate> {
        let (mesh, units) = (&self.bodies.mesh, self.scene.units);
        let sum = match &force.amount {
            ForceAmount::Total(total) => length(total.value),
            ForceAmount::Each(each) => {
                let nodes = groups::boundary_nodes(mesh, &force.on, label).ok()?;
                let at = nodes
                    .iter()
                    .map(|&node| each.at(mesh.points[node as usize]));
                at.filter_map(|value| Some(length(value.ok()?))).sum()
            }
        };
        let stiffness = self.materials.iter().map(|one| one.stiffness.largest());
        let stiffness = stiffness.fold(0.0, f64::max);
        // In the plane it acts on a thickness of 1, around an axis on the whole ring.
        let is_per_thickness = mesh.dim == 2 && self.scene.plane != Some(PlaneState::Axisymmetric);
        let extent = self.extent();
        let (area, dim) = match is_per_thickness {
            true => (extent, 2),
            false => (extent * extent, 3),
        };
        let strain = (factor * sum).abs() / (area * stiffness);
        Some(Estimate {
            strain,
            words: format!(
                "{label}: forces of {} {} on bodies that measure {} {} and have a stiffness of up to {} {} make strains \
                 of about {}, beyond small strains; are their units consistent?",
                short((factor * sum).abs()),
                units.force(dim),
                short(extent),
                units.length(),
                short(stiffness),
                units.stress(),
                short(strain)
            ),
        })
    }

    /// Strains from overlaps, compared with the size of the bodies.
    fn of_gaps(&self) -> Vec<Estimate> {
        let (extent, unit) = (self.extent(), self.scene.units.length());
        let of_contact = |contact: &Contact| {
            let gaps = contact.points.iter().map(|point| point.gap);
            let gap = gaps
                .reduce(f64::min)
                .filter(|gap| -gap > REFUSED_STRAIN * extent)?;
            Some(Estimate {
                strain: -gap / extent,
                words: format!(
                    "contact '{}': a gap of {} {unit} presses bodies that measure {} {unit} into each other, and makes \
                     strains of about {}, beyond small strains; are their units consistent?",
                    contact.name,
                    short(gap),
                    short(extent),
                    short(-gap / extent)
                ),
            })
        };
        self.contacts.iter().filter_map(of_contact).collect()
    }

    /// Strains from body forces, initial stresses and thermal strains.
    fn of_bodies(&self) -> Vec<Estimate> {
        let mut first_cells = vec![None; self.scene.bodies.len()];
        for (cell, &body) in self.bodies.cell_body.iter().enumerate() {
            first_cells[body as usize].get_or_insert(cell);
        }
        let loadings = self.scene.loadings().into_iter();
        loadings
            .flat_map(|loading| {
                let bodies = first_cells.iter().enumerate();
                let there = bodies.filter_map(|(index, first)| Some((index, (*first)?)));
                let estimates = there.flat_map(|of| self.of_body(&loading, of));
                estimates.collect::<Vec<Estimate>>()
            })
            .collect()
    }

    /// The large strains of the body with this index and `first` cell, in a loading.
    fn of_body(&self, loading: &Loading, (index, first): (usize, usize)) -> Vec<Estimate> {
        let units = self.scene.units;
        let Some((name, body)) = self.scene.bodies.iter().nth(index) else {
            return Vec::new();
        };
        let material = &self.materials[self.bodies.cell_material[first] as usize];
        let stiffness = material.stiffness.largest();
        let against = |what: String, strain: f64| Estimate {
            strain,
            words: format!(
                "body '{name}': {what} of a stiffness of {} {} make strains of about {}, beyond small \
                 strains; are their units consistent?",
                short(stiffness),
                units.stress(),
                short(strain)
            ),
        };
        let mut estimates = Vec::new();
        if let Some(given) = loading.body_force[index] {
            let (scale, extent) = (loading.scale.body_force, self.extent());
            let size = |x| Ok(scale * length(given.at(x)?));
            let most = self.largest((index, first), given.is_constant(), size);
            let what = format!(
                "body forces of up to {} {} on bodies that measure {} {}",
                short(most),
                units.body_force(),
                short(extent),
                units.length()
            );
            estimates.push(against(what, most * extent / stiffness));
        }
        if let Some(given) = &body.initial_stress {
            let scale = loading.scale.initial_stress;
            let size = |x| {
                let stress = given.at(x)?;
                Ok(scale * stress.iter().fold(0.0, |most: f64, s| most.max(s.abs())))
            };
            let most = self.largest((index, first), given.is_constant(), size);
            let what = format!(
                "initial stresses of up to {} {} in a material",
                short(most),
                units.stress()
            );
            estimates.push(against(what, most / stiffness));
        }
        if let Some(thermal) = &body.thermal {
            estimates.push(self.of_heat(loading, (index, first), (name, thermal)));
        }
        estimates
    }

    /// The thermal strain of a body from its coefficient of expansion.
    fn of_heat(
        &self,
        loading: &Loading,
        (index, first): (usize, usize),
        (name, thermal): (&str, &Thermal),
    ) -> Estimate {
        let temperature = loading.temperature[index].unwrap_or(&thermal.temperature);
        let scale = loading.scale.thermal * thermal.expansion.0;
        let size = |x| Ok(scale * temperature.at(x)?);
        let strain = self.largest((index, first), temperature.is_constant(), size);
        Estimate {
            strain,
            words: format!(
                "body '{name}': thermal strains are about {}, beyond small strains; is the expansion that \
                 of one degree?",
                short(strain)
            ),
        }
    }

    /// The largest `size` at the nodes of a body, given by its index and first cell.
    fn largest(
        &self,
        (index, first): (usize, usize),
        is_constant: bool,
        size: impl Fn([f64; 3]) -> Result<f64, String>,
    ) -> f64 {
        let mesh = &self.bodies.mesh;
        // A uniform field needs one evaluation.
        let last = if is_constant {
            first + 1
        } else {
            mesh.cells.len()
        };
        let own = (first..last).filter(|&cell| self.bodies.cell_body[cell] as usize == index);
        let nodes = own.flat_map(|cell| mesh.cells.nodes_of(cell));
        nodes
            .filter_map(|&node| size(mesh.points[node as usize]).ok())
            .fold(0.0, |most: f64, size| most.max(size.abs()))
    }

    /// The strain from a surface load whose magnitude at a point is `size`; non-finite values have been refused
    /// earlier.
    fn of_side(
        &self,
        label: &str,
        on: &Names,
        size: impl Fn([f64; 3]) -> Result<f64, String>,
    ) -> Option<Estimate> {
        let mesh = &self.bodies.mesh;
        let facets = groups::facets(mesh, on, label).ok()?;
        let loaded = facets.into_iter().filter_map(|facet| {
            let nodes = mesh.facets.nodes_of(facet as usize);
            let [CellFacet { cell, .. }] = self.topology.cells_at(nodes)[..] else {
                return None;
            };
            let at = nodes.iter().map(|&node| mesh.points[node as usize]);
            let load = at
                .filter_map(|x| size(x).ok())
                .map(f64::abs)
                .fold(0.0, f64::max);
            let material = &self.materials[self.bodies.cell_material[cell as usize] as usize];
            Some((load, material.stiffness.largest(), material.name.as_str()))
        });
        let unit = self.scene.units.stress();
        let (load, stiffness, name) = loaded.max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
        Some(Estimate {
            strain: load / stiffness,
            words: format!(
                "{label}: up to {} {unit} on '{name}' of a stiffness of {} {unit} make strains of about {}, \
                 beyond small strains; are their units consistent?",
                short(load),
                short(stiffness),
                short(load / stiffness)
            ),
        })
    }
}
