//! Set-points that jump, a pitch that follows with noise, and now and then something that is no pitch.

use fspid_core::Sample;
use fspid_numeric::Real;

use super::{Event, Flight};

/// Numbers that are the same in each run.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    /// From 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn around(&mut self, size: f64) -> f64 {
        (2.0 * self.unit() - 1.0) * size
    }

    pub(crate) fn bad(&mut self) -> f64 {
        BAD[(self.unit() * 8.0) as usize % 8]
    }
}

/// What is no pitch.
pub(super) const BAD: [f64; 8] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 3e38, -3e38, 1e30, -0.0, 1e-40];

/// Where set-point and pitch are.
struct Pursuit {
    draw: Draw,
    setpoint: f64,
    pitch: f64,
}

impl Pursuit {
    fn next(&mut self) -> [f64; 3] {
        let Self { draw, setpoint, pitch } = self;
        if draw.unit() < 0.02 {
            *setpoint = draw.around(0.6);
        }
        let before = *pitch;
        *pitch += 0.08 * (*setpoint - *pitch) + draw.around(0.01);
        let rate = (*pitch - before) / 0.01;
        let mut values = [*setpoint, *pitch, rate];
        if draw.unit() < 0.02 {
            values[(draw.unit() * 3.0) as usize % 3] = draw.bad();
        }
        if draw.unit() < 0.01 {
            values[1] = draw.around(4.0);
        }
        values
    }
}

fn pursuit(seed: u64) -> Pursuit {
    Pursuit { draw: Draw(seed), setpoint: 0.0, pitch: 0.0 }
}

/// `count` samples, drawn from a seed.
#[must_use]
pub fn samples<R: Real>(seed: u64, count: usize) -> Vec<Sample<R>> {
    let mut pursuit = pursuit(seed);
    let mut sample = |_| {
        let [setpoint_rad, measurement_rad, rate_rad_s] = pursuit.next().map(R::from_f64);
        Sample { setpoint_rad, measurement_rad, rate_rad_s }
    };
    (0..count).map(&mut sample).collect()
}

/// Fills a flight.
pub(super) fn fly<R: Real>(flight: &mut Flight<'_, R>, seed: u64) {
    let mut pursuit = pursuit(seed);
    let mut events = Draw(!seed);
    flight.reset(pursuit.next());
    while !flight.is_full() {
        let sample = pursuit.next();
        match (events.unit() * 1000.0) as u32 {
            _ if !flight.has_events => flight.step(sample),
            0..2 => flight.reset(sample),
            2..6 => flight.event(Event::Hold, sample),
            6..12 => flight.event(Event::Faults, sample),
            12..16 => {
                for _ in 0..5 {
                    let command = events.around(0.4);
                    flight.track(command, pursuit.next());
                }
            }
            _ => flight.step(sample),
        }
    }
}
