//! Measures by name, for requirements and claims.

/// What must be at hand to answer a measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// The response to a step of the command; the worst step counts.
    Step,
    /// A flight as a whole.
    Flight,
    /// The flight of a nonlinear aircraft: its loads, its way, its air; a linear plant has none of these.
    Aircraft,
    /// The linear loop as sampled, around rest; the worst of the aircraft's plants counts.
    Loop,
    /// The same with the gains frozen at everything that the supervisor can produce; the worst counts.
    Frozen,
    /// The aircraft without its controller, behind servo and dead time.
    Airframe,
    /// The linear loop while its gains move, proved; the worst of the aircraft's plants counts.
    Proof,
}

/// A measure that can be asked for by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Beyond the new set-point, %.
    Overshoot,
    /// 10 % to 90 %, s.
    RiseTime,
    /// Within 2 %, s.
    SettlingTime,
    /// Left at the end of the window, %.
    FinalError,
    /// Left at the end of the window, deg.
    FinalErrorAngle,
    /// Until the error stays within a band, s.
    RecoveryTime,
    /// Root mean square of the error, deg.
    RmsError,
    /// Largest error, deg.
    LargestError,
    /// Integral of the size of the error, deg s.
    ErrorIntegral,
    /// The same weighted with the time since the last step, deg s².
    TimedErrorIntegral,
    /// Largest command, deg.
    LargestCommand,
    /// Way of the command, deg.
    CommandVariation,
    /// Way of the elevator, deg.
    ElevatorTravel,
    /// Fastest command, deg/s.
    CommandRate,
    /// Fastest elevator, deg/s.
    ElevatorRate,
    /// Samples whose command was cut, %.
    Saturated,
    /// 1 for a stable loop, 0 for another.
    Stable,
    /// The smaller of the two ends of the gain margin, dB.
    GainMargin,
    /// How far the gain may fall, dB.
    GainMarginLow,
    /// How far the gain may rise, dB.
    GainMarginHigh,
    /// Phase margin, deg.
    PhaseMargin,
    /// Delay margin, s.
    DelayMargin,
    /// Disk margin.
    DiskMargin,
    /// Peak of the sensitivity.
    SensitivityPeak,
    /// Frequency of the crossover with the smallest phase margin, rad/s.
    GainCrossover,
    /// Least damping of a closed-loop mode.
    ModeDamping,
    /// 1 if the loop is stable at every gain the supervisor can produce, 0 if not.
    FrozenStable,
    /// Least gain margin over the frozen gains, dB.
    FrozenGainMargin,
    /// Least phase margin over the frozen gains, deg.
    FrozenPhaseMargin,
    /// Least disk margin over the frozen gains.
    FrozenDiskMargin,
    /// Damping of the aircraft's short period.
    ShortPeriodDamping,
    /// Control anticipation parameter, rad/s² for each multiple of gravity.
    ControlAnticipation,
    /// Damping of the aircraft's phugoid.
    PhugoidDamping,
    /// Time in which the phugoid doubles, s.
    PhugoidDoubling,
    /// The same of one that swings, s.
    PhugoidOscillationDoubling,
    /// The same of one that creeps, s.
    PhugoidDivergenceDoubling,
    /// Equivalent delay between command and elevator, s.
    EquivalentDelay,
    /// Largest load factor, g.
    LargestLoadFactor,
    /// Least load factor, g.
    LeastLoadFactor,
    /// Largest fall below the altitude of the start or of a target, ft.
    AltitudeLoss,
    /// Beyond the target altitude, seen from the start, ft.
    AltitudeOvershoot,
    /// Largest distance from the altitude of the start or of a target, ft.
    AltitudeDeviation,
    /// Largest true airspeed, kt.
    LargestAirspeed,
    /// Least true airspeed, kt.
    LeastAirspeed,
    /// Largest distance from the airspeed of the trim, kt.
    AirspeedDeviation,
    /// Largest angle of attack, deg.
    LargestAlpha,
    /// Least distance below the largest angle of attack that the aircraft's data hold for, deg.
    AlphaMargin,
    /// Largest size of the bank, deg.
    LargestBank,
    /// Largest pitch above the horizon, deg.
    LargestPitch,
    /// Least pitch above the horizon, deg.
    LeastPitch,
    /// Fastest descent, ft/min.
    LargestSink,
    /// Descent at the end, ft/min.
    FinalSink,
    /// 1 if stability while the gains move is proved, 0 if not.
    Certified,
}

/// All that is to be known about a measure.
struct Row {
    measure: Measure,
    name: &'static str,
    unit: &'static str,
    family: Family,
    doc: &'static str,
    /// Conditions that it can be asked under, beyond those of its family.
    conditions: &'static [&'static str],
}

