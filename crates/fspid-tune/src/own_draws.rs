//! What is drawn for a controller that flies without the others, with numbers that are tuned.

use fspid_campaign::Draws;
use fspid_scenario::dispersion::Drawn;
use fspid_scenario::file::{NewValue, SettingPath, Template};

use crate::flyer::Flyer;

/// Draws of a whole scenario, and where they go where one controller flies alone.
#[derive(Clone, Debug)]
pub(crate) struct OwnDraws {
    draws: Draws,
    /// Where each of its values goes, in their order; none for what is drawn for another controller.
    places: Vec<Option<SettingPath>>,
    /// Paths of draws that are factors of what is tuned: as the scenario has them, and as the controller alone has them.
    factors: Vec<[SettingPath; 2]>,
}

impl OwnDraws {
    /// Of what a whole scenario draws, for one that flies.
    pub(crate) fn of(draws: Draws, whole: &Template, flyer: Flyer<'_>) -> Self {
        let own = |path: &SettingPath| whole.path_of_only(flyer.controller, path);
        let places = draws.paths().map(own).collect();
        let tuned = draws.paths().filter(|path| whole.leads_to(flyer.free, path));
        let factors = tuned.filter_map(|path| Some([path.clone(), own(path)?])).collect();
        Self { draws, places, factors }
    }

    /// Paths whose draws are factors of what is tuned.
    pub(crate) fn factors(&self) -> impl Iterator<Item = &str> {
        self.factors.iter().map(|[_, own]| own.text())
    }

    /// The values that draws put into the scenario of the controller alone, in which what is tuned has these values.
    pub(crate) fn values(
        &self,
        drawn: &[Drawn],
        alone: &Template,
        tuned: &[(&SettingPath, NewValue)],
    ) -> Vec<(&SettingPath, NewValue)> {
        let number = |path: &SettingPath, written: f64| {
            let factor = self.factors.iter().find(|[it, _]| it == path);
            let number = factor.and_then(|[_, own]| alone.number_with(tuned, own));
            number.unwrap_or(written)
        };
        let values = self.draws.values_of(drawn, number).into_iter().zip(&self.places);
        values.filter_map(|((_, value), place)| Some((place.as_ref()?, value))).collect()
    }
}
