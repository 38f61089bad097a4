//! Contact with friction.

mod judge;
