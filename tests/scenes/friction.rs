//! Contact with friction.

mod cycle;
mod incline;
mod judge;
mod patch;
mod random;
mod reference;
mod validation;
