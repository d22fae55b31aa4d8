//! The autopilot around the loop: outer loops, modes, engine and glide slope.

use fspid_aircraft::Spool;
use fspid_core::{AntiWindup, ControllerSetting, Gains, Limits, Pid, PidConfig, SetpointWeights};
use fspid_sim::aircraft::Lateral;
use fspid_sim::autopilot::{
    Autopilot, AutopilotError, Condition, Engagement, Entry, GlideSlope, Mode, Moves, OuterLoop,
    Quantity, Side, TotalEnergy, Units,
};
use fspid_sim::sensor::{Sensor, SensorModel};
use fspid_sim::{Controller, Plant, Simulator};

use super::cost::check_times;
use super::flown::Flown;
use super::{controller, judged, rad};
use crate::file::aircraft::{quantity, unit_size};
use crate::file::dispersion::placed_texts;
use crate::file::files::Files;
use crate::file::spec::autopilot as keys;
use crate::file::spec::autopilot::{EngineKind, HoldsWord};
use crate::file::spec::flight::GROUND_M;
use crate::file::spec::scenario::{
    AIRCRAFT, ENGINE, GLIDE_SLOPE, LATERAL, MODE, OUTER_LOOP, TOTAL_ENERGY,
};
use crate::keyed::{Key, Section};
use fspid_diagnostics::{Report, known_words};

/// First channel of the sensors of outer loops in the streams of their seeds; pitch and pitch rate come before.
const FIRST_CHANNEL: u32 = 16;
/// Channels of the glide slope: its angle and its range.
const BEAM_CHANNELS: [u32; 2] = [8, 9];
/// What `moves` may say beside the names of loops.
const SURFACES: [(&str, Moves); 3] =
    [("pitch", Moves::Pitch), ("throttle", Moves::Throttle), ("bank", Moves::Bank)];

/// What stands around the loop; the inner `None` where nothing does, the outer one for a problem.
#[allow(clippy::option_option, reason = "left out and refused are two things")]
pub(super) fn autopilot(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (flown, dt_s): (Option<&Flown>, f64),
) -> Option<Option<Autopilot>> {
    let (loops, modes) = (section.sections(OUTER_LOOP), section.sections(MODE));
    let energy = section.get(TOTAL_ENERGY);
    let beam = section.get(GLIDE_SLOPE);
    if loops.is_empty() && modes.is_empty() && energy.is_none() && beam.is_none() {
        return Some(None);
    }
    let before = report.count();
    refuse_pitch_alone(report, section, flown);
    let written = loops;
    let loops: Vec<Option<OuterLoop>> = (written.iter().enumerate())
        .map(|(number, part)| outer_loop(report, files, (part, number), (written, dt_s)))
        .collect();
    let energy = energy.map(|part| total_energy(report, part, dt_s));
    let beam = beam.map(|part| glide_slope(report, (part, section), flown));
    let modes: Vec<Option<Mode>> = modes.iter().map(|part| mode(report, part, section)).collect();
    if report.count() > before {
        return None;
    }
    let parts = (loops.into_iter().collect::<Option<_>>()?, energy.flatten(), beam.flatten());
    let autopilot = joined(report, section, parts, modes.into_iter().collect::<Option<_>>()?)?;
    refuse_bank(report, section, (flown, &autopilot)).map(|()| Some(autopilot))
}

/// Refuses a bank in JSBSim, at whatever asks for it.
fn refuse_bank(
    report: &mut Report,
    section: &Section,
    (flown, autopilot): (Option<&Flown>, &Autopilot),
) -> Option<()> {
    if flown.is_none_or(|flown| flown.plant.external().is_none()) {
        return Some(());
    }
    let before = report.count();
    let message = "the bridge to JSBSim levels the wings and holds no bank";
    let loops = section.sections(OUTER_LOOP).iter().zip(autopilot.loops());
    for (part, _) in loops.filter(|(_, outer)| outer.moves == Moves::Bank) {
        part.wrong(report, keys::MOVES, message, "pitch, throttle, or another loop");
    }
    let modes = section.sections(MODE).iter().zip(autopilot.modes());
    for (part, _) in modes.filter(|(_, mode)| mode.bank_rad != 0.0) {
        part.wrong(report, keys::BANK_DEG, message, "0");
    }
    (report.count() == before).then_some(())
}

/// The aircraft with its engine's lag and what looks after its lateral motion.
pub(super) fn equipped(report: &mut Report, section: &Section, flown: Flown) -> Option<Flown> {
    let flown = with_engine(report, section, flown)?;
    with_lateral(report, section, flown)
}

