//! Initial stress σ_i, the stress of cells without strain: residual stress and the stress of a body whose thermal
//! expansion is prevented, σ = C (ε − ε_T) + σ_0 = C ε + σ_i. It loads nodes with f_i = −∫ Bᵀ σ_i dx.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};

use nalgebra::Matrix3;

use super::bodies::Bodies;
use super::rules::rule_of_cells;
use super::{Material, PlaneState};
use crate::element::geometry::advance;
use crate::element::quadrature::TabulatedPoint;
use crate::error::InputError;
use crate::magnitude;
use crate::scene::Scene;
use crate::scene::loading::Loading;
use crate::scene::number::Number;

/// A stress in the order of results: XX YY ZZ XY YZ XZ (Pa).
pub type Stress = [f64; 6];

/// σ_i in a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialStress {
    /// The average over every cell; empty if no body of the scene has initial stress.
    pub cells: Vec<Stress>,
    /// The measure of every cell of a body with initial stress (m², m³; around an axis that of the ring).
    pub measures: Vec<f64>,
    /// Stresses by node and material; each body with initial stress has a separate material.
    pub nodes: HashMap<(u32, u32), Stress>,
}

/// σ_i of one body in a load step.
struct StressField<'a> {
    initial: Option<(&'a crate::scene::initial::InitialStress, f64)>,
    /// σ_i per kelvin, and the temperature with its factor.
    thermal: Option<(Stress, &'a Number, f64)>,
}

impl StressField<'_> {
    fn at(&self, x: [f64; 3]) -> Result<Stress, String> {
        let mut sum = [0.0; 6];
        let mut add = |factor: f64, stress: Stress| {
            sum = std::array::from_fn(|k| sum[k] + factor * stress[k]);
        };
        if let Some((initial, scale)) = self.initial {
            add(scale, initial.at(x)?);
        }
        if let Some((of_degree, temperature, scale)) = self.thermal {
            add(scale * temperature.at(x)?, of_degree);
        }
        match sum
            .into_iter()
            .try_for_each(|s| magnitude::check(s).map(drop))
        {
            Ok(()) => Ok(sum),
            Err(expected) => Err(format!("a stress of {sum:?}; expected {expected}")),
        }
    }

    fn is_constant(&self) -> bool {
        self.initial
            .is_none_or(|(initial, _)| initial.is_constant())
            && self
                .thermal
                .is_none_or(|(_, t, _)| matches!(t, Number::Constant(_)))
    }
}

impl InitialStress {
    /// σ_i of a loading of `scene`, whose nodal forces are added to `forces`.
    pub(super) fn new(
        scene: &Scene,
        loading: &Loading,
        bodies: &Bodies,
        materials: &[Material],
        forces: &mut [[f64; 3]],
    ) -> Result<Self, InputError> {
        let mut all = Self::default();
        if !scene
            .bodies
            .values()
            .any(crate::scene::condition::Body::has_initial_stress)
        {
            return Ok(all);
        }
        all.cells.resize(bodies.mesh.cells.len(), [0.0; 6]);
        all.measures.resize(bodies.mesh.cells.len(), 0.0);
        for (number, (name, body)) in (0..).zip(&scene.bodies) {
            if !body.has_initial_stress() {
                continue;
            }
            let initial = body.initial_stress.as_ref();
            let what = match (initial, &body.thermal) {
                (Some(_), None) => format!("bodies.{name}.initial_stress"),
                (None, _) => format!("bodies.{name}.thermal"),
                _ => format!("bodies.{name}"),
            };
            let cell = bodies.cell_body.iter().position(|&body| body == number);
            let material = &materials[cell.map_or(0, |cell| bodies.cell_material[cell] as usize)];
            let thermal = body.thermal.as_ref().map(|thermal| {
                let of_degree = of_degree(material, scene.plane, thermal.expansion.0)?;
                let temperature =
                    loading.temperature[number as usize].unwrap_or(&thermal.temperature);
                Ok((of_degree, temperature, loading.scale.thermal))
            });
            let field = StressField {
                initial: initial.map(|initial| (initial, loading.scale.initial_stress)),
                thermal: thermal.transpose().map_err(InputError::about(&what))?,
            };
            all.add(scene.plane, bodies, number, &field, forces)
                .map_err(InputError::about(&what))?;
        }
        Ok(all)
    }

