//! Figures of loop analysis, for the Boeing 747 of the paper under a sampled PID controller.
//!
//! Margins are read off a dense grid here, which is good enough for a picture; a study computes them exactly.

use std::error::Error;

use fspid_lti::{
    Complex, Matrix, TransferFunction, eigenvalues, modulus, quotient, spectral_radius,
    zero_order_hold,
};
use fspid_plot::{
    BodeFigure, CLOSED_LOOP_DB, CellState, Crossing, Exclusion, GainCell, GainMap, GainSet,
    GainSurface, LocusSample, LoopCurve, LoopPoint, MapCell, MapPoint, Margin, MarginDisk,
    MarginMark, NicholsFigure, NyquistFigure, PeakMark, PoleZeroMap, RadiusFigure, RootLocus,
    SensitivityFigure, Series, SeriesStyle, Svg, Transfer,
};

type Outcome<T> = Result<T, Box<dyn Error>>;

const DT_S: f64 = 0.05;
const NYQUIST_RAD_S: f64 = std::f64::consts::PI / DT_S;

/// Proportional, integral (1/s) and derivative (s) gain.
type Gains = [f64; 3];

/// Servo and aircraft, nose up positive, sampled with a zero-order hold.
struct Plant {
    a: Matrix,
    b: Matrix,
    c: Matrix,
}

fn entry(matrix: &Matrix, row: usize, column: usize) -> f64 {
    matrix.get(row, column).unwrap_or(f64::NAN)
}

impl Plant {
    fn new() -> Outcome<Self> {
        let aircraft = TransferFunction::new(
            &[1.69144, 0.84341, 0.009_909_6],
            &[1.0, 1.17103, 1.55405, 0.012538, 0.007_277_1],
        )?;
        let servo = TransferFunction::new(&[10.0], &[1.0, 10.0])?;
        let system = aircraft.series(&servo)?.to_state_space();
        let (a, b) = zero_order_hold(system.a(), system.b(), DT_S)?;
        Ok(Self { a, b, c: system.c().clone() })
    }

    /// The plant at a point of the plane of z, solved as a real system of twice the size.
    fn at(&self, z: Complex) -> Outcome<Complex> {
        let n = self.a.rows();
        let mut system = Matrix::zeros(2 * n, 2 * n);
        let mut right = Matrix::zeros(2 * n, 1);
        for i in 0..n {
            for j in 0..n {
                let unit = f64::from(u8::from(i == j));
                let value = unit * z.re - entry(&self.a, i, j);
                system.set(i, j, value)?;
                system.set(n + i, n + j, value)?;
                system.set(i, n + j, -unit * z.im)?;
                system.set(n + i, j, unit * z.im)?;
            }
            right.set(i, 0, entry(&self.b, i, 0))?;
        }
        let x = system.solve(&right)?;
        let sum = |from: usize| (0..n).map(|i| entry(&self.c, 0, i) * entry(&x, from + i, 0)).sum();
        Ok(Complex::new(sum(0), sum(n)))
    }

    /// The open loop with one sample of computing delay.
    fn open(&self, gains: Gains, frequency_rad_s: f64) -> Outcome<LoopPoint> {
        let angle = frequency_rad_s * DT_S;
        let z = Complex::new(angle.cos(), angle.sin());
        let one = Complex::new(1.0, 0.0);
        let back = quotient(one, z);
        let integral = quotient(one, one - back) * gains[1] * DT_S;
        let controller = (one - back) * (gains[2] / DT_S) + integral + one * gains[0];
        let value = controller * self.at(z)? * back;
        Ok(LoopPoint { frequency_rad_s, real: value.re, imaginary: value.im })
    }

    /// The closed loop's matrix: plant, delay, integral, last error.
    fn closed(&self, gains: Gains) -> Outcome<Matrix> {
        let n = self.a.rows();
        let mut loop_ = Matrix::zeros(n + 3, n + 3);
        let [kp, ki, kd] = gains;
        for i in 0..n {
            for j in 0..n {
                loop_.set(i, j, entry(&self.a, i, j))?;
            }
            loop_.set(i, n, entry(&self.b, i, 0))?;
            let c = entry(&self.c, 0, i);
            loop_.set(n, i, -c * (kp + ki * DT_S + kd / DT_S))?;
            loop_.set(n + 1, i, -c * DT_S)?;
            loop_.set(n + 2, i, -c)?;
        }
        loop_.set(n, n + 1, ki)?;
        loop_.set(n, n + 2, -kd / DT_S)?;
        loop_.set(n + 1, n + 1, 1.0)?;
        Ok(loop_)
    }