/// How the engine of an aircraft follows; the aircraft, where that makes sense.
fn with_engine(report: &mut Report, section: &Section, flown: Flown) -> Option<Flown> {
    let Some(part) = section.get(ENGINE).filter(|part| part.sound) else { return Some(flown) };
    let spool = match part.variant()? {
        EngineKind::FirstOrder => {
            Spool::FirstOrder { time_constant_s: part.get(keys::TIME_CONSTANT_S)? }
        }
        EngineKind::StevensLewis => Spool::StevensLewis,
    };
    let Plant::Aircraft(plant) = flown.plant else {
        let message = match flown.plant {
            Plant::External(_) => "another simulator flies, whose engine is its own",
            _ => "a linear plant has no engine",
        };
        report.value(part.place, &part.path, message, "nothing; or a nonlinear aircraft");
        return Some(flown);
    };
    let plant = judged(report, (part, keys::TIME_CONSTANT_S), plant.with_engine(spool))?;
    Some(Flown { plant: plant.into(), ..flown })
}

/// How the lateral motion of an aircraft is looked after; the aircraft, where that makes sense.
fn with_lateral(report: &mut Report, section: &Section, flown: Flown) -> Option<Flown> {
    let Some(part) = section.get(LATERAL).filter(|part| part.sound) else { return Some(flown) };
    let usual = Lateral::default();
    let lateral = Lateral {
        bank_time_s: part.get(keys::BANK_TIME_S).unwrap_or(usual.bank_time_s),
        yaw_damping: part.get(keys::YAW_DAMPING).unwrap_or(usual.yaw_damping),
    };
    let Plant::Aircraft(plant) = flown.plant else {
        let message = match flown.plant {
            Plant::External(_) => "another simulator flies, whose wings are held by `wings`",
            _ => "a linear plant has no lateral motion",
        };
        report.value(part.place, &part.path, message, "nothing; or a nonlinear aircraft");
        return Some(flown);
    };
    let plant = judged(report, (part, keys::BANK_TIME_S), plant.with_lateral(lateral))?;
    Some(Flown { plant: plant.into(), ..flown })
}

/// Refuses every table of an autopilot around a plant that shows pitch alone.
fn refuse_pitch_alone(report: &mut Report, section: &Section, flown: Option<&Flown>) {
    let message = match flown.map(|flown| &flown.plant) {
        Some(Plant::Linear(_)) => {
            "a linear plant shows neither altitude nor airspeed that outer loops could hold"
        }
        Some(Plant::External(plant)) if matches!(plant.simulator, Simulator::Fmu(_)) => {
            "an FMU shows neither altitude nor airspeed that outer loops could hold"
        }
        _ => return,
    };
    let lists = [section.sections(OUTER_LOOP), section.sections(MODE)].into_iter().flatten();
    let single = [TOTAL_ENERGY, GLIDE_SLOPE].into_iter().filter_map(|key| section.get(key));
    for part in lists.chain(single) {
        report.value(part.place, &part.path, message, "a nonlinear aircraft, or nothing");
    }
}

/// The whole; each mode is judged by itself first, so that the problems of all are told.
fn joined(
    report: &mut Report,
    section: &Section,
    (loops, energy, beam): (Vec<OuterLoop>, Option<TotalEnergy>, Option<GlideSlope>),
    modes: Vec<Mode>,
) -> Option<Autopilot> {
    let before = report.count();
    let mut known: Vec<AutopilotError> = Vec::new();
    for (mode, part) in modes.iter().zip(section.sections(MODE)) {
        let conditions = mode.entry.conditions.clone();
        let entry = Entry { at_s: 0.0, conditions: Vec::new() };
        let alone = vec![Mode { entry, ..mode.clone() }];
        if let Err(error) = Autopilot::new(loops.clone(), energy, beam, alone) {
            // Two modes that use the same wrong loop tell it once.
            if !known.contains(&error) {
                told(report, section, Some(part), &error);
                known.push(error);
            }
        }
        let looks = conditions.iter().any(|it| it.quantity == Quantity::GlideSlope);
        if looks && beam.is_none() {
            told(report, section, Some(part), &AutopilotError::NoBeam { name: mode.name.clone() });
        }
    }
    if report.count() > before {
        return None;
    }
    match Autopilot::new(loops, energy, beam, modes) {
        Ok(autopilot) => Some(autopilot),
        Err(error) => {
            told(report, section, None, &error);
            None
        }
    }
}

