//! What each run of a dispersed scenario draws, from seed and run alone.

use fspid_scenario::dispersion::{Dispersion, Distribution, Drawn};
use fspid_scenario::file::{NewValue, SettingPath, Template};

use crate::error::CampaignError;
use crate::sample::{Cube, Sampling};

/// The dispersions of a scenario with the points that their draws come from.
#[derive(Clone, Debug)]
pub struct Draws {
    dispersions: Vec<Dispersion>,
    cube: Cube,
    /// The first coordinate of each dispersion.
    first: Vec<usize>,
    /// The number that stands in the scenario at each path of each dispersion, where draws are relative.
    nominal: Vec<Vec<f64>>,
}

impl Draws {
    /// Of so many runs of a scenario.
    ///
    /// # Errors
    /// More coordinates than the sampling has, or dispersions that make the scenario wrong.
    pub fn new(
        template: &Template,
        sampling: Sampling,
        runs: u64,
        seed: u64,
    ) -> Result<Self, CampaignError> {
        let dispersions = template.study().dispersions.clone();
        let dimensions = dispersions.iter().map(Dispersion::dimensions).sum();
        let cube = Cube::new(sampling, dimensions, runs, seed)?;
        let nominal = template.check_dispersions().map_err(CampaignError::Scenario)?;
        let first = first_coordinates(&dispersions);
        Ok(Self { dispersions, cube, first, nominal })
    }

    /// The same of the points of another seed, without asking the scenario again.
    ///
    /// # Errors
    /// None that [`Draws::new`] did not have.
    pub fn reseeded(&self, seed: u64) -> Result<Self, CampaignError> {
        let (dimensions, runs) = (self.cube.dimensions(), self.cube.runs());
        let cube = Cube::new(self.cube.sampling(), dimensions, runs, seed)?;
        Ok(Self { cube, ..self.clone() })
    }

    /// How many numbers between 0 and 1 decide about a run.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        self.dispersions.iter().map(Dispersion::dimensions).sum()
    }

    /// What a function says of the coordinates of each dispersion, in the order of the cube's.
    pub(crate) fn in_cube<T: Clone + Default>(&self, of: impl Fn(&Dispersion) -> Vec<T>) -> Vec<T> {
        let mut all = vec![T::default(); self.dimensions()];
        for (dispersion, &first) in self.dispersions.iter().zip(&self.first) {
            for (place, value) in all.iter_mut().skip(first).zip(of(dispersion)) {
                *place = value;
            }
        }
        all
    }

    /// What run `number` draws.
    #[must_use]
    pub fn drawn(&self, number: u64) -> Vec<Drawn> {
        let mut point = vec![0.0; self.dimensions()];
        self.cube.point(number, &mut point);
        self.drawn_at(&point)
    }

    /// What is drawn at a point of the unit cube.
    #[must_use]
    pub fn drawn_at(&self, point: &[f64]) -> Vec<Drawn> {
        let mut drawn = Vec::new();
        for (dispersion, &first) in self.dispersions.iter().zip(&self.first) {
            let mine = point.get(first..first + dispersion.dimensions()).unwrap_or_default();
            dispersion.draw(mine, &mut drawn);
        }
        drawn
    }

    /// The values that draws put into the scenario.
    #[must_use]
    pub fn values(&self, drawn: &[Drawn]) -> Vec<(&SettingPath, NewValue)> {
        self.values_of(drawn, |_, written| written)
    }

    /// The same of a scenario in which other numbers stand: `number` is asked for the one at each path of a relative
    /// dispersion, and given the one that is written there.
    #[must_use]
    pub fn values_of(
        &self,
        drawn: &[Drawn],
        number: impl Fn(&SettingPath, f64) -> f64,
    ) -> Vec<(&SettingPath, NewValue)> {
        let mut rest = drawn;
        let mut values = Vec::new();
        for (dispersion, nominal) in self.dispersions.iter().zip(&self.nominal) {
            let (mine, others) = rest.split_at(dispersion.names().count().min(rest.len()));
            rest = others;
            let paths = dispersion.targets.iter().flat_map(|target| &target.paths);
            let nominal: Vec<f64> =
                paths.zip(nominal).map(|(path, &written)| number(path, written)).collect();
            values.extend(dispersion.values(mine, &nominal));
        }
        values
    }

    /// Every path that something is drawn for, in the order of the values.
    pub fn paths(&self) -> impl Iterator<Item = &SettingPath> {
        let targets = self.dispersions.iter().flat_map(|dispersion| &dispersion.targets);
        targets.flat_map(|target| &target.paths)
    }
}

/// The first coordinate of each dispersion. Seeds come last: the last dimensions of an even sequence
/// are its least even ones, and what a seed does with them nobody can tell.
fn first_coordinates(dispersions: &[Dispersion]) -> Vec<usize> {
    let is_seed = |dispersion: &Dispersion| matches!(dispersion.distribution, Distribution::Seed);
    let mut order: Vec<usize> = (0..dispersions.len()).collect();
    order.sort_by_key(|&index| is_seed(&dispersions[index]));
    let mut first = vec![0; dispersions.len()];
    let mut next = 0;
    for index in order {
        first[index] = next;
        next += dispersions[index].dimensions();
    }
    first
}