    fn poles(&self, gains: Gains) -> Outcome<Vec<(f64, f64)>> {
        Ok(eigenvalues(&self.closed(gains)?)?.into_iter().map(|z| (z.re, z.im)).collect())
    }

    fn curve(&self, name: &str, style: usize, gains: Gains) -> Outcome<LoopCurve> {
        let count = 900;
        let points = (0..=count).map(|n| {
            let part = f64::from(n) / f64::from(count);
            self.open(gains, 0.003 * (NYQUIST_RAD_S / 0.003).powf(part))
        });
        let points = points.collect::<Outcome<Vec<LoopPoint>>>()?;
        Ok(LoopCurve { name: name.to_owned(), style: SeriesStyle::Numbered(style), points })
    }

    /// By how much the gains may grow, by bisection (dB); none when the loop is unstable as it is.
    fn gain_margin_db(&self, gains: Gains) -> Outcome<Option<f64>> {
        let stable = |factor: f64| -> Outcome<bool> {
            Ok(spectral_radius(&self.closed(gains.map(|gain| gain * factor))?)? < 1.0)
        };
        if !stable(1.0)? {
            return Ok(None);
        }
        let (mut low, mut high) = (0.0_f64, 40.0_f64);
        for _ in 0..24 {
            let middle = (low + high) / 2.0;
            let holds = stable(10_f64.powf(middle / 20.0))?;
            if holds { low = middle } else { high = middle }
        }
        Ok(Some(low))
    }
}

const CPID: Gains = [1.1, 0.4, 0.55];
const FSPID: Gains = [0.8, 0.3, 0.85];
/// What the gains of the maps are multiplied by, so that some of them are too large.
const BOLD: f64 = 3.8;

/// What the supervisor answers to an error (deg) and its change (deg).
fn supervised(e: f64, ec: f64) -> Gains {
    let pull = (0.5 * e + 0.9 * ec).tanh();
    let near = (-(e * e + ec * ec) / 6.0).exp();
    let size = (0.8 * pull).exp();
    [
        size * (FSPID[0] + 0.5 * pull * pull),
        FSPID[1] + 0.35 * near - 0.1 * pull,
        size * (FSPID[2] - 0.1 * pull * pull + 0.15 * near),
    ]
}

/// Every figure with its name.
pub(crate) fn figures() -> Outcome<Vec<(&'static str, Svg)>> {
    let plant = Plant::new()?;
    let curves = vec![
        plant.curve("FSPID at rest", 0, FSPID)?,
        plant.curve("CPID, same nominal gains", 1, CPID)?,
    ];
    let mut all = responses(&curves);
    all.extend(z_planes(&plant)?);
    all.extend(maps(&plant)?);
    all.push(("analysis-radius", radius(&plant)?));
    all.push(("analysis-gain-set", gain_set()));
    Ok(all)
}

/// Where a curve crosses a level of `value`, between two points of the grid.
fn crossings(curve: &LoopCurve, value: impl Fn(&LoopPoint) -> f64) -> Vec<LoopPoint> {
    let crosses = |pair: &[LoopPoint]| {
        let (a, b) = (value(&pair[0]), value(&pair[1]));
        let part = a / (a - b);
        let mix = |a: f64, b: f64| a + (b - a) * part;
        (a * b < 0.0 && (a - b).abs() < 0.5).then(|| LoopPoint {
            frequency_rad_s: mix(pair[0].frequency_rad_s, pair[1].frequency_rad_s),
            real: mix(pair[0].real, pair[1].real),
            imaginary: mix(pair[0].imaginary, pair[1].imaginary),
        })
    };
    curve.points.windows(2).filter_map(crosses).collect()
}

fn gain(point: &LoopPoint) -> f64 {
    modulus(Complex::new(point.real, point.imaginary))
}

