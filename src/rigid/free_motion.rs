//! Free rigid motions, and how they travel.

use crate::comm::{Message, MessageReader};

/// A free rigid motion without load along it: for each body that takes part its coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMotion {
    /// Bodies and their coefficients.
    pub bodies: Vec<(usize, Vec<f64>)>,
}

impl FreeMotion {
    /// Appends `motions` to a message.
    pub fn pack(motions: &[Self], message: &mut Message) {
        message.integers.push(motions.len() as i64);
        for motion in motions {
            message.integers.push(motion.bodies.len() as i64);
            for (body, z) in &motion.bodies {
                message.integers.push(*body as i64);
                message.reals.extend(z);
            }
        }
    }

    /// Motions from a message, of bodies that have so many `modes` each.
    pub fn unpack(reader: &mut MessageReader, modes: usize) -> Vec<Self> {
        (0..reader.count())
            .map(|_| Self {
                bodies: (0..reader.count())
                    .map(|_| (reader.count(), reader.reals(modes)))
                    .collect(),
            })
            .collect()
    }
}
