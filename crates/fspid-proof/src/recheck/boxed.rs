//! Re-check of claims for all gains, starting with their bounding box.

use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopModel;

use super::{Recheck, RecheckError, Rechecked};
use crate::certificate::{Certificate, Claim};
use crate::gain_set::{GainSet, KnownSlopes};

impl Recheck<'_> {
    /// Proves a claim of the return to rest. One about all gains is proved of the box around them, if it holds there: of
    /// thousands of corners eight are left.
    pub(crate) fn of_rest(
        certificate: &Certificate,
        model: &LoopModel<Interval>,
        set: &GainSet,
        (known, stops): (&KnownSlopes, fn() -> bool),
    ) -> Result<Rechecked, RecheckError> {
        let proved = |set: GainSet| {
            Recheck::with(certificate, model.clone(), set, known)?.until(stops).run()
        };
        let is_common = matches!(certificate.claim, Claim::CommonQuadratic { .. });
        if is_common
            && set.cells.len() > 1
            && let Ok(rechecked) = proved(set.bounding_box())
        {
            return Ok(rechecked);
        }
        proved(set.clone())
    }
}
