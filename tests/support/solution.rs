//! A result file as read by any HDF5 reader.

use std::collections::BTreeMap;
use std::path::Path;

use contact_dd_partition::model::Model;
use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{File, H5Type};
use serde_json::Value;

/// The results of a run.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Displacement by node tag [m].
    pub displacement: BTreeMap<i64, [f64; 3]>,
    /// Stress of every cell, with its centre [Pa].
    pub cells: Vec<([f64; 3], [f64; 6])>,
    /// Stress recovered at nodes, by node tag [Pa].
    pub nodal_stress: BTreeMap<i64, [f64; 6]>,
    /// VTK's numbers of the types of cells.
    pub types: Vec<u8>,
    /// Conditions by contact.
    pub contacts: BTreeMap<String, Vec<ContactPoint>>,
    /// The report.
    pub report: Value,
}

/// A contact condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    pub tags: [i64; 2],
    pub position: [f64; 3],
    pub normal: [f64; 3],
    pub gap: f64,
    pub force: f64,
    pub pressure: f64,
    pub closed: bool,
    /// True with friction at its bound.
    pub slipping: bool,
    /// Force on side a; 0 without friction, like the slip.
    pub tangential_force: [f64; 3],
    pub slip: [f64; 3],
}

fn column<T: H5Type>(file: &File, name: &str) -> Vec<T> {
    let dataset = file.dataset(name).unwrap_or_else(|e| panic!("{name}: {e}"));
    dataset.read_raw().unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn table<const N: usize>(file: &File, name: &str) -> Vec<[f64; N]> {
    column::<f64>(file, name).as_chunks::<N>().0.to_vec()
}

impl Solution {
    pub fn read(path: &Path) -> Self {
        Self::of_step(path, None)
    }

    /// The report of a whole run.
    pub fn read_report(path: &Path) -> Value {
        let file = File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let report: VarLenUnicode = file.attr("report").unwrap().read_scalar().unwrap();
        serde_json::from_str(report.as_str()).unwrap()
    }

    /// K_I and K_II of the crack tips (Pa √m).
    pub fn stress_intensity(&self) -> Vec<[f64; 2]> {
        let tips = self.report["crack_tips"].as_array().unwrap().iter();
        tips.map(|tip| ["k_i", "k_ii"].map(|key| tip[key].as_f64().unwrap()))
            .collect()
    }

    /// All increments: the load steps, or the single one.
    pub fn increments(path: &Path, has_steps: bool) -> Vec<Self> {
        match has_steps {
            true => Self::steps(path),
            false => vec![Self::read(path)],
        }
    }

    /// The solutions of all load steps, each with the report's entry as its report.
    pub fn steps(path: &Path) -> Vec<Self> {
        let file = File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let times = column::<f64>(&file, "VTKHDF/Steps/Values");
        let steps = 0..times.len();
        steps
            .map(|k| Self::of_step(path, Some((k, times.len()))))
            .collect()
    }

    /// Step k of that many; `None` for a file without steps.
    fn of_step(path: &Path, step: Option<(usize, usize)>) -> Self {
        let file = File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let tags = column::<i64>(&file, "VTKHDF/PointData/GlobalNodeId");
        let displacement = field::<3>(&file, "VTKHDF/PointData/Displacement", step);
        let report: VarLenUnicode = file.attr("report").unwrap().read_scalar().unwrap();
        let names = file.group("contact").map(|g| g.member_names().unwrap());
        let contacts = (names.unwrap_or_default().into_iter())
            .map(|name| {
                (
                    name.clone(),
                    points(&file, &format!("contact/{name}"), step),
                )
            })
            .collect();
        let nodal_stress = field::<6>(&file, "VTKHDF/PointData/Stress", step);
        let report: Value = serde_json::from_str(report.as_str()).unwrap();
        Self {
            nodal_stress: tags.iter().copied().zip(nodal_stress).collect(),
            types: column::<u8>(&file, "VTKHDF/Types"),
            displacement: tags.into_iter().zip(displacement).collect(),
            cells: cells(&file, step),
            contacts,
            report: step.map_or(&report, |(k, _)| &report["steps"][k]).clone(),
        }
    }

    /// Displacement in the order of the model's nodes, with the dofs of a node in a row.
    pub fn dofs(&self, model: &Model) -> Vec<f64> {
        let tags = model.mesh.node_tags.iter();
        tags.flat_map(|tag| self.displacement[tag][..model.mesh.dim].to_vec())
            .collect()
    }

    pub fn largest_displacement(&self) -> f64 {
        let components = self.displacement.values().flatten();
        components.fold(0.0, |m, u| m.max(u.abs()))
    }

    pub fn largest_force(&self) -> f64 {
        self.points().fold(0.0, |m, point| m.max(point.force))
    }

    /// The points of all contacts.
    pub fn points(&self) -> impl Iterator<Item = &ContactPoint> {
        self.contacts.values().flatten()
    }

    pub fn closed(&self) -> usize {
        self.points().filter(|point| point.closed).count()
    }

    pub fn slipping(&self) -> usize {
        self.points().filter(|point| point.slipping).count()
    }

    pub fn sweeps(&self) -> u64 {
        self.report["sweeps"].as_u64().unwrap()
    }

    /// Fails unless the certificate fulfils the targets of the design.
    #[track_caller]
    pub fn check_certificate(&self) {
        let limits = [
            ("equilibrium", 1e-14),
            ("penetration", 1e-14),
            ("tension", 1e-12),
            ("complementarity", 1e-12),
            ("force_balance", 1e-9),
            ("moment_balance", 1e-9),
            ("interface_jump", 1e-14),
        ];
        let certificate = &self.report["certificate"];
        for (name, limit) in limits {
            let value = certificate[name].as_f64();
            assert!(
                value.is_some_and(|value| value <= limit),
                "{name} is {value:?}; expected at most {limit:e}\n{certificate:#}"
            );
        }
        // Only with friction.
        let friction = certificate["friction"].as_f64().unwrap_or(0.0);
        assert!(friction <= 1e-9, "friction is {friction:e}");
    }
}

/// Every dataset of a result file except times, bit by bit.
pub fn datasets(result: &Path) -> BTreeMap<String, Vec<u64>> {
    let file = File::open(result).unwrap();
    let mut all = BTreeMap::new();
    let mut groups = vec![file.group("/").unwrap()];
    while let Some(group) = groups.pop() {
        groups.extend(group.groups().unwrap());
        for dataset in group.datasets().unwrap() {
            fn bits<T: H5Type>(dataset: &hdf5::Dataset, as_bits: impl Fn(&T) -> u64) -> Vec<u64> {
                dataset
                    .read_raw::<T>()
                    .unwrap()
                    .iter()
                    .map(as_bits)
                    .collect()
            }
            let values = match is_real(&dataset) {
                true => bits::<f64>(&dataset, |x| x.to_bits()),
                false => bits::<i64>(&dataset, |x| *x as u64),
            };
            all.insert(dataset.name(), values);
        }
    }
    all.retain(|name, _| !name.ends_with("/seconds"));
    all
}

fn is_real(dataset: &hdf5::Dataset) -> bool {
    let descriptor = dataset.dtype().unwrap().to_descriptor().unwrap();
    matches!(descriptor, TypeDescriptor::Float(_))
}

/// Kinds of numbers in a result by the last parts of their datasets' names: lengths, forces and statuses.
const KINDS: [&[&str]; 3] = [
    &["displacement", "gap", "slip"],
    &["force", "tangential_force"],
    &["status"],
];

/// The largest difference between displacements, jumps, forces and statuses of two result files, relative to the
/// largest number of the same kind, and its dataset; infinite where only one file has a number.
pub fn difference(a: &Path, b: &Path) -> (f64, String) {
    let (a, b) = (numbers(a), numbers(b));
    let mut worst = (0.0, "all".to_owned());
    for kind in KINDS {
        let is_one = |name: &&String| {
            kind.iter()
                .any(|last| name.rsplit('/').next() == Some(last))
        };
        let names: Vec<&String> = a.keys().chain(b.keys()).filter(is_one).collect();
        let values = names.iter().filter_map(|name| a.get(*name)).flatten();
        let values = values.filter(|x| x.is_finite());
        let size = values.fold(f64::MIN_POSITIVE, |m: f64, x| m.max(x.abs()));
        for name in names {
            let difference = match (a.get(name), b.get(name)) {
                (Some(a), Some(b)) if a.len() == b.len() => farthest(a, b) / size,
                _ => f64::INFINITY,
            };
            if difference > worst.0 {
                worst = (difference, name.clone());
            }
        }
    }
    worst
}

/// Every dataset of a result file.
fn numbers(result: &Path) -> BTreeMap<String, Vec<f64>> {
    let file = File::open(result).unwrap();
    let number = |is_real: bool, bits: u64| match is_real {
        true => f64::from_bits(bits),
        false => bits as i64 as f64,
    };
    let all = datasets(result).into_iter().map(|(name, values)| {
        let is_real = is_real(&file.dataset(&name).unwrap());
        let values = values.into_iter().map(|bits| number(is_real, bits));
        (name, values.collect())
    });
    all.collect()
}

/// The largest difference of two lists; infinite where only one has a number.
fn farthest(a: &[f64], b: &[f64]) -> f64 {
    let differences = a
        .iter()
        .zip(b)
        .map(|(a, b)| match (a.is_nan(), b.is_nan()) {
            (true, true) => 0.0,
            (false, false) if a == b => 0.0,
            (false, false) => (a - b).abs(),
            _ => f64::INFINITY,
        });
    differences.fold(0.0, f64::max)
}

/// The part of a list that belongs to step k of that many.
fn part<T: Copy>(all: Vec<T>, step: Option<(usize, usize)>) -> Vec<T> {
    let Some((k, count)) = step else {
        return all;
    };
    let rows = all.len() / count;
    all[k * rows..(k + 1) * rows].to_vec()
}

fn field<const N: usize>(file: &File, name: &str, step: Option<(usize, usize)>) -> Vec<[f64; N]> {
    part(table::<N>(file, name), step)
}

fn points(file: &File, group: &str, step: Option<(usize, usize)>) -> Vec<ContactPoint> {
    let reals = |name: &str| part(column::<f64>(file, &format!("{group}/{name}")), step);
    let vectors = |name: &str| table::<3>(file, &format!("{group}/{name}"));
    let tags = |name: &str| column::<i64>(file, &format!("{group}/{name}"));
    let (a, b) = (tags("node_a"), tags("node_b"));
    let (position, normal) = (vectors("position"), vectors("normal"));
    let (gap, force, pressure) = (reals("gap"), reals("force"), reals("pressure"));
    let status = part(column::<u8>(file, &format!("{group}/status")), step);
    // Only with friction.
    let of_friction = |name: &str| match file.dataset(&format!("{group}/{name}")) {
        Ok(_) => part(vectors(name), step),
        Err(_) => vec![[0.0; 3]; gap.len()],
    };
    let (tangential_force, slip) = (of_friction("tangential_force"), of_friction("slip"));
    let all = [position.len(), normal.len(), gap.len(), force.len()];
    assert!(all.iter().all(|&n| n == a.len()), "{group}: {all:?} rows");
    (0..a.len())
        .map(|i| ContactPoint {
            tags: [a[i], b[i]],
            position: position[i],
            normal: normal[i],
            gap: gap[i],
            force: force[i],
            pressure: pressure[i],
            closed: status[i] != 0,
            slipping: status[i] == 2,
            tangential_force: tangential_force[i],
            slip: slip[i],
        })
        .collect()
}

fn cells(file: &File, step: Option<(usize, usize)>) -> Vec<([f64; 3], [f64; 6])> {
    let counts = |name: &str| column::<i64>(file, &format!("VTKHDF/{name}"));
    let points = table::<3>(file, "VTKHDF/Points");
    let connectivity = counts("Connectivity");
    let offsets = counts("Offsets");
    let stress = field::<6>(file, "VTKHDF/CellData/Stress", step);
    let mut list = Vec::with_capacity(stress.len());
    let (mut first_point, mut first_entry, mut first_offset) = (0, 0, 0);
    for ((n, m), c) in (counts("NumberOfPoints").iter())
        .zip(counts("NumberOfCells"))
        .zip(counts("NumberOfConnectivityIds"))
    {
        for cell in 0..m as usize {
            let ends = &offsets[first_offset + cell..][..2];
            let nodes = &connectivity[first_entry..][ends[0] as usize..ends[1] as usize];
            let mut centre = [0.0; 3];
            for &node in nodes {
                for (c, x) in centre.iter_mut().zip(points[first_point + node as usize]) {
                    *c += x / nodes.len() as f64;
                }
            }
            list.push((centre, stress[list.len()]));
        }
        first_point += *n as usize;
        first_entry += c as usize;
        first_offset += m as usize + 1;
    }
    list
}
