//! Disk margins: gain and phase that may change together.

use core::f64::consts::PI;

/// The largest disk of complex factors on the loop that leaves it stable.
///
/// $$ f = \frac{1 + \frac{1 - \sigma}{2} \delta}{1 - \frac{1 + \sigma}{2} \delta}, \quad |\delta| < \alpha, \quad
/// \alpha = \frac{1}{\lVert S + \frac{\sigma - 1}{2} \rVert_\infty} $$
///
/// # Source
/// P. Seiler, A. Packard, P. Gahinet, An introduction to disk margins, IEEE Control Systems Magazine 40 (2020) 78.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiskMargin {
    /// Size α of the disk.
    pub size: f64,
    /// Skew σ: 0 treats growing and falling gain alike, a positive one allows more growth.
    pub skew: f64,
    /// Frequency of the smallest destabilising factor.
    pub omega_rad_s: f64,
    /// Smallest and largest real factor in the disk; 0 where it holds factors below 0, infinite where it holds all
    /// large ones.
    pub gain: [f64; 2],
    /// Largest angle in rad by which the phase alone may change to either side; π where any may.
    pub phase_rad: f64,
}

impl DiskMargin {
    /// Margin of a size and skew at a frequency.
    pub(crate) fn new(size: f64, skew: f64, omega_rad_s: f64) -> Self {
        let (gain, phase_rad) = Self::ends(size, skew);
        Self { size, skew, omega_rad_s, gain, phase_rad }
    }

    /// Real factors at the ends of the disk, and the largest angle of a factor of modulus 1 within it, in rad.
    ///
    /// With $p = \alpha (1 - \sigma) / 2$ and $q = \alpha (1 + \sigma) / 2$:
    ///
    /// $$ g_{\min} = \frac{1 - p}{1 + q}, \quad g_{\max} = \frac{1 + p}{1 - q}, \quad
    /// \cos \varphi = \frac{1 + g_{\min} g_{\max}}{g_{\min} + g_{\max}}, \quad
    /// \tan \frac{\varphi}{2} = \frac{\alpha}{\sqrt{4 - \alpha^2 \sigma^2}} $$
    #[must_use]
    pub fn ends(size: f64, skew: f64) -> ([f64; 2], f64) {
        let (p, q) = (0.5 * size * (1.0 - skew), 0.5 * size * (1.0 + skew));
        let low = if p < 1.0 && q > -1.0 { (1.0 - p) / (1.0 + q) } else { 0.0 };
        let high = if q < 1.0 { (1.0 + p) / (1.0 - q) } else { f64::INFINITY };
        // Where |ασ| ≥ 2 the edge of the disk does not meet the unit circle, and every angle is allowed.
        let across = 4.0 - (size * skew) * (size * skew);
        let phase_rad = if across > 0.0 { 2.0 * libm::atan(size / across.sqrt()) } else { PI };
        ([low, high], phase_rad)
    }
}
