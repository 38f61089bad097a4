//! Nodes that represent reference points, with their loads.

use std::collections::BTreeMap;

use crate::scene::coupling::COMPONENTS;

/// A node and a component from 0: the translations along the axes, then for a reference node the rotations.
pub(super) type NodeAxis = (u32, usize);

/// Number of translations and rotations of a reference node.
pub(super) const FREEDOMS: usize = COMPONENTS.len();

/// The degrees of freedom of a reference node in the plane: along x and y, and about z.
const IN_THE_PLANE: [usize; 3] = [0, 1, 5];

/// The components that the degrees of freedom of a reference node represent.
#[derive(Clone, Copy)]
pub(super) struct Reference {
    /// The reference node.
    pub(super) node: u32,
    /// Component that is the node's first degree of freedom: 3 for a node that represents rotations.
    pub(super) first: usize,
    /// The components that are coupled.
    pub(super) coupled: [bool; FREEDOMS],
    /// True if its components are along the axes of an orientation.
    pub(super) is_local: bool,
}

/// The loads on a reference node at the end of a step, and its prescribed displacements.
#[derive(Clone, Default)]
pub(super) struct AtReference {
    pub(super) load: [f64; FREEDOMS],
    pub(super) held: [Option<f64>; FREEDOMS],
}

impl Reference {
    /// The reference point of a pretension's node, whose first degree of freedom is the force or the shortening.
    pub(super) fn of_pretension(node: u32) -> Self {
        Self {
            node,
            first: 0,
            coupled: std::array::from_fn(|freedom| freedom == 0),
            is_local: false,
        }
    }

    /// True for a pretension: couplings have more than one component.
    pub(super) fn is_of_pretension(&self) -> bool {
        self.coupled.iter().filter(|&&coupled| coupled).count() == 1
    }

    /// The component of a degree of freedom, from 0, in an equation or a spring.
    ///
    /// # Errors
    /// A component that doesn't exist or isn't coupled, a reference point that equations can't refer to.
    pub(super) fn of_equation(&self, freedom: usize, dim: usize) -> Result<NodeAxis, &'static str> {
        match self.component(freedom, dim) {
            _ if self.is_of_pretension() => {
                Err("is one of a *PRE-TENSION SECTION, which takes loads and supports only")
            }
            _ if self.is_local => Err(
                "is one of a *DISTRIBUTING coupling with ORIENTATION, which takes loads only; expected no orientation",
            ),
            Some(component) => Ok(component),
            None => Err(
                "doesn't move its coupling along this degree of freedom; expected one that is coupled",
            ),
        }
    }

    /// The reference node and its component for a degree of freedom, from 0; `None` if the component doesn't exist in
    /// `dim` dimensions or isn't coupled.
    pub(super) fn component(&self, freedom: usize, dim: usize) -> Option<NodeAxis> {
        let component = self.first + freedom;
        let is_coupled = self.coupled.get(component) == Some(&true);
        let is_here = dim == 3 || IN_THE_PLANE.contains(&component);
        (is_coupled && is_here).then_some((self.node, component))
    }
}

impl AtReference {
    /// The states of all reference nodes, from loads and prescribed displacements by node and component.
    pub(super) fn all(
        loads: Vec<(NodeAxis, f64)>,
        held: Vec<(NodeAxis, f64)>,
    ) -> BTreeMap<u32, Self> {
        let mut all: BTreeMap<u32, Self> = BTreeMap::new();
        for ((node, k), load) in loads {
            all.entry(node).or_default().load[k] = load;
        }
        for ((node, k), value) in held {
            all.entry(node).or_default().held[k] = Some(value);
        }
        all
    }
}
