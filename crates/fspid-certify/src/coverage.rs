//! What a certificate makes of every key of a scenario: one list, that a test holds against the specification.

/// What becomes of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// In the model that is proved, as it is.
    Covered,
    /// In the claim over a range that is stated, or with a bound of what it leaves.
    Bounded,
    /// A scenario that uses it is refused by name; the row says when.
    Refused,
    /// No part of the claim; said beside the verdict where the scenario has it.
    Beside,
    /// Nothing between pitch and elevator: names, what is asked of flights, tunings and contests.
    NoPart,
}

impl Treatment {
    /// In a word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Covered => "covered",
            Self::Bounded => "bounded",
            Self::Refused => "refused",
            Self::Beside => "said beside it",
            Self::NoPart => "no part",
        }
    }
}

/// A row of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyCoverage {
    /// Path of a key, or of a table with `.*` for all that is in it.
    pub keys: &'static str,
    /// What becomes of it.
    pub treatment: Treatment,
    /// How, in a sentence without a stop.
    pub how: &'static str,
}

const fn row(keys: &'static str, treatment: Treatment, how: &'static str) -> KeyCoverage {
    KeyCoverage { keys, treatment, how }
}

use Treatment::{Beside, Bounded, Covered, NoPart, Refused};

const GAINS: &str = "gains are enclosed over everything that the supervisor can answer";
const MOVING_AIR: &str = "the air is calm in the claim; what gusts of a size do at most, from rest, is bounded where `--disturbances` asks for it";
const NOISE: &str = "the claim is about sensors without noise";
const DRIFT: &str = "a bias stands still in the claim";
const LINEAR_AT_TRIM: &str =
    "the linear model at the trim; that the aircraft is nonlinear is said beside the verdict";
const TERMS: &str = "the constant set-points and loads of the range are those that it reaches; with limits in the loop it is flown in sets as it moves, times any number up to its size, where that is proved, and the time while it moves is left out otherwise";
const LOADS: &str = "the constant set-points and loads of the range are those that it reaches; what it does at most while it moves, from rest, is bounded where `--disturbances` asks for it and it enters at the elevator, or at a servo without a lag of second order; with limits in the loop it is flown in sets together with the set-point, where that is proved; and left out otherwise";
const AT_LIMITS: &str = "steps from rest up to a stated size, and what the scenario commands, are flown in sets with the limit acting; other motions within an ellipsoid in which none acts, or said to be left out; where rest itself is at a limit nothing is proved";
const AT_STOPS: &str = "no step of the stated size meets an end, and nothing that is proved of what the scenario commands; other motions within an ellipsoid in which none acts, or said to be left out; where rest itself is at a limit nothing is proved";
const STEPS: &str = "a disturbance of half a step; what it leaves is stated, and nothing is proved where that is more than a tenth of the set-points and than ten steps";
const AROUND: &str = "the claim is about the pitch loop alone, not about the loops around it";
const AIM: &str = "asked of flights, not of the loop";

