//! `/contact/<name>/`: one row for each contact point.

use contact_dd_partition::problem::{ContactKind, ContactSummary};
use hdf5::{File, Group, Result};

use super::checkpoint::Column;
use super::column::{self, List, Row, Written};
use crate::comm::is_asked_to_stop;
use crate::fem::contact_state::ContactRow;

/// The table of every contact, and flags of the rows written in a load step.
#[derive(Debug)]
pub(super) struct ContactTables {
    tables: Vec<Table>,
}

#[derive(Debug)]
struct Table {
    name: String,
    /// The columns, each with its index in `COLUMNS`.
    columns: Vec<(usize, Written)>,
    written: Vec<bool>,
}

/// The load steps in which a column is written.
#[derive(Clone, Copy, PartialEq)]
enum In {
    First,
    Each,
    /// Every load step, if the contact has friction or is a tie.
    EachWithFriction,
    /// Every load step, if the contact is compliant.
    EachOfCompliant,
}

/// Function for the values of a column in some rows.
type Values = fn(&[ContactRow]) -> Box<dyn List>;

/// The columns; those that some contacts don't have come last.
const COLUMNS: [(&str, In, Values); 11] = [
    ("node_a", In::First, |run| list(run, |(p, _)| p.tag_a)),
    ("node_b", In::First, |run| list(run, |(p, _)| p.tag_b)),
    ("position", In::First, |run| list(run, |(p, _)| p.position)),
    ("normal", In::First, |run| list(run, |(p, _)| p.normal())),
    ("gap", In::Each, |run| list(run, |(_, state)| state.gap)),
    ("force", In::Each, |run| list(run, |(_, state)| state.force)),
    ("pressure", In::Each, |run| {
        list(run, |(p, state)| state.force / p.area)
    }),
    ("status", In::Each, |run| {
        list(run, |(_, state)| state.status())
    }),
    ("tangential_force", In::EachWithFriction, |run| {
        list(run, |(_, state)| state.tangential_force)
    }),
    ("slip", In::EachWithFriction, |run| {
        list(run, |(_, state)| state.slip)
    }),
    ("overclosure", In::EachOfCompliant, |run| {
        list(run, |(p, state)| p.overclosure(state.force))
    }),
];

/// A list of values, one for each row.
fn list<R: Row>(run: &[ContactRow], of: fn(&ContactRow) -> R) -> Box<dyn List> {
    Box::new(run.iter().map(of).collect::<Vec<R>>())
}

impl ContactTables {
    /// Creates all tables in their final sizes; for thousands of contacts this takes seconds.
    ///
    /// # Errors
    /// A table can't be created, or a signal asked the run to stop.
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

    /// Writes `rows` of a load step; they may belong to several contacts.
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

    /// All datasets by their places in the file.
    pub(super) fn columns(&self) -> Result<Vec<Column>> {
        let all = self.tables.iter().flat_map(|table| &table.columns);
        all.map(|(_, column)| column.column()).collect()
    }

    /// Checks that every row was written in a load step, and prepares for the next one; returns the digests of the
    /// datasets.
    pub(super) fn finish_step(&mut self) -> Result<Vec<u64>> {
        for Table { name, written, .. } in &mut self.tables {
            if let Some(place) = written.iter().position(|&written| !written) {
                return Err(format!("contact '{name}': condition {place} is missing").into());
            }
            written.fill(false);
        }
        let all = (self.tables.iter_mut()).flat_map(|table| &mut table.columns);
        Ok(all.map(|(_, column)| column.finish_step()).collect())
    }
}

impl Table {
    fn create(parent: &Group, contact: &ContactSummary, steps: usize) -> Result<Self> {
        let (name, rows) = (&contact.name, contact.conditions);
        let group =
            column::group(parent, name).map_err(|error| format!("contact '{name}': {error}"))?;
        let is_tied = contact.kind == ContactKind::Tie;
        let is_there = |when: In| match when {
            In::First | In::Each => true,
            In::EachWithFriction => contact.has_friction || is_tied,
            In::EachOfCompliant => contact.is_compliant,
        };
        let columns = COLUMNS.iter().enumerate();
        let columns = columns.filter(|(_, (_, when, _))| is_there(*when));
        let columns = columns.map(|(place, (name, when, values))| {
            let steps = if *when == In::First { 0 } else { steps };
            let column = Written::empty(&*values(&[]), &group, name, steps, rows)?;
            Ok((place, column))
        });
        Ok(Self {
            name: name.clone(),
            columns: columns.collect::<Result<_>>()?,
            written: vec![false; rows],
        })
    }

    /// Writes rows with consecutive places.
    fn write(&mut self, run: &[ContactRow], step: usize) -> Result<()> {
        let start = run[0].0.place as usize;
        let Some(written) = self.written.get_mut(start..start + run.len()) else {
            let (name, last) = (&self.name, run[run.len() - 1].0.place);
            let rows = self.written.len();
            return Err(format!("contact '{name}' has {rows} conditions, none at {last}").into());
        };
        for (place, column) in &mut self.columns {
            let (_, when, values) = &COLUMNS[*place];
            if step == 0 || *when != In::First {
                column.fill(step, start, &*values(run))?;
            }
        }
        written.fill(true);
        Ok(())
    }
}
