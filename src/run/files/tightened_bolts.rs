//! Tightened bolts of a load step, for the report.

use contact_dd_partition::id::OnBlocks;
use contact_dd_partition::problem::ContactKind;

use crate::context::Context;
use crate::fem::resultants::ContactResultant;
use crate::fem::tightened_bolt::TightenedBolt;
use crate::step::transfer::jumps_of_points;

/// The bolts in load step `step`, from the displacement of every block of this rank (m) and the resultants of contacts;
/// on the root. Collective.
pub fn tightened_bolts(
    context: &Context<'_>,
    displacement: &OnBlocks<Vec<f64>>,
    contacts: &[ContactResultant],
    step: usize,
) -> Vec<TightenedBolt> {
    let points = TightenedBolt::points(context.catalog, &context.catalog.points);
    let jumps = jumps_of_points(&points, context, displacement);
    let bolts = points.iter().zip(jumps).map(|(point, jump)| {
        let number = point.contact as usize;
        // The constraint that holds a bolt's shortening comes after its cut.
        let hold = contacts.get(number + 1);
        let hold = hold.filter(|next| next.kind == ContactKind::Held.word() && next.closed > 0);
        let held = hold.map(|hold| hold.held);
        TightenedBolt::new(&contacts[number].name, point, (step, jump), held)
    });
    bolts.collect()
}
