//! Whether loads are linear in the rate of the angle of attack, as the equations of motion take them to be.
//!
//! A model is a text that may say anything, so that it is asked: at many states inside of its tables, at rates of both
//! signs and of many sizes, with the controls at rest and moved.

use fspid_aircraft::{Range, Travel, Validity};

use super::Wired;
use super::error::FlightError;
use super::quantity::{Quantities, Quantity};

/// States at which a model is asked.
const STATES: u32 = 64;

/// Sizes of the rate, rad/s: from what is hardly seen to what only a tumbling model aircraft has.
const SIZES_RAD_S: [f64; 6] = [0.001, 0.02, 0.1, 0.5, 1.0, 3.0];

/// How far a coefficient may be off, of the largest of its parts: rounding is far below.
const ROUNDING: f64 = 1e-9;

/// Steps through the quantities, in their order: 2³² times the fractions of the roots of the first primes, of which no
/// two keep step.
const STEPS: [u32; 13] = [
    0x6a09_e667,
    0xbb67_ae85,
    0x3c6e_f372,
    0xa54f_f53a,
    0x510e_527f,
    0x9b05_688c,
    0x1f83_d9ab,
    0x5be0_cd19,
    0xcbbb_9d5d,
    0x629a_292a,
    0x9159_015a,
    0x152f_ecd8,
    0x6733_2667,
];

/// A coefficient with the angle of attack at rest and at 1 rad/s.
#[derive(Clone, Copy)]
struct Line {
    at_rest: f64,
    at_one: f64,
}

/// Finds a coefficient that is no straight line over the rate, or whose slope depends on the controls.
///
/// # Errors
/// [`FlightError::NotLinear`], [`FlightError::RateByControl`].
pub(super) fn linear(
    aerodynamics: &Wired<6>,
    names: &[&'static str; 6],
    (validity, travel): (&Validity, &Travel),
) -> Result<(), FlightError> {
    let ranges = ranges(validity, travel);
    for state in 0..STATES {
        let moved = Quantities::new(drawn(&ranges, state));
        let resting = moved.with_controls_at_rest();
        let resting = straight(aerodynamics, names, &resting)?;
        let moved = straight(aerodynamics, names, &moved)?;
        for ((name, resting), moved) in names.iter().zip(resting).zip(moved) {
            let finite = resting.rise().is_finite() && moved.rise().is_finite();
            let size = resting.size().max(moved.size());
            if finite && !near(resting.rise(), moved.rise(), size) {
                return Err(FlightError::RateByControl { name });
            }
        }
    }
    Ok(())
}

/// Lines on which coefficients are at every rate; where a model has no number at rest there is none.
fn straight(
    aerodynamics: &Wired<6>,
    names: &[&'static str; 6],
    at: &Quantities,
) -> Result<[Line; 6], FlightError> {
    let lines = lines(aerodynamics, at);
    for rate_rad_s in SIZES_RAD_S.into_iter().flat_map(|size| [size, -size]) {
        let found = aerodynamics.answer(&at.with_alpha_rate(rate_rad_s));
        for ((&name, line), found) in names.iter().zip(lines).zip(found) {
            let expected = line.at_rest + rate_rad_s * line.rise();
            let size = line.size().max(found.abs()).max((rate_rad_s * line.rise()).abs());
            if line.at_rest.is_finite() && !near(found, expected, size) {
                return Err(FlightError::NotLinear { name, rate_rad_s, found, expected });
            }
        }
    }
    Ok(lines)
}

fn lines(aerodynamics: &Wired<6>, at: &Quantities) -> [Line; 6] {
    let at_rest = aerodynamics.answer(&at.with_alpha_rate(0.0));
    let mut at_one = aerodynamics.answer(&at.with_alpha_rate(1.0)).into_iter();
    at_rest.map(|at_rest| Line { at_rest, at_one: at_one.next().unwrap_or(f64::NAN) })
}

impl Line {
    fn rise(self) -> f64 {
        self.at_one - self.at_rest
    }

    fn size(self) -> f64 {
        self.at_rest.abs().max(self.at_one.abs())
    }
}

/// Whether two numbers differ by no more than rounding; NaN is near nothing.
fn near(found: f64, expected: f64, size: f64) -> bool {
    (found - expected).abs() <= ROUNDING * size
}

/// Where each quantity is drawn: the box of the tables, and what is usual where they have no end.
fn ranges(validity: &Validity, travel: &Travel) -> [Range; STEPS.len()] {
    let within = |range: Range, min: f64, max: f64| Range {
        min: if range.min.is_finite() { range.min } else { min.min(range.max) },
        max: if range.max.is_finite() { range.max } else { max.max(range.min) },
    };
    [
        within(validity.airspeed_m_s, 10.0, 300.0),
        within(validity.alpha_rad, -0.2, 0.4),
        within(validity.beta_rad, -0.3, 0.3),
        Range::within(1.0),
        Range::within(1.0),
        Range::within(1.0),
        within(travel.elevator_rad, -0.4, 0.4),
        within(travel.aileron_rad, -0.4, 0.4),
        within(travel.rudder_rad, -0.4, 0.4),
        within(validity.mach, 0.0, 0.9),
        within(validity.altitude_m, 0.0, 12_000.0),
        Range { min: 0.0, max: 1.0 },
        Range { min: 0.0, max: 0.0 },
    ]
}

fn drawn(ranges: &[Range; STEPS.len()], state: u32) -> [f64; STEPS.len()] {
    let mut steps = STEPS.into_iter();
    ranges.map(|Range { min, max }| {
        let step = steps.next().unwrap_or_default();
        let part = f64::from(step.wrapping_mul(state + 1)) / (f64::from(u32::MAX) + 1.0);
        min + part * (max - min)
    })
}

impl Quantities {
    /// The same with surfaces and throttle at 0.
    fn with_controls_at_rest(self) -> Self {
        let controls = [Quantity::Elevator, Quantity::Aileron, Quantity::Rudder, Quantity::Power];
        controls.into_iter().fold(self, |quantities, control| quantities.with(control, 0.0))
    }
}
