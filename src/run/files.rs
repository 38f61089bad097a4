//! The output files of a run: created before the work, written load step by load step.

mod parcel;
mod rows;
mod tightened_bolts;

use contact_dd_partition::model::PlaneState;

pub use self::rows::absent_rows;
use self::rows::write_solution;
use self::tightened_bolts::tightened_bolts;
use crate::comm::is_asked_to_stop;
use crate::context::Context;
use crate::error::Failure;
use crate::fem::contact_state::ContactRow;
use crate::fem::resultants::Resultants;
use crate::output::report::{Report, ReportFile};
use crate::output::vtkhdf::beside::FileBeside;
use crate::output::vtkhdf::kept::Kept;
use crate::output::vtkhdf::{Layout, ResultFile};
use crate::recover::Slips;
use crate::recover::penetration::probe;
use crate::recover::solution::Solution;
use crate::report::totals::Totals;
use crate::settings::Settings;

/// The output files on this rank, under temporary names until they are finished.
#[derive(Debug, Default)]
pub struct RunFiles {
    /// The results; on the root.
    pub result: Option<ResultFile>,
    /// The report, if requested; on the root.
    report: Option<ReportFile>,
    /// The result file as opened by this rank, if all ranks can write to it in parallel.
    beside: Option<FileBeside>,
}

impl RunFiles {
    /// Creates the output files, so that an unwritable folder is found before the work starts, or opens those of a
    /// stopped run with its `finished` load steps. Collective.
    ///
    /// # Errors
    /// A file can't be created, or doesn't contain the finished load steps as written, or a signal asked the run to
    /// stop.
    pub fn create(
        context: &Context<'_>,
        settings: &Settings,
        finished: Option<Kept>,
    ) -> Result<Self, Failure> {
        let comm = context.comm;
        let layout = layout(context, settings);
        let create = move |layout: &Layout| -> Result<_, Failure> {
            let report = settings.report.as_deref().map(ReportFile::create);
            let result = match finished {
                None => ResultFile::create(&settings.output, layout)?,
                Some(kept) => {
                    let whole = kept.check(&settings.output);
                    whole.map_err(|error| Failure::input(format!("--restart: {error}")))?;
                    ResultFile::resume(&settings.output, layout, kept)?
                }
            };
            Ok((result, report.transpose()?))
        };
        let create = || {
            let created = create(&layout);
            // After a signal the files may be incomplete.
            match is_asked_to_stop() {
                false => created,
                true => Err(Failure::interrupted(
                    "interrupted while creating the outputs",
                )),
            }
        };
        let created = comm.agree(comm.is_root().then(create).transpose())?;
        let (result, report) = created.unzip();
        // A single rank needs no parallel writing.
        let shared = result.as_ref().filter(|_| comm.size() > 1);
        let mut places = shared.and_then(ResultFile::places);
        comm.broadcast(&mut places);
        let beside = places
            .and_then(|places| FileBeside::open(&places, &settings.output, &layout, comm.hosts()));
        let is_alone = comm.is_any(beside.is_none());
        Ok(Self {
            result,
            report: report.flatten(),
            beside: beside.filter(|_| !is_alone),
        })
    }

    /// Writes the solution of load step `step`, including rows of the contact points that are `absent`; returns, on the
    /// root, the resultants of contacts and supports. Collective.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn write(
        &mut self,
        context: &Context<'_>,
        solution: &Solution,
        slips: &Slips,
        absent: &[ContactRow],
        step: usize,
    ) -> Result<Resultants, Failure> {
        let mut resultants = Resultants::new(context.catalog, solution.reactions.clone());
        resultants.crack_tips = solution.stress_intensities.clone();
        resultants.put(solution.quantities.clone());
        let contacts = &mut resultants.contacts;
        let files = (self.result.as_mut(), self.beside.as_mut());
        write_solution(context, (solution, slips), files, contacts, absent)?;
        probe(context, &solution.displacement, contacts);
        resultants.pretensions = tightened_bolts(context, &solution.displacement, contacts, step);
        if context.catalog.plane == Some(PlaneState::Axisymmetric) {
            resultants.sum_around_axis();
        }
        Ok(resultants)
    }

    /// Finishes the result file and writes the report. On the root.
    ///
    /// # Errors
    /// One of the files can't be written.
    pub fn finish(self, totals: &Totals<'_>, report: &Report) -> Result<(), Failure> {
        let json = report.to_json();
        if let Some(mut result) = self.result {
            let histories = totals.steps.iter().map(|step| &step.outcome.records[..]);
            result.write_convergence(histories)?;
            result.finish(&json)?;
        }
        if let Some(file) = self.report {
            file.write(&json)?;
        }
        Ok(())
    }
}

/// Sizes of all parts of the result file. Collective.
fn layout(context: &Context<'_>, settings: &Settings) -> Layout {
    let &Context {
        comm,
        catalog,
        plan,
        blocks,
        ..
    } = context;
    let mut connectivity = comm.gathered(&plan.owners(), |s| {
        (blocks.get(&s)).map_or(0, |block| block.subdomain.cells.connectivity().len())
    });
    comm.broadcast(&mut connectivity);
    Layout::new(catalog, &connectivity, !settings.no_stress)
}
