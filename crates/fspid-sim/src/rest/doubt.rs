//! Why it is undecided whether an equilibrium is stable: each reason with the number that it has and its sentence.

use crate::led::Led;
use crate::loop_model::MOST_AS_STATES;

/// Why the stability of an equilibrium is undecided. A spectral radius is that of the sampled closed loop that is in doubt, as computed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// Rounding may carry poles across the unit circle.
    #[error(
        "rounding may carry poles across the unit circle (spectral radius {spectral_radius:.9} as computed)"
    )]
    Rounding {
        /// Spectral radius.
        spectral_radius: f64,
    },
    /// A side of a kink is unstable, and no motion was seen to grow.
    #[error(
        "unstable on one side of a kink that the rules have where the loop rests ({} there), and no motion was seen to grow",
        in_words(*spectral_radius)
    )]
    OneSide {
        /// Spectral radius on that side.
        spectral_radius: f64,
    },
    /// A side of a kink is unstable, and so much is on its way that no motion is followed through the sides.
    #[error(
        "unstable on one side of a kink that the rules have where the loop rests ({} there), and motions are not followed through so many samples on their way",
        in_words(*spectral_radius)
    )]
    LongWay {
        /// Spectral radius on that side.
        spectral_radius: f64,
    },
    /// Without the dead zone, as beyond its border, the rest of a self-tuner grows or may; within the zone it holds.
    #[error(
        "within the dead zone the gains rest and the loop holds; with the rules as they are beyond its border it grows, or may ({}): what leaves the zone need not come back, and a swing may stay; rules, scales and set-point weight that hold without the dead zone leave none",
        in_words(*spectral_radius)
    )]
    DeadZone {
        /// Spectral radius there.
        spectral_radius: f64,
    },
    /// The gain of a self-tuner's integral is zero at rest, and elsewhere one with which it need not come to rest.
    #[error(
        "the gain of the integral is 0 at rest, and where the rules move it it is negative, which drives the error away, or multiplies the sum of all errors (the literal integral), which grows: a nominal ki above 0, no rules for ki, or gain_limits with ki from 0 on and the bumpless integral leave no doubt"
    )]
    IntegralGain,
    /// An accumulating law without leakage keeps its gains wherever they have come to, or moves them for ever.
    #[error(
        "the gains of an accumulating law without leakage stay wherever they have come to, and no gains are those at rest: a leakage above 0 gives them a rest, and with gain_limits certify asks all of them at once"
    )]
    KeptGains,
    /// Such a law moves its gains at rest without end.
    #[error(
        "the accumulating law moves the gains at rest without end, so that there is no equilibrium; gain_limits or leakage_per_s bound it"
    )]
    DriftingGains,
    /// What is held at the end of the flight takes more of the integral than its own limits leave, and without it nothing holds.
    #[error(
        "at the end of the flight set-point and loads take more of the integral than the limits of its anti-windup leave, and the loop does not hold while the integral stands at one: wider limits leave it room"
    )]
    IntegralLimits,
    /// A flight ended with a sample that the controller does not believe.
    #[error(
        "the flight ends, as it is or flown on, with a sample beyond the controller's sample guard, for which the command is held: nobody holds the aircraft until a sample is believed again; a larger sample_guard_deg, or a smaller set-point, leaves the controller at work"
    )]
    HeldByGuard,
    /// A sensor shows values of changing age: of the pitch loop, which is stable with one of them and not with another; of a mode
    /// of the autopilot, which is unstable with one.
    #[error(
        "a sensor with a clock of its own shows values of changing age; with one of them, or over some samples, the loop is unstable, or there are too many of them to be asked in turn"
    )]
    ChangingAge,
    /// So much is on its way in a mode of the autopilot that it is not asked for its poles.
    #[error("more than {MOST_AS_STATES} samples are on their way in a mode of the autopilot")]
    LongMode,
    /// It grows at a set-point that the loops around the pitch loop may command.
    #[error(
        "at a set-point that the loops around the pitch loop may command the loop is unstable ({})",
        in_words(*spectral_radius)
    )]
    Commanded {
        /// Spectral radius there.
        spectral_radius: f64,
    },
    /// With a configuration of later there is no trim at the speed and altitude of the start; or with an empty tank none, or one
    /// that is not shown to hold.
    #[error(
        "with its configuration or its fuel of later in the flight the aircraft has no trim at the speed and altitude of the start, or none that is shown to be stable"
    )]
    ChangedAircraft,
    /// About the trim of an aircraft something grows that is no pitching.
    #[error(
        "about the trim something grows that is no pitching ({}): roll, yaw or bank, with leveller and damper as they are",
        in_words(*spectral_radius)
    )]
    Wings {
        /// Spectral radius of all small motions, sample to sample.
        spectral_radius: f64,
    },
    /// A gyro's erection makes small motions grow, until its bounded rate holds them.
    #[error(
        "with the erection of the vertical gyro small motions grow ({}) until its bounded rate holds them, so that an oscillation stays",
        in_words(*spectral_radius)
    )]
    Erection {
        /// Spectral radius of all small motions, sample to sample.
        spectral_radius: f64,
    },
    /// Pitch that is held on with the throttle of the start brings an aircraft to another airspeed, where it grows: by set-point,
    /// loads and errors of the pitch sensor of the end, or by a configuration or fuel of later.
    #[error(
        "held on, the pitch of the end brings the aircraft, as it is by then and with the throttle of its trim at the start, to another airspeed, at which the loop is unstable ({}): a longer flight shows it",
        in_words(*spectral_radius)
    )]
    HeldOn {
        /// Spectral radius there.
        spectral_radius: f64,
    },
    /// A mode of the autopilot brings an aircraft to another airspeed or altitude, where it grows.
    #[error(
        "{led}, where everything together that it engages is unstable ({}): a longer flight shows it",
        in_words(*spectral_radius)
    )]
    Led {
        /// The mode, and where it leads to.
        led: Led,
        /// Spectral radius there, of everything that the mode engages.
        spectral_radius: f64,
    },
    /// A mode of the autopilot leads an aircraft to no flight within its limits.
    #[error("{0}: a longer flight shows it")]
    LedNowhere(Led),
    /// In the wind of the end of the flight, if it stays, a mode of the autopilot grows.
    #[error(
        "in the wind of the end of the flight, if it stays, a mode of the autopilot is unstable ({}): a longer flight shows it",
        in_words(*spectral_radius)
    )]
    WindOfTheEnd {
        /// Spectral radius of everything that the mode engages.
        spectral_radius: f64,
    },
    /// In the wind as it blows on a heading that a mode of the autopilot turns to, that mode grows.
    #[error(
        "in the wind as it blows on a heading that a mode of the autopilot turns to, that mode is unstable ({}): a longer flight shows it",
        in_words(*spectral_radius)
    )]
    WindOnAHeading {
        /// Spectral radius of everything that the mode engages.
        spectral_radius: f64,
    },
    /// The trim of an aircraft lies on a kink of its data, or at a jump of its engine, where no linear model is that of its small
    /// motions.
    #[error(
        "the trim lies right on a kink of the aircraft's data (a breakpoint of a table, a row of Mach numbers, a corner of a gearing, half the power of an engine that jumps there), where each side has slopes of its own: a trim a little beside it has one linear model"
    )]
    Kink,
    /// About the trim of an aircraft something moves so fast that the steps of the integration do not follow.
    #[error(
        "about the trim the airframe has a motion that is too fast for the steps of the integration, which are the sample period and 0.01 s at most: with a shorter period they follow it"
    )]
    FastMotion,
    /// Gains of a loop around the pitch loop move with its error and multiply what it holds, and what comes of that may grow.
    #[error(
        "gains of a loop around the pitch loop move with its error and multiply what it holds (a set-point weight other than 1, the literal integral, no integral), or are others beyond its dead zone, and what comes of that may grow"
    )]
    OuterGains,
    /// What is held at the end of the flight takes more than a limit leaves, of a plant that does not come to rest by itself.
    #[error(
        "the plant does not come to rest by itself, and at the end of the flight set-point and loads take more elevator than a limit leaves"
    )]
    BeyondLimits,
    /// A flight of such a plant ended at a limit, with an error that grew through its last tenth.
    #[error(
        "the plant does not come to rest by itself, and the flight ends with its command at a limit and an error that grows: a longer flight shows what becomes of it"
    )]
    RunsAway,
    /// A flight, flown on, is lost, or meets limits in a swing that does not shrink.
    #[error(
        "limits are met, and the flight does not settle, nor when it is flown on (in still air, for ten times as long): it swings on between them or is lost, as a longer flight shows; wider limits, smaller or slower commands, or lower gains may hold it"
    )]
    SwingAtLimits,
    /// A flight whose gains move is lost or, flown on, does not come back to the rest around which the loop holds.
    #[error(
        "around its rest the loop holds, with the gains there; this flight, flown on (in still air, for ten times as long), is lost or swings on, for away from the rest the gains are others: smaller commands, smaller output scales, or gain_limits that keep the gains where the loop holds (ki above 0 first of all) bring it back"
    )]
    AwayFromRest,
}

