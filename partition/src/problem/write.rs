//! Writes `problem.h5`.

use std::path::Path;

use hdf5::H5Type;
use hdf5::types::VarLenUnicode;

use super::{FORMAT, Problem, Subdomain, VERSION, vtkhdf};
use crate::destination::Destination;
use crate::error::OutputError;

impl Problem {
    /// Writes the problem under a temporary name and renames it when it is whole.
    ///
    /// # Errors
    /// The file can't be written; what was there before is untouched.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        hdf5::silence_errors(true);
        let destination = Destination::new(path)?;
        self.write_all(destination.temporary())
            .map_err(|error| destination.failure(error))?;
        destination.commit()
    }

    fn write_all(&self, path: &Path) -> hdf5::Result<()> {
        let file = hdf5::File::with_options()
            .with_fapl(|access| access.file_locking(false))
            .create(path)?;
        self.write_catalog(&file)?;
        self.write_mesh(&file)?;
        self.write_conditions(&file)?;
        self.write_contacts(&file)?;
        file.flush()?;
        file.close()
    }

    fn write_catalog(&self, file: &hdf5::File) -> hdf5::Result<()> {
        let catalog = &self.catalog;
        text(file, "format", FORMAT)?;
        attribute(file, "version", VERSION)?;
        text(file, "title", &catalog.title)?;
        attribute(file, "dimension", catalog.dim as i64)?;
        text(file, "plane", catalog.plane.name())?;
        text(file, "units", catalog.units.length())?;

        let materials = Section::new(file, "materials")?;
        let all = &catalog.materials;
        materials.strings("name", all.iter().map(|m| m.name.as_str()))?;
        let stiffness: Vec<f64> = all.iter().flat_map(|m| m.stiffness).flatten().collect();
        materials.put("stiffness", &[all.len(), 3, 3], &stiffness)?;
        let rows: Vec<f64> = all
            .iter()
            .flat_map(|m| m.out_of_plane.unwrap_or([f64::NAN; 3]))
            .collect();
        materials.put("out_of_plane", &[all.len(), 3], &rows)?;
        materials.column("poisson", all.iter().map(|m| m.poisson.unwrap_or(f64::NAN)))?;

        let bodies = Section::new(file, "bodies")?;
        bodies.strings("name", catalog.bodies.iter().map(|b| b.name.as_str()))?;
        let subdomains = Section::new(file, "subdomains")?;
        let all = &catalog.subdomains;
        subdomains.column("body", all.iter().map(|s| s.body as i64))?;
        let group = |group: Option<usize>| group.map_or(-1, |g| g as i64);
        subdomains.column("group", all.iter().map(|s| group(s.group)))?;
        let hierarchy = Section::new(file, "hierarchy")?;
        let parents = catalog.hierarchy.parent.iter();
        hierarchy.column("parent", parents.map(|p| p.map_or(-1, i64::from)))?;
        if !catalog.steps.is_empty() {
            let steps = Section::new(file, "steps")?;
            steps.strings("name", catalog.steps.iter().map(|step| step.name.as_str()))?;
            steps.column("time", catalog.steps.iter().map(|step| step.time))?;
        }
        self.write_settings(file)?;
        if !catalog.warnings.is_empty() {
            let root = Section::root(file)?;
            root.strings("warnings", catalog.warnings.iter().map(String::as_str))?;
        }
        Ok(())
    }

    fn write_settings(&self, file: &hdf5::File) -> hdf5::Result<()> {
        let solver = &self.catalog.solver;
        if solver.is_empty() {
            return Ok(());
        }
        let settings = file.create_group("settings")?;
        if let Some(method) = solver.method {
            text(&settings, "method", method.name())?;
        }
        let positive = [
            ("tolerance", solver.tolerance),
            ("relaxation", solver.relaxation),
        ];
        for (name, value) in positive {
            if let Some(value) = value {
                attribute(&settings, name, value.value())?;
            }
        }
        if let Some(count) = solver.max_sweeps {
            attribute(&settings, "max_sweeps", count as i64)?;
        }
        if let Some(left_out) = solver.no_stress {
            attribute(&settings, "no_stress", left_out)?;
        }
        Ok(())
    }

    fn write_mesh(&self, file: &hdf5::File) -> hdf5::Result<()> {
        let all = &self.subdomains;
        let grid = Section::new(file, "VTKHDF")?;
        vtkhdf::mark(&grid.group)?;
        grid.column("NumberOfPoints", all.iter().map(|s| s.points.len() as i64))?;
        grid.column("NumberOfCells", all.iter().map(|s| s.cells.len() as i64))?;
        grid.column(
            "NumberOfConnectivityIds",
            all.iter().map(|s| s.cells.connectivity().len() as i64),
        )?;
        grid.vectors("Points", 3, all.iter().flat_map(|s| &s.points))?;
        let connectivity = all.iter().flat_map(|s| s.cells.connectivity());
        grid.column("Connectivity", connectivity.map(|&node| i64::from(node)))?;
        let offsets = all.iter().flat_map(|s| s.cells.offsets());
        grid.column("Offsets", offsets.map(|&offset| offset as i64))?;
        let kinds = all.iter().flat_map(|s| s.cells.iter());
        grid.column("Types", kinds.map(|(kind, _)| kind.vtk()))?;
        let points = Section::new(file, "VTKHDF/PointData")?;
        let tags = all.iter().flat_map(|s| &s.node_tags);
        points.column("GlobalNodeId", tags.copied())?;
        let cells = Section::new(file, "VTKHDF/CellData")?;
        let numbers = all
            .iter()
            .flat_map(|s| std::iter::repeat_n(s.index as i64, s.cells.len()));
        cells.column("Subdomain", numbers)?;
        let materials = all.iter().flat_map(|s| &s.cell_material);
        cells.column("Material", materials.map(|&m| i64::from(m)))
    }

    fn write_conditions(&self, file: &hdf5::File) -> hdf5::Result<()> {
        let catalog = &self.catalog;
        let dim = catalog.dim;
        let all = &self.subdomains;
        let interface = Section::new(file, "interface")?;
        interface.offsets("offset", all.iter().map(|s| s.interface.len()))?;
        let nodes = || all.iter().flat_map(|s: &Subdomain| &s.interface);
        interface.column("node", nodes().map(|n| i64::from(n.node)))?;
        interface.column("interface", nodes().map(|n| i64::from(n.interface)))?;

        let support = Section::new(file, "support")?;
        support.offsets("offset", all.iter().map(|s| s.supports.len()))?;
        let rows = || all.iter().flat_map(|s: &Subdomain| &s.supports);
        support.column("node", rows().map(|s| i64::from(s.node)))?;
        support.vectors("direction", dim, rows().map(|s| &s.direction))?;
        let steps = catalog.steps.len();
        match steps {
            0 => support.column("value", rows().map(|s| s.value))?,
            _ => {
                let values: Vec<f64> = (all.iter())
                    .flat_map(|s| (0..s.supports.len()).map(move |i| (s, i)))
                    .flat_map(|(s, i)| s.steps.iter().map(move |step| step.supports[i]))
                    .collect();
                support.put("value", &[values.len() / steps, steps], &values)?;
            }
        }
        support.column("condition", rows().map(|s| i64::from(s.condition)))?;
        support.strings("name", self.catalog.supports.iter().map(String::as_str))?;

        let force = Section::new(file, "force")?;
        force.offsets("offset", all.iter().map(|s| s.forces.len()))?;
        let rows = || all.iter().flat_map(|s: &Subdomain| &s.forces);
        force.column("node", rows().map(|&(node, _)| i64::from(node)))?;
        match steps {
            0 => force.vectors("value", dim, rows().map(|(_, value)| value)),
            _ => {
                let values: Vec<f64> = (all.iter())
                    .flat_map(|s| (0..s.forces.len()).map(move |i| (s, i)))
                    .flat_map(|(s, i)| s.steps.iter().map(move |step| &step.forces[i][..dim]))
                    .flatten()
                    .copied()
                    .collect();
                force.put("value", &[rows().count(), steps, dim], &values)
            }
        }
    }

    fn write_contacts(&self, file: &hdf5::File) -> hdf5::Result<()> {
        if self.catalog.contacts.is_empty() {
            return Ok(());
        }
        let dim = self.catalog.dim;
        let contact = Section::new(file, "contact")?;
        contact.strings(
            "name",
            self.catalog.contacts.iter().map(|c| c.name.as_str()),
        )?;
        contact.offsets("group_offset", self.points.iter().map(Vec::len))?;
        let points = || self.points.iter().flatten();
        contact.column("contact", points().map(|p| i64::from(p.contact)))?;
        contact.column("place", points().map(|p| i64::from(p.place)))?;
        contact.column("gap", points().map(|p| p.gap))?;
        contact.column("area", points().map(|p| p.area))?;
        contact.vectors("position", dim, points().map(|p| &p.position))?;
        contact.vectors("force_point", dim, points().map(|p| &p.force_point))?;
        contact.vectors("normal", dim, points().map(|p| &p.frame.normal))?;
        contact.column("node_a", points().map(|p| p.tag_a))?;
        contact.column("node_b", points().map(|p| p.tag_b))?;
        contact.offsets("entry_offset", points().map(|p| p.entries.len()))?;
        let nodes = || points().flat_map(|p| p.entries.iter().map(|(node, _)| node));
        contact.column("entry_subdomain", nodes().map(|n| i64::from(n.subdomain)))?;
        contact.column("entry_node", nodes().map(|n| i64::from(n.node)))?;
        let weights = points().flat_map(|p| p.entries.iter().map(|&(_, weight)| weight));
        contact.column("entry_weight", weights)
    }
}

