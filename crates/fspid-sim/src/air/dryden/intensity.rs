//! How strong turbulence is.

use crate::error::{SimError, not_negative};
use fspid_numeric::units::{FOOT_M, KNOT_M_S};

/// How rough the air is aloft, by the severity index of the exceedance chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Index 3.
    Light,
    /// Index 4.
    Moderate,
    /// Index 6.
    Severe,
}

/// Heights of the exceedance table, ft.
const CHART_FT: [f64; 8] = [500.0, 1750.0, 3750.0, 7500.0, 15_000.0, 25_000.0, 35_000.0, 45_000.0];

impl Severity {
    /// All, from light to severe.
    pub const ALL: [Self; 3] = [Self::Light, Self::Moderate, Self::Severe];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Moderate => "moderate",
            Self::Severe => "severe",
        }
    }

    /// Wind at 20 ft that goes with it near the ground, m/s: 15, 30, 45 kt.
    #[must_use]
    pub const fn w20_m_s(self) -> f64 {
        match self {
            Self::Light => 15.0 * KNOT_M_S,
            Self::Moderate => 30.0 * KNOT_M_S,
            Self::Severe => 45.0 * KNOT_M_S,
        }
    }

    /// Root mean square velocities of the exceedance table, ft/s.
    ///
    /// # Source
    /// MIL-F-8785C, figure 7, as tabulated in the source of JSBSim.
    const fn chart_ft_s(self) -> [f64; 8] {
        match self {
            Self::Light => [6.6, 6.9, 7.4, 6.7, 4.6, 2.7, 0.4, 0.0],
            Self::Moderate => [8.6, 9.6, 10.6, 10.1, 8.0, 6.6, 5.0, 4.2],
            Self::Severe => [15.6, 17.6, 23.0, 23.6, 22.1, 20.0, 16.0, 15.1],
        }
    }

    /// Root mean square velocity aloft, m/s; straight lines in the table, constant outside it.
    #[must_use]
    pub fn aloft_m_s(self, height_m: f64) -> f64 {
        let (heights, sizes) = (CHART_FT, self.chart_ft_s());
        let chart: [(f64, f64); 8] = std::array::from_fn(|row| (heights[row], sizes[row]));
        FOOT_M * interpolated(&chart, height_m / FOOT_M)
    }
}

/// How strong turbulence is: by the wind near the ground, by the severity aloft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intensity {
    w20_m_s: f64,
    aloft: Severity,
}

impl Intensity {
    /// With a wind of its own at 20 ft.
    ///
    /// # Errors
    /// [`SimError::Number`] for a wind that is negative or not finite.
    pub fn new(w20_m_s: f64, aloft: Severity) -> Result<Self, SimError> {
        Ok(Self { w20_m_s: not_negative("wind at 20 ft, m/s", w20_m_s)?, aloft })
    }

    /// Wind at 20 ft, m/s.
    #[must_use]
    pub fn w20_m_s(&self) -> f64 {
        self.w20_m_s
    }

    /// Severity aloft.
    #[must_use]
    pub fn aloft(&self) -> Severity {
        self.aloft
    }
}

impl From<Severity> for Intensity {
    fn from(aloft: Severity) -> Self {
        Self { w20_m_s: aloft.w20_m_s(), aloft }
    }
}

/// A table of rising places and values, read in straight lines and constant outside.
pub(crate) fn interpolated(table: &[(f64, f64)], at: f64) -> f64 {
    let Some(&(_, first)) = table.first() else {
        return 0.0;
    };
    table.windows(2).fold(first, |value, pair| match *pair {
        [(x0, y0), (x1, y1)] if at > x0 => y0 + (y1 - y0) * ((at - x0) / (x1 - x0)).clamp(0.0, 1.0),
        _ => value,
    })
}