/// A spectral radius; who leaves a rest within the few samples that were flown has none that is a number.
fn in_words(spectral_radius: f64) -> String {
    match spectral_radius.is_finite() {
        true => format!("spectral radius {spectral_radius:.6}"),
        false => "it grows within a few samples".to_owned(),
    }
}

impl Doubt {
    /// True for what limits, or gains that move, make of a flight: small motions, and their margins, say nothing of it.
    #[must_use]
    pub const fn is_of_limits(self) -> bool {
        matches!(
            self,
            Self::IntegralLimits
                | Self::HeldByGuard
                | Self::BeyondLimits
                | Self::RunsAway
                | Self::SwingAtLimits
                | Self::AwayFromRest
        )
    }

    /// True for what is no loop of a plant at rest: a set-point that is held says nothing of it.
    #[must_use]
    pub fn is_beyond_the_loop(self) -> bool {
        match self {
            Self::Rounding { .. }
            | Self::OneSide { .. }
            | Self::LongWay { .. }
            | Self::DeadZone { .. }
            | Self::IntegralGain
            | Self::ChangingAge
            | Self::Commanded { .. } => false,
            Self::LongMode
            | Self::ChangedAircraft
            | Self::Wings { .. }
            | Self::Erection { .. }
            | Self::HeldOn { .. }
            | Self::Led { .. }
            | Self::LedNowhere(_)
            | Self::WindOfTheEnd { .. }
            | Self::WindOnAHeading { .. }
            | Self::Kink
            | Self::FastMotion
            | Self::OuterGains
            | Self::KeptGains
            | Self::DriftingGains
            | Self::IntegralLimits
            | Self::HeldByGuard
            | Self::BeyondLimits
            | Self::RunsAway
            | Self::SwingAtLimits
            | Self::AwayFromRest => true,
        }
    }

