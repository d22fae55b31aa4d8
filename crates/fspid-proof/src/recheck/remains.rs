//! What remains of every motion where something of bounded size never ceases: resolution of the sensors, and
//! what is not known of the rules to the last digit.
//!
//! With $M^T P M \prec \rho^2 P$ and $z^+ = M z + b_1 w_1 + \dots$, in the norm of P
//!
//! $$ |z^+| \le \rho |z| + \sigma, \qquad \sigma = \sum_j |b_j| W_j, \quad |w_j| \le W_j $$
//!
//! so that every motion comes, and stays, as near to $|z| \le \sigma / (1 - \rho)$ as one likes.

use fspid_fuzzy::Scalar;
use fspid_fuzzy::scalar::Interval;
use fspid_lti::Matrix;
use fspid_sim::loop_model::BreakPoint;

use super::{Doubt, Recheck, malformed, points};
use crate::check::{IntervalMatrix, NotProved, reach};
use crate::gain_set::HeldGains;

/// Motions come within so much more of what is said to remain, in finite time.
const NEARLY: f64 = 1.0 + 1e-6;

impl Recheck<'_> {
    /// True with a sensor that resolves in steps.
    pub(super) fn is_blurred(&self) -> bool {
        self.certificate.description.blurs().iter().any(|blur| *blur > 0.0)
    }

    /// Proves how far the pitch angle may stay from rest, rad.
    pub(super) fn remains(&self, form: &Matrix, rate: f64) -> Result<f64, Doubt> {
        if self.off_rad == 0.0 && !self.is_blurred() {
            return Ok(0.0);
        }
        if !(rate < 1.0) {
            return Err(malformed("without a rate below 1 nothing is known of what remains"));
        }
        let kept = Interval::ONE - Interval::point(rate);
        let norm = Interval::point(NEARLY * self.added(form)?) / kept;
        let level = (norm * norm).upper();
        if self.is_blurred() && !self.certificate.description.limits().is_empty() {
            let covered = self.certificate.level.is_some_and(|claimed| level <= claimed);
            if !covered {
                return Err(malformed(
                    "limits may act in what the resolution of the sensors leaves",
                ));
            }
        }
        let mut pitch = vec![Interval::ZERO; self.model.size()];
        pitch[0] = Interval::ONE;
        Ok(reach(form, level, &pitch)?)
    }

    /// The most that a sample adds, in the norm of the form.
    fn added(&self, form: &Matrix) -> Result<f64, Doubt> {
        let own = IntervalMatrix::from(form);
        let norm = |column: &[Interval]| -> Result<Interval, NotProved> {
            let rows: Vec<[Interval; 1]> = column.iter().map(|entry| [*entry]).collect();
            let column = IntervalMatrix::from_rows(&rows)?;
            let square = column.transpose().product(&own.product(&column)?)?.get(0, 0);
            let square = square.unwrap_or(Interval::ENTIRE);
            Ok(Interval::point(square.upper().max(0.0)).sqrt())
        };
        let of_command = norm(&self.model.by_command())? * Interval::point(self.off_rad);
        if !self.is_blurred() {
            return Ok(of_command.upper());
        }
        let [of_pitch, of_rate] = self.certificate.description.blurs().map(Interval::point);
        let mut most = 0.0_f64;
        for (_, HeldGains { gains, change_gain }) in self.held.held_corners() {
            let model = self.model.with_change_gain(Interval::point(change_gain));
            let at = points(gains);
            let by_pitch = norm(&model.by_seen(BreakPoint::Pitch, at))?;
            let by_rate = norm(&model.by_seen(BreakPoint::Rate, at))?;
            most = most.max((of_command + by_pitch * of_pitch + by_rate * of_rate).upper());
        }
        Ok(most)
    }
}
