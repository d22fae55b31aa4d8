//! The figures of an analysis: frequency responses, root locus, poles, frozen gains.

use fspid_lti::{Complex, SampledLoop, SampledMargins};
use fspid_sim::SimError;
use fspid_sim::flown::trajectory::{TrajectoryLinearisation, TrajectoryPoint};

use super::answer::{Margins, decibels};
use super::frozen::{FrozenMap, FrozenPoint};
use super::{AnalysedLoop, Analysis, Columns, PlantLoop};
use fspid_plot::{
    BodeFigure, CLOSED_LOOP_DB, Crossing, Exclusion, GainMap, GainSurface, LocusSample, LoopCurve,
    LoopPoint, MapCell, MapPoint, Margin, MarginDisk, MarginMark, NicholsFigure, NyquistFigure,
    PeakMark, PoleZeroMap, RadiusFigure, RootLocus, SensitivityFigure, Series, SeriesStyle, Svg,
    Transfer,
};

/// Points of a frequency response, over so many decades below the Nyquist frequency.
const POINTS: usize = 600;
const DECADES: f64 = 5.0;
/// Factors on the gain of a root locus, over so many decades to both sides of 1, and so far beyond the
/// limits of the gain.
const FACTORS: usize = 301;
const FACTOR_DECADES: f64 = 1.0;
const BEYOND_LIMIT: f64 = 1.5;
const WIDTH_PX: f64 = 720.0;

/// A loop with the name that figures show.
struct Shown<'a> {
    name: String,
    plant: &'a PlantLoop,
}

/// All loops of an analysis, ready to be drawn.
pub(crate) struct LoopFigures<'a> {
    shown: Vec<Shown<'a>>,
    curves: Vec<LoopCurve>,
}

impl<'a> LoopFigures<'a> {
    /// The worst plant of every controller.
    pub(crate) fn of(analysis: &'a Analysis) -> Self {
        let worst = |found: &'a AnalysedLoop| {
            Some(Shown { name: found.name.clone(), plant: found.worst()? })
        };
        let shown: Vec<Shown<'a>> = analysis.loops.iter().filter_map(worst).collect();
        let curves = shown.iter().enumerate().map(|(number, shown)| curve(number, shown)).collect();
        Self { shown, curves }
    }

    /// False if there is no loop to draw.
    pub(crate) fn any(&self) -> bool {
        !self.shown.is_empty()
    }

    /// The curves as columns.
    pub(super) fn columns(&self) -> Vec<(String, Columns)> {
        self.curves.iter().map(|curve| (curve.name.clone(), columns(curve))).collect()
    }

    fn nyquist_rad_s(&self) -> Option<f64> {
        self.shown.first().map(|shown| shown.plant.worst.open.nyquist_rad_s())
    }

    /// Margins of the loops that have some, with the number of their curves.
    fn margins(&self) -> impl Iterator<Item = (usize, &Margins)> {
        let numbered = self.shown.iter().enumerate();
        numbered
            .filter_map(|(number, shown)| Some((number, shown.plant.worst.margins.as_ref().ok()?)))
    }

    pub(crate) fn bode(&self) -> BodeFigure {
        let marks = self.margins().flat_map(|(curve, margins)| {
            let gains = margins.gain_margin_db.into_iter().zip(margins.phase_crossover_rad_s);
            let gains = gains.filter_map(move |(db, at)| {
                Some(MarginMark { curve, frequency_rad_s: at?, margin: Margin::GainDb(db) })
            });
            let phase = margins.gain_crossover_rad_s.map(|at| MarginMark {
                curve,
                frequency_rad_s: at,
                margin: Margin::PhaseDeg(margins.phase_margin_deg),
            });
            gains.chain(phase)
        });
        BodeFigure {
            title: "Open loop: gain and phase".to_owned(),
            curves: self.curves.clone(),
            margins: marks.collect(),
            nyquist_rad_s: self.nyquist_rad_s(),
            width_px: WIDTH_PX,
        }
    }

    pub(crate) fn nyquist(&self) -> NyquistFigure {
        let disks = self.margins().map(|(curve, margins)| MarginDisk {
            name: format!("disk margin of {}", self.shown[curve].name),
            curve,
            gain_min: factor(margins.disk_gain_db[0]),
            gain_max: factor(margins.disk_gain_db[1]),
        });
        NyquistFigure {
            title: "Open loop in the complex plane".to_owned(),
            curves: self.curves.clone(),
            disks: disks.collect(),
            reach: 3.0,
        }
    }

    pub(crate) fn nichols(&self) -> NicholsFigure {
        NicholsFigure {
            title: "Open loop: gain over phase".to_owned(),
            curves: self.curves.clone(),
            contours_db: CLOSED_LOOP_DB.to_vec(),
            exclusion: Some(Exclusion::diamond("6 dB and 45 deg, MIL-F-9490D", 6.0, 45.0)),
            width_px: WIDTH_PX,
        }
    }

    /// What the responses of `analyse --report` show, each by its name.
    pub(super) fn named(&self) -> Vec<(&'static str, Svg)> {
        if !self.any() {
            return Vec::new();
        }
        vec![
            ("bode", self.bode().render()),
            ("nyquist", self.nyquist().render()),
            ("nichols", self.nichols().render()),
            ("sensitivity", self.sensitivity().render()),
        ]
    }

    /// Poles and zeros of each worst plant as columns.
    pub(super) fn pole_columns(&self) -> Result<Vec<(String, Columns)>, SimError> {
        let one = |shown: &Shown<'_>| {
            let map = pole_zero(&shown.name, shown.plant)?;
            Ok((shown.name.clone(), poles(&map)))
        };
        self.shown.iter().map(one).collect()
    }

    pub(crate) fn sensitivity(&self) -> SensitivityFigure {
        let peaks = self.margins().map(|(curve, margins)| PeakMark {
            curve,
            transfer: Transfer::Sensitivity,
            frequency_rad_s: margins.sensitivity_peak_rad_s,
            peak_db: decibels(margins.sensitivity_peak),
        });
        SensitivityFigure {
            title: "Sensitivity and complementary sensitivity".to_owned(),
            curves: self.curves.clone(),
            peaks: peaks.collect(),
            disk_margins: self.margins().map(|(curve, m)| (curve, m.disk_margin)).collect(),
            nyquist_rad_s: self.nyquist_rad_s(),
            width_px: WIDTH_PX,
        }
    }
}

