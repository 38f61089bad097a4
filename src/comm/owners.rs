//! Owners of distributed data.

use contact_dd_partition::numbered::Numbered;

/// The rank that owns each of several consecutively numbered items.
pub trait Owners {
    /// The type of their numbers.
    type Of: Copy + Ord + From<usize>;

    /// The owner of each item.
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