fn margins(curves: &[LoopCurve]) -> Vec<MarginMark> {
    let mut marks = Vec::new();
    for (n, curve) in curves.iter().enumerate() {
        for at in crossings(curve, |point| gain(point).ln()) {
            let deg = (-at.imaginary).atan2(-at.real).to_degrees();
            let margin = Margin::PhaseDeg(deg);
            marks.push(MarginMark { curve: n, frequency_rad_s: at.frequency_rad_s, margin });
        }
        for at in crossings(curve, |point| point.imaginary).iter().filter(|at| at.real < -0.01) {
            let margin = Margin::GainDb(-20.0 * (-at.real).log10());
            marks.push(MarginMark { curve: n, frequency_rad_s: at.frequency_rad_s, margin });
        }
    }
    marks
}

/// Disk margin of zero skew.
fn alpha(curve: &LoopCurve) -> f64 {
    let ratio = |point: &LoopPoint| {
        let far = modulus(Complex::new(1.0 - point.real, point.imaginary));
        2.0 * modulus(Complex::new(1.0 + point.real, point.imaginary)) / far
    };
    curve.points.iter().map(ratio).fold(f64::INFINITY, f64::min)
}

fn peak(n: usize, curve: &LoopCurve, transfer: Transfer) -> Option<PeakMark> {
    let value = |point: &LoopPoint| {
        let above = if transfer == Transfer::Sensitivity { 1.0 } else { gain(point) };
        20.0 * (above / modulus(Complex::new(1.0 + point.real, point.imaginary))).log10()
    };
    let best = curve.points.iter().max_by(|a, b| value(a).total_cmp(&value(b)))?;
    let frequency_rad_s = best.frequency_rad_s;
    Some(PeakMark { curve: n, transfer, frequency_rad_s, peak_db: value(best) })
}

fn responses(curves: &[LoopCurve]) -> Vec<(&'static str, Svg)> {
    let title = |what: &str| format!("{what}: 747 with servo, sampled at 20 Hz");
    let alphas: Vec<(usize, f64)> = curves.iter().map(alpha).enumerate().collect();
    let disk = |&(curve, alpha): &(usize, f64)| MarginDisk {
        name: format!("disk of {}: \u{3b1} = {alpha:.2}", curves[curve].name),
        curve,
        gain_min: (2.0 - alpha) / (2.0 + alpha),
        gain_max: (2.0 + alpha) / (2.0 - alpha),
    };
    let bode = BodeFigure {
        title: title("Open loop at the elevator"),
        curves: curves.to_vec(),
        margins: margins(curves),
        nyquist_rad_s: Some(NYQUIST_RAD_S),
        width_px: 720.0,
    };
    let nyquist = NyquistFigure {
        title: title("Nyquist plot"),
        curves: curves.to_vec(),
        disks: alphas.iter().map(disk).collect(),
        reach: 2.0,
    };
    let nichols = NicholsFigure {
        title: title("Nichols chart"),
        curves: curves.to_vec(),
        contours_db: CLOSED_LOOP_DB.to_vec(),
        exclusion: Some(Exclusion::boxed("6 dB and 45\u{b0} of MIL-F-9490D", 6.0, 45.0)),
        width_px: 570.0,
    };
    let both = [Transfer::Sensitivity, Transfer::Complementary];
    let peaks = curves.iter().enumerate();
    let sensitivity = SensitivityFigure {
        title: title("Sensitivities"),
        curves: curves.to_vec(),
        peaks: peaks
            .flat_map(|(n, curve)| both.map(|kind| peak(n, curve, kind)))
            .flatten()
            .collect(),
        disk_margins: alphas,
        nyquist_rad_s: Some(NYQUIST_RAD_S),
        width_px: 720.0,
    };
    vec![
        ("analysis-bode", bode.render()),
        ("analysis-nyquist", nyquist.render()),
        ("analysis-nichols", nichols.render()),
        ("analysis-sensitivity", sensitivity.render()),
    ]
}

