//! A random scene under construction: its text and its mesh.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::mesh::Mesh;

use super::super::blocks::Blocks;
use super::super::random::Random;
use super::friction::Friction;

/// Poisson's ratios from which the difficult ones are drawn.
const HARD_POISSON: [f64; 5] = [0.49, 0.499, 0.4999, 0.499_999, 0.499_999_9];

/// Builder of a scene, on which the families draw.
pub struct Draft {
    pub random: Random,
    pub blocks: Blocks,
    /// Keys of the scene's root, which have to precede its tables.
    head: String,
    tables: String,
    /// True if an equilibrium exists by construction; `None` if that follows from [`super::Balance`] only.
    pub equilibrium: Option<bool>,
    /// Young's modulus around which those of the bodies vary (Pa).
    young: f64,
    /// Orders of magnitude between the stiffest and the softest.
    contrast: f64,
    /// Size of the pressures (Pa).
    pub load: f64,
    /// Most cells along a side of a block.
    pub cells: usize,
    /// True if nodes of blocks in contact lie opposite each other.
    pub matching: bool,
    contacts: usize,
    /// The friction of its contacts; `None` without friction.
    pub friction: Option<Friction>,
    /// True if the resultants of all contacts follow from statics.
    pub determined: bool,
    /// The kind of cells of a scene in space, and whether the scene is tilted.
    pub kind: ElementKind,
    pub tilted: bool,
    /// Sides in space under pressure.
    pub pressed: Vec<String>,
}

impl Draft {
    /// A draft with blocks of at most `cells` × `cells` cells.
    pub fn new(mut random: Random, cells: usize) -> Self {
        let young = random.magnitude(3.0, 12.0);
        let contrast = random.pick(&[0.0, 0.5, 1.0, 2.0, 4.0, 6.0, 8.0]);
        let load = young * random.magnitude(-7.0, -3.0);
        let plane = random.pick(&["strain", "strain", "stress"]);
        Self {
            blocks: Blocks::new(),
            head: format!("plane = '{plane}'\n"),
            tables: String::new(),
            equilibrium: Some(true),
            young,
            contrast,
            load,
            cells,
            matching: true,
            contacts: 0,
            friction: None,
            determined: false,
            kind: ElementKind::Hexahedron8,
            tilted: false,
            pressed: Vec::new(),
            random,
        }
    }

    /// A draft in space, with cells of this kind.
    pub fn in_space(random: Random, kind: ElementKind, cells: usize) -> Self {
        let mut draft = Self::new(random, cells);
        draft.head.clear();
        draft.kind = kind;
        // Existence of an equilibrium has to be found by statics.
        draft.equilibrium = None;
        draft.tilted = draft.random.chance(0.3);
        draft.matching = draft.random.chance(0.5);
        draft.blocks.mesh.dim = 3;
        draft
    }

    /// Adds a part of the scene's text.
    pub fn add(&mut self, text: &str) {
        self.tables += text;
    }

    /// Adds a load step with these keys of the scene file.
    pub fn step(&mut self, keys: &str) {
        self.tables += &format!("[[step]]\n{keys}\n");
    }

    /// A number of cells along a side.
    pub fn side_cells(&mut self) -> usize {
        self.random.count(1, self.cells)
    }

    /// A number of cells along a side of a block in contact with others of `n`.
    pub fn facing(&mut self, n: usize) -> usize {
        match self.matching {
            true => n,
            false => self.random.count(1, 2 * self.cells),
        }
    }

    /// Adds a quadrilateral, its inner nodes moved a little, as a body with `force` per volume.
    pub fn block(&mut self, name: &str, corners: [[f64; 2]; 4], n: [usize; 2], force: [f64; 2]) {
        self.shape(name, n, |st| bilinear(corners, st));
        self.body(name, &[name], force);
    }

