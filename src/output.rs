//! Everything that leaves the program: the result file, the report, the terminal.
//!
//! [`result`] holds what the ranks hand over, [`vtkhdf`] streams it into the result file in slabs of
//! subdomains, [`report`] is the JSON of `--report` and of the file's attribute, [`build`] what it
//! says of the program, [`terminal`] prints for people, [`event`] for programs, [`message`] what went
//! wrong, [`mod@bar`] draws the bar. Only the root writes files and tells of the run; [`ranks`] and
//! [`memory`] are what every rank measures of itself.

pub mod bar;
pub mod build;
pub mod event;
pub mod memory;
pub mod memory_check;
pub mod message;
pub mod ranks;
pub mod report;
pub mod result;
pub mod resultants;
pub mod terminal;
pub mod vtkhdf;
