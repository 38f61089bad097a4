//! The chapter on scenes with friction.

use std::fmt::Write as _;

use super::super::random::Ran;
use super::{Figure, figures, verdict_columns, verdict_line};
use crate::support::stress::friction::Law;
use crate::support::stress::trial::Verdict;
use crate::support::stress::{Family, friction, space};

/// Largest coefficient that the promise covers.
const USUAL: f64 = 0.5;

const FIGURES: [Figure; 6] = [
    ("Newton steps of an increment", None, |ran| {
        ran.trial.newton_steps()
    }),
    ("backward error", Some(1e-14), |ran| {
        ran.trial.reported(&["certificate", "equilibrium"])
    }),
    ("friction", Some(1e-9), |ran| {
        ran.trial.reported(&["certificate", "friction"])
    }),
    (
        "force beyond the bound, by the independent checker",
        None,
        |ran| ran.trial.findings.map(|found| found.bound.max(0.0)),
    ),
    (
        "slip of the result, by the independent checker",
        None,
        |ran| ran.trial.findings.map(|found| found.slip),
    ),
    ("difference to the reference", None, |ran| {
        ran.trial.findings?.difference
    }),
];

const HOW_TO_READ: &str = "\
*Right*: what fulfils the discrete problem and the law of friction in every load step: |λ_t| at most the bound, at the
bound and against the slip where there is slip since the step before, all checked from mesh, scene and result alone.
Coulomb's law may have other solutions. Without equilibrium: by a linear program for rigid bodies with friction, whose
failure no elasticity mends. *Unclear*: refused, where rigid bodies could be held by friction alone, which elastic ones
need not find. *In parts*: a load step was halved, once or more, as it didn't converge at once; the slip is then judged by
its bound alone. *Newton steps* are those of a scene's worst increment.

";

/// Scenes of one kind.
pub struct Kind {
    title: &'static str,
    place: &'static str,
    option: &'static str,
    moved: &'static str,
    families: &'static [Family],
    how_to_read: &'static str,
}

pub const PLANE: Kind = Kind {
    title: "Friction",
    place: "",
    option: "--friction",
    moved: "change their sign",
    families: &friction::FAMILIES,
    how_to_read: HOW_TO_READ,
};

pub const SPACE: Kind = Kind {
    title: "Friction in space",
    place: " in space",
    option: "--space --friction",
    moved: "turn and reverse",
    families: &space::friction::FAMILIES,
    how_to_read: "As in the plane, with friction cones for bounds. Whether friction holds rigid bodies a linear program says, with polygons in the
cones and around them. Of the scenes that it finds without equilibrium four of five are drawn anew, within their family.

",
};

impl Kind {
    /// The verdicts, by law.
    pub fn chapter(&self, first: u64, ran: &[Ran]) -> String {
        let given = |one: &Ran| one.friction == Some(Law::Given);
        let upto = |one: &Ran| matches!(one.friction, Some(Law::Coulomb(most)) if most <= USUAL);
        let above = |one: &Ran| matches!(one.friction, Some(Law::Coulomb(most)) if most > USUAL);
        let count = |of: &dyn Fn(&Ran) -> bool| ran.iter().filter(|one| of(one)).count();
        let mut text = format!(
        "
## {}

{} random scenes with friction{}, seeds {first} to {} (`scripts/stress {} --only SEED`): {} with Tresca bounds of
1e-10 to 100 times the pressure, {} with coefficients up to {USUAL}, {} with coefficients up to 1.5, some with cohesion;
{} with 1 to 5 load steps, in which loads along the joints {}; {} also run on 2 to 4 ranks.

",
        self.title,
        ran.len(),
        self.place,
        ran.iter().map(|one| one.seed).max().unwrap_or(first),
        self.option,
        count(&given),
        count(&upto),
        count(&above),
        count(&|one| one.steps > 0),
        self.moved,
        count(&|one| one.ranks > 0),
    );
        text += self.how_to_read;
        verdict_columns(&mut text);
        let mut line =
            |name: &str, of: &dyn Fn(&Ran) -> bool| verdict_line(&mut text, ran, name, of);
        for family in self.families {
            line(family.name, &|one| one.family == family.name);
        }
        line("Tresca bounds", &given);
        line("μ ≤ 0.5", &upto);
        line("μ > 0.5", &above);
        line("without equilibrium", &|one| {
            one.trial.equilibrium == Some(false)
        });
        line("in parts", &|one| one.trial.in_parts);
        line("held by friction", &|one| one.trial.by_friction);
        line("**all**", &|_| true);
        text.push('\n');
        figures(&mut text, ran, &FIGURES);
        let wrong = ran.iter().filter(|one| one.trial.verdict != Verdict::Right);
        let wrong: Vec<String> = wrong.map(|one| one.seed.to_string()).collect();
        match wrong.is_empty() {
            true => text += "All of them are right.\n",
            false => {
                let _ = writeln!(text, "Not right are the seeds {}.", wrong.join(", "));
            }
        }
        text
    }
}
