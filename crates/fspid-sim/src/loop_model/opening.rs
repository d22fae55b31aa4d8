//! The open loop at a named break point, with all other loops closed.

use super::break_point::BreakPoint;
use fspid_core::Gains;
use fspid_lti::{FineMatrix, LoopFamily, Matrix, SampledLoop, SeriesControl};

use super::assembly::OpenLoop;
use super::{LoopModel, LoopSettings, Memory, SampledPlant};
use crate::error::SimError;

impl LoopModel<f64> {
    /// The open loops of all gains (kp, ki, kd) at a point, if the gains are factors there.
    ///
    /// For gains that stand still the literal and the bumpless integral are one. At the pitch angle it is the loop
    /// through the part of the command that answers it, in which the same signals go around. At the rate the gains are
    /// in the loop that stays closed: there is no family.
    ///
    /// # Errors
    /// Poles of the plant that are not found, and a way that is too long for a matrix.
    pub fn family(&self, point: BreakPoint) -> Result<Option<LoopFamily>, SimError> {
        self.settings.require_matrix()?;
        let (settings, none) =
            (&self.settings, Memory { integral: false, derivative: false, previous: false });
        let without = LoopSettings { memory: none, ..settings.clone() };
        let plant = Self::new(self.plant.clone(), without).assembly(Gains::ZERO).plant();
        let (matrix, fixed) = match point {
            BreakPoint::Command => (plant.matrix, plant.by_rate),
            BreakPoint::Pitch => (plant.matrix_with_rate, vec![0.0; plant.by_rate.len()]),
            BreakPoint::Rate => return Ok(None),
        };
        let matrix = Matrix::from_rows(&matrix)?;
        let control = settings.series_control()?;
        let outputs = [fixed.as_slice(), &plant.pitch];
        let dt_s = settings.config.dt_s;
        Ok(Some(LoopFamily::new(&matrix, &plant.by_command, outputs, control, dt_s)?))
    }

    /// The open loop at a point.
    ///
    /// # Errors
    /// Gains so large that an entry overflows, and a way that is too long for a matrix.
    pub fn open(&self, gains: Gains<f64>, point: BreakPoint) -> Result<SampledLoop, SimError> {
        self.settings.require_matrix()?;
        let OpenLoop { matrix, entry, exit } = self.assembly(gains).broken(point);
        let returned = exit.iter().map(|value| -value).collect();
        let dt_s = self.settings.config.dt_s;
        let open = SampledLoop::new(Matrix::from_rows(&matrix)?, entry, returned, dt_s)?;
        match &self.change {
            Some(rows) => {
                let (change, input) = self.change_when_broken(rows, gains, point)?;
                Ok(open.with_change(change, input)?)
            }
            None => Ok(open),
        }
    }

    /// The matrix of the loop broken at a point, less 1 on the diagonal, and what enters.
    fn change_when_broken(
        &self,
        [high, low]: &[Vec<f64>; 2],
        gains: Gains<f64>,
        point: BreakPoint,
    ) -> Result<(FineMatrix, FineMatrix), SimError> {
        let states = self.plant.states;
        let broken = |rows: &Vec<f64>| {
            let plant = SampledPlant { rows: rows.clone(), ..self.plant.clone() };
            Self { plant, ..self.clone() }.assembly(gains).broken(point)
        };
        let (mut change, mut rest) = (broken(high), broken(low));
        for (place, row) in change.matrix.iter_mut().enumerate().skip(states) {
            row[place] -= 1.0;
        }
        // Queues, sensors and controller are what they are.
        rest.matrix.iter_mut().skip(states).for_each(|row| row.fill(0.0));
        rest.entry.iter_mut().skip(states).for_each(|entry| *entry = 0.0);
        let matrix = |rows: &[Vec<f64>]| Matrix::from_rows(rows);
        let column = |entry: &[f64]| {
            let rows: Vec<[f64; 1]> = entry.iter().map(|&value| [value]).collect();
            Matrix::from_rows(&rows)
        };
        Ok((
            FineMatrix::new(matrix(&change.matrix)?, matrix(&rest.matrix)?)?,
            FineMatrix::new(column(&change.entry)?, column(&rest.entry)?)?,
        ))
    }
}

impl LoopSettings {
    /// The controller from seen pitch to command, its sign changed: factors of kp, ki and kd.
    ///
    /// $$ C = k_p + k_i \frac{T z}{z - 1} + \frac{k_d}{T_f + T} \frac{z - 1}{z - 1 + T/(T_f + T)} $$
    fn series_control(&self) -> Result<SeriesControl, SimError> {
        let (dt_s, memory) = (self.config.dt_s, self.memory);
        let time_s = self.config.derivative.filter_s + dt_s;
        let pole = -dt_s / time_s;
        let (poles, by_gain) = match (memory.previous, memory.integral) {
            (false, false) => (vec![], [vec![], vec![]]),
            (false, true) => (vec![0.0], [vec![dt_s, dt_s], vec![]]),
            (true, false) => (vec![pole], [vec![], vec![1.0 / time_s, pole / time_s]]),
            (true, true) => {
                let integral = vec![dt_s, dt_s, -pole * dt_s];
                (vec![pole, 0.0], [integral, vec![1.0 / time_s, pole / time_s]])
            }
        };
        let by_gain = core::iter::once(vec![1.0]).chain(by_gain).collect();
        Ok(SeriesControl::new(poles, by_gain)?)
    }
}