/// Reports what is wrong at the table that is to blame: that of the mode or the loop which the error names.
fn told(report: &mut Report, section: &Section, mode: Option<&Section>, error: &AutopilotError) {
    let named = |key: Key<[Section]>, name: &str| {
        section.sections(key).iter().find(|part| part.own_name() == name)
    };
    let part = match error {
        AutopilotError::WrongPair { name, .. } | AutopilotError::Circle { name } => {
            named(OUTER_LOOP, name)
        }
        AutopilotError::NoBeam { name } | AutopilotError::TwoOfOneName { name } => {
            named(OUTER_LOOP, name).or_else(|| named(MODE, name))
        }
        AutopilotError::FirstWaits { mode } | AutopilotError::NeverBegins { mode, .. } => {
            named(MODE, mode)
        }
        _ => mode,
    };
    let first = || section.sections(MODE).iter().chain(section.sections(OUTER_LOOP)).next();
    let part = part.or(mode).or_else(first).unwrap_or(section);
    let text = error.to_string();
    let (message, allowed) = fspid_diagnostics::in_two(&text);
    report.missing(part.place, &part.path, message, allowed);
}

fn holds(word: HoldsWord) -> Quantity {
    match word {
        HoldsWord::Altitude => Quantity::Altitude,
        HoldsWord::VerticalSpeed => Quantity::VerticalSpeed,
        HoldsWord::FlightPath => Quantity::FlightPath,
        HoldsWord::Airspeed => Quantity::Airspeed,
        HoldsWord::GlideSlope => Quantity::GlideSlope,
        HoldsWord::Heading => Quantity::Heading,
    }
}

/// What a unit of the text is for a controller, which counts degrees as radians: every other unit passes as a degree does, so
/// that gains and scales of the text mean what they say.
fn counted(is_angle: bool) -> f64 {
    if is_angle { 1.0 } else { rad(1.0) }
}

fn is_angle(quantity: Quantity) -> bool {
    match quantity {
        Quantity::FlightPath | Quantity::Heading => true,
        Quantity::Altitude
        | Quantity::VerticalSpeed
        | Quantity::Airspeed
        | Quantity::GlideSlope => false,
    }
}

fn outer_loop(
    report: &mut Report,
    files: &mut Files<'_>,
    (part, number): (&Section, usize),
    (all, dt_s): (&[Section], f64),
) -> Option<OuterLoop> {
    let part = Some(part).filter(|part| part.sound)?;
    let name = part.get(keys::NAME)?;
    if SURFACES.iter().any(|(surface, _)| *surface == name) {
        let allowed = "any name but \"pitch\", \"throttle\" and \"bank\", which loops move";
        part.wrong(report, keys::NAME, "it is what a loop moves", allowed);
    }
    let (quantity, moves) = (holds(part.get(keys::HOLDS)?), moves(report, part, all));
    let moves = moves?;
    let moves_angle = match moves {
        Moves::Pitch | Moves::Bank => true,
        Moves::Throttle => false,
        Moves::Loop(below) => {
            let below = all.get(below).and_then(|below| below.get(keys::HOLDS));
            below.is_some_and(|below| is_angle(holds(below)))
        }
    };
    let units = Units { held: counted(is_angle(quantity)), moved: counted(moves_angle) };
    let ends = ends(report, part, dt_s);
    let controller = controller::outer(report, files, part, ends?);
    Some(OuterLoop {
        name: name.to_owned(),
        holds: quantity,
        moves,
        controller: controller?,
        units,
        sensor: sensor(report, part, (quantity, number), dt_s)?,
    })
}

fn moves(report: &mut Report, part: &Section, all: &[Section]) -> Option<Moves> {
    let name = part.get(keys::MOVES)?;
    if let Some((_, moves)) = SURFACES.iter().find(|(surface, _)| *surface == name) {
        return Some(*moves);
    }
    let found = all.iter().position(|other| other.own_name() == name);
    if found.is_none() {
        let names = SURFACES.iter().map(|(surface, _)| *surface);
        let names: Vec<&str> = names.chain(all.iter().map(Section::own_name)).collect();
        let message = format!("nothing of this name{}", known_words(name, &names));
        part.wrong(report, keys::MOVES, message, "");
    }
    found.map(Moves::Loop)
}