    /// Adds the image of the unit square under `map`, its inner nodes moved a little.
    pub fn shape(&mut self, name: &str, n: [usize; 2], map: impl Fn([f64; 2]) -> [f64; 2]) {
        let amount = self.random.pick(&[0.0, 0.1, 0.25]);
        let seed = self.random.below(1 << 20) as f64;
        let inner = |c: f64| 1e-9 < c && c < 1.0 - 1e-9;
        let drawn = |amount: f64| {
            let moved = |c: f64, other: f64, n: usize| {
                amount / n as f64 * noise(seed + 17.0 * c + 3.0 * other)
            };
            let blocks = self.blocks.clone();
            blocks.mapped(name, n, |[s, t]| match inner(s) && inner(t) {
                true => map([s + moved(s, t, n[0]), t + moved(t, s, n[1])]),
                false => map([s, t]),
            })
        };
        // Cells may fold where a side is far shorter than its opposite.
        let whole = drawn(amount);
        self.blocks = match is_folded(&whole.mesh, self.blocks.mesh.cells.len()) {
            true => drawn(0.0),
            false => whole,
        };
    }

    /// Merges nodes with the same position, where `at(x, y)` is true.
    pub fn glue(&mut self, at: impl Fn(f64, f64) -> bool) {
        let blocks = std::mem::replace(&mut self.blocks, Blocks::new());
        self.blocks = blocks.glued(at);
    }

    /// The scene's text.
    pub fn text(&self) -> String {
        format!("{}{}", self.head, self.tables)
    }

    /// Makes one body of `groups`, with its own material.
    pub fn body<const D: usize>(&mut self, name: &str, groups: &[&str], force: [f64; D]) {
        let (young, poisson) = self.material();
        self.head += &format!("materials.'{name}' = {{young = {young:e}, poisson = {poisson}}}\n");
        for group in groups {
            self.head +=
                &format!("bodies.'{group}' = {{material = '{name}', body_force = {force:?}}}\n");
        }
    }

    fn material(&mut self) -> (f64, f64) {
        let random = &mut self.random;
        let exponent = match random.below(3) {
            0 => 0.0,
            1 => self.contrast / 2.0 * random.signed(),
            _ => self.contrast / 2.0 * random.signed().signum(),
        };
        let poisson = match random.below(8) {
            0 => 0.0,
            1 => random.pick(&HARD_POISSON),
            _ => random.within(0.0, 0.45),
        };
        (self.young * 10_f64.powf(exponent), poisson)
    }

    /// Prescribes displacements on groups.
    pub fn hold(&mut self, on: &str, x: Option<&str>, y: Option<&str>) {
        self.tables += &format!("[[displacement]]\non = '{on}'\n");
        for (axis, value) in [("x", x), ("y", y)] {
            if let Some(value) = value {
                self.tables += &format!("{axis} = '{value}'\n");
            }
        }
    }

    /// A roller support.
    pub fn roll(&mut self, on: &str) {
        self.tables += &format!("[[bilateral]]\non = '{on}'\n");
    }

    pub fn pressure(&mut self, on: &str, value: &str) {
        self.tables += &format!("[[pressure]]\non = '{on}'\nvalue = '{value}'\n");
    }

    pub fn traction(&mut self, on: &str, [x, y]: [&str; 2]) {
        self.tables += &format!("[[traction]]\non = '{on}'\nvalue = ['{x}', '{y}']\n");
    }

    /// Adds a contact between groups of facets; without a given gap the geometry determines it. If nodes don't match,
    /// either side may be the first.
    pub fn contact(&mut self, a: &[String], b: &[String], gap: Option<&str>) {
        let turned = !self.matching && self.random.chance(0.5);
        let [a, b] = if turned { [b, a] } else { [a, b] };
        self.tables += &format!(
            "[[contact]]\nname = 'c{}'\nsides = [{a:?}, {b:?}]\n",
            self.contacts
        );
        self.gap(gap);
    }