/// A group of datasets.
struct Section {
    group: hdf5::Group,
}

impl Section {
    fn new(file: &hdf5::File, name: &str) -> hdf5::Result<Self> {
        Ok(Self {
            group: file.create_group(name)?,
        })
    }

    fn root(file: &hdf5::File) -> hdf5::Result<Self> {
        Ok(Self {
            group: file.group("/")?,
        })
    }

    fn put<T: H5Type>(&self, name: &str, shape: &[usize], data: &[T]) -> hdf5::Result<()> {
        let dataset = self.group.new_dataset::<T>().shape(shape).create(name)?;
        if data.is_empty() {
            return Ok(());
        }
        dataset.write_raw(data)
    }

    fn column<T: H5Type>(&self, name: &str, values: impl Iterator<Item = T>) -> hdf5::Result<()> {
        let values: Vec<T> = values.collect();
        self.put(name, &[values.len()], &values)
    }

    fn vectors<'a>(
        &self,
        name: &str,
        width: usize,
        vectors: impl Iterator<Item = &'a [f64; 3]>,
    ) -> hdf5::Result<()> {
        let values: Vec<f64> = vectors.flat_map(|v| &v[..width]).copied().collect();
        self.put(name, &[values.len() / width, width], &values)
    }

    fn offsets(&self, name: &str, counts: impl Iterator<Item = usize>) -> hdf5::Result<()> {
        let mut end = 0i64;
        let ends = counts.map(|count| {
            end += count as i64;
            end
        });
        self.column(name, std::iter::once(0).chain(ends))
    }

    fn strings<'a>(&self, name: &str, strings: impl Iterator<Item = &'a str>) -> hdf5::Result<()> {
        let strings = strings.map(variable).collect::<hdf5::Result<Vec<_>>>()?;
        self.put(name, &[strings.len()], &strings)
    }
}

fn text(group: &hdf5::Group, name: &str, value: &str) -> hdf5::Result<()> {
    attribute(group, name, variable(value)?)
}

fn attribute<T: H5Type>(group: &hdf5::Group, name: &str, value: T) -> hdf5::Result<()> {
    group.new_attr::<T>().create(name)?.write_scalar(&value)
}

/// HDF5's strings end at the first NUL.
fn variable(text: &str) -> hdf5::Result<VarLenUnicode> {
    text.replace('\0', "\u{fffd}")
        .parse()
        .map_err(|reason: hdf5::types::StringError| hdf5::Error::Internal(reason.to_string()))
}
