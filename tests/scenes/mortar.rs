//! Contact of sides whose nodes don't match.

mod order;
mod patch;
mod round;
mod space;
mod system;
