//! Contact with friction.

mod cycle;
mod extremes;
mod held;
mod increments;
mod judge;
mod limit;
mod patch;
mod random;
mod validation;
