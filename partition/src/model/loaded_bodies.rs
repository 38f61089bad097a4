//! The bodies of a scene on its mesh with all loads and supports, before contacts and equations join them.

use super::adjust;
use super::bodies::{self, Bodies};
use super::parts::Material;
use super::pretension;
use super::springs::Springs;
use super::steps::Loads;
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::material::PlaneState;

/// Bodies on the mesh with their materials, loads, supports and springs to the ground.
pub(super) struct LoadedBodies {
    pub bodies: Bodies,
    /// The pairs of nodes of each cut through a bolt.
    pub cuts: Vec<Vec<[u32; 2]>>,
    pub topology: Topology,
    pub materials: Vec<Material>,
    pub loads: Loads,
    pub springs: Springs,
}

impl LoadedBodies {
    /// The bodies of a scene, with nodes moved where a tie requests it.
    ///
    /// # Errors
    /// Groups that don't exist, or supports that contradict each other.
    pub fn new(
        scene: &Scene,
        mesh: Mesh,
        plane: Option<PlaneState>,
        warnings: &mut Vec<String>,
    ) -> Result<Self, InputError> {
        let mut bodies = Bodies::new(scene, mesh, warnings)?;
        let cuts = pretension::cut(scene, &mut bodies)?;
        let topology = Topology::new(&bodies.mesh);
        (topology.check_sides(&bodies.mesh)).map_err(|error| error.in_file(&scene.mesh))?;
        adjust::adjust(scene, &mut bodies, &topology, warnings)?;
        let materials = bodies.with_variants(bodies::materials(scene, plane));
        let loads = Loads::new(scene, &bodies, &topology, &materials)?;
        let springs = Springs::new(scene, &bodies, &topology, loads.names.len())?;
        Ok(Self {
            bodies,
            cuts,
            topology,
            materials,
            loads,
            springs,
        })
    }

    /// Moves out the names of the boundary conditions that prescribe displacements, followed by those of springs.
    pub fn take_support_names(&mut self) -> Vec<String> {
        let own = std::mem::take(&mut self.loads.names).into_iter();
        own.chain(std::mem::take(&mut self.springs.names)).collect()
    }
}