    /// True where no gains are those at rest: a proof of all gains that there may be speaks of each of them.
    #[must_use]
    pub fn is_of_gains_without_rest(self) -> bool {
        matches!(self, Self::KeptGains | Self::DriftingGains)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::led::Leg;

    #[test]
    fn what_leaves_within_a_few_samples_is_said_so_and_no_number_is_shown_that_is_none() {
        let led = Led { mode: 0, target: None, airspeed_m_s: None, leg: Leg::End };
        for spectral_radius in [f64::INFINITY, f64::NAN] {
            for doubt in [
                Doubt::OneSide { spectral_radius },
                Doubt::LongWay { spectral_radius },
                Doubt::DeadZone { spectral_radius },
                Doubt::Commanded { spectral_radius },
                Doubt::Wings { spectral_radius },
                Doubt::Erection { spectral_radius },
                Doubt::HeldOn { spectral_radius },
                Doubt::Led { led, spectral_radius },
                Doubt::WindOfTheEnd { spectral_radius },
                Doubt::WindOnAHeading { spectral_radius },
            ] {
                let words = doubt.to_string();
                assert!(words.contains("it grows within a few samples"), "{words}");
                assert!(!words.contains("spectral radius"), "{words}");
            }
        }
        let words = Doubt::Wings { spectral_radius: 1.25 }.to_string();
        assert!(words.contains("(spectral radius 1.250000)"), "{words}");
    }

    #[test]
    fn what_is_held_on_speaks_of_no_configuration_that_a_scenario_may_not_have() {
        let words = Doubt::HeldOn { spectral_radius: 1.1 }.to_string();
        assert!(!words.contains("configuration") && !words.contains("fuel"), "{words}");
    }
}
