//! How long and how strong turbulence is, by height.

use super::intensity::Intensity;
use fspid_numeric::units::FOOT_M;

/// Which document scale lengths are stated by.
///
/// MIL-HDBK-1797 writes $2 L_v$ and $2 L_w$ where MIL-F-8785C writes $L_v$ and $L_w$, and halves
/// these lengths at all heights: printed lengths differ, spectra do not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Specification {
    /// MIL-F-8785C.
    #[default]
    MilF8785c,
    /// MIL-HDBK-1797.
    MilHdbk1797,
}

impl Specification {
    /// Both.
    pub const ALL: [Self; 2] = [Self::MilF8785c, Self::MilHdbk1797];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::MilF8785c => "mil-f-8785c",
            Self::MilHdbk1797 => "mil-hdbk-1797",
        }
    }

    /// What the filters of v and w multiply their printed length by.
    #[must_use]
    pub const fn length_factor(self) -> f64 {
        match self {
            Self::MilF8785c => 1.0,
            Self::MilHdbk1797 => 2.0,
        }
    }
}

/// Scale lengths, m, as the document prints them, and root mean square velocities, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// $L_u, L_v, L_w$, m.
    pub length_m: [f64; 3],
    /// $\sigma_u, \sigma_v, \sigma_w$, m/s.
    pub sigma_m_s: [f64; 3],
}

/// Top of the layer near the ground, ft.
const LOW_FT: f64 = 1000.0;
/// Bottom of the layer aloft, ft.
const HIGH_FT: f64 = 2000.0;
/// Least height that the formulas near the ground are for, ft; below it they are taken there.
const LEAST_FT: f64 = 10.0;
/// $L_u$ aloft, ft.
const ALOFT_FT: f64 = 1750.0;

impl Scales {
    /// Scales at a height above the ground.
    ///
    /// Below 1000 ft, with h in ft:
    ///
    /// $$ L_w = h, \quad L_u = L_v = \frac{h}{(0.177 + 0.000823 h)^{1.2}}, \quad
    /// \sigma_w = 0.1 W_{20}, \quad
    /// \sigma_u = \sigma_v = \frac{\sigma_w}{(0.177 + 0.000823 h)^{0.4}} $$
    ///
    /// Above 2000 ft all lengths are 1750 ft and all sizes those of [`Severity::aloft_m_s`](super::Severity::aloft_m_s); between,
    /// straight lines. In MIL-HDBK-1797 $L_v$ and $L_w$ are half of this.
    ///
    /// # Source
    /// MIL-F-8785C, 3.7.2 and 3.7.3; MIL-HDBK-1797, appendix A.
    #[must_use]
    pub fn at(specification: Specification, intensity: Intensity, height_m: f64) -> Self {
        let height_ft = height_m / FOOT_M;
        let share = ((height_ft - LOW_FT) / (HIGH_FT - LOW_FT)).clamp(0.0, 1.0);
        let low = Self::near_ground(intensity, height_ft.clamp(LEAST_FT, LOW_FT));
        let high = Self::aloft(intensity, height_ft.max(HIGH_FT));
        let mut scales = low.mixed(&high, share);
        let [_, across, vertical] = &mut scales.length_m;
        *across /= specification.length_factor();
        *vertical /= specification.length_factor();
        scales
    }

    fn near_ground(intensity: Intensity, height_ft: f64) -> Self {
        let base = 0.177 + 0.000_823 * height_ft;
        let horizontal_m = FOOT_M * height_ft / libm::pow(base, 1.2);
        let sigma_w = 0.1 * intensity.w20_m_s();
        let sigma_u = sigma_w / libm::pow(base, 0.4);
        Self {
            length_m: [horizontal_m, horizontal_m, FOOT_M * height_ft],
            sigma_m_s: [sigma_u, sigma_u, sigma_w],
        }
    }

    fn aloft(intensity: Intensity, height_ft: f64) -> Self {
        let sigma = intensity.aloft().aloft_m_s(height_ft * FOOT_M);
        Self { length_m: [ALOFT_FT * FOOT_M; 3], sigma_m_s: [sigma; 3] }
    }

