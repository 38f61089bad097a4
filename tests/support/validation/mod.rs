//! Scenes with exact solutions, refined step by step: errors and their orders of convergence.
//!
//! `tests/scenes/validation.rs` tests the first refinements against gates; `scripts/validate` runs more and writes all
//! to docs/validation.md.

pub mod beam;
pub mod crack;
pub mod exact;
pub mod half_space;
pub mod hertz;
pub mod hole;
pub mod indentation;
pub mod mindlin;
pub mod mindlin_in_space;
pub mod punch;
pub mod raous;
pub mod ring;
pub mod roller;
pub mod signorini;
pub mod space;
pub mod uniform;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::mesh::{Group, Mesh};
use contact_dd_partition::model::Model;

use self::exact::Exact;
use super::solution::Solution;
use super::solver;

/// The figure of the certificate that every answer has to fulfil, and its target.
const BACKWARD_ERROR: &str = "backward error";
const CERTIFIED: Gate = Gate::AtMost(BACKWARD_ERROR, 1e-14);

/// The kinds of cells of built-in scenes, by the names of [`super::sorts`].
pub const KINDS: [(&str, ElementKind); 5] = [
    ("triangle3", ElementKind::Triangle3),
    ("quad4", ElementKind::Quad4),
    ("triangle6", ElementKind::Triangle6),
    ("quad8", ElementKind::Quad8),
    ("quad9", ElementKind::Quad9),
];

/// A scene with an exact solution.
pub struct Case {
    pub title: &'static str,
    /// Formula, source and mesh, in Markdown.
    pub text: &'static str,
    pub families: Vec<Family>,
}

/// Meshes of one kind of cells, each with half the cell size of the one before.
pub struct Family {
    pub name: String,
    /// Solves the scene on a mesh refined this many times.
    pub run: Box<dyn Fn(usize) -> Measured>,
    /// Number of meshes in the tests, which may be none, and in the document.
    pub meshes: [usize; 2],
    pub gates: Vec<Gate>,
}

/// Results on one mesh.
pub struct Measured {
    pub dofs: usize,
    pub figures: Vec<Figure>,
}

/// A measured figure, such as an error.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    pub name: &'static str,
    pub value: f64,
    /// True if it falls with a power of the mesh size.
    pub has_order: bool,
}