/// Names of the ends of a time window.
const TIMES: &[&str] = &["from_s", "to_s"];
/// Names of the ends of a band of frequencies.
const BAND: &[&str] = &["from_hz", "to_hz"];
/// Names of a time window and of a target altitude.
const TARGET: &[&str] = &["from_s", "to_s", "target_ft", "target_m"];

const fn row(
    measure: Measure,
    (name, unit): (&'static str, &'static str),
    family: Family,
    conditions: &'static [&'static str],
    doc: &'static str,
) -> Row {
    Row { measure, name, unit, family, doc, conditions }
}

/// One row a measure, in the order of the enumeration.
#[rustfmt::skip] // a table: one row a measure
const ROWS: [Row; 53] = {
    use Family::{Aircraft, Airframe, Flight, Frozen, Loop, Proof, Step};
    use Measure as M;
    [
        row(M::Overshoot, ("overshoot_pct", "%"), Step, &[], "how far the response goes beyond the new set-point, of the step"),
        row(M::RiseTime, ("rise_time_s", "s"), Step, &[], "time from 10 % to 90 % of the way"),
        row(M::SettlingTime, ("settling_time_s", "s"), Step, &[], "time until the response stays within 2 % of the step"),
        row(M::FinalError, ("final_error_pct", "%"), Step, &[], "size of the error at the end of the step's window, of the step"),
        row(M::FinalErrorAngle, ("final_error_deg", "deg"), Step, &[], "size of the error at the end of the step's window; without a step, at the end of the flight"),
        row(M::RecoveryTime, ("recovery_time_s", "s"), Step, &["within_deg", "from_s", "to_s"], "time until the error stays within the band, counted from the step or from from_s"),
        row(M::RmsError, ("rms_error_deg", "deg"), Flight, TIMES, "root mean square of the error"),
        row(M::LargestError, ("largest_error_deg", "deg"), Flight, TIMES, "largest size of the error"),
        row(M::ErrorIntegral, ("iae_deg_s", "deg s"), Flight, &[], "integral of the size of the error"),
        row(M::TimedErrorIntegral, ("itae_deg_s2", "deg s²"), Flight, &[], "the same, weighted with the time since the last step"),
        row(M::LargestCommand, ("largest_command_deg", "deg"), Flight, &[], "largest size of the command"),
        row(M::CommandVariation, ("command_variation_deg", "deg"), Flight, &[], "way of the command: sum of the sizes of its changes; a jump at the first sample does not count"),
        row(M::ElevatorTravel, ("elevator_travel_deg", "deg"), Flight, &[], "way of the elevator: sum of the sizes of its changes from sample to sample; a jump at the first, and what it does between samples, do not count"),
        row(M::CommandRate, ("command_rate_deg_s", "deg/s"), Flight, &[], "largest change of the command from sample to sample, per second; a jump at the first does not count"),
        row(M::ElevatorRate, ("elevator_rate_deg_s", "deg/s"), Flight, &[], "largest change of the elevator from sample to sample, per second; a jump at the first, and what it does between samples, do not count"),
        row(M::Saturated, ("saturated_pct", "%"), Flight, &[], "samples whose command the controller's own limits cut"),
        row(M::Stable, ("stable", ""), Loop, &[], "1 for a loop whose every mode decays, 0 for another; needs no limit"),
        row(M::GainMargin, ("gain_margin_db", "dB"), Loop, BAND, "the smaller of how far the gain may fall and rise"),
        row(M::GainMarginLow, ("gain_margin_low_db", "dB"), Loop, BAND, "how far the gain may fall, counted positive"),
        row(M::GainMarginHigh, ("gain_margin_high_db", "dB"), Loop, BAND, "how far the gain may rise"),
        row(M::PhaseMargin, ("phase_margin_deg", "deg"), Loop, BAND, "smallest distance of the phase from -180 deg over all frequencies at which the loop gain is 1"),
        row(M::DelayMargin, ("delay_margin_s", "s"), Loop, &[], "the dead time that makes the loop unstable"),
        row(M::DiskMargin, ("disk_margin", ""), Loop, &[], "size of the disk of gain and phase together that is allowed, without skew"),
        row(M::SensitivityPeak, ("sensitivity_peak", ""), Loop, &[], "largest gain from disturbance to error"),
        row(M::GainCrossover, ("gain_crossover_rad_s", "rad/s"), Loop, &[], "frequency of the crossover with the smallest phase margin"),
        row(M::ModeDamping, ("mode_damping", ""), Loop, BAND, "least damping ratio of a closed-loop mode"),
        row(M::FrozenStable, ("frozen_stable", ""), Frozen, &[], "1 if stable at every gain of a map of what the supervisor can produce, held still, and of a search around the worst; needs no limit"),
        row(M::FrozenGainMargin, ("frozen_gain_margin_db", "dB"), Frozen, &[], "gain_margin_db at the worst of these gains"),
        row(M::FrozenPhaseMargin, ("frozen_phase_margin_deg", "deg"), Frozen, &[], "phase_margin_deg at the worst of these gains"),
        row(M::FrozenDiskMargin, ("frozen_disk_margin", ""), Frozen, &[], "disk_margin at the worst of these gains"),
        row(M::ShortPeriodDamping, ("short_period_damping", ""), Airframe, &[], "damping ratio of the aircraft's short period"),
        row(M::ControlAnticipation, ("cap_rad_s2_per_g", "rad/s² per g"), Airframe, &[], "control anticipation parameter"),
        row(M::PhugoidDamping, ("phugoid_damping", ""), Airframe, &[], "damping ratio of the aircraft's phugoid; 1 or -1 where it creeps"),
        row(M::PhugoidDoubling, ("phugoid_doubling_s", "s"), Airframe, &[], "time in which the phugoid doubles, whether it swings or creeps"),
        row(M::PhugoidOscillationDoubling, ("phugoid_oscillation_doubling_s", "s"), Airframe, &[], "time in which a phugoid that swings doubles; infinite for one that creeps"),
        row(M::PhugoidDivergenceDoubling, ("phugoid_divergence_doubling_s", "s"), Airframe, &[], "time in which a phugoid that creeps doubles; infinite for one that swings"),
        row(M::EquivalentDelay, ("equivalent_delay_s", "s"), Airframe, &[], "delay of servo, whole samples and half a sample of the hold"),
        row(M::LargestLoadFactor, ("largest_load_factor_g", "g"), Aircraft, TIMES, "largest load factor along the body's upward axis; 1 in level flight"),
        row(M::LeastLoadFactor, ("least_load_factor_g", "g"), Aircraft, TIMES, "least load factor along the body's upward axis; its limits may be below 0"),
        row(M::AltitudeLoss, ("altitude_loss_ft", "ft"), Aircraft, TARGET, "largest fall below the altitude of the start, or below the target; 0 where it never is below"),
        row(M::AltitudeOvershoot, ("altitude_overshoot_ft", "ft"), Aircraft, TARGET, "how far it goes beyond the target altitude, seen from the start, or beyond the start, seen from the target; one that does not get there has none"),
        row(M::AltitudeDeviation, ("altitude_deviation_ft", "ft"), Aircraft, TARGET, "largest distance from the altitude of the start, or from the target"),
        row(M::LargestAirspeed, ("largest_airspeed_kt", "kt"), Aircraft, TIMES, "largest true airspeed"),
        row(M::LeastAirspeed, ("least_airspeed_kt", "kt"), Aircraft, TIMES, "least true airspeed"),
        row(M::AirspeedDeviation, ("airspeed_deviation_kt", "kt"), Aircraft, TIMES, "largest distance of the true airspeed from that of the trim"),
        row(M::LargestAlpha, ("largest_alpha_deg", "deg"), Aircraft, TIMES, "largest angle of attack, from the reference of the aircraft's data"),
        row(M::AlphaMargin, ("alpha_margin_deg", "deg"), Aircraft, TIMES, "least distance below the largest angle of attack for which the aircraft's data are trusted; below 0 beyond it"),
        row(M::LargestBank, ("largest_bank_deg", "deg"), Aircraft, TIMES, "largest size of the bank"),
        row(M::LargestPitch, ("largest_pitch_deg", "deg"), Aircraft, TIMES, "largest pitch above the horizon, in the axes of the aircraft's data; below 0 for a nose that is always low"),
        row(M::LeastPitch, ("least_pitch_deg", "deg"), Aircraft, TIMES, "least pitch above the horizon; its limits may be below 0"),
        row(M::LargestSink, ("largest_sink_ft_min", "ft/min"), Aircraft, TIMES, "fastest descent; 0 where it never descends"),
        row(M::FinalSink, ("final_sink_ft_min", "ft/min"), Aircraft, TIMES, "descent at the end of the time that counts; below 0 in a climb"),
        row(M::Certified, ("certified", ""), Proof, &[], "1 if the loop is proved stable while its gains move, for every set-point and load that the scenario commands; needs no limit"),
    ]
};