fn z_planes(plant: &Plant) -> Outcome<Vec<(&'static str, Svg)>> {
    let scaled = |factor: f64| CPID.map(|gain| gain * factor);
    let mut samples = Vec::new();
    let mut crossings = Vec::new();
    let mut was_stable = true;
    for n in 0..=800 {
        let factor = 0.01 * 1000_f64.powf(f64::from(n) / 800.0);
        let poles = plant.poles(scaled(factor))?;
        let outside = |at: &&(f64, f64)| at.0.hypot(at.1) > 1.0;
        let unstable: Vec<(f64, f64)> = poles.iter().filter(outside).copied().collect();
        if was_stable && !unstable.is_empty() {
            crossings.extend(unstable.iter().map(|at| Crossing { factor, at: *at }));
        }
        was_stable = unstable.is_empty();
        samples.push(LocusSample { factor, poles });
    }
    // The open loop: the poles of plant, delay and integrator, and the zeros of plant and controller.
    let open_poles = plant.poles([0.0; 3])?;
    let [kp, ki, kd] = CPID;
    let root = TransferFunction::new(
        &[kp + ki * DT_S + kd / DT_S, -kp - 2.0 * kd / DT_S, kd / DT_S],
        &[1.0, 0.0, 0.0],
    )?;
    let mut open_zeros: Vec<(f64, f64)> = root.zeros()?.iter().map(|z| (z.re, z.im)).collect();
    open_zeros.extend([(0.9994, 0.0), (0.9763, 0.0), (-0.17, 0.0), (-2.31, 0.0)]);
    let title = |what: &str| format!("{what}: CPID on the 747, 20 Hz, one sample of delay");
    let locus = RootLocus {
        title: title("Root locus over the loop gain"),
        dt_s: DT_S,
        samples,
        poles_at_one: plant.poles(CPID)?,
        open_poles: open_poles.clone(),
        open_zeros: open_zeros.clone(),
        crossings,
    };
    let map = |closed_poles| PoleZeroMap {
        title: title("Poles and zeros"),
        dt_s: DT_S,
        open_poles: open_poles.clone(),
        open_zeros: open_zeros.clone(),
        closed_poles,
    };
    Ok(vec![
        ("analysis-root-locus", locus.render()),
        ("analysis-poles", map(plant.poles(CPID)?).render()),
        ("analysis-poles-unstable", map(plant.poles(scaled(14.0))?).render()),
    ])
}

fn words(gains: Gains) -> String {
    let [kp, ki, kd] = gains;
    format!("k_{{p}} = {kp:.2}, k_{{i}} = {ki:.2} /s, k_{{d}} = {kd:.2} s")
}

/// A path from a step of the command to rest.
fn flown() -> Vec<(f64, f64)> {
    let at = |t: f64| 4.2 * (-0.42 * t).exp() * (1.15 * t).cos();
    (0..=400).map(|n| f64::from(n) * 0.03).map(|t| (at(t), 3.0 * (at(t + 0.3) - at(t)))).collect()
}

/// Gain margins of the bold gains that the supervisor makes of so many errors and changes.
fn map(plant: &Plant, count: u32) -> Outcome<GainMap> {
    let bold = |e: f64, ec: f64| supervised(e, ec).map(|gain| gain * BOLD);
    let node = |n: u32| -5.0 + 10.0 * f64::from(n) / f64::from(count - 1);
    let nodes: Vec<f64> = (0..count).map(node).collect();
    let mut cells = Vec::new();
    let mut worst = (f64::INFINITY, (0.0, 0.0));
    for ec in &nodes {
        let mut row = Vec::new();
        for e in &nodes {
            let found = plant.gain_margin_db(bold(*e, *ec))?;
            if found.unwrap_or(-1.0) < worst.0 {
                worst = (found.unwrap_or(-1.0), (*e, *ec));
            }
            row.push(found.map_or(MapCell::Unstable, MapCell::Value));
        }
        cells.push(row);
    }
    let (e, ec) = worst.1;
    let at_rest = plant.gain_margin_db(bold(0.0, 0.0))?;
    let at_rest = at_rest.map_or(String::new(), |db| format!("{db:.1} dB, "));
    let rest = format!("{at_rest}{}", words(bold(0.0, 0.0)));
    let least = format!("UNSTABLE at e = {e:.2} deg, ec = {ec:.2} deg: {}", words(bold(e, ec)));
    Ok(GainMap {
        title: "Gain margin with the gains frozen: FSPID on the 747".to_owned(),
        x_label: "error e [deg]".to_owned(),
        y_label: "change of error ec [deg]".to_owned(),
        quantity: "gain margin [dB]".to_owned(),
        xs: nodes.clone(),
        ys: nodes,
        cells,
        scale: None,
        required: Some((6.0, "6 dB".to_owned())),
        worst: Some(MapPoint { at: (e, ec), name: least }),
        equilibrium: Some(MapPoint { at: (0.0, 0.0), name: rest }),
        flown: flown(),
    })
}

