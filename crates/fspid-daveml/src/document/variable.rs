//! Variables.

use serde::{Deserialize, Serialize};

use crate::expression::Expression;
use crate::finding::Origin;
use crate::formula::text_of_formula;

/// A variable.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Variable {
    /// Identifier in the file.
    pub id: String,
    /// Name, often one of the standard.
    pub name: String,
    /// Units in the spelling of the standard, such as `ft_s` and `nd`.
    pub units: String,
    /// Sign convention, as written.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub sign: String,
    /// Symbol.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub symbol: String,
    /// What it is.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Value of a constant, or of an input that is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<f64>,
    /// Lower limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Upper limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// What it is for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub roles: Vec<Role>,
    /// How it is calculated.
    #[serde(default, with = "text_of_formula", skip_serializing_if = "Option::is_none")]
    pub formula: Option<Expression>,
    /// Where it was written.
    #[serde(skip)]
    pub origin: Origin,
}

/// What a variable is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Given from outside.
    Input,
    /// Given from outside: a control.
    Control,
    /// Given from outside: a disturbance.
    Disturbance,
    /// Given from outside: a state, integrated by whoever uses the model.
    State,
    /// An answer: the rate of a state.
    StateRate,
    /// An answer.
    Output,
    /// Named by the standard.
    Standard,
}

impl Role {
    /// Every role with the name of its element.
    pub const ALL: [(&'static str, Self); 7] = [
        ("isInput", Self::Input),
        ("isControl", Self::Control),
        ("isDisturbance", Self::Disturbance),
        ("isState", Self::State),
        ("isStateDeriv", Self::StateRate),
        ("isOutput", Self::Output),
        ("isStdAIAA", Self::Standard),
    ];

    /// The role with that element.
    #[must_use]
    pub fn named(element: &str) -> Option<Self> {
        Self::ALL.iter().find(|(name, _)| *name == element).map(|&(_, role)| role)
    }

    /// The name of its element.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, role)| *role == self).map_or("", |&(name, _)| name)
    }

    /// True for a variable that has to be given.
    #[must_use]
    pub fn is_given(self) -> bool {
        matches!(self, Self::Input | Self::Control | Self::Disturbance | Self::State)
    }

    /// True for a variable that is answered.
    #[must_use]
    pub fn is_answer(self) -> bool {
        matches!(self, Self::Output | Self::StateRate)
    }
}
