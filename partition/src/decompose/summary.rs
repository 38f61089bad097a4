//! Summary of a decomposition for the user.

use std::fmt;

use crate::hierarchy::work::Work;
use crate::problem::{ContactKind, Problem};

/// Sizes and balance of a problem; the partition tool prints its `Display`.
#[derive(Clone, Copy, Debug)]
pub struct Summary<'a>(&'a Problem);

impl Problem {
    /// The summary of the problem.
    pub fn summary(&self) -> Summary<'_> {
        Summary(self)
    }
}

impl Summary<'_> {
    /// Number of subdomains of every contact group.
    pub fn groups(&self) -> Vec<usize> {
        let catalog = &self.0.catalog;
        let mut sizes = vec![0; catalog.groups.len()];
        for group in catalog.subdomains.iter().filter_map(|s| s.group) {
            sizes[group] += 1;
        }
        sizes
    }

    /// Number of cells of the largest subdomain over the average.
    pub fn imbalance(&self) -> f64 {
        let cells = self.0.catalog.subdomains.iter().map(|s| s.cells);
        let (count, largest) = (cells.len(), cells.clone().max());
        largest.unwrap_or(0) as f64 * count as f64 / cells.sum::<usize>().max(1) as f64
    }

    /// The discretization of each contact, as determined from its points.
    fn pairings(&self) -> Vec<&'static str> {
        let mut pairings = vec![""; self.0.catalog.contacts.len()];
        for point in &self.0.catalog.points {
            let weights: f64 = point.entries.iter().map(|(_, weight)| weight).sum();
            pairings[point.contact as usize] = match (weights > 0.5, point.tag_a, point.tag_b) {
                _ if point.is_equation() => "",
                (true, ..) => ", obstacle",
                (_, -1, _) => ", mortar, conditions at the nodes of side b",
                (_, _, -1) => ", mortar",
                _ => ", node by node",
            };
        }
        pairings
    }

    /// Number of contact groups by their number of subdomains, as text.
    fn sizes_of_groups(&self) -> String {
        let sizes = self.groups();
        let words = [
            (1..=1, "of one subdomain"),
            (2..=2, "of two subdomains"),
            (3..=usize::MAX, "of three or more subdomains"),
        ];
        let words = words.map(|(sought, word)| {
            let count = sizes.iter().filter(|&size| sought.contains(size)).count();
            (count > 0).then(|| format!("{count} {word}"))
        });
        let words: Vec<String> = words.into_iter().flatten().collect();
        match words.is_empty() {
            true => "none".into(),
            false => format!("{}, linked by contact", words.join(", ")),
        }
    }
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let catalog = &self.0.catalog;
        let cells: usize = catalog.subdomains.iter().map(|s| s.cells).sum();
        writeln!(f, "mesh          {} nodes, {cells} cells", catalog.nodes())?;
        writeln!(f, "dofs          {}", catalog.dofs())?;
        let (count, in_contact) = (
            catalog.subdomains.len(),
            self.groups().iter().sum::<usize>(),
        );
        writeln!(f, "subdomains    {count}, {in_contact} in contact")?;
        let imbalance = self.imbalance();
        writeln!(
            f,
            "balance       {imbalance:.2} (largest subdomain over the mean, by cells)"
        )?;
        writeln!(f, "interface     {} nodes", catalog.interface_nodes)?;
        let work = Work::new(catalog);
        let fronts = work.fronts.iter().map(|f| f.eliminated + f.kept);
        writeln!(
            f,
            "hierarchy     {} merges, {:.3e} flops, largest front {} dofs; the costliest part takes {:.3} times the mean",
            fronts.len(),
            work.of_fronts(),
            fronts.max().unwrap_or(0),
            work.imbalance
        )?;
        writeln!(f, "clusters      {}", catalog.hierarchy.clusters.len())?;
        writeln!(
            f,
            "ranks         {} are useful, best possible speed-up {:.1}",
            work.useful_ranks(),
            work.speed_up
        )?;
        writeln!(f, "contact       {} conditions", catalog.conditions())?;
        for (index, (contact, pairing)) in catalog.contacts.iter().zip(self.pairings()).enumerate()
        {
            let (points, name) = (contact.conditions, &contact.name);
            let friction = catalog.friction(index).map(|words| format!(", {words}"));
            let friction = friction.unwrap_or_default();
            let stiffness = catalog.contact_stiffness(index);
            let stiffness = stiffness.map_or(String::new(), |words| format!(", {words}"));
            let tied = match contact.kind {
                ContactKind::Tie => ", tied",
                ContactKind::Coupling => ", coupled",
                ContactKind::Pretension => ", pulled together",
                ContactKind::Held => ", held",
                ContactKind::Unilateral | ContactKind::Equation | ContactKind::Spring => "",
            };
            writeln!(
                f,
                "              {points:>6} on {name}{pairing}{friction}{stiffness}{tied}"
            )?;
        }
        write!(f, "groups        {}", self.sizes_of_groups())
    }
}