fn maps(plant: &Plant) -> Outcome<Vec<(&'static str, Svg)>> {
    let nine = map(plant, 9)?;
    let fine = map(plant, 33)?;
    let gains = fine.ys.iter().map(|ec| fine.xs.iter().map(|e| supervised(*e, *ec)[0]).collect());
    let surface = GainSurface {
        gains: gains.collect(),
        gain_label: "k_{p}".to_owned(),
        map: GainMap {
            title: "Proportional gain, coloured by gain margin".to_owned(),
            ..fine.clone()
        },
    };
    Ok(vec![
        ("analysis-map", nine.render()),
        ("analysis-map-fine", fine.render()),
        ("analysis-surface", surface.render()),
    ])
}

fn radius(plant: &Plant) -> Outcome<Svg> {
    let path = flown();
    let time: Vec<f64> = (0..path.len()).map(|n| n as f64 * 0.03).collect();
    let mut frozen = Vec::new();
    let mut moving = Vec::new();
    for (e, ec) in &path {
        let value = spectral_radius(&plant.closed(supervised(*e, *ec).map(|gain| gain * BOLD))?)?;
        frozen.push(value);
        moving.push(value + 0.012 * (0.4 * e).tanh() * ec.tanh() - 0.002 * e.tanh().abs());
    }
    let line = |name: &str, n, y: Vec<f64>| Series {
        name: name.to_owned(),
        style: SeriesStyle::Numbered(n),
        x: time.clone(),
        y,
        stairs: false,
    };
    let gain = |n: usize| path.iter().map(|(e, ec)| supervised(*e, *ec)[n]).collect::<Vec<f64>>();
    let figure = RadiusFigure {
        title: "Spectral radius along a step of 4 deg: FSPID on the 747".to_owned(),
        x_label: "time [s]".to_owned(),
        radii: vec![
            line("gains frozen", 0, frozen),
            line("with the gains' own response", 1, moving),
        ],
        below: vec![
            line("k_{p}", 3, gain(0)),
            line("k_{i} [1/s]", 4, gain(1)),
            line("k_{d} [s]", 5, gain(2)),
        ],
        below_label: "gains".to_owned(),
        width_px: 720.0,
    };
    Ok(figure.render())
}

fn gain_set() -> Svg {
    let mut cells = Vec::new();
    let count = 12;
    let edge = |n: u32| -5.0 + 10.0 * f64::from(n) / f64::from(count);
    for i in 0..count {
        for j in 0..count {
            let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)]
                .map(|(i, j)| supervised(edge(j), edge(i)));
            let of = |pick: fn(f64, f64) -> f64| {
                [0, 1, 2].map(|n| corners.iter().map(|gains| gains[n]).reduce(pick).unwrap_or(0.0))
            };
            let (lower, upper) = (of(f64::min), of(f64::max));
            let state = if upper[0] > 2.8 { CellState::Open } else { CellState::Proved };
            cells.push(GainCell { lower, upper, state });
        }
    }
    let proved = cells.iter().filter(|cell| cell.state == CellState::Proved);
    let hull = proved.flat_map(|cell| {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|corner: usize| {
            [0, 1, 2].map(|n| if corner >> n & 1 == 0 { cell.lower[n] } else { cell.upper[n] })
        })
    });
    GainSet {
        title: "Gains of the FSPID for which stability is proved".to_owned(),
        labels: ["k_{p}", "k_{i} [1/s]", "k_{d} [s]"].map(str::to_owned),
        hull: hull.collect(),
        cells,
        nominal: Some(FSPID),
        equilibrium: Some(supervised(0.0, 0.0)),
        unstable: vec![[2.87, 0.2, 1.66], [2.88, 0.21, 1.66]],
        flown: flown().into_iter().map(|(e, ec)| supervised(e, ec)).collect(),
    }
    .render()
}
