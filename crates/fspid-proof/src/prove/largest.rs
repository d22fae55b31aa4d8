//! The largest output scale that can be proved.

use super::{Largest, Prover, Verdict};
use crate::certificate::{Certificate, Claim};

impl Prover<'_> {
    /// The largest output scale that can be proved, by halving.
    pub(super) fn largest(&self, verdict: &Verdict) -> Largest {
        let may_use_s_procedure = !matches!(
            verdict,
            Verdict::Proved(Certificate { claim: Claim::CommonQuadratic { .. }, .. }, _)
        );
        let mut largest = Largest { proved: 0.0, not_proved: None, certificate: None };
        if self.tuned().is_none() {
            largest.proved = if matches!(verdict, Verdict::Proved(..)) { 1.0 } else { 0.0 };
            return largest;
        }
        let mut next = 1.0;
        if matches!(verdict, Verdict::Proved(..)) {
            largest.proved = 1.0;
            next = 2.0;
        } else {
            largest.not_proved = Some(1.0);
        }
        while largest.not_proved.is_none() && next <= self.effort.largest_factor {
            self.ask(&mut largest, next, may_use_s_procedure);
            next *= 2.0;
        }
        for _ in 0..self.effort.halvings {
            let Some(above) = largest.not_proved else { break };
            let middle = 0.5 * (largest.proved + above);
            self.ask(&mut largest, middle, may_use_s_procedure);
        }
        largest
    }

    pub(super) fn ask(&self, largest: &mut Largest, factor: f64, may_use_s_procedure: bool) {
        let set = self.set(factor);
        let common_quadratic = self.common_quadratic(&set, factor, false);
        let found = common_quadratic.or_else(|| {
            if may_use_s_procedure { self.s_procedure(&set, factor, false) } else { None }
        });
        match found {
            Some((certificate, _)) => {
                largest.proved = factor;
                largest.certificate = Some(certificate);
            }
            None => largest.not_proved = Some(factor),
        }
    }
}
