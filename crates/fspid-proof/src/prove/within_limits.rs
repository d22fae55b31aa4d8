//! How far a flight may begin from rest so that no limit acts while gains move, in ordinary arithmetic.

use fspid_lti::Matrix;

use super::Prover;
use crate::certificate::{BoundedRate, Certificate, Claim};
use crate::gain_set::GainSet;
use crate::limits;
use crate::recheck::Recheck;

/// Of what ordinary arithmetic finds, so much is claimed.
const CLAIMED: f64 = 1.0 - 1e-6;

impl Prover<'_> {
    /// The largest level of a moving form within which no limit acts.
    pub(super) fn level_within_limits(
        &self,
        set: &GainSet,
        factor: f64,
        claim: &BoundedRate,
    ) -> Option<f64> {
        let certificate = self.claim_alone(factor, claim);
        let recheck =
            Recheck::with(&certificate, self.enclosed.clone(), set.clone(), &self.slopes).ok()?;
        let rest = self.rest(set).ok()?;
        let mut level = f64::INFINITY;
        for corner in recheck.moving_decrease(claim).ok()?.corners(claim).ok()? {
            let form = corner.form.midpoint();
            let rows = limits::rows(self.description, &self.model, corner.gains_middle(), &rest);
            for (row, limit) in rows {
                // Rest itself is at a limit.
                if !(limit > 0.0) {
                    return None;
                }
                let size = size(&form, &row)?;
                level = if size > 0.0 { level.min(limit * limit / size) } else { level };
            }
        }
        let level = CLAIMED * level;
        (level > 0.0 && level.is_finite()).then_some(level)
    }

    /// A certificate of the claim alone.
    fn claim_alone(&self, factor: f64, claim: &BoundedRate) -> Certificate {
        Certificate {
            description: self.description.clone(),
            output_factor: factor,
            divisions: self.effort.divisions,
            range: self.range,
            left_out: self.asked.left_out.clone(),
            claim: Claim::BoundedRate(claim.clone()),
            steps: None,
            commanded: None,
            family: None,
            disturbances: Vec::new(),
            nonlinear: None,
            level: None,
        }
    }
}

/// $r P^{-1} r^T$.
fn size(form: &Matrix, row: &[f64]) -> Option<f64> {
    let column = Matrix::from_rows(&row.iter().map(|value| [*value]).collect::<Vec<_>>()).ok()?;
    let solved = form.solve(&column).ok()?;
    Some(row.iter().zip(solved.data()).map(|(r, x)| r * x).sum())
}
