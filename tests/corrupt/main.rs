//! Every dataset and attribute of a valid problem file is dropped, shortened, lengthened, emptied, retyped and
//! poisoned: the file is refused with a message, gives the same result, or is another problem that is consistent with
//! the remainder of the file.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

extern crate contact_dd_trials as support;

mod bytes;
mod change;
mod everything;
mod walk;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use contact_dd_partition::problem::Problem;
use contact_dd_partition::problem::read::ProblemFile;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

use change::{Change, changes};
use everything::everything;
use support::process::Running;
use support::solver::{LIMIT, program};
use walk::{Place, places};

/// Changes that make another problem which nothing in the file contradicts.
const FREE: [&str; 66] = [
    "/@title",
    "/@plane",
    "/VTKHDF/Points",
    "/VTKHDF/PointData/GlobalNodeId",
    "/VTKHDF/CellData/Material",
    "/bodies/name",
    "/materials/name",
    "/materials/stiffness",
    "/materials/out_of_plane",
    "/materials/poisson",
    "/hierarchy/parent",
    "/hierarchy/cluster",
    "/settings/@max_sweeps",
    "/settings/@method",
    "/settings/@no_stress",
    "/settings/@relaxation",
    "/settings/@tolerance",
    "/warnings",
    "/probe/contact",
    "/probe/node",
    "/probe/normal",
    "/probe/gap",
    "/probe/entry_subdomain",
    "/probe/entry_node",
    "/probe/entry_weight",
    "/quantity/name",
    "/quantity/kind",
    "/quantity/direction",
    "/quantity/point",
    "/quantity/length",
    "/quantity/constant",
    "/quantity/node",
    "/quantity/of",
    "/weight/quantity",
    "/weight/node",
    "/weight/value",
    "/parameter/name",
    "/parameter/kind",
    "/parameter/value",
    "/parameter/of",
    "/load/parameter",
    "/load/node",
    "/load/force",
    "/steps/name",
    "/steps/time",
    "/steps/body",
    "/steps/contact",
    "/support/node",
    "/support/direction",
    "/support/value",
    "/support/condition",
    "/support/name",
    "/force/node",
    "/force/value",
    "/initial_stress/cell",
    "/initial_stress/node",
    "/contact/name",
    "/contact/gap",
    "/contact/given_gap",
    "/contact/area",
    "/contact/node_a",
    "/contact/node_b",
    "/contact/force_point",
    "/contact/law",
    "/contact/friction",
    "/contact/shear_bound",
];

/// Number of changed or refused files of which one is run on 3 ranks.
const SAMPLE: usize = 100;

/// Limit of memory: far above the need of the small problem, below the sizes that a header may claim (bytes).
const MEMORY: u64 = 16 << 30;

/// The fate of a changed file.
#[derive(Debug, PartialEq)]
enum Verdict {
    Refused(String),
    Same,
    Other,
}

fn read(path: &Path, good: &Problem) -> Verdict {
    match ProblemFile::open(path).and_then(|file| file.problem()) {
        Err(error) => Verdict::Refused(error.to_string()),
        Ok(problem) if problem == *good => Verdict::Same,
        Ok(_) => Verdict::Other,
    }
}

/// A file for the solver.
struct Job {
    what: String,
    path: PathBuf,
    ranks: usize,
    /// The exit codes that are right.
    codes: &'static [i32],
}

impl Job {
    /// The fault of the solver's answer to it; nothing where that is right.
    fn defect(&self) -> Option<String> {
        let mut command = program(self.ranks);
        let ended = Running::start(command.arg("--quiet").arg(&self.path)).wait(LIMIT);
        let code = ended.code();
        let expected = usize::from(code != 0);
        let is_right = self.codes.contains(&code) && ended.errors().len() == expected;
        let (what, ranks) = (&self.what, self.ranks);
        (!is_right).then(|| format!("{what}, {ranks} ranks: code {code}, {}", ended.stderr))
    }
}

