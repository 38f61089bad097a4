//! Everything that leaves the program: the result file, the report, the terminal.
//!
//! [`result`] holds what the ranks hand over, [`vtkhdf`] streams it into the result file in slabs of
//! subdomains, [`report`] is the JSON of `--report` and of the file's attribute, [`terminal`] prints for
//! people, [`event`] for programs and what went wrong, [`mod@bar`] draws the bar; [`lock`] keeps other runs from the
//! same output. Only the root writes files and tells of the run.

pub mod bar;
pub mod event;
pub mod lock;
pub mod report;
pub mod result;
pub mod terminal;
pub mod vtkhdf;
