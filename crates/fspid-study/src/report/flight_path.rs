//! Where an aircraft flew, seen from the side, and how it was loaded.

use fspid_aircraft::{
    AirMotion, EulerAngles, ForceModel as _, Quaternion, Range, RigidState, Vector3,
};
use fspid_plot::{Band, LinePanel, Series, SeriesStyle};
use fspid_sim::{AircraftPlant, Trace};

use fspid_page::number::significant;
use fspid_scenario::units::{KNOT_M_S, degrees};

/// A flight that is drawn: its style, its name and what happened.
pub(super) type Flown<'a> = (SeriesStyle, &'a str, &'a Trace);

/// Arrows along the way.
const ARROWS: usize = 24;
/// Length of the longest arrow, px.
const LONGEST_PX: f64 = 30.0;
/// Length of a barb, as a share of its arrow, and the cosine and sine of its angle, 150 deg.
const BARB: [f64; 3] = [0.3, -0.866, 0.5];
/// What a figure of one panel leaves to the plot area beside its labels, and its height, px.
const BESIDE_PX: f64 = 90.0;
const HEIGHT_PX: f64 = 250.0;
/// A side view shows at least this much height, m: less is no climb but rounding of the figure.
const LEAST_HEIGHT_M: f64 = 20.0;
/// Air slower than this is calm, m/s.
const CALM_M_S: f64 = 1e-3;
/// Points of a line of equal angle of attack.
const POINTS: u32 = 60;