/// The defects that the solver shows, a few files at a time: most of a run is the start of MPI.
fn solve(jobs: &[Job]) -> Vec<String> {
    let next = AtomicUsize::new(0);
    let work = || {
        let take = || jobs.get(next.fetch_add(1, Ordering::Relaxed));
        std::iter::from_fn(take).filter_map(Job::defect).collect()
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(work)).collect();
        let found = threads.into_iter().map(|t| t.join());
        found
            .flat_map(|defects: std::thread::Result<Vec<String>>| defects.unwrap())
            .collect()
    })
}

#[test]
fn no_change_of_a_problem_file_goes_unnoticed() {
    let limit = Rlimit {
        current: Some(MEMORY),
        ..getrlimit(Resource::As)
    };
    setrlimit(Resource::As, limit).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (whole, path) = (folder.path().join("whole.h5"), folder.path().join("p.h5"));
    everything().write(&whole).unwrap();
    let good = ProblemFile::open(&whole).unwrap().problem().unwrap();
    let (mut refused, mut same, mut other) = (0, 0, 0);
    let mut defects = Vec::new();
    let mut jobs: Vec<Job> = Vec::new();
    for place in places(&whole) {
        for change in changes(&whole, &place) {
            fs::copy(&whole, &path).unwrap();
            change.apply(&path, &place);
            let what = format!("{place} {change}");
            let verdict = read(&path, &good);
            let mut solved_with = None;
            match verdict {
                Verdict::Same => same += 1,
                Verdict::Refused(message) => {
                    refused += 1;
                    let named = message.starts_with(path.to_str().unwrap());
                    if !named || message.contains('\n') {
                        defects.push(format!("{what}: {message}"));
                    }
                    if refused % SAMPLE == 0 {
                        solved_with = Some((3, &[2][..]));
                    }
                }
                Verdict::Other if !FREE.contains(&place.to_string().as_str()) => {
                    defects.push(format!("{what}: taken for another problem"));
                }
                Verdict::Other => {
                    other += 1;
                    let ranks = if other % SAMPLE == 0 { 3 } else { 0 };
                    solved_with = Some((ranks, &[0, 2, 3, 4]));
                }
            }
            if let Some((ranks, codes)) = solved_with {
                let path_of_job = folder.path().join(format!("{}.h5", jobs.len()));
                fs::rename(&path, &path_of_job).unwrap();
                jobs.push(Job {
                    what,
                    path: path_of_job,
                    ranks,
                    codes,
                });
            }
        }
    }
    defects.extend(solve(&jobs));
    println!("{refused} refused, {same} the same, {other} another problem");
    assert!(defects.is_empty(), "{}", defects.join("\n"));
    // A walk that finds nothing, or changes that change nothing, would find no defect.
    assert!(refused > 900 && same > 100 && other > 80);
}

#[test]
fn what_is_dropped_is_missed_unless_the_format_says_that_it_may_be() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, path) = (folder.path().join("whole.h5"), folder.path().join("p.h5"));
    everything().write(&whole).unwrap();
    let good = ProblemFile::open(&whole).unwrap().problem().unwrap();
    let mut optional = Vec::new();
    for place in places(&whole) {
        fs::copy(&whole, &path).unwrap();
        Change::Drop.apply(&path, &place);
        if !matches!(read(&path, &good), Verdict::Refused(_)) {
            optional.push(place.to_string());
        }
    }
    optional.sort();
    assert_eq!(
        optional,
        [
            "/@title",
            "/@units",
            "/VTKHDF/@Type",
            "/VTKHDF/@Version",
            "/VTKHDF/CellData/Subdomain",
            "/contact/given_gap",
            "/hierarchy/cluster",
            "/materials/out_of_plane",
            "/materials/poisson",
            "/settings/@max_sweeps",
            "/settings/@method",
            "/settings/@no_stress",
            "/settings/@relaxation",
            "/settings/@tolerance",
            "/steps/body",
            "/steps/contact",
            "/warnings",
        ]
    );
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let group = if self.group == "/" { "" } else { &self.group };
        let sign = if self.is_attribute { "@" } else { "" };
        write!(f, "{group}/{sign}{}", self.name)
    }
}
