//! What all lanes see.

use fspid_core::Sample;

use super::lane::Lanes;

/// Numbers up to this are far from overflow: products and quotients that a sample makes of them stay
/// below the bounds at which a single controller holds its output (above 10²⁸⁹). Beyond it a lane is
/// answered by a single controller.
pub(super) const FAR: f64 = 1e200;

/// What all lanes see at a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<'a, const W: usize> {
    pub(super) setpoint_rad: &'a Lanes<W>,
    pub(super) measurement_rad: &'a Lanes<W>,
    pub(super) rate_rad_s: &'a Lanes<W>,
}

impl<const W: usize> Samples<'_, W> {
    #[inline(always)]
    pub(super) fn of(&self, lane: usize) -> Sample<f64> {
        Sample {
            setpoint_rad: self.setpoint_rad[lane],
            measurement_rad: self.measurement_rad[lane],
            rate_rad_s: self.rate_rad_s[lane],
        }
    }
}