impl Measure {
    /// All of them.
    pub const ALL: [Self; ROWS.len()] = {
        let mut all = [Self::Overshoot; ROWS.len()];
        let mut index = 0;
        while index < ROWS.len() {
            all[index] = ROWS[index].measure;
            index += 1;
        }
        all
    };

    /// Names of all of them.
    pub const NAMES: [&'static str; ROWS.len()] = {
        let mut names = [""; ROWS.len()];
        let mut index = 0;
        while index < ROWS.len() {
            names[index] = ROWS[index].name;
            index += 1;
        }
        names
    };

    const fn row(self) -> &'static Row {
        const TABLE: &[Row; ROWS.len()] = &ROWS;
        &TABLE[self as usize]
    }

    /// Name in files and answers, with its unit.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Its unit; empty for a number without one.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        self.row().unit
    }

    /// What must be at hand to answer it.
    #[must_use]
    pub const fn family(self) -> Family {
        self.row().family
    }

    /// What it is, in a line.
    #[must_use]
    pub const fn doc(self) -> &'static str {
        self.row().doc
    }

    /// True for a measure that is 1 or 0, so that it needs no limit.
    #[must_use]
    pub const fn is_yes_or_no(self) -> bool {
        matches!(self, Self::Stable | Self::FrozenStable | Self::Certified)
    }

    /// What 1 and 0 are of such a measure.
    #[must_use]
    pub const fn yes_and_no(self) -> [&'static str; 2] {
        match self {
            Self::Certified => ["proved stable", "not proved stable"],
            _ => ["stable", "unstable"],
        }
    }

    /// True for a measure that may be below 0, so that its limits may be too.
    #[must_use]
    pub const fn is_signed(self) -> bool {
        matches!(
            self,
            Self::LargestLoadFactor
                | Self::LeastLoadFactor
                | Self::LargestAlpha
                | Self::AlphaMargin
                | Self::LargestPitch
                | Self::LeastPitch
                | Self::FinalSink
        )
    }

    /// True if the condition of this name can be asked of it, such as `step_deg`.
    #[must_use]
    pub fn takes(self, condition: &str) -> bool {
        let of_family = match self.family() {
            Family::Step => &["step_deg", "air"][..],
            Family::Flight | Family::Aircraft => &["air"],
            Family::Loop | Family::Frozen | Family::Airframe | Family::Proof => &[],
        };
        of_family.contains(&condition) || self.row().conditions.contains(&condition)
    }

    /// The measure with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|measure| measure.name() == name)
    }

    /// What of a value is compared with limits: of the error that is left its size, of everything else
    /// the value itself.
    #[must_use]
    pub fn compared(self, value: f64) -> f64 {
        if self == Self::FinalError { value.abs() } else { value }
    }
}