fn poles(map: &PoleZeroMap) -> Columns {
    let real = |values: &[(f64, f64)]| values.iter().map(|value| value.0).collect();
    let imaginary = |values: &[(f64, f64)]| values.iter().map(|value| value.1).collect();
    vec![
        ("closed_real", real(&map.closed_poles)),
        ("closed_imaginary", imaginary(&map.closed_poles)),
        ("open_real", real(&map.open_poles)),
        ("open_imaginary", imaginary(&map.open_poles)),
        ("zero_real", real(&map.open_zeros)),
        ("zero_imaginary", imaginary(&map.open_zeros)),
    ]
}

fn columns(curve: &LoopCurve) -> Columns {
    let (values, polar) = (&curve.points, curve.polar());
    vec![
        ("frequency_rad_s", values.iter().map(|it| it.frequency_rad_s).collect()),
        ("real", values.iter().map(|it| it.real).collect()),
        ("imaginary", values.iter().map(|it| it.imaginary).collect()),
        ("gain_db", polar.iter().map(|it| it.gain_db).collect()),
        ("phase_deg", polar.iter().map(|it| it.phase_deg).collect()),
        ("sensitivity_db", curve.transfer_db(Transfer::Sensitivity)),
        ("complementary_db", curve.transfer_db(Transfer::Complementary)),
    ]
}

fn factor(db: f64) -> f64 {
    libm::pow(10.0, db / 20.0)
}

fn curve(number: usize, shown: &Shown<'_>) -> LoopCurve {
    let open = &shown.plant.worst.open;
    let last = open.nyquist_rad_s();
    let place =
        |index: usize| last * libm::pow(10.0, DECADES * (index as f64 / (POINTS - 1) as f64 - 1.0));
    let point = |index| {
        let frequency_rad_s = place(index);
        let Complex { re, im } = open.at(frequency_rad_s);
        LoopPoint { frequency_rad_s, real: re, imaginary: im }
    };
    LoopCurve {
        name: shown.name.clone(),
        style: SeriesStyle::Numbered(number),
        points: (0..POINTS).map(point).collect(),
    }
}

fn pairs(values: &[Complex]) -> Vec<(f64, f64)> {
    values.iter().map(|value| (value.re, value.im)).collect()
}

/// Poles over the loop's gain.
///
/// # Errors
/// Eigenvalues that are not found.
pub(crate) fn root_locus(name: &str, plant: &PlantLoop) -> Result<RootLocus, SimError> {
    let open = &plant.worst.open;
    let crossings = crossings(open, plant.worst.sampled.as_deref());
    let [low, high] = decades(&crossings);
    let sample = |index: usize| {
        let share = index as f64 / (FACTORS - 1) as f64;
        let factor = libm::pow(10.0, low + share * (high - low));
        Ok::<_, SimError>(LocusSample { factor, poles: pairs(&open.closed_poles_at(factor)?) })
    };
    Ok(RootLocus {
        title: format!("{name}: closed-loop poles while the loop gain grows"),
        dt_s: open.dt_s(),
        samples: (0..FACTORS).map(sample).collect::<Result<_, _>>()?,
        poles_at_one: pairs(&plant.worst.closed_poles),
        open_poles: pairs(&open.open_poles()?),
        open_zeros: pairs(&open.zeros()?),
        crossings,
    })
}

/// Decades of the factors that are shown.
fn decades(crossings: &[Crossing]) -> [f64; 2] {
    let beyond = libm::log10(BEYOND_LIMIT);
    crossings.iter().fold([-FACTOR_DECADES, FACTOR_DECADES], |[low, high], crossing| {
        let decade = libm::log10(crossing.factor);
        [low.min(decade - beyond), high.max(decade + beyond)]
    })
}

