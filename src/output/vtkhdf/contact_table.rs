//! `/contact/<name>/`: one row for each contact point.

use contact_dd_partition::problem::ContactSummary;
use hdf5::{Dataset, File, Group, Result};

use super::super::result::ContactRow;
use super::column;

/// The table of every contact, and which of its rows have been written in a load step.
#[derive(Debug)]
pub(super) struct ContactTables {
    tables: Vec<Table>,
}

#[derive(Debug)]
struct Table {
    name: String,
    node_a: Dataset,
    node_b: Dataset,
    position: Dataset,
    normal: Dataset,
    gap: Dataset,
    force: Dataset,
    pressure: Dataset,
    status: Dataset,
    /// Tangential force and slip, where the contact has friction.
    friction: Option<[Dataset; 2]>,
    written: Vec<bool>,
}

impl ContactTables {
    /// Makes all tables in their final sizes.
    pub(super) fn create(file: &File, contacts: &[ContactSummary], steps: usize) -> Result<Self> {
        let parent = column::group(file, "contact")?;
        let tables = contacts
            .iter()
            .map(|contact| Table::create(&parent, contact, steps))
            .collect::<Result<_>>()?;
        Ok(Self { tables })
    }

    /// Writes `rows`, which may belong to several contacts, in a load step.
    pub(super) fn write(&mut self, rows: &[ContactRow], step: usize) -> Result<()> {
        let mut rows = rows.to_vec();
        rows.sort_by_key(|(point, _)| (point.contact, point.place));
        let neighbours = |(a, _): &ContactRow, (b, _): &ContactRow| {
            (a.contact, a.place + 1) == (b.contact, b.place)
        };
        for run in rows.chunk_by(neighbours) {
            let contact = run[0].0.contact as usize;
            let Some(table) = self.tables.get_mut(contact) else {
                let count = self.tables.len();
                return Err(format!("contact {contact} of {count} has no place").into());
            };
            table.write(run, step)?;
        }
        Ok(())
    }

    /// Checks that every row was written in a load step, and makes ready for the next one.
    pub(super) fn finish_step(&mut self) -> Result<()> {
        for Table { name, written, .. } in &mut self.tables {
            if let Some(place) = written.iter().position(|&written| !written) {
                return Err(format!("contact '{name}': condition {place} is missing").into());
            }
            written.fill(false);
        }
        Ok(())
    }
}

impl Table {
    fn create(parent: &Group, contact: &ContactSummary, steps: usize) -> Result<Self> {
        let (name, rows) = (&contact.name, contact.conditions);
        let group =
            column::group(parent, name).map_err(|error| format!("contact '{name}': {error}"))?;
        let tags = |name| column::empty::<i64>(&group, name, 0, rows);
        let vectors = |name| column::empty::<[f64; 3]>(&group, name, 0, rows);
        let states = |name| column::empty::<f64>(&group, name, steps, rows);
        let jumps = |name| column::empty::<[f64; 3]>(&group, name, steps, rows);
        let friction = || -> Result<_> { Ok([jumps("tangential_force")?, jumps("slip")?]) };
        Ok(Self {
            name: name.clone(),
            node_a: tags("node_a")?,
            node_b: tags("node_b")?,
            position: vectors("position")?,
            normal: vectors("normal")?,
            gap: states("gap")?,
            force: states("force")?,
            pressure: states("pressure")?,
            status: column::empty::<u8>(&group, "status", steps, rows)?,
            friction: contact.has_friction.then(friction).transpose()?,
            written: vec![false; rows],
        })
    }

    /// Writes rows whose places follow each other.
    fn write(&mut self, run: &[ContactRow], step: usize) -> Result<()> {
        let start = run[0].0.place as usize;
        let Some(written) = self.written.get_mut(start..start + run.len()) else {
            let (name, last) = (&self.name, run[run.len() - 1].0.place);
            let rows = self.written.len();
            return Err(format!("contact '{name}' has {rows} conditions, none at {last}").into());
        };
        let tags = |column, of: fn(&ContactRow) -> i64| {
            column::fill(column, 0, start, &run.iter().map(of).collect::<Vec<_>>())
        };
        let vectors = |table, of: fn(&ContactRow) -> [f64; 3]| {
            column::fill(table, 0, start, &run.iter().map(of).collect::<Vec<_>>())
        };
        let reals = |column, of: fn(&ContactRow) -> f64| {
            column::fill(column, step, start, &run.iter().map(of).collect::<Vec<_>>())
        };
        if step == 0 {
            tags(&self.node_a, |(point, _)| point.tag_a)?;
            tags(&self.node_b, |(point, _)| point.tag_b)?;
            vectors(&self.position, |(point, _)| point.position)?;
            vectors(&self.normal, |(point, _)| point.normal())?;
        }
        reals(&self.gap, |(_, state)| state.gap)?;
        reals(&self.force, |(_, state)| state.force)?;
        reals(&self.pressure, |(point, state)| state.force / point.area)?;
        let status: Vec<u8> = run.iter().map(|(_, state)| state.status()).collect();
        column::fill(&self.status, step, start, &status)?;
        if let Some([tangential_force, slip]) = &self.friction {
            let forces: Vec<_> = run.iter().map(|row| row.1.tangential_force).collect();
            column::fill(tangential_force, step, start, &forces)?;
            let slips: Vec<_> = run.iter().map(|row| row.1.slip).collect();
            column::fill(slip, step, start, &slips)?;
        }
        written.fill(true);
        Ok(())
    }
}
