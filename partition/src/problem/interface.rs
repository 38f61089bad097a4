//! What the subdomains that share a node of Γ must agree on.

use super::Problem;
use crate::error::InputError;

impl Problem {
    /// Checks that all copies of a node on Γ have the same place, tag and supports.
    ///
    /// # Errors
    /// The first node on Γ for which they don't.
    pub fn check_interface(&self) -> Result<(), InputError> {
        let mut first: Vec<Option<(usize, u32)>> = vec![None; self.catalog.interface_nodes];
        for (index, subdomain) in self.subdomains.iter().enumerate() {
            for on in &subdomain.interface {
                let seen = &mut first[on.interface as usize];
                let Some((other, node)) = *seen else {
                    *seen = Some((index, on.node));
                    continue;
                };
                if let Some(what) = self.difference((other, node), (index, on.node)) {
                    return Err(InputError::new(format!(
                        "node {} on Γ: the subdomains {other} and {index} disagree on its {what}",
                        on.interface
                    )));
                }
            }
        }
        Ok(())
    }

    /// What two copies (subdomain, node) of a node differ in.
    fn difference(&self, a: (usize, u32), b: (usize, u32)) -> Option<&'static str> {
        let at = |(subdomain, node): (usize, u32)| (&self.subdomains[subdomain], node as usize);
        let ((left, i), (right, j)) = (at(a), at(b));
        if left.points[i] != right.points[j] {
            return Some("coordinates (/VTKHDF/Points)");
        }
        if left.node_tags[i] != right.node_tags[j] {
            return Some("tag (/VTKHDF/PointData/GlobalNodeId)");
        }
        let supports_of = |(subdomain, node): (usize, u32)| {
            let all = &self.subdomains[subdomain].supports;
            let start = all.partition_point(|s| s.node < node);
            let rows = all[start..].iter().take_while(move |s| s.node == node);
            rows.map(|s| (s.direction, s.value))
        };
        (!supports_of(a).eq(supports_of(b))).then_some("supports (/support)")
    }
}
