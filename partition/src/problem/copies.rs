//! Consistency of subdomains: of shared nodes, and of tags, which are unique.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use serde::{Deserialize, Serialize};

use super::Subdomain;

/// A node on Γ with the data of one of its subdomains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SharedNode {
    /// Number on Γ.
    pub interface: u32,
    /// The mesh file's tag.
    pub tag: i64,
    /// Coordinates (m).
    pub point: [f64; 3],
    /// Directions of its supports, and their values, one for each load step.
    pub supports: Vec<([f64; 3], Vec<f64>)>,
}

/// The data of a subdomain's nodes that other subdomains have to agree with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OwnNodes {
    /// Tags of nodes that aren't on Γ.
    pub inner: Vec<i64>,
    /// Tags of nodes on Γ, with their numbers there.
    pub on_interface: Vec<(i64, u32)>,
    /// The nodes on Γ.
    pub shared: Vec<SharedNode>,
}

impl OwnNodes {
    /// Splits it into `count` parts that can be checked independently: a node of Γ belongs to the part of its number, a
    /// tag to the part of the tag.
    pub fn parts(self, count: usize) -> Vec<Self> {
        if count == 1 {
            return vec![self];
        }
        let mut parts = vec![Self::default(); count];
        let of_tag = |tag: i64| tag.rem_euclid(count as i64) as usize;
        for tag in self.inner {
            parts[of_tag(tag)].inner.push(tag);
        }
        for (tag, number) in self.on_interface {
            parts[of_tag(tag)].on_interface.push((tag, number));
        }
        for node in self.shared {
            parts[node.interface as usize % count].shared.push(node);
        }
        parts
    }
}

impl Subdomain {
    /// The data of the nodes that other subdomains have to agree with.
    pub fn own_nodes(&self) -> OwnNodes {
        let mut is_shared = vec![false; self.points.len()];
        let shared = self.interface.iter().map(|on| {
            let node = on.node as usize;
            is_shared[node] = true;
            let start = self.supports.partition_point(|s| s.node < on.node);
            let rows = self.supports.iter().enumerate().skip(start);
            let rows = rows.take_while(|(_, s)| s.node == on.node);
            SharedNode {
                interface: on.interface,
                tag: self.node_tags[node],
                point: self.points[node],
                supports: rows.map(|(i, s)| (s.direction, self.support(i))).collect(),
            }
        });
        let shared: Vec<SharedNode> = shared.collect();
        let nodes = self.node_tags.iter().zip(&is_shared);
        OwnNodes {
            inner: nodes.filter(|&(_, on)| !on).map(|(&tag, _)| tag).collect(),
            on_interface: shared.iter().map(|n| (n.tag, n.interface)).collect(),
            shared,
        }
    }
}

/// An inconsistency between subdomains; they are ordered, and the smallest is reported.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Disagreement {
    /// Copies before tags, by subdomain and number on Γ, or by tag.
    order: (bool, i64, u32),
    /// The message that names the entries.
    pub message: String,
}

/// Comparison of the nodes of all subdomains, or of [parts](OwnNodes::parts) of these.
#[derive(Clone, Debug, Default)]
pub struct NodeCopies {
    /// The first subdomain of each node of Γ, with its data.
    first: HashMap<u32, (usize, SharedNode)>,
    /// Tags of nodes that aren't on Γ, subdomain by subdomain.
    inner: Vec<i64>,
    /// Every subdomain and the end of its inner tags.
    ends: Vec<(usize, usize)>,
    /// Tags of nodes on Γ, with their numbers there and the subdomain.
    on_interface: Vec<(i64, u32, usize)>,
    /// The first inconsistency.
    fault: Option<Disagreement>,
}

impl NodeCopies {
    /// Adds the nodes of subdomain `index`; indices ascend.
    pub fn add(&mut self, index: usize, nodes: OwnNodes) {
        self.inner.extend(nodes.inner);
        self.ends.push((index, self.inner.len()));
        let tags = nodes.on_interface.into_iter();
        (self.on_interface).extend(tags.map(|(tag, number)| (tag, number, index)));
        for node in nodes.shared {
            let number = node.interface;
            let (other, known) = match self.first.entry(number) {
                Entry::Vacant(vacant) => {
                    vacant.insert((index, node));
                    continue;
                }
                Entry::Occupied(known) => known.into_mut(),
            };
            let Some(what) = difference(known, &node) else {
                continue;
            };
            let fault = Disagreement {
                order: (false, index as i64, number),
                message: format!(
                    "node {number} on Γ: the subdomains {other} and {index} disagree on its {what}"
                ),
            };
            self.fault = self.fault.take().into_iter().chain([fault]).min();
        }
    }

