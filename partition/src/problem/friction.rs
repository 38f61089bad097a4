//! Friction and stiffness of a contact in plain words.

use super::Catalog;
use super::law::LawRow;
use crate::contact_point::ContactPoint;
use crate::magnitude::short;

impl Catalog {
    /// Number of contact constraints with friction.
    pub fn conditions_with_friction(&self) -> usize {
        let points = self.points.iter();
        points.filter(|point| point.law.has_friction()).count()
    }

    /// Friction of a contact in plain words, with the number of its constraints unless all have it; `None` without
    /// friction.
    pub fn friction(&self, contact: usize) -> Option<String> {
        let points = self.points.iter();
        let laws: Vec<LawRow> = points
            .filter(|point| point.contact as usize == contact && point.law.has_friction())
            .map(|point| LawRow::from(point.law))
            .collect();
        let of = |law: i64| laws.iter().filter(move |row| row.law == law);
        let unit = self.units.stress();
        let mut words = Vec::new();
        if let Some(range) = range(of(2).map(|row| row.friction)) {
            words.push(format!("friction {range}"));
        }
        let cohesion = of(2).map(|row| row.shear_bound);
        if cohesion.clone().any(|cohesion| cohesion > 0.0)
            && let Some(range) = range(cohesion)
        {
            words.push(format!("cohesion {range} {unit}"));
        }
        if let Some(range) = range(of(1).map(|row| row.shear_bound)) {
            words.push(format!("shear bound {range} {unit}"));
        }
        let all = self.contacts[contact].conditions;
        if (1..all).contains(&laws.len()) {
            words.push(format!("on {} of {all}", laws.len()));
        }
        (!words.is_empty()).then(|| words.join(", "))
    }

    /// The stiffness of a contact in plain words, per area, or that of a spring; `None` for a rigid contact.
    pub fn contact_stiffness(&self, contact: usize) -> Option<String> {
        let points = self.points.iter();
        let of = points.filter(|point| point.contact as usize == contact && point.is_compliant());
        let per = match of.clone().any(ContactPoint::is_equation) {
            true => self.units.force(self.dim),
            false => self.units.stress(),
        };
        let unit = format!("{per}/{}", self.units.length());
        let along = |direction: usize| {
            let per_area = of.clone().map(move |p| p.stiffness[direction] / p.area);
            // Multiplying by an area and dividing by it leaves round-off.
            range(per_area.filter(|&k| k > 0.0))
        };
        let normal = along(0)?;
        let tangential = along(1).map_or(String::new(), |k| format!(" and {k} along tangents"));
        Some(format!("stiffness {normal} {unit}{tangential}"))
    }
}

/// The range of some numbers; a single number if all are equal, `None` if there are none.
pub(crate) fn range(values: impl Iterator<Item = f64> + Clone) -> Option<String> {
    let least = values.clone().reduce(f64::min).map(short)?;
    let most = values.reduce(f64::max).map(short)?;
    Some(match least == most {
        true => least,
        false => format!("{least} to {most}"),
    })
}
