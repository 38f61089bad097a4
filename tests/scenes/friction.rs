//! Contact with friction.

mod cycle;
mod incline;
mod judge;
mod patch;
mod reference;
mod validation;
