//! Owners of what ranks share.

use contact_dd_partition::numbered::Numbered;

/// The rank that owns each of some things, which are numbered one after the other.
pub trait Owners {
    /// Their numbers.
    type Of: Copy + Ord + From<usize>;

    /// The ranks.
    fn ranks(&self) -> &[usize];
}

impl<I: Copy + Ord + From<usize>> Owners for Numbered<I, usize> {
    type Of = I;

    fn ranks(&self) -> &[usize] {
        self.values()
    }
}

impl Owners for Vec<usize> {
    type Of = usize;

    fn ranks(&self) -> &[usize] {
        self
    }
}

impl Owners for [usize] {
    type Of = usize;

    fn ranks(&self) -> &[usize] {
        self
    }
}