    /// Checks that all copies of a node on Γ have the same position, tag and supports, and that no other nodes have the
    /// same tag; returns the first inconsistency.
    pub fn check(mut self) -> Option<Disagreement> {
        // A node of Γ counts once, for its first subdomain.
        self.on_interface.sort_unstable();
        (self.on_interface).dedup_by_key(|&mut (tag, number, _)| (tag, number));
        let on_interface = self.on_interface.iter();
        let mut tags = self.inner.clone();
        tags.extend(on_interface.clone().map(|&(tag, ..)| tag));
        let repeated = self.fault.is_none().then(|| repeated(tags)).flatten();
        let Some(repeated) = repeated else {
            return self.fault;
        };
        let places = (0..self.inner.len()).filter(|&place| self.inner[place] == repeated);
        let inner = places.map(|place| {
            let subdomain = self.ends.partition_point(|&(_, end)| end <= place);
            self.ends[subdomain].0
        });
        let on_interface = on_interface.filter(|&&(tag, ..)| tag == repeated);
        let mut of: Vec<usize> = inner.chain(on_interface.map(|&(.., s)| s)).collect();
        of.sort_unstable();
        let of: Vec<String> = of.iter().take(2).map(ToString::to_string).collect();
        Some(Disagreement {
            order: (true, repeated, 0),
            message: format!(
                "dataset /VTKHDF/PointData/GlobalNodeId: the subdomains {} have a node of tag {repeated} \
                 each that isn't one node on Γ; expected copies of a node under one number in \
                 /interface/interface, and other tags for other nodes",
                of.join(" and ")
            ),
        })
    }
}

/// A number that occurs twice in a list.
fn repeated(mut list: Vec<i64>) -> Option<i64> {
    list.sort_unstable();
    let twice = list.windows(2).find(|two| two[0] == two[1]);
    twice.map(|two| two[0])
}

/// Description of a difference between two copies of a node.
fn difference(a: &SharedNode, b: &SharedNode) -> Option<&'static str> {
    if a.point != b.point {
        Some("coordinates (/VTKHDF/Points)")
    } else if a.tag != b.tag {
        Some("tag (/VTKHDF/PointData/GlobalNodeId)")
    } else if a.supports != b.supports {
        Some("supports (/support)")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(interface: u32, tag: i64, x: f64) -> SharedNode {
        SharedNode {
            interface,
            tag,
            point: [x, 0.0, 0.0],
            supports: Vec::new(),
        }
    }

    fn nodes(inner: &[i64], shared: Vec<SharedNode>) -> OwnNodes {
        OwnNodes {
            inner: inner.to_vec(),
            on_interface: shared.iter().map(|n| (n.tag, n.interface)).collect(),
            shared,
        }
    }

    /// The message of a comparison in this number of parts.
    fn found(subdomains: &[OwnNodes], parts: usize) -> Option<String> {
        let mut copies = vec![NodeCopies::default(); parts];
        for (s, nodes) in subdomains.iter().enumerate() {
            for (copies, part) in copies.iter_mut().zip(nodes.clone().parts(parts)) {
                copies.add(s, part);
            }
        }
        let first = copies.into_iter().filter_map(NodeCopies::check).min();
        first.map(|fault| fault.message)
    }

    #[test]
    fn parts_find_what_the_whole_finds() {
        let right = || {
            vec![
                nodes(&[1, 2], vec![node(0, 10, 0.5), node(1, 11, 0.0)]),
                nodes(&[3], vec![node(0, 10, 0.5)]),
                nodes(&[4, -5], vec![node(0, 10, 0.5), node(1, 11, 0.0)]),
            ]
        };
        let mut cases = vec![(right(), None)];
        let mut moved = right();
        moved[2].shared[1].point[0] = 1.0;
        moved[1].inner[0] = 2;
        cases.push((
            moved,
            Some("node 1 on Γ: the subdomains 0 and 2 disagree on its coord"),
        ));
        let mut renamed = right();
        renamed[1] = nodes(&[3], vec![node(0, 12, 0.5)]);
        cases.push((
            renamed,
            Some("node 0 on Γ: the subdomains 0 and 1 disagree on its tag"),
        ));
        let mut twice = right();
        twice[2].inner = vec![3, 1];
        cases.push((
            twice,
            Some("the subdomains 0 and 2 have a node of tag 1 each"),
        ));
        let mut inside = right();
        inside[1].inner[0] = 11;
        cases.push((
            inside,
            Some("the subdomains 0 and 1 have a node of tag 11 each"),
        ));
        let mut two_numbers = right();
        two_numbers[0] = nodes(&[1], vec![node(0, 10, 0.5), node(2, 10, 0.0)]);
        cases.push((
            two_numbers,
            Some("the subdomains 0 and 0 have a node of tag 10 each"),
        ));
        for (subdomains, expected) in cases {
            let whole = found(&subdomains, 1);
            match expected {
                Some(words) => assert!(whole.as_ref().unwrap().contains(words), "{whole:?}"),
                None => assert_eq!(whole, None),
            }
            for parts in [2, 3, 7] {
                assert_eq!(found(&subdomains, parts), whole);
            }
        }
    }
}