/// Limits of what is commanded, in its unit; an integral waits at them.
fn ends(report: &mut Report, part: &Section, dt_s: f64) -> Option<PidConfig<f64>> {
    let (least, most) = (part.get(keys::LEAST), part.get(keys::GREATEST));
    let (lower, upper) = (least.map_or(f64::NEG_INFINITY, rad), most.map_or(f64::INFINITY, rad));
    let limits = match (least, most) {
        (None, None) => None,
        _ if lower < upper => Limits::new(ControllerSetting::OutputLimits, lower, upper).ok(),
        _ => {
            let allowed = format!("above {:?}", least.unwrap_or_default());
            part.wrong(report, keys::GREATEST, "not above `least`", allowed);
            return None;
        }
    };
    let slew_rad_s = part.get(keys::MOST_PER_S).map(rad);
    let is_limited = limits.is_some() || slew_rad_s.is_some();
    let anti_windup = if is_limited { AntiWindup::Conditional } else { AntiWindup::None };
    Some(PidConfig { limits, slew_rad_s, anti_windup, ..PidConfig::sampled_every(dt_s) })
}

/// The errors of what a loop sees; the inner `None` without any.
#[allow(clippy::option_option, reason = "left out and refused are two things")]
fn sensor(
    report: &mut Report,
    part: &Section,
    (quantity, number): (Quantity, usize),
    dt_s: f64,
) -> Option<Option<Sensor>> {
    let Some(sensor) = part.get(keys::LOOP_SENSOR) else { return Some(None) };
    let size = |value: f64| if is_angle(quantity) { rad(value) } else { value };
    let given = |key: Key<f64>| sensor.get(key).unwrap_or(0.0);
    let model = SensorModel {
        noise_density: size(given(keys::NOISE)),
        bias: size(given(keys::BIAS)),
        resolution: size(given(keys::RESOLUTION)),
        period_s: given(keys::PERIOD_S),
        delay_s: given(keys::DELAY_S),
        ..SensorModel::default()
    };
    let seed = u64::try_from(sensor.get(keys::LOOP_SEED).unwrap_or(1)).ok()?;
    let channel = FIRST_CHANNEL + u32::try_from(number).ok()?;
    let built = judged(report, (sensor, keys::NOISE), Sensor::new(model, seed, channel))?;
    let slowest = if model.delay_s > model.period_s { keys::DELAY_S } else { keys::PERIOD_S };
    check_times(report, (sensor, [keys::PERIOD_S.into(), slowest.into()]), &built, dt_s);
    Some(Some(built))
}

fn total_energy(report: &mut Report, part: &Section, dt_s: f64) -> Option<TotalEnergy> {
    let part = Some(part).filter(|part| part.sound)?;
    let pitch_rad = rad(part.get(keys::PITCH_LIMITS_DEG)?);
    let limits = Limits::new(ControllerSetting::OutputLimits, -pitch_rad, pitch_rad).ok();
    let mut answering = |gains: &Section, limits: Option<Limits<f64>>| {
        let values =
            Gains { kp: gains.get(keys::ENERGY_KP)?, ki: gains.get(keys::ENERGY_KI)?, kd: 0.0 };
        // What is found is taken off, what is missing is added up: the command does not jump with what is asked.
        let setpoint_weights = SetpointWeights { proportional: 0.0, derivative: 0.0 };
        let anti_windup = if limits.is_some() { AntiWindup::Conditional } else { AntiWindup::None };
        let config =
            PidConfig { setpoint_weights, limits, anti_windup, ..PidConfig::sampled_every(dt_s) };
        let pid = judged(report, (gains, keys::ENERGY_KP), Pid::new(values, config))?;
        Some(Controller::Fixed(pid))
    };
    Some(TotalEnergy {
        altitude_gain_1_s: part.get(keys::ALTITUDE_GAIN)?,
        airspeed_gain_1_s: part.get(keys::AIRSPEED_GAIN)?,
        most_path_rad: rad(part.get(keys::MOST_PATH_DEG)?),
        most_acceleration_g: part.get(keys::MOST_ACCELERATION_G)?,
        energy: answering(part.get(keys::THROTTLE_GAINS)?, None)?,
        distribution: answering(part.get(keys::PITCH_GAINS)?, limits)?,
    })
}

