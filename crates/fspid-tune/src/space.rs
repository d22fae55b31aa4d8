//! The unit cube that is searched, and what its points put into a scenario.

use fspid_scenario::file::{NewValue, SettingPath};
use fspid_scenario::tuning::Mark;

/// The marked places of a scenario, one or more coordinates each.
#[derive(Clone, Debug)]
pub struct Space {
    marks: Vec<Mark>,
}

impl Space {
    /// The cube of these marks.
    #[must_use]
    pub fn new(marks: Vec<Mark>) -> Self {
        Self { marks }
    }

    /// The marks, in the order of the coordinates.
    #[must_use]
    pub fn marks(&self) -> &[Mark] {
        &self.marks
    }

    /// Number of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.marks.iter().map(Mark::dimensions).sum()
    }

    /// The point from which a search begins.
    #[must_use]
    pub fn start(&self) -> Vec<f64> {
        self.marks.iter().flat_map(Mark::start).collect()
    }

    /// Names of the coordinates.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.marks.iter().flat_map(Mark::names).collect()
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
    ) -> impl Iterator<Item = (&'a Mark, &'p [f64])> + use<'a, 'p> {
        let mut rest = point;
        self.marks.iter().map(move |mark| {
            let (mine, others) = rest.split_at(mark.dimensions().min(rest.len()));
            rest = others;
            (mark, mine)
        })
    }
}
