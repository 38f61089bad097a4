//! Conclusions from the measurements.

use contact_dd_mpi::settings::DEFAULT_TOLERANCE;

use super::Measurements;
use super::document::shown;
use super::reached::{GOAL, Reached, reached};
use super::series::{SCENES, Series};
use super::timed::Timed;
use super::tolerance::Tried;

/// The largest ratio of quadratic cells' solve phases to linear cells' at the goal.
pub const RATIO: f64 = 0.1;
/// The change of an error, over it, that the sweeps may make.
pub const MOVED: f64 = 0.01;

/// The smallest error of a mesh in the energy that is thought of: a hundredth of the finest here.
const SMALLEST: f64 = 1e-6;

/// All of them.
pub struct Conclusions {
    pub places: Vec<Place>,
    pub stopped: Vec<Row>,
    /// The smallest residual that a mesh needs for the error of the mesh to be all there is, and the
    /// smallest over that error.
    enough: [f64; 2],
    /// The largest change that a run as a user asks for it made, if it converged.
    refined: f64,
    /// The smallest error in the energy of a mesh.
    finest: f64,
}

/// A series and where it reaches the goal.
pub struct Place {
    pub scene: &'static str,
    pub element: &'static str,
    pub mesh: &'static str,
    is_quadratic: bool,
    pub reached: Option<Reached>,
}

/// Error of sweeps that end below a residual.
pub struct Row {
    pub residual: f64,
    pub largest: f64,
    pub moved: usize,
    pub meshes: usize,
}

impl Conclusions {
    /// From all that was measured.
    pub fn new(series: &[Series], all: &Measurements) -> Self {
        let of = |series: &Series| -> Vec<&Timed> {
            let own = |mesh: &&Timed| {
                [&mesh.scene, &mesh.element, &mesh.mesh]
                    == [series.scene, series.element, series.mesh]
            };
            all.timed.iter().filter(own).collect()
        };
        let places = series.iter().map(|series| Place {
            scene: series.scene,
            element: series.element,
            mesh: series.mesh,
            is_quadratic: series.is_quadratic,
            reached: reached(&of(series)),
        });
        let asked = |tried: &Tried| {
            let good = tried.asked.iter().filter(|run| run.converged);
            good.fold(0.0f64, |most, run| most.max(tried.shift(run.error)))
        };
        let enough = |tried: &Tried| tried.enough(MOVED);
        let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
        Self {
            places: places.collect(),
            stopped: (2..15).map(|digits| row(&all.tried, digits)).collect(),
            enough: [
                least(&mut all.tried.iter().map(enough)),
                least(&mut all.tried.iter().map(|t| enough(t) / t.error)),
            ],
            refined: all.tried.iter().map(asked).fold(0.0, f64::max),
            finest: least(&mut all.tried.iter().map(|tried| tried.error)),
        }
    }

