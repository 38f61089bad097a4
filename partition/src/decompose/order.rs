//! The numbers of the subdomains.

use crate::problem::Problem;

impl Problem {
    /// Numbers the subdomains in the depth-first order of the hierarchy, so that what is under a
    /// node of it is one slice of every dataset; groups by their lowest subdomain, as before.
    #[must_use]
    pub fn in_order_of_hierarchy(mut self) -> Self {
        let catalog = &mut self.catalog;
        let groups: Vec<Option<usize>> = catalog.subdomains.iter().map(|s| s.group).collect();
        let order = catalog.hierarchy.depth_first(&groups);
        catalog.hierarchy = catalog.hierarchy.renumbered(&order);
        catalog.subdomains = taken(&catalog.subdomains, &order);
        catalog.interface = taken(&catalog.interface, &order);

        let mut group_order: Vec<u32> = Vec::new();
        let mut new_group = vec![None; catalog.groups.len()];
        for subdomain in &mut catalog.subdomains {
            if let Some(old) = subdomain.group {
                subdomain.group = Some(*new_group[old].get_or_insert_with(|| {
                    group_order.push(old as u32);
                    group_order.len() - 1
                }));
            }
        }
        let ends = catalog.groups.iter().scan(0, |end, &count| {
            *end += count;
            Some(*end - count..*end)
        });
        let slices: Vec<_> = ends.collect();
        let of_group = |&group: &u32| slices[group as usize].clone();
        let all: Vec<u32> = (group_order.iter().flat_map(of_group))
            .map(|j| j as u32)
            .collect();
        catalog.points = taken(&catalog.points, &all);
        catalog.point_nodes = taken(&catalog.point_nodes, &all);
        catalog.groups = taken(&catalog.groups, &group_order);

        let mut number = vec![0; order.len()];
        for (new, &old) in (0..).zip(&order) {
            number[old as usize] = new;
        }
        let points = catalog.points.iter_mut();
        for (node, _) in points.flat_map(|point| &mut point.entries) {
            node.subdomain = number[node.subdomain as usize];
        }
        for subdomain in &mut self.subdomains {
            subdomain.index = number[subdomain.index] as usize;
        }
        self.subdomains.sort_by_key(|subdomain| subdomain.index);
        self
    }
}

fn taken<T: Clone>(all: &[T], order: &[u32]) -> Vec<T> {
    order.iter().map(|&i| all[i as usize].clone()).collect()
}