/// Every key of a scenario.
pub const COVERAGE: &[KeyCoverage] = &[
    row("schema", NoPart, "version of the format"),
    row("name", NoPart, "a name"),
    row("set", Covered, "changes are made before anything is read"),
    row("plant.*", Covered, "coefficients as printed, with all decimals that round to them"),
    row("aircraft.name", Beside, LINEAR_AT_TRIM),
    row("aircraft.file", Beside, LINEAR_AT_TRIM),
    row("aircraft.model", Beside, LINEAR_AT_TRIM),
    row("aircraft.airspeed_m_s", Beside, LINEAR_AT_TRIM),
    row("aircraft.airspeed_kt", Beside, LINEAR_AT_TRIM),
    row("aircraft.airspeed_ft_s", Beside, LINEAR_AT_TRIM),
    row("aircraft.altitude_m", Beside, LINEAR_AT_TRIM),
    row("aircraft.altitude_ft", Beside, LINEAR_AT_TRIM),
    row("aircraft.climb_angle_deg", Beside, LINEAR_AT_TRIM),
    row("aircraft.mass_kg", Beside, LINEAR_AT_TRIM),
    row("aircraft.cg_mac", Beside, LINEAR_AT_TRIM),
    row("aircraft.ix_kg_m2", Beside, LINEAR_AT_TRIM),
    row("aircraft.ix_slug_ft2", Beside, LINEAR_AT_TRIM),
    row("aircraft.ix_gyration_m", Beside, LINEAR_AT_TRIM),
    row("aircraft.iy_kg_m2", Beside, LINEAR_AT_TRIM),
    row("aircraft.iy_slug_ft2", Beside, LINEAR_AT_TRIM),
    row("aircraft.iy_gyration_m", Beside, LINEAR_AT_TRIM),
    row("aircraft.iz_kg_m2", Beside, LINEAR_AT_TRIM),
    row("aircraft.iz_slug_ft2", Beside, LINEAR_AT_TRIM),
    row("aircraft.iz_gyration_m", Beside, LINEAR_AT_TRIM),
    row("aircraft.ixz_kg_m2", Beside, LINEAR_AT_TRIM),
    row("aircraft.ixz_slug_ft2", Beside, LINEAR_AT_TRIM),
    row("aircraft.atmosphere", Beside, LINEAR_AT_TRIM),
    row("aircraft.drag", Beside, LINEAR_AT_TRIM),
    row("aircraft.thrust", Beside, LINEAR_AT_TRIM),
    row("aircraft.configuration", Beside, LINEAR_AT_TRIM),
    row(
        "aircraft.heading_deg",
        Beside,
        "it changes what wind is met, and the air is calm in the claim",
    ),
    row("aircraft.ground_m", Beside, LINEAR_AT_TRIM),
    row("aircraft.validity", NoPart, AIM),
    row(
        "simulator.*",
        Refused,
        "another simulator flies, and there are no equations of its aircraft",
    ),
    row("configuration.*", Beside, LINEAR_AT_TRIM),
    row(
        "configuration_change.*",
        Beside,
        "the claim is about the configuration of the start; what moves after it is left out",
    ),
    row("ground_effect.*", Beside, LINEAR_AT_TRIM),
    row(
        "fuel.*",
        Beside,
        "the claim is about the mass of the start; what is burnt after it is left out",
    ),
    row("engine.*", Beside, LINEAR_AT_TRIM),
    row("lateral.*", NoPart, "pitch alone is in the model"),
    row("glide_slope.*", Beside, AROUND),
    row("outer_loop.*", Beside, AROUND),
    row("total_energy.*", Beside, AROUND),
    row("mode.*", Beside, AROUND),
    row("actuator.preset", Covered, "the parts that it stands for"),
    row("actuator.time_constant_s", Covered, "exactly held between samples"),
    row("actuator.natural_frequency_rad_s", Covered, "exactly held between samples"),
    row("actuator.damping", Covered, "exactly held between samples"),
    row("actuator.delay_samples", Covered, "a queue of commands in the state"),
    row("actuator.position_limit_deg", Bounded, AT_LIMITS),
    row("actuator.travel_deg", Bounded, AT_STOPS),
    row("actuator.rate_limit_deg_s", Bounded, AT_LIMITS),
    row("actuator.bias_deg", Bounded, "a constant load; limits are then left out"),
    row("actuator.deadband_deg", Refused, "above 0: around rest the loop is not linear"),
    row("actuator.backlash_deg", Refused, "above 0: around rest the loop is not linear"),
    row("loop.sample_period_s", Covered, "the period of plant and controller"),
    row(
        "loop.duration_s",
        NoPart,
        "a claim is about all time, and so is its range: what begins after the flight counts",
    ),
    row("setpoint.kind", Bounded, TERMS),
    row("setpoint.amplitude_deg", Bounded, TERMS),
    row("setpoint.at_s", Bounded, TERMS),
    row("setpoint.width_s", Bounded, TERMS),
    row("setpoint.half_period_s", Bounded, TERMS),
    row("setpoint.bipolar", Bounded, TERMS),
    row("setpoint.frequency_hz", Bounded, TERMS),
    row("setpoint.time_s", Bounded, TERMS),
    row("setpoint.value_deg", Bounded, TERMS),
    row("setpoint.interpolation", Bounded, TERMS),
    row("sensor.preset", Covered, "the parts that it stands for"),
    row(
        "sensor.seed",
        Bounded,
        "the bias that it draws counts as a load; the noise that it draws is left out",
    ),
    row("sensor.pitch.noise_deg_rt_hz", Beside, NOISE),
    row("sensor.pitch.bias_deg", Bounded, "the bias of this seed counts as a load"),
    row("sensor.pitch.drift_deg", Beside, DRIFT),
    row("sensor.pitch.drift_time_s", Beside, DRIFT),
    row("sensor.pitch.scale_error_pct", Covered, "a factor on what is seen"),
    row("sensor.pitch.resolution_deg", Bounded, STEPS),
    row(
        "sensor.pitch.period_s",
        Refused,
        "where it is not that of the loop: the age of values changes",
    ),
    row(
        "sensor.pitch.delay_s",
        Covered,
        "samples that are remembered, and a part of one as a straight line between two, which is said beside it",
    ),
    row(
        "sensor.pitch.erection_deg_min",
        Refused,
        "above 0 with an aircraft: the gyro follows the apparent vertical at a bounded rate",
    ),
    row("sensor.rate.noise_deg_s_rt_hz", Beside, NOISE),
    row("sensor.rate.bias_deg_s", Bounded, "the bias of this seed counts as a load"),
    row("sensor.rate.drift_deg_s", Beside, DRIFT),
    row("sensor.rate.drift_time_s", Beside, DRIFT),
    row("sensor.rate.scale_error_pct", Covered, "a factor on what is seen"),
    row("sensor.rate.resolution_deg_s", Bounded, STEPS),
    row(
        "sensor.rate.period_s",
        Refused,
        "where it is not that of the loop: the age of values changes",
    ),
    row(
        "sensor.rate.delay_s",
        Covered,
        "samples that are remembered, and a part of one as a straight line between two, which is said beside it",
    ),
    row("wind.*", Beside, MOVING_AIR),
    row("gust.*", Beside, MOVING_AIR),
    row("turbulence.*", Beside, MOVING_AIR),
    row("disturbance.kind", Bounded, LOADS),
    row("disturbance.enters_at", Bounded, LOADS),
    row("disturbance.amplitude_deg", Bounded, LOADS),
    row("disturbance.at_s", Bounded, LOADS),
    row("disturbance.width_s", Bounded, LOADS),
    row("disturbance.frequency_hz", Bounded, LOADS),
    row("disturbance.standard_deviation_deg", Beside, NOISE),
    row("disturbance.seed", Beside, NOISE),
    row(
        "plant_change.*",
        Beside,
        "each plant that lasts is proved on its own; the passage is left out",
    ),
    row("controller.name", NoPart, "a name"),
    row("controller.kind", Covered, "fixed gains and self-tuning ones, each as it is"),
    row("controller.kp", Covered, "a gain"),
    row("controller.ki", Covered, "a gain"),
    row("controller.kd", Covered, "a gain"),
    row("controller.isa.*", Covered, "as the gains and the filter that it stands for"),
    row("controller.nominal.*", Covered, "the middle of the gains that are enclosed"),
    row("controller.nominal_isa.*", Covered, "as the gains and the filter that it stands for"),
    row("controller.design.*", Covered, "as the gains that it makes"),
    row("controller.weights.*", Covered, "as the gains that they make"),
    row(
        "controller.schedule.*",
        Covered,
        "as the gains that it makes at the airspeed of the scenario",
    ),
    row("controller.library", NoPart, "a program has no equations and is left out, by name"),
    row("controller.fmu", NoPart, "as `library`"),
    row("controller.inputs.*", NoPart, "of a program"),
    row("controller.outputs.*", NoPart, "of a program"),
    row("controller.answer_limit_s", NoPart, "of a program"),
    row("controller.control_law", NoPart, "as `library`"),
    row("controller.input.*", NoPart, "of a control law in a file"),
    row(
        "controller.listen",
        NoPart,
        "where a flight stack is waited for; it has no equations and is left out, by name",
    ),
    row("controller.connect_limit_s", NoPart, "of a flight stack"),
    row("controller.lead_in_s", NoPart, "of a flight stack"),
    row("controller.elevator_channel", NoPart, "of a flight stack"),
    row("controller.elevator_deg", NoPart, "of a flight stack"),
    row("controller.elevator_reversed", NoPart, "of a flight stack"),
    row("controller.pulses_us", NoPart, "of a flight stack"),
    row("controller.throttle_channel", NoPart, "of a flight stack"),
    row("controller.setpoint_channel", NoPart, "of a flight stack"),
    row("controller.setpoint_deg", NoPart, "of a flight stack"),
    row("controller.airspeed_m_s", NoPart, "of a flight stack"),
    row("controller.altitude_m", NoPart, "of a flight stack"),
    row("controller.latitude_deg", NoPart, "of a flight stack"),
    row("controller.longitude_deg", NoPart, "of a flight stack"),
    row("controller.declination_deg", NoPart, "of a flight stack"),
    row("controller.rate_gain", Covered, "the inner loop of pitch rate"),
    row(
        "controller.setpoint_weight",
        Bounded,
        "other than 1 with gains that move: over the range of set-points",
    ),
    row(
        "controller.setpoint_weights.proportional",
        Bounded,
        "other than 1 with gains that move: over the range of set-points",
    ),
    row(
        "controller.feedforward",
        Covered,
        "it does not move with the gains, and acts while the set-point moves, which is left out",
    ),
    row(
        "controller.setpoint_weights.derivative",
        Covered,
        "it acts while the set-point moves, which is left out",
    ),
    row(
        "controller.derivative_on",
        Covered,
        "it acts while the set-point moves, which is left out",
    ),
    row("controller.derivative_filter_s", Covered, "a state of the loop"),
    row(
        "controller.integral",
        Bounded,
        "the literal one with gains that move: over the range of set-points and loads",
    ),
    row(
        "controller.anti_windup.kind",
        Bounded,
        "clamping is a limit; the others act at limits alone, and in steps as they fly",
    ),
    row("controller.anti_windup.lower_deg", Bounded, AT_LIMITS),
    row("controller.anti_windup.upper_deg", Bounded, AT_LIMITS),
    row(
        "controller.anti_windup.tracking_s",
        Bounded,
        "it acts at limits alone, and in steps as it flies",
    ),
    row("controller.output_limits_deg", Bounded, AT_LIMITS),
    row("controller.slew_limit_deg_s", Bounded, AT_LIMITS),
    row(
        "controller.sample_guard_deg",
        Bounded,
        "below 10^6 deg a limit as the others, but on a pitch rate that the supervisor alone sees; above, a flight is lost before",
    ),
    row(
        "controller.law",
        Covered,
        "memoryless: gains belong to the error of the moment; accumulating: every combination of gains that the law reaches, at any time",
    ),
    row(
        "controller.leakage_per_s",
        Covered,
        "what bounds the gains of the accumulating law, and which combinations it reaches; without bounds it is refused",
    ),
    row("controller.gain_limits.*", Covered, "gains that are enclosed are moved into them"),
    row(
        "controller.dead_zone.*",
        Covered,
        "within it the rules add nothing; at its border the gains may jump",
    ),
    row(
        "controller.gain_coupling.*",
        Covered,
        "the rate loop follows kd in the matrix of the loop; the set-point weight follows kp in what the gains make of a held command",
    ),
    row("controller.supervisor.range", Covered, "the cells over which gains are enclosed fill it"),
    row("controller.supervisor.table", Covered, GAINS),
    row("controller.supervisor.table.*", Covered, GAINS),
    row("controller.supervisor.system", Covered, GAINS),
    row(
        "controller.supervisor.numbers.*",
        Covered,
        "the interpolation of the numbers is enclosed over everything that the supervisor can see",
    ),
    row(
        "controller.supervisor.network.*",
        Covered,
        "what the network answers is enclosed over everything that the supervisor can see, with its rounding",
    ),
    row(
        "controller.supervisor.defuzzifier",
        Covered,
        "as it is, with the rounding of its sums; a certificate with more than 10 000 samples is refused",
    ),
    row(
        "controller.supervisor.out_of_range",
        Covered,
        "clamped: the gains at the border of the range; evaluated: all that rules can give; refused: those of before, which may be any",
    ),
    row(
        "controller.supervisor.error_sign",
        Covered,
        "an error turned round is another cell of the same surface: all cells are in the claim",
    ),
    row(
        "controller.supervisor.error_scale",
        Covered,
        "all inputs are in the claim, whatever the scale; it says which cells lie side by side in flight, and what a held command adds",
    ),
    row(
        "controller.supervisor.error_set_centres",
        Covered,
        "cells are told by their inputs, and asked for where the tuner moves these to",
    ),
    row("controller.supervisor.change", Covered, "as for the scales: per second or per sample"),
    row(
        "controller.supervisor.change_scale",
        Covered,
        "all inputs are in the claim, whatever the scale; it says which cells lie side by side in flight, and what a held command adds",
    ),
    row(
        "controller.supervisor.change_set_centres",
        Covered,
        "cells are told by their inputs, and asked for where the tuner moves these to",
    ),
    row(
        "controller.supervisor.second_input",
        Covered,
        "the gains of all inputs are in the claim, whatever shows them; the pitch rate only through a sensor without bias",
    ),
    row(
        "controller.supervisor.model.*",
        Covered,
        "its error may be any; where gains remember a held command, its states are in the loop",
    ),
    row(
        "controller.supervisor.output_scale.*",
        Covered,
        "a factor on what is enclosed of each gain",
    ),
    row("requirement.*", NoPart, AIM),
    row(
        "dispersion.*",
        Beside,
        "the claim is about the nominal numbers; what a family draws of the loop is in its claim, and what is drawn of all that acts on it is not",
    ),
    row("tuning.*", NoPart, AIM),
    row("contest.*", NoPart, AIM),
];