fn crossings(open: &SampledLoop, margins: Option<&SampledMargins>) -> Vec<Crossing> {
    let limits = margins.into_iter().flat_map(|it| [&it.gain_low, &it.gain_high]).flatten();
    limits
        .map(|limit| {
            let (sine, cosine) = libm::sincos(limit.omega_rad_s * open.dt_s());
            Crossing { factor: limit.factor, at: (cosine, sine) }
        })
        .collect()
}

/// Poles and zeros of a loop.
///
/// # Errors
/// Eigenvalues that are not found.
pub(crate) fn pole_zero(name: &str, plant: &PlantLoop) -> Result<PoleZeroMap, SimError> {
    Ok(PoleZeroMap {
        title: format!("{name}: poles and zeros of the sampled loop"),
        dt_s: plant.worst.open.dt_s(),
        open_poles: pairs(&plant.worst.open.open_poles()?),
        open_zeros: pairs(&plant.worst.open.zeros()?),
        closed_poles: pairs(&plant.worst.closed_poles),
    })
}

/// Which margin a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MapQuantity {
    /// Smaller end of the gain margin, dB.
    Gain,
    /// Phase margin, deg.
    Phase,
}

/// Margins of the frozen gains over the supervisor's inputs, and the flown way.
pub(crate) fn gain_map(
    name: &str,
    map: &FrozenMap,
    quantity: MapQuantity,
    flown: Vec<(f64, f64)>,
) -> GainMap {
    let (label, required) = match quantity {
        MapQuantity::Gain => ("gain margin, smaller end [dB]", (6.0, "6 dB, MIL-F-9490D")),
        MapQuantity::Phase => ("phase margin [deg]", (45.0, "45 deg, MIL-F-9490D")),
    };
    let inputs = |index: usize| -> Vec<f64> {
        let points = map.points.iter().map(|point| point.input[index]);
        let mut values: Vec<f64> = points.collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let row = |row: &[FrozenPoint]| row.iter().map(|point| cell(point, quantity)).collect();
    GainMap {
        title: format!("{name}: {label} of {} frozen gains", map.points.len()),
        // The error is on the side, as in rule tables.
        x_label: format!("{} [supervisor units]", map.beside),
        y_label: "error [supervisor units]".to_owned(),
        quantity: label.to_owned(),
        xs: inputs(1),
        ys: inputs(0),
        cells: map.points.chunks(map.side.max(1)).map(row).collect(),
        scale: None,
        required: Some((required.0, required.1.to_owned())),
        worst: Some(MapPoint {
            at: (map.worst.input[1], map.worst.input[0]),
            name: super::text::triple(map.worst.gains),
        }),
        equilibrium: Some(MapPoint { at: (0.0, 0.0), name: "at rest".to_owned() }),
        flown: flown.into_iter().map(|(error, change)| (change, error)).collect(),
    }
}

/// The surface of the proportional gain over the supervisor's inputs, coloured by a margin.
pub(crate) fn gain_surface(name: &str, map: &FrozenMap, quantity: MapQuantity) -> GainSurface {
    let row = |row: &[FrozenPoint]| row.iter().map(|point| point.gains.kp).collect();
    GainSurface {
        map: gain_map(name, map, quantity, Vec::new()),
        gain_label: "kp".to_owned(),
        gains: map.points.chunks(map.side.max(1)).map(row).collect(),
    }
}

fn cell(point: &FrozenPoint, quantity: MapQuantity) -> MapCell {
    let Ok(margins) = &point.margins else {
        return MapCell::Unstable;
    };
    let value = match quantity {
        MapQuantity::Gain => margins.smaller_gain_margin_db(),
        MapQuantity::Phase => margins.phase_margin_deg,
    };
    if value.is_finite() { MapCell::Value(value) } else { MapCell::Unbounded }
}

/// Spectral radii along a flight, over its gains.
pub(crate) fn radius_figure(name: &str, along: &TrajectoryLinearisation) -> RadiusFigure {
    let points = &along.points;
    let series = |name: &str, number: usize, value: &dyn Fn(&TrajectoryPoint) -> f64| Series {
        name: name.to_owned(),
        style: SeriesStyle::Numbered(number),
        x: points.iter().map(|point| point.time_s).collect(),
        y: points.iter().map(value).collect(),
        stairs: false,
    };
    RadiusFigure {
        title: format!("{name}: the loop linearised along its flight"),
        x_label: "time [s]".to_owned(),
        radii: vec![
            series("gains frozen", 0, &|point| point.frozen_radius),
            series("with the derivatives of the gains", 1, &|point| point.radius),
        ],
        below: vec![
            series("kp", 0, &|point| point.gains.kp),
            series("ki [1/s]", 1, &|point| point.gains.ki),
            series("kd [s]", 2, &|point| point.gains.kd),
        ],
        below_label: "gains".to_owned(),
        width_px: WIDTH_PX,
    }
}
