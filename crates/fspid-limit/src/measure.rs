//! The error measure that is minimised: IAE, ISE or largest error.

/// A measure of the error $e = r - \theta$ over all samples of a flight, as reports print it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// $T \sum |e_k|$, rad s.
    Iae,
    /// $T \sum e_k^2$, rad² s.
    Ise,
    /// $\max |e_k|$, rad.
    Peak,
}

impl Measure {
    /// Every measure.
    pub const ALL: [Self; 3] = [Self::Iae, Self::Ise, Self::Peak];

    /// Name in arguments and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Iae => "iae",
            Self::Ise => "ise",
            Self::Peak => "peak",
        }
    }

    /// Of errors, rad, at samples `dt_s` apart.
    #[must_use]
    pub fn of(self, errors_rad: &[f64], dt_s: f64) -> f64 {
        let sum = |term: fn(f64) -> f64| errors_rad.iter().map(|&e| term(e)).sum::<f64>() * dt_s;
        match self {
            Self::Iae => sum(f64::abs),
            Self::Ise => sum(|e| e * e),
            Self::Peak => errors_rad.iter().fold(0.0, |largest, e| e.abs().max(largest)),
        }
    }
}
