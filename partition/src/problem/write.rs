//! Writes `problem.h5`.

use std::path::Path;

use hdf5::H5Type;
use hdf5::plist::file_access::LibraryVersion;
use toml::Value;

use super::datasets::{Datasets, group, without_nul};
use super::goals;
use super::law::LawRow;
use super::schema::{Counts, FORMULATIONS};
use super::strings::{type_of, write_strings};
use super::{
    FORMAT, InitialStress, Problem, Subdomain, SubdomainNode, VERSION, digest, tips, vtkhdf,
};
use crate::contact_point::{ContactPoint, Law, LocalFrame};
use crate::destination::Destination;
use crate::error::OutputError;
use crate::model::PlaneState;

impl Problem {
    /// Writes the problem, with its [digest], under a temporary name and renames the complete file.
    ///
    /// # Errors
    /// A file that can't be written; an existing file stays unchanged.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        hdf5::silence_errors(true);
        let destination = Destination::new(path)?;
        self.write_all(destination.temporary())
            .map_err(|error| destination.failure(error))?;
        digest::append(destination.temporary()).map_err(|error| destination.failure(error))?;
        destination.commit()
    }

    fn write_all(&self, path: &Path) -> hdf5::Result<()> {
        let file = hdf5::File::with_options()
            .with_fapl(|access| {
                // Of the formats with checksums for metadata, this is the one that most programs read, and that keeps
                // no mark of a writer that was killed.
                access.libver_bounds(LibraryVersion::V18, LibraryVersion::V18);
                access.file_locking(false)
            })
            .with_fcpl(|root| root.obj_track_times(false))
            .create(path)?;
        let mut datasets = Datasets {
            file: &file,
            counts: Counts::new(self.catalog.dim, self.catalog.plane),
        };
        self.write_attributes(&file)?;
        self.write_catalog(&mut datasets)?;
        self.write_mesh(&mut datasets)?;
        self.write_conditions(&mut datasets)?;
        if !self.catalog.contacts.is_empty() {
            self.write_contacts(&mut datasets)?;
        }
        if !self.catalog.probes.is_empty() {
            self.write_probes(&mut datasets)?;
        }
        if !self.catalog.tips.is_empty() {
            tips::write(&self.catalog.tips, &mut datasets)?;
        }
        goals::write(self, &mut datasets)?;
        vtkhdf::mark(&file.group("VTKHDF")?)?;
        file.flush()?;
        file.close()
    }

    fn write_attributes(&self, file: &hdf5::File) -> hdf5::Result<()> {
        let catalog = &self.catalog;
        text(file, "format", FORMAT)?;
        attribute(file, "version", VERSION)?;
        text(file, "title", &catalog.title)?;
        attribute(file, "dimension", catalog.dim as i64)?;
        if let Some(plane) = catalog.plane {
            text(file, "plane", plane.name())?;
        }
        text(file, "units", catalog.units.length())?;
        if catalog.solver.is_empty() {
            return Ok(());
        }
        let settings = group(file, "settings")?;
        let values = toml::Table::try_from(catalog.solver).map_err(|error| error.to_string())?;
        for (name, value) in &values {
            match value {
                Value::String(word) => text(&settings, name, word)?,
                Value::Integer(count) => attribute(&settings, name, *count)?,
                Value::Float(number) => attribute(&settings, name, *number)?,
                Value::Boolean(truth) => attribute(&settings, name, *truth)?,
                other => return Err(format!("{name} can't be {other}").into()),
            }
        }
        Ok(())
    }

    fn write_catalog(&self, datasets: &mut Datasets) -> hdf5::Result<()> {
        let catalog = &self.catalog;
        let materials = &catalog.materials;
        let names = materials.iter().map(|m| m.name.as_str());
        datasets.strings("/materials/name", names)?;
        let stiffness = materials.iter().flat_map(|m| m.stiffness.values()).copied();
        datasets.put("/materials/stiffness", stiffness)?;
        if matches!(catalog.plane, Some(PlaneState::Strain | PlaneState::Stress)) {
            let planes = materials.iter();
            let planes = planes.flat_map(|m| m.out_of_plane.unwrap_or([f64::NAN; 3]));
            datasets.put("/materials/out_of_plane", planes)?;
        }
        let ratios = materials.iter().map(|m| m.poisson.unwrap_or(f64::NAN));
        datasets.put("/materials/poisson", ratios)?;
        for (formulation, path) in FORMULATIONS {
            if materials.iter().any(|m| m.formulation == formulation) {
                let have = materials.iter().map(|m| m.formulation == formulation);
                datasets.put(path, have.map(i64::from))?;
            }
        }

        let names = catalog.bodies.iter().map(|b| b.name.as_str());
        datasets.strings("/bodies/name", names)?;
        let subdomains = &catalog.subdomains;
        datasets.put("/subdomains/body", subdomains.iter().map(|s| s.body as i64))?;
        let groups = subdomains.iter().map(|s| s.group.map_or(-1, |g| g as i64));
        datasets.put("/subdomains/group", groups)?;
        if self.subdomains.iter().any(|s| s.reference_nodes > 0) {
            let counts = self.subdomains.iter().map(|s| s.reference_nodes as i64);
            datasets.put("/subdomains/reference", counts)?;
        }
        let parents = catalog.hierarchy.parent.iter();
        datasets.put(
            "/hierarchy/parent",
            parents.map(|p| p.map_or(-1, i64::from)),
        )?;
        let clusters = catalog.hierarchy.clusters.iter();
        if clusters.len() > 0 {
            datasets.integers("/hierarchy/cluster", clusters.copied())?;
        }
        let steps = &catalog.steps;
        if !steps.is_empty() {
            datasets.strings("/steps/name", steps.iter().map(|step| step.name.as_str()))?;
            datasets.put("/steps/time", steps.iter().map(|step| step.time))?;
            let bodies = steps.iter().map(|step| &step.absent.bodies);
            datasets.presence("/steps/body", catalog.bodies.len(), bodies)?;
        }
        if !catalog.warnings.is_empty() {
            datasets.strings("/warnings", catalog.warnings.iter().map(String::as_str))?;
        }
        Ok(())
    }

    fn write_mesh(&self, datasets: &mut Datasets) -> hdf5::Result<()> {
        let all = &self.subdomains;
        let points = all.iter().map(|s| s.points.len() as i64);
        datasets.put("/VTKHDF/NumberOfPoints", points)?;
        let cells = all.iter().map(|s| s.cells.len() as i64);
        datasets.put("/VTKHDF/NumberOfCells", cells)?;
        let entries = all.iter().map(|s| s.cells.connectivity().len() as i64);
        datasets.put("/VTKHDF/NumberOfConnectivityIds", entries)?;
        datasets.vectors("/VTKHDF/Points", all.iter().flat_map(|s| &s.points))?;
        let kinds = all.iter().flat_map(|s| s.cells.iter());
        datasets.put("/VTKHDF/Types", kinds.map(|(kind, _)| kind.vtk()))?;
        let offsets = all.iter().flat_map(|s| s.cells.offsets());
        datasets.put("/VTKHDF/Offsets", offsets.map(|&offset| offset as i64))?;
        let nodes = all.iter().flat_map(|s| s.cells.connectivity());
        datasets.integers("/VTKHDF/Connectivity", nodes.copied())?;
        let tags = all.iter().flat_map(|s| &s.node_tags);
        datasets.put("/VTKHDF/PointData/GlobalNodeId", tags.copied())?;
        let numbers = all.iter().map(|s| (s.index as i64, s.cells.len()));
        let numbers = numbers.flat_map(|(index, cells)| std::iter::repeat_n(index, cells));
        datasets.put("/VTKHDF/CellData/Subdomain", numbers)?;
        let materials = all.iter().flat_map(|s| &s.cell_material);
        datasets.integers("/VTKHDF/CellData/Material", materials.copied())
    }

    fn write_conditions(&self, datasets: &mut Datasets) -> hdf5::Result<()> {
        let all = &self.subdomains;
        datasets.offsets("/interface/offset", all.iter().map(|s| s.interface.len()))?;
        let nodes = || all.iter().flat_map(|s: &Subdomain| &s.interface);
        datasets.integers("/interface/node", nodes().map(|n| n.node))?;
        datasets.integers("/interface/interface", nodes().map(|n| n.interface))?;

        datasets.offsets("/support/offset", all.iter().map(|s| s.supports.len()))?;
        let rows = || all.iter().flat_map(|s: &Subdomain| &s.supports);
        datasets.integers("/support/node", rows().map(|s| s.node))?;
        datasets.vectors("/support/direction", rows().map(|s| &s.direction))?;
        let values = all
            .iter()
            .flat_map(|s| (0..s.supports.len()).map(move |i| s.support(i)));
        datasets.put("/support/value", values.flatten())?;
        datasets.integers("/support/condition", rows().map(|s| s.condition))?;
        let names = self.catalog.supports.iter().map(String::as_str);
        datasets.strings("/support/name", names)?;

        if all.iter().any(|s| !s.springs.is_empty()) {
            datasets.offsets("/spring/offset", all.iter().map(|s| s.springs.len()))?;
            let blocks = || all.iter().flat_map(|s: &Subdomain| &s.springs);
            datasets.put(
                "/spring/node",
                blocks().flat_map(|block| block.nodes.map(i64::from)),
            )?;
            datasets.vectors(
                "/spring/stiffness",
                blocks().flat_map(|block| &block.stiffness[..self.catalog.dim]),
            )?;
            let conditions = blocks().map(|block| i64::from(block.condition));
            datasets.put("/spring/condition", conditions)?;
        }

        datasets.offsets("/force/offset", all.iter().map(|s| s.forces.len()))?;
        let rows = || all.iter().flat_map(|s: &Subdomain| &s.forces);
        datasets.integers("/force/node", rows().map(|&(node, _)| node))?;
        let values = all
            .iter()
            .flat_map(|s| (0..s.forces.len()).map(move |i| s.force(i)));
        datasets.vectors("/force/value", values.flatten())?;
        if all.iter().all(|s| s.initial_stress.cells.is_empty()) {
            return Ok(());
        }
        // All steps of a cell or node, row by row.
        let rows = |rows: fn(&InitialStress) -> &[[f64; 6]]| {
            all.iter().flat_map(move |s| {
                let of_steps = s.initial_stresses();
                let count = rows(of_steps[0]).len();
                (0..count).flat_map(move |row| {
                    let of_steps = of_steps.clone().into_iter();
                    of_steps.flat_map(move |of_step| rows(of_step)[row])
                })
            })
        };
        datasets.put("/initial_stress/cell", rows(|s| &s.cells))?;
        datasets.put("/initial_stress/node", rows(|s| &s.nodes))
    }

    fn write_probes(&self, datasets: &mut Datasets) -> hdf5::Result<()> {
        let probes = || self.catalog.probes.iter();
        datasets.integers("/probe/contact", probes().map(|p| p.contact))?;
        datasets.put("/probe/node", probes().map(|p| p.tag))?;
        datasets.vectors("/probe/normal", probes().map(|p| &p.normal))?;
        datasets.put("/probe/gap", probes().map(|p| p.gap))?;
        datasets.entries("/probe", probes().map(|p| &p.entries))
    }

    fn write_contacts(&self, datasets: &mut Datasets) -> hdf5::Result<()> {
        let names = self.catalog.contacts.iter().map(|c| c.name.as_str());
        datasets.strings("/contact/name", names)?;
        datasets.offsets("/contact/group_offset", self.catalog.groups.iter().copied())?;
        let absent = self.catalog.steps.iter().map(|step| &step.absent.contacts);
        datasets.presence("/steps/contact", self.catalog.contacts.len(), absent)?;
        let points = || self.catalog.points.iter();
        datasets.integers("/contact/contact", points().map(|p| p.contact))?;
        datasets.integers("/contact/place", points().map(|p| p.place))?;
        datasets.put("/contact/gap", points().map(|p| p.gap))?;
        datasets.put("/contact/area", points().map(|p| p.area))?;
        datasets.vectors("/contact/position", points().map(|p| &p.position))?;
        datasets.vectors("/contact/force_point", points().map(|p| &p.force_point))?;
        datasets.vectors("/contact/normal", points().map(|p| &p.frame.normal))?;
        datasets.put("/contact/node_a", points().map(|p| p.tag_a))?;
        datasets.put("/contact/node_b", points().map(|p| p.tag_b))?;
        datasets.entries("/contact", points().map(|p| &p.entries))?;
        if points().any(ContactPoint::is_equation) {
            let axes = |p: &ContactPoint<SubdomainNode>| {
                let none = [0.0; 3];
                let of_entry = |i: usize| p.axes.get(i).copied().unwrap_or(none);
                (0..p.entries.len()).map(of_entry).collect::<Vec<_>>()
            };
            let all: Vec<[f64; 3]> = points().flat_map(axes).collect();
            datasets.vectors("/contact/entry_axis", all.iter())?;
        }
        let is_turned = |p: &ContactPoint<SubdomainNode>| {
            p.law.has_friction() && p.frame != LocalFrame::new(p.normal())
        };
        if points().any(is_turned) {
            datasets.vectors("/contact/tangent", points().map(|p| &p.frame.tangents[0]))?;
        }
        if points().any(ContactPoint::is_compliant) {
            datasets.put("/contact/stiffness", points().flat_map(|p| p.stiffness))?;
        }
        if points().any(|p| p.is_gap_given) {
            datasets.put(
                "/contact/given_gap",
                points().map(|p| i64::from(p.is_gap_given)),
            )?;
        }
        if points().any(|p| p.is_absolute) {
            datasets.put(
                "/contact/absolute",
                points().map(|p| i64::from(p.is_absolute)),
            )?;
        }
        if points().any(|p| !p.motion.is_empty()) {
            let steps = self.catalog.steps.len().max(1);
            let in_step = |p: &ContactPoint<SubdomainNode>, k: usize| p.motion.get(k).copied();
            let all: Vec<[f64; 3]> = points()
                .flat_map(|p| (0..steps).map(move |k| in_step(p, k).unwrap_or_default()))
                .collect();
            datasets.vectors("/contact/motion", all.iter())?;
        }
        if points().any(|p| !p.preload.is_empty()) {
            let steps = self.catalog.steps.len().max(1);
            let in_step = |p: &ContactPoint<SubdomainNode>, k: usize| p.preload.get(k).copied();
            let all =
                points().flat_map(|p| (0..steps).map(move |k| in_step(p, k).unwrap_or_default()));
            datasets.put("/contact/preload", all)?;
        }
        if points().all(|p| p.law == Law::Frictionless) {
            return Ok(());
        }
        let rows = || points().map(|p| LawRow::from(p.law));
        datasets.put("/contact/law", rows().map(|row| row.law))?;
        datasets.put("/contact/friction", rows().map(|row| row.friction))?;
        datasets.put("/contact/shear_bound", rows().map(|row| row.shear_bound))
    }
}

fn text(group: &hdf5::Group, name: &str, value: &str) -> hdf5::Result<()> {
    let text = [without_nul(value)];
    let new = group.new_attr_builder().empty_as(type_of(&text));
    let attribute = new.create(name)?;
    write_strings(&attribute, &text)
}

fn attribute<T: H5Type>(group: &hdf5::Group, name: &str, value: T) -> hdf5::Result<()> {
    group.new_attr::<T>().create(name)?.write_scalar(&value)
}
