//! Rests within a dead zone, where gains do not move, and the same rests with the rules as they are beyond its border.
//!
//! Within the zone a loop is that of its nominal gains. A motion that leaves it, by a step or a gust however small the zone is,
//! meets the rules, and with what gains that move make of a held command the loop there may grow: back to the zone it does not
//! come then.

use fspid_core::SecondInput;

use super::{Holding, Rest, RestPoint};

impl Holding<'_> {
    /// True where this error and this rate, which is seen and not there, are within the dead zone, and small motions as well.
    pub(super) fn is_silent(&self, [error_rad, rate_rad_s]: [f64; 2]) -> bool {
        let settings = self.fspid.tuner().settings();
        let second_rad = match settings.second_input {
            SecondInput::Change => 0.0,
            SecondInput::Rate => rate_rad_s,
            // The model has come to rest at the set-point.
            SecondInput::ModelError(_) => error_rad,
        };
        settings.dead_zone.is_some_and(|zone| {
            error_rad.abs() < zone.error_rad && second_rad.abs() < zone.change_rad
        })
    }

    /// The rest with this error and rate as it would be without the dead zone; none where there is no zone.
    pub(super) fn beyond_dead_zone(&self, at: RestPoint, held: [f64; 2]) -> Option<Rest> {
        self.fspid.tuner().settings().dead_zone?;
        let [error_rad, rate_rad_s] = held;
        let gains = self.gains_at(self.seen(error_rad, rate_rad_s));
        let rest = self.with_gains(at, held, gains, false);
        Some(Rest { is_beyond_dead_zone: true, ..rest })
    }

    /// The rest of gains that multiply nothing that is held, and beside it the one without the dead zone where that is another.
    pub(super) fn still_beside(&self, still: Rest) -> Vec<Rest> {
        let beyond = self.fspid.tuner().settings().dead_zone.map(|_| {
            let rest = Rest::still(self.gains_at([0.0; 2]));
            Rest { is_beyond_dead_zone: true, ..rest }
        });
        let beyond = beyond.filter(|beyond| !still.says_as_much_as(beyond));
        [Some(still), beyond].into_iter().flatten().collect()
    }
}
