//! What is chosen so seldom that independent flights do not know what it does.
//!
//! Two values that are met often enough each may hardly ever be met together, and a climb that does not meet them goes up with
//! the others. So it is combinations of the values of all choices that have to be met.

use fspid_scenario::dispersion::{Dispersion, Distribution};

/// So often independent flights have to meet a combination of values that are chosen among others, in the mean: none of them
/// does in one of 20 000 questions ($e^{-10}$). A choice of this project.
const FEWEST_MEETINGS: f64 = 10.0;

/// Combinations of the values of all choices that flights meet too seldom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seldom {
    /// Probability of all of them together.
    pub share: f64,
    /// The likeliest of them, as `--set` takes it; empty without any.
    pub likeliest: Vec<String>,
}

/// A choice: what each of its values is called, and its share; the likeliest share.
struct Chosen {
    values: Vec<(String, f64)>,
    most: f64,
}

/// A combination that is hardly met, whatever the choices behind it come to.
struct Missed {
    /// Of it with the likeliest values behind it.
    share: f64,
    values: Vec<usize>,
}

impl Seldom {
    /// Those that so many independent flights meet less than [`FEWEST_MEETINGS`] times in the mean.
    pub(super) fn of(dispersions: &[Dispersion], flights: f64) -> Self {
        Self::among(&dispersions.iter().filter_map(Chosen::of).collect::<Vec<_>>(), flights)
    }

    fn among(choices: &[Chosen], flights: f64) -> Self {
        let mut search = Search { choices, flights, share: 0.0, likeliest: None };
        search.below(1.0, &mut Vec::new());
        let likeliest = search.likeliest.as_ref().map_or(Vec::new(), |it| search.named(it));
        Self { share: search.share.min(1.0), likeliest }
    }
}

impl Chosen {
    fn of(dispersion: &Dispersion) -> Option<Self> {
        let Distribution::Choice(choice) = &dispersion.distribution else { return None };
        let paths = || dispersion.targets.iter().flat_map(|target| &target.paths);
        let named = |place: usize| {
            let value = dispersion.choices.get(place).map(ToString::to_string).unwrap_or_default();
            let set = paths().map(|path| match dispersion.relative {
                true => format!("{} times {value}", path.text()),
                false => format!("{}={value}", path.text()),
            });
            set.collect::<Vec<_>>().join(", ")
        };
        let values: Vec<(String, f64)> =
            choice.shares().enumerate().map(|(place, share)| (named(place), share)).collect();
        let most = values.iter().map(|(_, share)| *share).fold(0.0, f64::max);
        Some(Self { values, most })
    }
}

/// Goes through the combinations, and no further where they are hardly met whatever comes behind.
struct Search<'a> {
    choices: &'a [Chosen],
    flights: f64,
    share: f64,
    likeliest: Option<Missed>,
}

impl Search<'_> {
    /// Of values that the first choices have, which come together in this share of the flights.
    fn below(&mut self, share: f64, values: &mut Vec<usize>) {
        let Some(choice) = self.choices.get(values.len()) else { return };
        for (place, (_, part)) in choice.values.iter().enumerate() {
            let share = share * part;
            values.push(place);
            // No weight is no value.
            if share > 0.0 && share * self.flights < FEWEST_MEETINGS {
                self.miss(share, values);
            } else if share > 0.0 {
                self.below(share, values);
            }
            values.pop();
        }
    }

    fn miss(&mut self, share: f64, values: &[usize]) {
        self.share += share;
        let behind = self.choices.iter().skip(values.len());
        let share = behind.fold(share, |share, choice| share * choice.most);
        if self.likeliest.as_ref().is_none_or(|it| it.share < share) {
            self.likeliest = Some(Missed { share, values: values.to_vec() });
        }
    }

    /// With the likeliest values of the choices behind it.
    fn named(&self, missed: &Missed) -> Vec<String> {
        let behind = self.choices.iter().skip(missed.values.len()).map(|choice| {
            let values = choice.values.iter();
            values.max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(name, _)| name.clone())
        });
        let chosen = self.choices.iter().zip(&missed.values);
        let chosen = chosen.map(|(choice, place)| choice.values.get(*place));
        chosen.map(|it| it.map(|(name, _)| name.clone())).chain(behind).flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(weights: &[&[f64]], flights: f64) -> (f64, Vec<String>) {
        let chosen = |(choice, weights): (usize, &&[f64])| {
            let named = |(place, share): (usize, &f64)| (format!("{choice}={place}"), *share);
            Chosen {
                values: weights.iter().enumerate().map(named).collect(),
                most: weights.iter().copied().fold(0.0, f64::max),
            }
        };
        let choices: Vec<Chosen> = weights.iter().enumerate().map(chosen).collect();
        let Seldom { share, likeliest } = Seldom::among(&choices, flights);
        (share, likeliest)
    }

    #[test]
    fn values_that_are_met_often_each_and_hardly_ever_together_are_hardly_met() {
        let rare: &[f64] = &[0.995, 0.005];
        let (share, likeliest) = of(&[rare, rare], 2400.0);
        assert!((share - 2.5e-5).abs() < 1e-18, "{share}");
        assert_eq!(likeliest, ["0=1", "1=1"]);
        // Each of them alone is met twelve times.
        assert!(of(&[rare], 2400.0).0.abs() < 1e-18);
        // Met often enough together.
        assert!(of(&[rare, rare], 400_001.0).0.abs() < 1e-18);
        let (share, likeliest) = of(&[rare, rare], 1900.0);
        assert!((share - (1.0 - 0.995 * 0.995)).abs() < 1e-15, "{share}");
        assert!(likeliest == ["0=0", "1=1"] || likeliest == ["0=1", "1=0"], "{likeliest:?}");
    }

    #[test]
    fn all_combinations_that_are_hardly_met_are_as_likely_as_those_that_are_met_leave() {
        let weights: [&[f64]; 3] = [&[0.9, 0.0, 0.1], &[0.5, 0.49, 0.01], &[0.2, 0.8]];
        for flights in [1.0, 30.0, 150.0, 1e3, 2e4, 1e6] {
            let mut met = 0.0;
            for a in weights[0] {
                for b in weights[1] {
                    let both = weights[2].iter().map(|c| a * b * c);
                    met += both.filter(|it| it * flights >= FEWEST_MEETINGS).sum::<f64>();
                }
            }
            let (share, likeliest) = of(&weights, flights);
            assert!((share + met - 1.0).abs() < 1e-15, "{flights}: {share} {met}");
            assert_eq!(likeliest.len(), if share > 0.0 { 3 } else { 0 }, "{likeliest:?}");
        }
        assert_eq!(Seldom::among(&[], 1.0), Seldom::default());
    }
}
