//! Punches on blocks, a quarter of each in space and a half in the plane, whose meshes don't match.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::blocks::{Blocks, joined};
use crate::random::Random;
use crate::scenes::model;
use crate::solids::{between, moved, solid};

/// The height of a block, and its width.
pub const BLOCK: f64 = 10.0;

/// A punch pressed on a block by 100 Pa on its top, held by symmetry alone along x and y.
#[derive(Clone, Debug)]
pub struct Punch {
    /// The kind of cells; `None` for squares in the plane.
    pub kind: Option<ElementKind>,
    /// Cells along the edges of the block.
    pub block: usize,
    /// Cells across the punch.
    pub across: usize,
    /// Its half-width (m).
    pub width: f64,
    /// The radius of its lower face; infinite where that is flat (m).
    pub radius: f64,
}

impl Punch {
    /// One of any size and any radius on any mesh.
    pub fn random(random: &mut Random) -> Self {
        let kinds = [
            None,
            Some(ElementKind::Hexahedron8),
            Some(ElementKind::Tetrahedron4),
            Some(ElementKind::Hexahedron20),
        ];
        Self {
            kind: random.pick(&kinds),
            block: random.count(2, 6),
            across: random.count(2, 6),
            width: random.within(1.0, 5.0),
            radius: random.pick(&[10.0, 30.0, 100.0, f64::INFINITY]),
        }
    }

    /// Its mesh.
    pub fn mesh(&self) -> Mesh {
        let Self { width, radius, .. } = *self;
        let height = 1.5 * width;
        let rounded =
            move |far: f64, up: f64| (BLOCK + height - up) / height * far / (2.0 * radius);
        let Some(kind) = self.kind else {
            let [n, m] = [self.block, self.across];
            let blocks = Blocks::new()
                .rectangle("block", [0.0, BLOCK], [0.0, BLOCK], [n, n])
                .mapped("punch", [m, 3], |[s, t]| {
                    let [x, y] = [width * s, BLOCK + height * t];
                    [x, y + rounded(x * x, y)]
                });
            return blocks.mesh;
        };
        let block = solid(
            "block",
            kind,
            [self.block; 3],
            between([0.0; 3], [BLOCK; 3]),
        );
        let low = [0.0, 0.0, BLOCK];
        let high = [width, width, BLOCK + height];
        let punch = solid(
            "punch",
            kind,
            [self.across, self.across, 3],
            between(low, high),
        );
        let punch = moved(punch, |[x, y, z]| [x, y, z + rounded(x * x + y * y, z)]);
        joined(block, punch)
    }

    /// The names of the sides that touch: of the block, of the punch.
    pub fn sides(&self) -> [&'static str; 2] {
        match self.kind {
            None => ["block top", "punch bottom"],
            Some(_) => ["block z1", "punch z0"],
        }
    }

    /// The model with these two sides in their order.
    pub fn model(&self, [a, b]: [&str; 2]) -> Model {
        let (held, top, plane) = match self.kind {
            None => (
                "['block left', 'punch left', 'block bottom']",
                "punch top",
                "plane = 'strain'",
            ),
            Some(_) => (
                "['block x0', 'block y0', 'punch x0', 'punch y0', 'block z0']",
                "punch z1",
                "",
            ),
        };
        let text = format!(
            "{plane}
materials.steel = {{young = 210e3, poisson = 0.3}}
bodies.block.material = 'steel'
bodies.punch.material = 'steel'
[[bilateral]]
on = {held}
[[pressure]]
on = '{top}'
value = 100
[[contact]]
name = 'c'
sides = ['{a}', '{b}']
"
        );
        model(&text, self.mesh())
    }
}