    fn add(
        &mut self,
        plane: Option<PlaneState>,
        bodies: &Bodies,
        body: u32,
        field: &StressField,
        forces: &mut [[f64; 3]],
    ) -> Result<f64, String> {
        let mesh = &bodies.mesh;
        let mut rules = BTreeMap::new();
        let mut whole = 0.0;
        for (cell, (kind, nodes)) in mesh.cells.iter().enumerate() {
            if bodies.cell_body[cell] != body {
                continue;
            }
            let formulation = bodies.formulation(cell);
            let rule = (rules.entry(kind))
                .or_insert_with(|| rule_of_cells(kind, formulation, plane, field.is_constant()));
            let at: Vec<_> = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
            for (&node, &x) in nodes.iter().zip(&at) {
                let key = (node, bodies.cell_material[cell]);
                if let Entry::Vacant(place) = self.nodes.entry(key) {
                    place.insert(field.at(x)?);
                }
            }
            let (mut sum, mut measure) = ([0.0; 6], 0.0);
            for point in rule.iter() {
                let shape = point.shape.iter().zip(&at);
                let x = shape.fold([0.0; 3], |sum, (&n, &p)| advance(sum, n, p));
                let stress = field.at(x)?;
                let weight = point.weight
                    * kind.determinant(&point.gradients, &at)
                    * PlaneState::thickness(plane, x);
                let gradients = gradients(point, &at, mesh.dim);
                for ((&node, gradient), n) in nodes.iter().zip(gradients).zip(&point.shape) {
                    let mut force = along(&stress, gradient);
                    if plane == Some(PlaneState::Axisymmetric) {
                        force[0] += stress[2] * n / x[0];
                    }
                    let sum = &mut forces[node as usize];
                    *sum = advance(*sum, -weight, force);
                }
                sum = std::array::from_fn(|k| sum[k] + weight * stress[k]);
                measure += weight;
            }
            self.cells[cell] = sum.map(|s| s / measure);
            self.measures[cell] = measure;
            whole += measure;
        }
        Ok(whole)
    }

    /// The average over the cells of a body, weighted by their measure.
    pub(super) fn mean(&self, bodies: &Bodies, body: u32) -> Stress {
        let (mut sum, mut whole) = ([0.0; 6], 0.0);
        for (cell, (stress, measure)) in self.cells.iter().zip(&self.measures).enumerate() {
            if bodies.cell_body[cell] == body {
                sum = std::array::from_fn(|k| sum[k] + measure * stress[k]);
                whole += measure;
            }
        }
        sum.map(|s| if whole > 0.0 { s / whole } else { 0.0 })
    }
}

/// (1/V) ∫ Bᵀ σ dx over a body of measure V, node by node: the coefficients of displacements in the average of σ·ε.
///
/// # Errors
/// A stress that isn't finite.
pub(super) fn mean_weights(
    plane: Option<PlaneState>,
    bodies: &Bodies,
    body: u32,
    stress: Stress,
) -> Result<Vec<[f64; 3]>, String> {
    let mut forces = vec![[0.0; 3]; bodies.mesh.points.len()];
    let mut all = InitialStress {
        cells: vec![[0.0; 6]; bodies.mesh.cells.len()],
        measures: vec![0.0; bodies.mesh.cells.len()],
        nodes: HashMap::new(),
    };
    let field = StressField {
        initial: None,
        thermal: Some((stress, &Number::Constant(1.0), 1.0)),
    };
    let whole = all.add(plane, bodies, body, &field, &mut forces)?;
    let weights = forces.into_iter().map(|f| f.map(|f| -f / whole));
    Ok(weights.collect())
}

/// −C ε_T of an isotropic thermal expansion by `expansion` per kelvin.
fn of_degree(
    material: &Material,
    plane: Option<PlaneState>,
    expansion: f64,
) -> Result<Stress, String> {
    let c = &material.stiffness;
    let axes = if c.size() == 3 { 2 } else { 3 };
    let row = |i: usize| c[i][..axes].iter().sum::<f64>();
    let rows: Vec<f64> = (0..c.size()).map(row).collect();
    let stress = match (&rows[..], plane) {
        (&[xx, yy, xy], Some(PlaneState::Strain)) => {
            let (Some([zx, zy, _]), Some(_)) = (material.out_of_plane, material.poisson) else {
                return Err(
                    "in plane strain thermal strain needs the stiffness out of the plane; expected a material of \
                     'young' and 'poisson'"
                        .into(),
                );
            };
            // The material is isotropic, so that c_zz is c_xx.
            [xx + zx, yy + zy, zx + zy + c[0][0], xy, 0.0, 0.0]
        }
        (&[xx, yy, xy], _) => [xx, yy, 0.0, xy, 0.0, 0.0],
        (&[xx, yy, zz, xy], _) => [xx, yy, zz, xy, 0.0, 0.0],
        (&[xx, yy, zz, yz, xz, xy], _) => [xx, yy, zz, xy, yz, xz],
        _ => [0.0; 6],
    };
    Ok(stress.map(|s| -expansion * s))
}

/// ∂N_i/∂x at a point of a cell (1/m).
fn gradients(
    point: &TabulatedPoint,
    at: &[[f64; 3]],
    dim: usize,
) -> impl Iterator<Item = [f64; 3]> {
    let mut jacobian = Matrix3::identity();
    for j in 0..dim {
        for i in 0..dim {
            let terms = point.gradients.iter().zip(at);
            jacobian[(i, j)] = terms.map(|(g, x)| x[i] * g[j]).sum();
        }
    }
    let inverse = jacobian.try_inverse().unwrap_or_default().transpose();
    point.gradients.iter().map(move |g| {
        let local = nalgebra::Vector3::from_fn(|j, _| if j < dim { g[j] } else { 0.0 });
        (inverse * local).into()
    })
}

/// σ g.
fn along(&[xx, yy, zz, xy, yz, xz]: &Stress, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        xx * x + xy * y + xz * z,
        xy * x + yy * y + yz * z,
        xz * x + yz * y + zz * z,
    ]
}