fn glide_slope(
    report: &mut Report,
    (part, section): (&Section, &Section),
    flown: Option<&Flown>,
) -> Option<GlideSlope> {
    let part = Some(part).filter(|part| part.sound)?;
    let course = flown?.way?.course;
    let distance_m = quantity(part, keys::DISTANCE)?;
    let (sine, cosine) = libm::sincos(course.heading_rad);
    let [north_m, east_m] = course.start_m;
    let altitude_m = match quantity(part, keys::ANTENNA_ALTITUDE) {
        Some(altitude_m) => altitude_m,
        // The ground of another simulator is at sea level.
        None => section.get(AIRCRAFT).map_or(Some(0.0), |aircraft| aircraft.get(GROUND_M))?,
    };
    let seed = u64::try_from(part.get(keys::SEED)?).ok()?;
    let mut sensor = |(noise_density, bias): (f64, f64), channel: u32| {
        let model = SensorModel { noise_density, bias, ..SensorModel::default() };
        judged(report, (part, keys::SEED), Sensor::new(model, seed, channel))
    };
    let angle = (rad(part.get(keys::ANGLE_NOISE)?), rad(part.get(keys::ANGLE_BIAS_DEG)?));
    let range = (part.get(keys::RANGE_NOISE)?, part.get(keys::RANGE_BIAS_M)?);
    let [angle_channel, range_channel] = BEAM_CHANNELS;
    let beam = GlideSlope {
        angle_rad: rad(part.get(keys::ANGLE_DEG)?),
        antenna_m: [north_m + distance_m * cosine, east_m + distance_m * sine],
        altitude_m,
        course_rad: course.heading_rad,
        angle_sensor: Some(sensor(angle, angle_channel)?),
        range_sensor: Some(sensor(range, range_channel)?),
    };
    judged(report, (part, keys::ANGLE_DEG), beam.checked())
}

fn mode(report: &mut Report, part: &Section, section: &Section) -> Option<Mode> {
    let part = Some(part).filter(|part| part.sound)?;
    let (engaged, total_energy) = engaged(report, part, section)?;
    Some(Mode {
        name: part.get(keys::MODE_NAME)?.to_owned(),
        entry: Entry { at_s: part.get(keys::AT_S)?, conditions: conditions(part) },
        engaged,
        total_energy,
        targets: targets(report, part)?,
        bank_rad: rad(part.get(keys::BANK_DEG)?),
    })
}

/// The numbers of the loops that a mode engages, and whether that for altitude and airspeed together is one of them.
fn engaged(report: &mut Report, part: &Section, section: &Section) -> Option<(Vec<usize>, bool)> {
    let Some(item) = part.get(keys::ENGAGE) else { return Some((Vec::new(), false)) };
    let Some(names) = placed_texts(item) else {
        part.wrong(report, keys::ENGAGE, "wrong type", keys::names_in_words());
        return None;
    };
    let loops = section.sections(OUTER_LOOP);
    let energy = section.get(TOTAL_ENERGY).and_then(|energy| energy.get(keys::ENERGY_NAME));
    let (mut numbers, mut total_energy, before) = (Vec::new(), false, report.count());
    for (place, name) in names {
        match loops.iter().position(|other| other.own_name() == name) {
            Some(number) if !numbers.contains(&number) => numbers.push(number),
            Some(_) => {}
            None if energy == Some(name.as_str()) => total_energy = true,
            None => {
                let known: Vec<&str> = loops.iter().map(Section::own_name).chain(energy).collect();
                let known = known_words(&name, &known);
                let message = format!("there is no outer loop \"{name}\"{known}");
                report.missing(place, &part.path(keys::ENGAGE), message, "");
            }
        }
    }
    (report.count() == before).then_some((numbers, total_energy))
}

fn targets(report: &mut Report, part: &Section) -> Option<Vec<Engagement>> {
    let Some(part) = part.get(keys::TARGET) else { return Some(Vec::new()) };
    let before = report.count();
    let mut targets = Vec::new();
    for (word, units) in keys::TARGETS {
        let mut given = units.iter().filter_map(|key| Some((key, in_si(part, *key)?)));
        let Some((first, target)) = given.next() else { continue };
        if let Some((second, _)) = given.next() {
            let message = format!("`{}` says it already", first.name);
            part.wrong(report, second.name, message, "one of the two");
        }
        targets.push(Engagement { quantity: holds(word), target });
    }
    (report.count() == before).then_some(targets)
}

fn conditions(part: &Section) -> Vec<Condition> {
    let Some(part) = part.get(keys::WHEN) else { return Vec::new() };
    let condition = |(word, above, key): &(HoldsWord, bool, Key<f64>)| {
        let side = if *above { Side::Above } else { Side::Below };
        Some(Condition { quantity: holds(*word), side, value: in_si(part, *key)? })
    };
    keys::CONDITIONS.iter().filter_map(condition).collect()
}

/// What a key holds, in SI.
fn in_si(part: &Section, key: Key<f64>) -> Option<f64> {
    let value = part.get(key)?;
    Some(match key.unit() {
        "deg" => rad(value),
        unit => unit_size(unit) * value,
    })
}
