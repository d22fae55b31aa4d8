//! The measurements of a group's controllers (pitch and pitch rate, with or without sensor models), forward and adjoint.
//!
//! What a sensor shows is a straight line between two samples of its quantity, and what is added is known before the
//! flight (`View`). So backwards each thing that is shown hands its worth to the two samples that it was made of.

use crate::batch::Refusal;
use crate::scenario::Prepared;
use crate::sensor::{Sensor, View};

type Lanes<const W: usize> = [f64; W];

/// Refuses a sensor that has no slope.
fn check(flight: usize, sensor: &Sensor) -> Result<(), Refusal> {
    match sensor.model().resolution > 0.0 {
        true => Err(Refusal::Part { flight, what: "a sensor with a resolution" }),
        false => Ok(()),
    }
}

/// A quantity of all lanes, and the sensors that show it.
#[derive(Clone, Debug)]
struct Quantity<const W: usize> {
    /// What there was at all samples.
    values: Vec<Lanes<W>>,
    /// What those are worth on the way back; nothing without a sensor.
    worth: Vec<Lanes<W>>,
    /// For each lane with a sensor, how it looks at each sample, and its scale error.
    sensors: Vec<Option<(Vec<View>, f64)>>,
}

impl<const W: usize> Quantity<W> {
    fn new(
        prepared: &[&Prepared],
        rows: usize,
        sensor: impl Fn(&Prepared) -> Option<Sensor>,
    ) -> Result<Self, Refusal> {
        let sensors = prepared.iter().enumerate().map(|(flight, prepared)| {
            let refused = |what| Refusal::Part { flight, what };
            let Some(sensor) = sensor(prepared) else { return Ok(None) };
            check(flight, &sensor)?;
            let views = sensor.views(prepared.timing.dt_s(), rows);
            let views = views.map_err(|_| refused("a sensor with too long a delay"))?;
            Ok(Some((views, sensor.model().scale_error)))
        });
        let sensors: Vec<Option<(Vec<View>, f64)>> = sensors.collect::<Result<_, _>>()?;
        let has_any = sensors.iter().any(Option::is_some);
        let worth = vec![[0.0; W]; if has_any { rows } else { 0 }];
        Ok(Self { values: vec![[0.0; W]; rows], worth, sensors })
    }

    /// Takes what there is at a sample, and answers what is shown of it.
    #[inline(always)]
    fn look(&mut self, k: usize, value: Lanes<W>) -> Lanes<W> {
        self.values[k] = value;
        let mut shown = value;
        if self.worth.is_empty() {
            return shown;
        }
        for (lane, sensor) in self.sensors.iter().enumerate() {
            let Some((views, scale_error)) = sensor else { continue };
            let view = &views[k];
            let [newer, older] = [view.newer, view.older].map(|it| self.values[it][lane]);
            shown[lane] = view.shown(newer, older, *scale_error);
        }
        shown
    }

    /// Takes what is worth what is shown at a sample, and answers what is worth what there was; later samples first.
    #[inline(always)]
    fn back(&mut self, k: usize, shown: Lanes<W>) -> Lanes<W> {
        let mut worth = shown;
        if self.worth.is_empty() {
            return worth;
        }
        for (lane, sensor) in self.sensors.iter().enumerate() {
            let Some((views, scale_error)) = sensor else { continue };
            let (view, by) = (&views[k], (1.0 + scale_error) * shown[lane]);
            self.worth[view.newer][lane] += (1.0 - view.part) * by;
            self.worth[view.older][lane] += view.part * by;
            worth[lane] = self.worth[k][lane];
        }
        worth
    }
}

/// Pitch and pitch rate.
#[derive(Clone, Debug)]
pub(super) struct Seeing<const W: usize> {
    pitch: Quantity<W>,
    rate: Quantity<W>,
}

impl<const W: usize> Seeing<W> {
    pub(super) fn new(prepared: &[&Prepared], rows: usize) -> Result<Self, Refusal> {
        Ok(Self {
            pitch: Quantity::new(prepared, rows, |it| it.pitch_sensor)?,
            rate: Quantity::new(prepared, rows, |it| it.rate_sensor)?,
        })
    }

    /// Refuses sensors that have no slope.
    pub(super) fn check(flight: usize, prepared: &Prepared) -> Result<(), Refusal> {
        let mut sensors = prepared.pitch_sensor.iter().chain(&prepared.rate_sensor);
        sensors.try_for_each(|sensor| check(flight, sensor))
    }

    /// Pitch at all samples, rad.
    pub(super) fn theta_rad(&self) -> &[Lanes<W>] {
        &self.pitch.values
    }

    /// What is shown of pitch, rad, and pitch rate, rad/s, at a sample.
    #[inline(always)]
    pub(super) fn look(
        &mut self,
        k: usize,
        [theta_rad, rate_rad_s]: [Lanes<W>; 2],
    ) -> [Lanes<W>; 2] {
        [self.pitch.look(k, theta_rad), self.rate.look(k, rate_rad_s)]
    }

    /// Hands what is worth what is shown back to pitch and pitch rate; the last sample first.
    #[inline(always)]
    pub(super) fn back(&mut self, k: usize, [pitch, rate]: [Lanes<W>; 2]) -> [Lanes<W>; 2] {
        [self.pitch.back(k, pitch), self.rate.back(k, rate)]
    }
}