/// A measure's name in words, without its unit: `elevator_rate_deg_s` in deg/s is "elevator rate".
#[must_use]
pub fn label(name: &str, unit: &str) -> String {
    let suffix = unit_in_names(unit);
    let bare = name.strip_suffix(&suffix).and_then(|rest| rest.strip_suffix('_')).unwrap_or(name);
    let bare = if suffix.is_empty() { name } else { bare };
    let word = |word: &str| match word {
        "iae" | "itae" | "ise" | "itse" | "rms" => word.to_uppercase(),
        _ => word.to_owned(),
    };
    bare.split('_').map(word).collect::<Vec<_>>().join(" ")
}

/// A unit as names end with it: `deg/s` is `deg_s`.
fn unit_in_names(unit: &str) -> String {
    unit.replace('%', "pct").replace('\u{b2}', "2").replace(['/', ' '], "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_measure_stands_at_its_own_row_with_a_name_of_its_own() {
        for (index, measure) in Measure::ALL.into_iter().enumerate() {
            assert_eq!(measure as usize, index, "{}", measure.name());
            assert_eq!(Measure::from_name(measure.name()), Some(measure));
            assert!(measure.doc().len() > 10, "{}", measure.name());
        }
    }

    #[test]
    fn the_unit_of_a_measure_is_the_last_part_of_its_name() {
        for measure in Measure::ALL {
            let suffix = format!("_{}", unit_in_names(measure.unit()).to_lowercase());
            let has_unit = !measure.unit().is_empty();
            assert!(!has_unit || measure.name().ends_with(&suffix), "{}", measure.name());
        }
    }

    #[test]
    fn names_lose_their_units_in_words() {
        assert_eq!(label("elevator_rate_deg_s", "deg/s"), "elevator rate");
        assert_eq!(label("itse_deg2_s2", "deg\u{b2} s\u{b2}"), "ITSE");
        assert_eq!(label("overshoot_pct", "%"), "overshoot");
        assert_eq!(label("disk_margin", ""), "disk margin");
    }
}
