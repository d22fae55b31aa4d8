//! The unit cube that is searched, and what its points put into a scenario.

use fspid_scenario::file::{NewValue, SettingPath};
use fspid_scenario::tuning::TunableParameter;

/// The marked places of a scenario, one or more coordinates each.
#[derive(Clone, Debug)]
pub struct Space {
    parameters: Vec<TunableParameter>,
}

impl Space {
    /// The cube of these parameters.
    #[must_use]
    pub fn new(parameters: Vec<TunableParameter>) -> Self {
        Self { parameters }
    }

    /// The parameters, in the order of the coordinates.
    #[must_use]
    pub fn parameters(&self) -> &[TunableParameter] {
        &self.parameters
    }

    /// Number of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.parameters.iter().map(TunableParameter::dimensions).sum()
    }

    /// The point from which a search begins.
    #[must_use]
    pub fn start(&self) -> Vec<f64> {
        self.parameters.iter().flat_map(TunableParameter::start).collect()
    }

    /// Names of the coordinates.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.parameters.iter().flat_map(TunableParameter::names).collect()
    }

    /// What the point puts into the scenario.
    #[must_use]
    pub fn values(&self, point: &[f64]) -> Vec<(&SettingPath, NewValue)> {
        self.parts(point).map(|(mark, part)| (&mark.path, mark.value(part))).collect()
    }

    /// The numbers of the coordinates in their own units.
    #[must_use]
    pub fn numbers(&self, point: &[f64]) -> Vec<f64> {
        self.parts(point).flat_map(|(mark, part)| mark.numbers(part)).collect()
    }

    fn parts<'a, 'p>(
        &'a self,
        point: &'p [f64],
    ) -> impl Iterator<Item = (&'a TunableParameter, &'p [f64])> + use<'a, 'p> {
        let mut rest = point;
        self.parameters.iter().map(move |mark| {
            let (mine, others) = rest.split_at(mark.dimensions().min(rest.len()));
            rest = others;
            (mark, mine)
        })
    }
}
