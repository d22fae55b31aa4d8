//! What a certificate's file says of disturbances: where one enters, what is bounded, and the form that carries it.

use fspid_proof::{AirPart, DisturbanceBound, Extent, Quantity, Way};
use serde::{Deserialize, Serialize};

use super::file::{Rows, matrix, rows};

/// A bound as written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DisturbanceFile {
    enters: Enters,
    /// From the air to pitch angle, over the denominator with a leading 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    numerator: Option<Vec<f64>>,
    bounds: Bounds,
    measured_by: MeasuredBy,
    decay: f64,
    gain: f64,
    form: Rows,
    /// What kp, ki and kd add to it, per half width of the claim's box; with a claim about the rate of gains alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    by_gain: Option<[Rows; 3]>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Enters {
    Elevator,
    ForwardGust,
    VerticalGust,
    TurningGust,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Bounds {
    Pitch,
    Command,
    Limits,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum MeasuredBy {
    Energy,
    Peak,
}

impl DisturbanceFile {
    pub(super) fn of(bound: &DisturbanceBound) -> Self {
        let DisturbanceBound { way, quantity, extent, decay, gain, form, by_gain } = bound;
        let (enters, numerator) = match way {
            Way::Elevator => (Enters::Elevator, None),
            Way::Air { part, numerator } => {
                let enters = match part {
                    AirPart::Forward => Enters::ForwardGust,
                    AirPart::Vertical => Enters::VerticalGust,
                    AirPart::Turning => Enters::TurningGust,
                };
                (enters, Some(numerator.clone()))
            }
        };
        Self {
            enters,
            numerator,
            bounds: match quantity {
                Quantity::Pitch => Bounds::Pitch,
                Quantity::Command => Bounds::Command,
                Quantity::Limits => Bounds::Limits,
            },
            measured_by: match extent {
                Extent::Energy => MeasuredBy::Energy,
                Extent::Peak => MeasuredBy::Peak,
            },
            decay: *decay,
            gain: *gain,
            form: rows(form),
            by_gain: by_gain.as_ref().map(|by_gain| by_gain.each_ref().map(rows)),
        }
    }

    pub(super) fn build(&self) -> Result<DisturbanceBound, String> {
        let part = match self.enters {
            Enters::Elevator => None,
            Enters::ForwardGust => Some(AirPart::Forward),
            Enters::VerticalGust => Some(AirPart::Vertical),
            Enters::TurningGust => Some(AirPart::Turning),
        };
        let way = match (part, self.numerator.clone()) {
            (None, None) => Way::Elevator,
            (Some(part), Some(numerator)) => Way::Air { part, numerator },
            (None, Some(_)) => return Err("a numerator at the elevator".to_owned()),
            (Some(_), None) => return Err("a gust without a numerator".to_owned()),
        };
        Ok(DisturbanceBound {
            way,
            quantity: match self.bounds {
                Bounds::Pitch => Quantity::Pitch,
                Bounds::Command => Quantity::Command,
                Bounds::Limits => Quantity::Limits,
            },
            extent: match self.measured_by {
                MeasuredBy::Energy => Extent::Energy,
                MeasuredBy::Peak => Extent::Peak,
            },
            decay: self.decay,
            gain: self.gain,
            form: matrix(&self.form)?,
            by_gain: match &self.by_gain {
                None => None,
                Some([kp, ki, kd]) => Some([matrix(kp)?, matrix(ki)?, matrix(kd)?]),
            },
        })
    }
}