    /// Adds a contact with a rigid obstacle, in the syntax of a scene.
    pub fn obstacle(&mut self, side: &[String], obstacle: &str, gap: Option<&str>) {
        self.tables += &format!(
            "[[contact]]\nname = 'c{}'\nsides = [{side:?}]\nobstacle = {obstacle}\n",
            self.contacts
        );
        self.gap(gap);
    }

    fn gap(&mut self, gap: Option<&str>) {
        self.contacts += 1;
        if let Some(gap) = gap {
            self.tables += &format!("gap = '{gap}'\n");
        }
        if let Some(friction) = &mut self.friction {
            self.tables += &friction.drawn();
        }
    }

    /// Displacement by the load in a body of size 1 of the average material (m).
    pub fn compression(&self) -> f64 {
        self.load / self.young
    }

    /// A given gap along `axis`: none, even, smooth, rough or noise; some of them an interference.
    pub fn drawn_gap(&mut self, axis: &str) -> String {
        let size = self.compression() * self.random.magnitude(-3.0, 1.0);
        let random = &mut self.random;
        let phase = random.within(0.0, 6.0);
        let offset = size * random.pick(&[-1.0, -0.3, 0.0, 0.0, 0.5, 1.0]);
        let wave = match random.below(6) {
            0 => return "0".into(),
            1 => 0.0,
            2 => random.within(0.5, 6.0),
            3 => random.within(6.0, 60.0),
            // The wavelength is so far below a facet that its nodes see noise.
            _ => random.within(1e3, 1e4),
        };
        format!("({size:e})*sin(({wave})*{axis}+({phase}))+({offset:e})")
    }

    /// A force per volume, as harmless as a pressure to a body of this height.
    pub fn weight(&mut self, height: f64) -> f64 {
        match self.random.chance(0.6) {
            true => -self.load / height * self.random.magnitude(-2.0, 0.0),
            false => 0.0,
        }
    }

    /// A pressure over [a, b] with its resultant well inside.
    pub fn drawn_pressure(&mut self, axis: &str, [a, b]: [f64; 2]) -> String {
        let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
        let size = self.load * self.random.magnitude(-2.0, 0.0);
        match self.random.below(4) {
            0 => format!("{size:e}"),
            1 => {
                let share = self.random.within(1.0, 8.0) / half.powi(2);
                format!("({size:e})*exp(-({share:e})*({axis}-({middle:e}))^2)")
            }
            _ => {
                // The resultant would lie at the end at a slope of 3.
                let slope = self.random.within(-1.8, 1.8) / half;
                format!("({size:e})*(1+({slope:e})*({axis}-({middle:e})))")
            }
        }
    }
}

/// True if triangles of a mesh, from a number on, have both orientations.
fn is_folded(mesh: &Mesh, first: usize) -> bool {
    let is_left = |cell: usize| {
        let nodes = mesh.cells.nodes_of(cell);
        let [a, b, c] = [0, 1, 2].map(|i| mesh.points[nodes[i] as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
    };
    (first..mesh.cells.len()).any(|cell| is_left(cell) != is_left(first))
}

/// The bilinear map to a quadrilateral, exact at both ends.
pub fn bilinear([a, b, c, d]: [[f64; 2]; 4], [s, t]: [f64; 2]) -> [f64; 2] {
    let between = |p: f64, q: f64, w: f64| p * (1.0 - w) + q * w;
    [0, 1].map(|i| between(between(a[i], b[i], s), between(d[i], c[i], s), t))
}

/// A pseudo-random number between −1 and 1 that depends on `at` only.
pub fn noise(at: f64) -> f64 {
    // Rounding identifies positions reached by different sums of fractions.
    let at = (at * 1e6).round();
    let wild = (at * 12.9898).sin() * 43_758.547;
    2.0 * (wild - wild.floor()) - 1.0
}

/// The corners of a rectangle.
pub fn rectangle(x: [f64; 2], y: [f64; 2]) -> [[f64; 2]; 4] {
    [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}
