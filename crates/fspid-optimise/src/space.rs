//! The box that is searched.

/// How a parameter is spread over its interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly in its logarithm; both bounds must be positive.
    Logarithmic,
}

impl Scale {
    /// Value at `unit` of the way from the lower to the upper bound.
    #[must_use]
    pub fn between(self, lower: f64, upper: f64, unit: f64) -> f64 {
        let value = match self {
            Self::Linear => lower + unit * (upper - lower),
            Self::Logarithmic => lower * libm::exp(unit * libm::log(upper / lower)),
        };
        value.clamp(lower, upper)
    }

    /// How far `value` is on the way from the lower to the upper bound, from 0 to 1.
    #[must_use]
    pub fn unit(self, lower: f64, upper: f64, value: f64) -> f64 {
        let unit = match self {
            Self::Linear => (value - lower) / (upper - lower),
            Self::Logarithmic => libm::log(value / lower) / libm::log(upper / lower),
        };
        unit.clamp(0.0, 1.0)
    }
}

/// A parameter and its bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name in reports.
    pub name: &'static str,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// How it is spread.
    pub scale: Scale,
}

impl Parameter {
    /// Value at `unit` of the way from the lower to the upper bound.
    fn at(&self, unit: f64) -> f64 {
        self.scale.between(self.lower, self.upper, unit)
    }

    /// How far `value` is on the way from the lower to the upper bound, from 0 to 1.
    fn unit(&self, value: f64) -> f64 {
        self.scale.unit(self.lower, self.upper, value)
    }
}

/// A box of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    parameters: Vec<Parameter>,
}

impl Space {
    /// The box of these parameters.
    #[must_use]
    pub fn new(parameters: Vec<Parameter>) -> Self {
        Self { parameters }
    }

    /// Number of parameters.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.parameters.len()
    }

    /// The parameters.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The coordinates of a point in the unit cube.
    #[must_use]
    pub fn unit(&self, point: &[f64]) -> Vec<f64> {
        self.parameters.iter().zip(point).map(|(parameter, &x)| parameter.unit(x)).collect()
    }

    /// The point at these coordinates of the unit cube.
    #[must_use]
    pub fn point(&self, unit: &[f64]) -> Vec<f64> {
        self.parameters.iter().zip(unit).map(|(parameter, &u)| parameter.at(u)).collect()
    }
}