    fn mixed(&self, other: &Self, share: f64) -> Self {
        let mix = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|axis| a[axis] + share * (b[axis] - a[axis]))
        };
        Self {
            length_m: mix(self.length_m, other.length_m),
            sigma_m_s: mix(self.sigma_m_s, other.sigma_m_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::intensity::Severity;
    use super::*;

    fn feet(value_m: f64) -> f64 {
        value_m / FOOT_M
    }

    fn at(severity: Severity, height_ft: f64) -> Scales {
        Scales::at(Specification::MilF8785c, severity.into(), height_ft * FOOT_M)
    }

    /// Handbook oracle: height, L_u, then sigma_u for light, moderate, severe, all in ft and ft/s.
    #[test]
    fn lengths_and_sizes_near_the_ground_are_those_of_the_table() {
        let table = [
            (50.0, 310.8, [4.655, 9.310, 13.965]),
            (100.0, 505.2, [4.344, 8.688, 13.032]),
            (200.0, 725.8, [3.891, 7.781, 11.672]),
            (500.0, 944.7, [3.130, 6.260, 9.389]),
            (1000.0, 1000.0, [2.532, 5.063, 7.595]),
        ];
        for (height_ft, length_ft, sizes) in table {
            for ((severity, sigma_u), sigma_w) in
                Severity::ALL.into_iter().zip(sizes).zip([2.532, 5.063, 7.595])
            {
                let Scales { length_m: [l_u, l_v, l_w], sigma_m_s: [u, v, w] } =
                    at(severity, height_ft);
                assert!((feet(l_u) - length_ft).abs() <= 0.05, "{height_ft} {}", feet(l_u));
                assert!((feet(u) - sigma_u).abs() <= 5.1e-4, "{height_ft} {}", feet(u));
                assert!((feet(w) - sigma_w).abs() <= 5.1e-4, "{height_ft} {}", feet(w));
                assert!((feet(l_w) - height_ft).abs() < 1e-9);
                assert_eq!((l_v, v), (l_u, u));
            }
        }
    }

    /// Handbook oracle: 3.65, 7.30, 21.05 ft/s at 20 000 ft.
    #[test]
    fn sizes_aloft_are_interpolated_in_the_chart() {
        for (severity, expected) in Severity::ALL.into_iter().zip([3.65, 7.30, 21.05]) {
            let scales = at(severity, 20_000.0);
            for axis in 0..3 {
                assert!((feet(scales.sigma_m_s[axis]) - expected).abs() < 1e-9);
                assert!((feet(scales.length_m[axis]) - 1750.0).abs() < 1e-9);
            }
        }
        assert!((feet(at(Severity::Severe, 70_000.0).sigma_m_s[0]) - 15.1).abs() < 1e-9);
    }

    #[test]
    fn between_1000_and_2000_ft_the_scales_are_half_way_at_1500() {
        for severity in Severity::ALL {
            let (low, middle, high) =
                (at(severity, 1000.0), at(severity, 1500.0), at(severity, 2000.0));
            for axis in 0..3 {
                let length = 0.5 * (low.length_m[axis] + high.length_m[axis]);
                let sigma = 0.5 * (low.sigma_m_s[axis] + high.sigma_m_s[axis]);
                assert!((middle.length_m[axis] - length).abs() < 1e-9);
                assert!((middle.sigma_m_s[axis] - sigma).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_handbook_prints_half_the_length_across_and_vertically() {
        for height_ft in [200.0, 1500.0, 30_000.0] {
            let intensity = Severity::Light.into();
            let height_m = height_ft * FOOT_M;
            let old = Scales::at(Specification::MilF8785c, intensity, height_m);
            let new = Scales::at(Specification::MilHdbk1797, intensity, height_m);
            let [u, v, w] = old.length_m;
            assert_eq!(new.length_m, [u, v / 2.0, w / 2.0]);
            assert_eq!(new.sigma_m_s, old.sigma_m_s);
        }
    }

    #[test]
    fn a_wind_of_ones_own_sets_the_size_near_the_ground_only() {
        let intensity = Intensity::new(10.0, Severity::Light).expect("allowed");
        let sigma = |height_ft: f64| {
            Scales::at(Specification::MilF8785c, intensity, height_ft * FOOT_M).sigma_m_s[2]
        };
        assert!((sigma(300.0) - 1.0).abs() < 1e-12);
        assert!((feet(sigma(20_000.0)) - 3.65).abs() < 1e-9);
        assert!(Intensity::new(f64::NAN, Severity::Light).is_err());
    }
}
