//! Runs of unknowns that belong together.

/// Runs of consecutive unknowns.
#[derive(Clone, Debug)]
pub(super) struct Sites {
    /// Where each one begins, and the end of the last.
    pub starts: Vec<u32>,
    /// The site of each node's own unknowns, if it has any.
    pub of_node: Vec<u32>,
    /// The next unknown.
    pub next: u32,
}

impl Sites {
    pub fn new(nodes: usize) -> Self {
        let mut starts = Vec::with_capacity(nodes + 1);
        starts.push(0);
        Self {
            starts,
            of_node: vec![u32::MAX; nodes],
            next: 0,
        }
    }

    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The next unknown.
    pub fn unknown(&mut self) -> u32 {
        self.next += 1;
        self.next - 1
    }

    /// Ends the current site; one without unknowns is none.
    pub fn end(&mut self) {
        if self.starts.last() != Some(&self.next) {
            self.starts.push(self.next);
        }
    }

    /// A node's own unknowns.
    pub fn unknowns_of(&self, node: u32) -> std::ops::Range<u32> {
        match self.of_node[node as usize] as usize {
            site if site < self.len() => self.starts[site]..self.starts[site + 1],
            _ => 0..0,
        }
    }

    /// The site of an unknown.
    pub fn of(&self, dof: u32) -> u32 {
        self.starts.partition_point(|&start| start <= dof) as u32 - 1
    }
}
