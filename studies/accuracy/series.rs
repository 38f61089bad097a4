//! The meshes: scene × element × grading, each with half the size of the one before.

use crate::support::sorts::sort;
use crate::support::validation::hertz::{GRADING, posed_on_an_obstacle};
use crate::support::validation::{KINDS, Posed, signorini};

/// The two scenes, by the names of the document.
pub const SCENES: [&str; 2] = ["Hertz", "Signorini"];

/// Meshes of one kind of cells.
pub struct Series {
    pub scene: &'static str,
    pub element: &'static str,
    pub mesh: &'static str,
    pub is_quadratic: bool,
    /// Makes the scene on the mesh of a level.
    pub pose: Box<dyn Fn(usize) -> Posed>,
    /// Number of meshes.
    pub levels: usize,
}

impl Series {
    /// Element and mesh.
    pub fn name(&self) -> String {
        format!("{}, {}", self.element, self.mesh)
    }
}

/// All of them.
pub fn all() -> Vec<Series> {
    let mut list = Vec::new();
    for (mesh, grading) in [("uniform", 1.0), ("graded", GRADING)] {
        for (element, _) in KINDS {
            let sort = sort(element);
            list.push(Series {
                scene: SCENES[0],
                element,
                mesh,
                is_quadratic: sort.is_quadratic,
                // Linear cells need twice as many for as many dofs.
                pose: Box::new(move |level| {
                    let n = if sort.is_quadratic { 1 } else { 2 };
                    posed_on_an_obstacle(sort, n << level, grading)
                }),
                levels: 5 - usize::from(sort.is_quadratic),
            });
        }
    }
    for (element, _) in KINDS {
        let is_quadratic = sort(element).is_quadratic;
        list.push(Series {
            scene: SCENES[1],
            element,
            mesh: if element == "quad8" {
                "squares"
            } else {
                "irregular"
            },
            is_quadratic,
            pose: Box::new(move |level| {
                let n = if is_quadratic { 3 } else { 6 };
                signorini::posed(element, n << level)
            }),
            levels: 6 - usize::from(is_quadratic),
        });
    }
    list
}
