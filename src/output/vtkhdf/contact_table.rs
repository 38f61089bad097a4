//! `/contact/<name>/`: one row for each contact point.

use contact_dd_partition::problem::ContactSummary;
use hdf5::{File, Group, Result};

use super::checkpoint::Column;
use super::column::{self, Written};
use crate::comm::is_asked_to_stop;
use crate::fem::contact_state::ContactRow;

/// The table of every contact, and which of its rows have been written in a load step.
#[derive(Debug)]
pub(super) struct ContactTables {
    tables: Vec<Table>,
}

#[derive(Debug)]
struct Table {
    name: String,
    node_a: Written,
    node_b: Written,
    position: Written,
    normal: Written,
    gap: Written,
    force: Written,
    pressure: Written,
    status: Written,
    /// Tangential force and slip, where the contact has friction.
    friction: Option<[Written; 2]>,
    written: Vec<bool>,
}

impl ContactTables {
    /// Makes all tables in their final sizes; thousands of contacts take seconds.
    ///
    /// # Errors
    /// One can't be made, or a signal asked the run to stop.
    pub(super) fn create(file: &File, contacts: &[ContactSummary], steps: usize) -> Result<Self> {
        let parent = column::group(file, "contact")?;
        let tables = contacts
            .iter()
            .map(|contact| match is_asked_to_stop() {
                false => Table::create(&parent, contact, steps),
                true => Err("interrupted".into()),
            })
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

    /// All datasets as they lie in the file.
    pub(super) fn columns(&mut self) -> Result<Vec<Column>> {
        let all = self.tables.iter_mut().flat_map(Table::columns);
        all.map(|column| column.column()).collect()
    }

    /// Checks that every row was written in a load step, and makes ready for the next one; returns the digests of the
    /// datasets.
    pub(super) fn finish_step(&mut self) -> Result<Vec<u64>> {
        for Table { name, written, .. } in &mut self.tables {
            if let Some(place) = written.iter().position(|&written| !written) {
                return Err(format!("contact '{name}': condition {place} is missing").into());
            }
            written.fill(false);
        }
        let all = self.tables.iter_mut().flat_map(Table::columns);
        Ok(all.map(Written::finish_step).collect())
    }
}

impl Table {
    fn create(parent: &Group, contact: &ContactSummary, steps: usize) -> Result<Self> {
        let (name, rows) = (&contact.name, contact.conditions);
        let group =
            column::group(parent, name).map_err(|error| format!("contact '{name}': {error}"))?;
        let tags = |name| Written::empty::<i64>(&group, name, 0, rows);
        let vectors = |name| Written::empty::<[f64; 3]>(&group, name, 0, rows);
        let states = |name| Written::empty::<f64>(&group, name, steps, rows);
        let jumps = |name| Written::empty::<[f64; 3]>(&group, name, steps, rows);
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
            status: Written::empty::<u8>(&group, "status", steps, rows)?,
            friction: contact.has_friction.then(friction).transpose()?,
            written: vec![false; rows],
        })
    }

    fn columns(&mut self) -> impl Iterator<Item = &mut Written> {
        let own = [
            &mut self.node_a,
            &mut self.node_b,
            &mut self.position,
            &mut self.normal,
            &mut self.gap,
            &mut self.force,
            &mut self.pressure,
            &mut self.status,
        ];
        own.into_iter().chain(self.friction.iter_mut().flatten())
    }

    /// Writes rows whose places follow each other.
    fn write(&mut self, run: &[ContactRow], step: usize) -> Result<()> {
        let start = run[0].0.place as usize;
        let Some(written) = self.written.get_mut(start..start + run.len()) else {
            let (name, last) = (&self.name, run[run.len() - 1].0.place);
            let rows = self.written.len();
            return Err(format!("contact '{name}' has {rows} conditions, none at {last}").into());
        };
        let tags = |column: &mut Written, of: fn(&ContactRow) -> i64| {
            column.fill(0, start, &run.iter().map(of).collect::<Vec<_>>())
        };
        let vectors = |table: &mut Written, of: fn(&ContactRow) -> [f64; 3]| {
            table.fill(0, start, &run.iter().map(of).collect::<Vec<_>>())
        };
        let reals = |column: &mut Written, of: fn(&ContactRow) -> f64| {
            column.fill(step, start, &run.iter().map(of).collect::<Vec<_>>())
        };
        if step == 0 {
            tags(&mut self.node_a, |(point, _)| point.tag_a)?;
            tags(&mut self.node_b, |(point, _)| point.tag_b)?;
            vectors(&mut self.position, |(point, _)| point.position)?;
            vectors(&mut self.normal, |(point, _)| point.normal())?;
        }
        reals(&mut self.gap, |(_, state)| state.gap)?;
        reals(&mut self.force, |(_, state)| state.force)?;
        reals(&mut self.pressure, |(point, state)| {
            state.force / point.area
        })?;
        let status: Vec<u8> = run.iter().map(|(_, state)| state.status()).collect();
        self.status.fill(step, start, &status)?;
        if let Some([tangential_force, slip]) = &mut self.friction {
            let forces: Vec<_> = run.iter().map(|row| row.1.tangential_force).collect();
            tangential_force.fill(step, start, &forces)?;
            let slips: Vec<_> = run.iter().map(|row| row.1.slip).collect();
            slip.fill(step, start, &slips)?;
        }
        written.fill(true);
        Ok(())
    }
}