/// The list as a table of a document.
#[must_use]
pub fn coverage_table() -> String {
    let mut out = String::from("| key | in a certificate | how |\n| --- | --- | --- |\n");
    for KeyCoverage { keys, treatment, how } in COVERAGE {
        out.push_str(&format!("| `{keys}` | {} | {how} |\n", treatment.word()));
    }
    out
}

#[cfg(test)]
mod tests {
    use fspid_scenario::file::scenario_keys;

    use super::*;

    fn matches(row: &KeyCoverage, path: &str) -> bool {
        match row.keys.strip_suffix('*') {
            Some(before) => path.starts_with(before),
            None => row.keys == path,
        }
    }

    #[test]
    fn every_key_of_a_scenario_has_one_row_and_every_row_a_key() {
        let paths = scenario_keys();
        for path in &paths {
            let rows = COVERAGE.iter().filter(|row| matches(row, path)).count();
            assert_eq!(rows, 1, "{path}: decide what a certificate makes of it, in COVERAGE");
        }
        for row in COVERAGE {
            assert!(paths.iter().any(|path| matches(row, path)), "{}: no such key", row.keys);
        }
    }

    #[test]
    fn the_document_shows_the_list() {
        let document = include_str!("../../../docs/certificates.md");
        let table = coverage_table();
        assert!(document.contains(&table), "docs/certificates.md should have this table:\n{table}");
    }
}
