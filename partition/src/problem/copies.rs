//! What subdomains must agree on: a node that several have, and that nodes are told apart by tag.

use serde::{Deserialize, Serialize};

use super::{Catalog, Subdomain};
use crate::error::InputError;

/// What a subdomain says of one of its nodes on Γ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SharedNode {
    /// Its number on Γ.
    pub interface: u32,
    /// The mesh file's tag.
    pub tag: i64,
    /// Coordinates (m).
    pub point: [f64; 3],
    /// Directions of its supports, and their values, one for each load step.
    pub supports: Vec<([f64; 3], Vec<f64>)>,
}

/// The nodes of a subdomain, as far as others are concerned.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OwnNodes {
    /// Tags of those that aren't on Γ.
    pub inner: Vec<i64>,
    /// Those on Γ.
    pub shared: Vec<SharedNode>,
}

impl Subdomain {
    /// Its nodes, as far as others are concerned.
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
        let shared = shared.collect();
        let nodes = self.node_tags.iter().zip(&is_shared);
        OwnNodes {
            inner: nodes.filter(|&(_, on)| !on).map(|(&tag, _)| tag).collect(),
            shared,
        }
    }
}

/// The nodes of all subdomains, compared as they come in.
#[derive(Clone, Debug)]
pub struct NodeCopies {
    /// The first subdomain that has each node of Γ, and what it says of it.
    first: Vec<Option<(usize, SharedNode)>>,
    /// Tags of all nodes, those of Γ once, subdomain by subdomain.
    tags: Vec<i64>,
    /// Every subdomain and where its tags end.
    ends: Vec<(usize, usize)>,
    /// The first disagreement.
    fault: Option<InputError>,
}

impl NodeCopies {
    /// None yet of the subdomains of `catalog`.
    pub fn new(catalog: &Catalog) -> Self {
        Self {
            first: vec![None; catalog.interface_nodes],
            tags: Vec::new(),
            ends: Vec::new(),
            fault: None,
        }
    }

    /// Takes in the nodes of subdomain `index`.
    pub fn add(&mut self, index: usize, nodes: OwnNodes) {
        self.tags.extend(nodes.inner);
        for node in nodes.shared {
            match &self.first[node.interface as usize] {
                None => {
                    self.tags.push(node.tag);
                    let place = node.interface as usize;
                    self.first[place] = Some((index, node));
                }
                Some((other, known)) => {
                    if let Some(what) = difference(known, &node).filter(|_| self.fault.is_none()) {
                        self.fault = Some(InputError::new(format!(
                            "node {} on Γ: the subdomains {other} and {index} disagree on its {what}",
                            node.interface
                        )));
                    }
                }
            }
        }
        self.ends.push((index, self.tags.len()));
    }

    /// Checks that all copies of a node on Γ have the same place, tag and supports, and that no
    /// other nodes have the same tag.
    ///
    /// # Errors
    /// The first node for which that isn't so.
    pub fn check(self) -> Result<(), InputError> {
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        let Some(repeated) = repeated(&self.tags) else {
            return Ok(());
        };
        let places = (0..self.tags.len()).filter(|&place| self.tags[place] == repeated);
        let of: Vec<String> = places
            .take(2)
            .map(|place| self.ends.partition_point(|&(_, end)| end <= place))
            .map(|subdomain| self.ends[subdomain].0.to_string())
            .collect();
        Err(InputError::new(format!(
            "dataset /VTKHDF/PointData/GlobalNodeId: the subdomains {} have a node of tag {repeated} \
             each that isn't one node on Γ; expected copies of a node under one number in \
             /interface/interface, and other tags for other nodes",
            of.join(" and ")
        )))
    }
}

/// A number that stands in a list twice.
fn repeated(list: &[i64]) -> Option<i64> {
    let mut sorted = list.to_vec();
    sorted.sort_unstable();
    let twice = sorted.windows(2).find(|two| two[0] == two[1]);
    twice.map(|two| two[0])
}

/// What two copies of a node differ in.
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
