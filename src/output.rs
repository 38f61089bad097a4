//! Output of the program: the result file, the report, the terminal.
//!
//! [`result`] holds the data that ranks send to the root, [`vtkhdf`] writes them to the result file in slabs of
//! subdomains, [`report`] is the JSON of `--report` and of the file's attribute, [`terminal`] prints text for people,
//! [`event`] JSON for programs, and errors; [`mod@bar`] draws the progress bar; [`lock`] keeps other runs from the same
//! output. Only the root writes files and prints.

pub mod bar;
pub mod event;
pub mod lock;
pub mod report;
pub mod result;
pub mod terminal;
pub mod vtkhdf;