/// Altitude over the way over ground, with the air that the first flight met as arrows.
pub(super) fn side_view(
    plant: &AircraftPlant,
    flights: &[Flown<'_>],
    width_px: f64,
) -> Option<LinePanel> {
    let paths: Vec<Vec<(f64, f64)>> = flights.iter().map(|(.., trace)| path(trace)).collect();
    let all = || paths.iter().flatten();
    let (low_m, high_m) = ends(all().map(|point| point.1))?;
    let (_, end_m) = ends(all().map(|point| point.0))?;
    let margin_m = (0.5 * (LEAST_HEIGHT_M - (high_m - low_m))).max(0.25 * (high_m - low_m));
    let y_range = (low_m - margin_m, high_m + margin_m);
    let x_range = (0.0, end_m.max(1.0));
    let mut series: Vec<Series> = flights
        .iter()
        .zip(&paths)
        .map(|((style, name, _), path)| line(*style, name, path))
        .collect();
    let scale = Scale {
        x_m_px: (x_range.1 - x_range.0) / (width_px - BESIDE_PX).max(1.0),
        y_m_px: (y_range.1 - y_range.0) / HEIGHT_PX,
    };
    if let (Some((_, name, trace)), Some(path)) = (flights.first(), paths.first()) {
        let met_by = if flights.len() > 1 { format!(" that {name} met") } else { String::new() };
        series.extend(arrows(trace, path, &scale, &met_by));
    }
    let ground_m = plant.ground_altitude_m().filter(|ground_m| *ground_m > y_range.0);
    let bands = ground_m.map(|ground_m| Band {
        label: "ground".to_owned(),
        lower: y_range.0,
        upper: ground_m.min(y_range.1),
    });
    Some(LinePanel {
        y_label: "altitude [m]".to_owned(),
        x_label: "way over ground [m]".to_owned(),
        series,
        bands: bands.into_iter().collect(),
        x_range: Some(x_range),
        y_range: Some(y_range),
        ..LinePanel::default()
    })
}

/// Load factor over true airspeed, with what the largest and the least angle of attack of the data allow.
pub(super) fn loads(plant: &AircraftPlant, flights: &[Flown<'_>]) -> Option<LinePanel> {
    let points = |trace: &Trace| -> Option<Vec<(f64, f64)>> {
        let speeds = trace.column("airspeed_m_s")?.iter().map(|speed| speed / KNOT_M_S);
        Some(speeds.zip(trace.column("load_factor")?.iter().copied()).collect())
    };
    let paths: Vec<Vec<(f64, f64)>> =
        flights.iter().filter_map(|(.., trace)| points(trace)).collect();
    let all = || paths.iter().flatten();
    let (slowest, fastest) = ends(all().map(|point| point.0))?;
    let (least, most) = ends(all().map(|point| point.1))?;
    let x_range =
        ((0.8 * slowest).min(slowest - 10.0).max(0.0), (1.1 * fastest).max(fastest + 10.0));
    let mut series: Vec<Series> = flights
        .iter()
        .zip(&paths)
        .map(|((style, name, _), path)| line(*style, name, path))
        .collect();
    let Range { min, max } = plant.aircraft().model().validity().alpha_rad;
    let limits =
        [("largest", max, SeriesStyle::Setpoint), ("least", min, SeriesStyle::SetpointDashed)];
    for (word, alpha_rad, style) in limits.into_iter().filter(|(_, alpha, _)| alpha.is_finite()) {
        let name = format!(
            "at the {word} angle of attack of the data, {} deg",
            significant(degrees(alpha_rad), 3)
        );
        let at = |index: u32| {
            let share = f64::from(index) / f64::from(POINTS);
            let speed_kt = x_range.0 + share * (x_range.1 - x_range.0);
            (speed_kt, load_factor(plant, speed_kt * KNOT_M_S, alpha_rad))
        };
        series.push(line(style, &name, &(0..=POINTS).map(at).collect::<Vec<_>>()));
    }
    Some(LinePanel {
        y_label: "load factor [g]".to_owned(),
        x_label: "true airspeed [kt]".to_owned(),
        series,
        x_range: Some(x_range),
        y_range: Some((least.min(0.0) - 0.3, most.max(1.5) + 0.5)),
        ..LinePanel::default()
    })
}

/// Load factor at an angle of attack in still air, not turning, at the altitude and with the controls of the trim.
fn load_factor(plant: &AircraftPlant, airspeed_m_s: f64, alpha_rad: f64) -> f64 {
    let (sine, cosine) = libm::sincos(alpha_rad);
    let (trim, aircraft) = (plant.trim(), plant.aircraft());
    let state = RigidState {
        position_ned_m: Vector3::new(0.0, 0.0, -trim.target.altitude_m),
        velocity_body_m_s: Vector3::new(airspeed_m_s * cosine, 0.0, airspeed_m_s * sine),
        ..RigidState::AT_REST
    };
    let instant = aircraft.instant(&state, &trim.controls, &AirMotion::default());
    let gravity_m_s2 = aircraft.environment().gravity_m_s2;
    -instant.load_factors(aircraft.mass().mass_kg, gravity_m_s2).z
}

fn line(style: SeriesStyle, name: &str, points: &[(f64, f64)]) -> Series {
    let (x, y) = points.iter().copied().unzip();
    Series { name: name.to_owned(), style, x, y, stairs: false }
}

/// The least and the largest of some numbers that are finite.
fn ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| value.is_finite()).fold(None, |ends, value| match ends {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// Way over ground since the start and altitude, m, of each sample.
fn path(trace: &Trace) -> Vec<(f64, f64)> {
    let columns = ["north_m", "east_m", "altitude_m"].map(|name| trace.column(name));
    let [Some(north), Some(east), Some(altitude)] = columns else {
        return Vec::new();
    };
    let mut way_m = 0.0;
    let mut before = None;
    let places = north.iter().zip(east).zip(altitude);
    let point = |((north, east), altitude): ((&f64, &f64), &f64)| {
        let (n, e) = before.replace((*north, *east)).unwrap_or((*north, *east));
        way_m += libm::hypot(north - n, east - e);
        (way_m, *altitude)
    };
    places.map(point).collect()
}

/// How much a pixel is along the axes.
struct Scale {
    x_m_px: f64,
    y_m_px: f64,
}

/// The air along a path as arrows, the longest of them of a fixed length; none in calm air.
fn arrows(trace: &Trace, path: &[(f64, f64)], scale: &Scale, met_by: &str) -> Option<Series> {
    let last = path.len().checked_sub(1).filter(|last| *last > 0)?;
    let places: Vec<usize> = (0..ARROWS).map(|index| index * last / (ARROWS - 1)).collect();
    let air: Vec<(f64, f64)> =
        places.iter().map(|k| air_m_s(trace, *k)).collect::<Option<Vec<_>>>()?;
    let longest = air.iter().map(|(along, up)| libm::hypot(*along, *up)).fold(0.0, f64::max);
    if !(longest > CALM_M_S) {
        return None;
    }
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (place, (along, up)) in places.iter().zip(air) {
        let (x_m, y_m) = path.get(*place).copied()?;
        let (a, b) = (along / longest * LONGEST_PX, up / longest * LONGEST_PX);
        let [share, cosine, sine] = BARB;
        let barb =
            |sine: f64| (a + share * (a * cosine - b * sine), b + share * (a * sine + b * cosine));
        for (dx, dy) in [(0.0, 0.0), (a, b), barb(sine), (a, b), barb(-sine)] {
            x.push(x_m + dx * scale.x_m_px);
            y.push(y_m + dy * scale.y_m_px);
        }
        x.push(x_m);
        y.push(f64::NAN);
    }
    let name = format!("air{met_by}, longest arrow {} m/s", significant(longest, 3));
    Some(Series { name, style: SeriesStyle::Setpoint, x, y, stairs: false })
}

/// Velocity of the air along the way over ground and upward at a sample, m/s.
fn air_m_s(trace: &Trace, k: usize) -> Option<(f64, f64)> {
    let at = |name: &str, k: usize| trace.column(name)?.get(k).copied();
    let body =
        Vector3::new(at("air_forward_m_s", k)?, at("air_right_m_s", k)?, at("air_down_m_s", k)?);
    let attitude = EulerAngles {
        phi_rad: at("bank_rad", k)?,
        theta_rad: at("attitude_rad", k)?,
        psi_rad: at("heading_rad", k)?,
    };
    let [north, east, down] = Quaternion::from_euler(attitude).to_ned(body).to_array();
    let before = k.saturating_sub(1);
    let (n, e) = (
        at("north_m", before + 1)? - at("north_m", before)?,
        at("east_m", before + 1)? - at("east_m", before)?,
    );
    let way_m = libm::hypot(n, e);
    let along = if way_m > 0.0 { (north * n + east * e) / way_m } else { 0.0 };
    Some((along, 0.0 - down))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAVION: &str = include_str!("../../../../scenarios/gallery/wind-table.toml");

    fn flown(text: &str) -> (fspid_scenario::file::Study, Trace) {
        let study = fspid_scenario::file::parse(text, "a.toml", None, &[]).expect("a scenario");
        let trace = fspid_sim::simulate(&study.scenario).expect("it flies").traces.remove(0);
        (study, trace)
    }

    /// Level flight carries its weight: the line of the trim's angle of attack goes through the trim.
    #[test]
    fn the_line_of_an_angle_of_attack_goes_through_level_flight_at_its_speed() {
        let (study, trace) = flown(NAVION);
        let plant = study.scenario.plant.aircraft().expect("an aircraft");
        let alpha_rad = trace.column("alpha_rad").expect("there")[0];
        let load = load_factor(plant, plant.trim().target.airspeed_m_s, alpha_rad);
        assert!((load - alpha_rad.cos()).abs() < 1e-9, "{load}");
        // Twice the speed is four times the air's force, but for the thrust's part.
        let faster = load_factor(plant, 2.0 * plant.trim().target.airspeed_m_s, alpha_rad);
        assert!((faster / load - 4.0).abs() < 0.05, "{faster}");
    }

    #[test]
    fn arrows_are_the_air_along_the_way_and_upward_and_calm_air_has_none() {
        let (study, trace) = flown(NAVION);
        let plant = study.scenario.plant.aircraft().expect("an aircraft");
        // At 12 s a headwind of 5 m/s, at 17.5 s no wind but a downdraught of 2 m/s; the nose is to the north.
        for (k, along, up) in
            [(1200, -5.0, -0.8), (1750, 0.0, -2.0), (2200, 5.0, -1.2), (3500, 0.0, 0.0)]
        {
            let (found_along, found_up) = air_m_s(&trace, k).expect("there");
            assert!(
                (found_along - along).abs() < 1e-6 && (found_up - up).abs() < 1e-6,
                "{k}: {found_along} {found_up}"
            );
        }
        let names = |trace: &Trace| {
            let flights: [Flown<'_>; 1] = [(SeriesStyle::Numbered(0), "PID", trace)];
            let panel = side_view(plant, &flights, 720.0).expect("drawn");
            panel.series.into_iter().map(|series| series.name).collect::<Vec<_>>()
        };
        assert_eq!(names(&trace), ["PID", "air, longest arrow 5.27 m/s"]);
        let (_, calm) = flown(
            &NAVION
                .replace("-5.0", "0.0")
                .replace("5.0, 5.0, 0.0]", "0.0, 0.0, 0.0]")
                .replace("-2.0, -2.0", "0.0, 0.0"),
        );
        assert_eq!(names(&calm), ["PID"]);
    }
}
