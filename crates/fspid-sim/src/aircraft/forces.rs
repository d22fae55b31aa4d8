//! The models of forces that a scenario can hold.

use std::fmt;
use std::sync::Arc;

use fspid_aircraft::aerodynamics::derivatives::DerivativeModel;
use fspid_aircraft::aerodynamics::varied::VariedModel;
use fspid_aircraft::{Controls, Departure, Flow, ForceModel, Gearing, Loads, Travel, Validity};

/// A model of the forces on an aircraft.
///
/// Scenarios are compared: derivatives by their numbers, other models by being the same object.
#[derive(Clone)]
#[non_exhaustive]
pub enum Forces {
    /// Stability derivatives.
    Derivatives(Box<DerivativeModel>),
    /// Stability derivatives and what is added to them in flight.
    Varied(Box<VariedModel>),
    /// Any other model.
    Other(Arc<dyn ForceModel + Send + Sync>),
}

impl Forces {
    /// Stability derivatives, if these are they.
    pub(crate) fn derivatives(&self) -> Option<&DerivativeModel> {
        match self {
            Self::Derivatives(model) => Some(model),
            Self::Varied(_) | Self::Other(_) => None,
        }
    }

    fn model(&self) -> &dyn ForceModel {
        match self {
            Self::Derivatives(model) => model.as_ref(),
            Self::Varied(model) => model.as_ref(),
            Self::Other(model) => model.as_ref(),
        }
    }

    /// The model whose forces vary, of an aircraft that has one.
    #[must_use]
    pub fn varied(&self) -> Option<&VariedModel> {
        match self {
            Self::Varied(model) => Some(model),
            Self::Derivatives(_) | Self::Other(_) => None,
        }
    }
}

impl From<VariedModel> for Forces {
    fn from(model: VariedModel) -> Self {
        Self::Varied(Box::new(model))
    }
}

impl From<DerivativeModel> for Forces {
    fn from(model: DerivativeModel) -> Self {
        Self::Derivatives(Box::new(model))
    }
}

impl PartialEq for Forces {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Derivatives(this), Self::Derivatives(that)) => this == that,
            (Self::Varied(this), Self::Varied(that)) => this == that,
            (Self::Other(this), Self::Other(that)) => Arc::ptr_eq(this, that),
            _ => false,
        }
    }
}

impl fmt::Debug for Forces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Derivatives(model) => model.fmt(f),
            Self::Varied(model) => model.fmt(f),
            Self::Other(_) => f.write_str("Other"),
        }
    }
}

impl ForceModel for Forces {
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        match self {
            Self::Derivatives(model) => model.loads(flow, controls),
            Self::Varied(model) => model.loads(flow, controls),
            Self::Other(model) => model.loads(flow, controls),
        }
    }

    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        match self {
            Self::Derivatives(model) => model.loads_per_alpha_rate(flow),
            Self::Varied(model) => model.loads_per_alpha_rate(flow),
            Self::Other(model) => model.loads_per_alpha_rate(flow),
        }
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        self.model().thrust_n(flow, controls)
    }

    fn has_engine(&self) -> bool {
        self.model().has_engine()
    }

    fn gearing(&self) -> Gearing {
        self.model().gearing()
    }

    fn validity(&self) -> &Validity {
        self.model().validity()
    }

    fn travel(&self) -> &Travel {
        self.model().travel()
    }

    fn beyond_data(&self, flow: &Flow, controls: &Controls) -> Option<Departure> {
        self.model().beyond_data(flow, controls)
    }
}