    /// Expectations that don't hold.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for place in self.places.iter().filter(|place| place.is_quadratic) {
            let at = format!("{}, {}, {}", place.scene, place.element, place.mesh);
            match self.of_linear(place) {
                Some([_, solve, _]) if solve <= RATIO => {}
                Some([_, solve, _]) => faults.push(format!(
                    "{at}: the solve phases take {solve:.3} of those of linear cells at an error of {} \
                     %; expected at most {RATIO}",
                    100.0 * GOAL
                )),
                None => faults.push(format!("{at}: an error of {} % isn't reached", 100.0 * GOAL)),
            }
        }
        if self.refined > MOVED {
            faults.push(format!(
                "the tolerance moves the error by {:.1e} of itself; expected at most {MOVED}",
                self.refined
            ));
        }
        if default_tolerance() > self.derived_tolerance() {
            faults.push(format!(
                "the default tolerance is {:.0e}; expected at most {:.0e}",
                default_tolerance(),
                self.derived_tolerance()
            ));
        }
        faults
    }

    /// The power of ten that leaves the smallest error to the mesh.
    fn derived_tolerance(&self) -> f64 {
        10f64.powf((self.enough[1] * SMALLEST).log10().floor())
    }

    /// The times of quadratic cells over those of linear ones of the same shape on the same meshes.
    pub fn of_linear(&self, place: &Place) -> Option<[f64; 3]> {
        let shape = |element: &str| element.starts_with("triangle");
        let is_linear = |other: &&Place| {
            let alike = shape(other.element) == shape(place.element);
            let on = other.mesh == place.mesh || place.mesh == "squares";
            alike && on && other.scene == place.scene && !other.is_quadratic
        };
        let linear = self.places.iter().find(is_linear)?.reached?;
        let own = place.reached.filter(|_| place.is_quadratic)?;
        Some([0, 1, 2].map(|i| own.seconds[i] / linear.seconds[i]))
    }

    /// The fastest on one rank of those that `is_one` holds for.
    fn fastest(&self, is_one: impl Fn(&Place) -> bool) -> Option<(&Place, Reached)> {
        let own = self.places.iter().filter(|place| is_one(place));
        own.filter_map(|place| Some((place, place.reached?)))
            .min_by(|a, b| a.1.seconds[0].total_cmp(&b.1.seconds[0]))
    }

    /// In words.
    pub fn text(&self) -> String {
        let mut text = format!("## In short\n\n{}", self.table());
        for scene in SCENES {
            text += &self.elements(scene).unwrap_or_default();
        }
        text += &self.grading().unwrap_or_default();
        text += &self.tolerance();
        text
    }

    /// The fastest quadratic and the fastest linear cells for each scene.
    fn table(&self) -> String {
        let mut text = format!(
            "| {} % in the energy | fastest cells | dofs | ms | fastest linear cells | dofs | ms |\n\
             |---|---|--:|--:|---|--:|--:|\n",
            100.0 * GOAL
        );
        for scene in SCENES {
            let of = |is_quadratic: bool| -> Option<String> {
                let (place, reached) =
                    self.fastest(|p| p.scene == scene && p.is_quadratic == is_quadratic)?;
                Some(format!(
                    "{} `{}` | {:.0} | {:.1}",
                    place.mesh,
                    place.element,
                    reached.dofs,
                    1e3 * reached.seconds[0]
                ))
            };
            if let (Some(quadratic), Some(linear)) = (of(true), of(false)) {
                text += &format!("| {scene} | {quadratic} | {linear} |\n");
            }
        }
        text + "\n"
    }

    /// The fastest cells for a scene.
    fn elements(&self, scene: &str) -> Option<String> {
        let quadratic = self.fastest(|p| p.scene == scene && p.is_quadratic)?;
        let linear = self.fastest(|p| p.scene == scene && !p.is_quadratic)?;
        let sentence = |(place, reached): (&Place, Reached)| {
            format!(
                "{} `{}`, {:.0} dofs, {:.1} ms",
                place.mesh,
                place.element,
                reached.dofs,
                1e3 * reached.seconds[0]
            )
        };
        let ratios = |shape: &str| {
            let own = (self.places.iter())
                .filter(|p| p.scene == scene && p.element.starts_with(shape))
                .filter_map(|place| self.of_linear(place))
                .map(|[ratio, ..]| ratio);
            let [least, most] = own.fold([f64::INFINITY, 0.0f64], |[a, b], r| [a.min(r), b.max(r)]);
            let [least, most] = [least, most].map(|ratio| format!("{ratio:.2}"));
            match least == most {
                true => most,
                false => format!("{least} to {most}"),
            }
        };
        Some(format!(
            "- **{scene}**: {} % in the energy takes least time with quadratic cells ({}, {:.1} of them \
             solving). Linear ones need {:.0} times that at best ({}). On the same kind of mesh \
             `triangle6` takes {} of the time of `triangle3`, `quad8` and `quad9` {} of that of `quad4`.\n",
            100.0 * GOAL,
            sentence(quadratic),
            1e3 * quadratic.1.seconds[1],
            linear.1.seconds[0] / quadratic.1.seconds[0],
            sentence(linear),
            ratios("triangle"),
            ratios("quad"),
        ))
    }

    /// The gain of grading.
    fn grading(&self) -> Option<String> {
        let on = |mesh: &str| {
            let own = (self.places.iter()).filter(|p| p.is_quadratic && p.mesh == mesh);
            own.filter_map(|place| Some((place.element, place.reached?)))
                .min_by(|a, b| a.1.dofs.total_cmp(&b.1.dofs))
        };
        let (graded, uniform) = (on("graded")?, on("uniform")?);
        Some(format!(
            "- **Grading** towards the end of the contact: quadratic cells have {} % with {:.0} dofs \
             (`{}`), on uniform meshes with {:.0} (`{}`).\n",
            100.0 * GOAL,
            graded.1.dofs,
            graded.0,
            uniform.1.dofs,
            uniform.0,
        ))
    }

    /// The largest sufficient tolerance.
    fn tolerance(&self) -> String {
        let [enough, share] = self.enough;
        format!(
            "- **Tolerance**: a residual of {} changes no error here, down to {}, by more than {} %; {} of the \
             error is always enough. For errors down to {SMALLEST:.0e} that makes {}, as a power of ten {:.0e}; \
             the default is {:.0e}. After the refinement the tolerance changes the error by {} at most.\n\n",
            shown(enough),
            shown(self.finest),
            100.0 * MOVED,
            shown(share),
            shown(share * SMALLEST),
            self.derived_tolerance(),
            default_tolerance(),
            shown(self.refined),
        )
    }
}

fn row(tried: &[Tried], digits: i32) -> Row {
    let residual = 10f64.powi(-digits);
    let shifts: Vec<f64> = (tried.iter())
        .filter_map(|tried| {
            let end = tried.stopped.iter().find(|end| end.residual <= residual)?;
            Some(tried.shift(end.error))
        })
        .collect();
    Row {
        residual,
        largest: shifts.iter().copied().fold(0.0, f64::max),
        moved: shifts.iter().filter(|&&shift| shift > MOVED).count(),
        meshes: shifts.len(),
    }
}

/// Of `--tolerance`.
pub fn default_tolerance() -> f64 {
    DEFAULT_TOLERANCE
}