/// A condition on figures.
#[derive(Clone, Copy, Debug)]
pub enum Gate {
    /// Least order of convergence between the last two meshes.
    Order(&'static str, f64),
    /// Largest value of the figure on the finest mesh.
    AtMost(&'static str, f64),
}

/// All cases, in the order of the document.
pub fn cases() -> Vec<Case> {
    vec![
        uniform::patch(),
        uniform::uneven(),
        uniform::junction(),
        hertz::on_an_obstacle(),
        hertz::body_on_body(),
        hertz::uneven_bodies(),
        roller::case(),
        roller::with_friction(),
        crack::case(),
        crack::with_friction(),
        raous::case(),
        mindlin::case(),
        punch::case(),
        ring::ball(),
        ring::balls(),
        ring::punch(),
        signorini::case(),
        beam::case(),
        hole::case(),
        space::ball(),
        space::balls(),
        space::layers(),
        indentation::ball(),
        indentation::punch(),
        indentation::force(),
        mindlin_in_space::case(),
    ]
}

/// An error with an order of convergence.
pub fn falling(name: &'static str, value: f64) -> Figure {
    let has_order = true;
    Figure {
        name,
        value: value.abs(),
        has_order,
    }
}

/// An error that falls irregularly, or not at all.
pub fn plain(name: &'static str, value: f64) -> Figure {
    let has_order = false;
    Figure {
        name,
        value: value.abs(),
        has_order,
    }
}

/// Function that computes figures from a solution.
pub type Figures = Box<dyn Fn(&Solution) -> Vec<Figure>>;

/// Solves a model, with a number of subdomains that suits its size.
pub fn figured(model: &Model, figures: impl Fn(&Solution) -> Vec<Figure>) -> Measured {
    figured_steps(model, |solutions| figures(&solutions[0]))
}

/// Solves all increments of a model, with a number of subdomains that suits its size.
pub fn figured_steps(model: &Model, figures: impl Fn(&[Solution]) -> Vec<Figure>) -> Measured {
    let dofs = model.mesh.dim * model.mesh.points.len();
    let case = solver::Case::new(&solver::problem(model, None));
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let solutions = Solution::increments(&case.result(), !model.steps.is_empty());
    let report = Solution::read_report(&case.result());
    let backward = report["certificate"]["equilibrium"].as_f64();
    let backward = plain(BACKWARD_ERROR, backward.unwrap());
    Measured {
        dofs,
        figures: [figures(&solutions), vec![backward]].concat(),
    }
}

/// A scene on a mesh, with its exact solution.
pub struct Posed {
    pub model: Model,
    pub exact: Exact,
    /// Figures besides the energy error.
    pub figures: Figures,
}

impl Posed {
    /// Number of unknowns, including prescribed ones.
    pub fn dofs(&self) -> usize {
        self.model.mesh.dim * self.model.mesh.points.len()
    }

    /// The error in the energy norm, then the other figures.
    pub fn errors(&self, solution: &Solution) -> Vec<Figure> {
        let energy = self.exact.energy_error(&self.model, solution);
        [vec![falling("energy", energy)], (self.figures)(solution)].concat()
    }

    /// Solves the scene, with a number of subdomains that suits its size, and measures its errors.
    pub fn measured(&self) -> Measured {
        figured(&self.model, |solution| self.errors(solution))
    }
}

/// The measurements of [`Posed::measured`] of a scene on a mesh.
pub fn measured(
    model: Model,
    exact: Exact,
    figures: impl Fn(&Solution) -> Vec<Figure> + 'static,
) -> Measured {
    let figures = Box::new(figures);
    let posed = Posed {
        model,
        exact,
        figures,
    };
    posed.measured()
}

/// Merges groups into one.
pub fn gather(mesh: &mut Mesh, name: &str, of: &[&str]) {
    let groups: Vec<Group> = of.iter().map(|old| mesh.groups[*old].clone()).collect();
    let members = groups.iter().flat_map(|group| group.members.clone());
    let (dim, members) = (groups[0].dim, members.collect());
    mesh.groups.insert(name.into(), Group { dim, members });
}

impl Family {
    /// Runs the first `count` meshes.
    pub fn measure(&self, count: usize) -> Vec<Measured> {
        (0..count).map(&self.run).collect()
    }

    /// The failed gates, in words.
    pub fn faults(&self, all: &[Measured]) -> Vec<String> {
        let last = &all[all.len() - 1];
        let value = |measured: &Measured, name: &str| {
            let figure = measured.figures.iter().find(|figure| figure.name == name);
            figure.unwrap_or_else(|| panic!("no figure {name}")).value
        };
        let broken = |gate: &Gate| match *gate {
            Gate::Order(name, least) => {
                let order = (value(&all[all.len() - 2], name) / value(last, name)).log2();
                (order.is_nan() || order < least)
                    .then(|| format!("{name}: order {order:.3}; expected at least {least}"))
            }
            Gate::AtMost(name, most) => {
                let value = value(last, name);
                (value.is_nan() || value > most)
                    .then(|| format!("{name}: {value:.2e}; expected at most {most:.1e}"))
            }
        };
        let gates = self.gates.iter().chain([&CERTIFIED]);
        gates.filter_map(broken).collect()
    }
}

impl Case {
    /// Runs the meshes of the tests and fails if a gate does.
    #[track_caller]
    pub fn check(&self) {
        let mut faults = Vec::new();
        for family in self.families.iter().filter(|family| family.meshes[0] > 0) {
            let all = family.measure(family.meshes[0]);
            for measured in &all {
                println!(
                    "{}: {} dofs, {:?}",
                    family.name, measured.dofs, measured.figures
                );
            }
            let found = family.faults(&all).into_iter();
            faults.extend(found.map(|fault| format!("{}, {fault}", family.name)));
        }
        assert!(faults.is_empty(), "{}:\n{}", self.title, faults.join("\n"));
    }
}
