//! A dispersion of a scenario: which of its places get what is drawn.

use super::{Distribution, Draw};
use crate::setting_path::{NewValue, SettingPath};

/// What is drawn for a run, as it is kept beside the run's results.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawn {
    /// A number; of a relative dispersion the factor.
    Number(f64),
    /// A whole number, such as a seed.
    Whole(i64),
    /// A text.
    Text(String),
}

/// One number that is drawn, and where it goes.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Name in results; unique in its scenario.
    pub name: String,
    /// The places that get it.
    pub paths: Vec<SettingPath>,
}

/// What differs from run to run at some places of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispersion {
    /// What is drawn: one target, or several of correlated numbers.
    pub targets: Vec<Target>,
    /// How it is distributed.
    pub distribution: Distribution,
    /// True where draws are factors of the number that stands in the scenario.
    pub relative: bool,
    /// What a choice chooses from; empty for other distributions.
    pub choices: Vec<NewValue>,
}

impl Dispersion {
    /// How many numbers between 0 and 1 it takes.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        self.distribution.dimensions()
    }

    /// Names of what is drawn.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.targets.iter().map(|target| target.name.as_str())
    }

    /// True where texts are drawn.
    #[must_use]
    pub fn is_text(&self) -> bool {
        let is_text = |value: &NewValue| matches!(value, NewValue::Text(_) | NewValue::Boolean(_));
        self.choices.iter().any(is_text)
    }

    /// True where whole numbers are drawn.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let is_whole = |value: &NewValue| matches!(value, NewValue::Integer(_));
        match &self.distribution {
            Distribution::Seed => true,
            _ => !self.choices.is_empty() && self.choices.iter().all(is_whole),
        }
    }

    /// What the column of `name` means.
    #[must_use]
    pub fn in_words(&self, name: &str) -> String {
        let target = self.targets.iter().find(|target| target.name == name);
        let paths = target.map(|target| target.paths.as_slice()).unwrap_or_default();
        let paths: Vec<&str> = paths.iter().map(SettingPath::text).collect();
        let kind = if self.relative { "factor of" } else { "drawn for" };
        format!("{kind} {}: {}", paths.join(", "), self.distribution)
    }

    /// Draws at a point of the unit cube with [`dimensions`](Self::dimensions) coordinates, one entry a
    /// target.
    pub fn draw(&self, point: &[f64], into: &mut Vec<Drawn>) {
        let mut draws = Vec::with_capacity(self.targets.len());
        // A point with other coordinates draws nothing.
        if self.distribution.draw(point, &mut draws).is_ok() {
            into.extend(draws.into_iter().map(|draw| self.drawn(draw)));
        }
    }

    /// What is drawn at the ends: everything smallest and everything largest; each value of a choice.
    pub(crate) fn ends(&self) -> Vec<Vec<Drawn>> {
        if !self.choices.is_empty() {
            let chosen = |index| vec![self.drawn(Draw::Index(index))];
            return (0..self.choices.len()).map(chosen).collect();
        }
        let ends = self.distribution.ends();
        let smallest = ends.iter().map(|ends| self.drawn(ends.smallest)).collect();
        let largest = ends.iter().map(|ends| self.drawn(ends.largest)).collect();
        vec![smallest, largest]
    }

    fn drawn(&self, draw: Draw) -> Drawn {
        match draw {
            Draw::Number(number) => Drawn::Number(number),
            // Seeds are below 2^53.
            Draw::Seed(seed) => Drawn::Whole(i64::try_from(seed).unwrap_or(i64::MAX)),
            Draw::Index(index) => match self.choices.get(index) {
                Some(NewValue::Number(number)) => Drawn::Number(*number),
                Some(NewValue::Integer(whole)) if self.is_whole() => Drawn::Whole(*whole),
                Some(NewValue::Integer(whole)) if !self.is_text() => Drawn::Number(*whole as f64),
                Some(NewValue::Text(text)) => Drawn::Text(text.clone()),
                Some(other) => Drawn::Text(other.to_string()),
                // There are as many choices as the distribution has indices.
                None => Drawn::Text(String::new()),
            },
        }
    }

    /// What draws put into the scenario; `nominal` are the numbers that stand there, in the order of all
    /// paths, where draws are relative.
    #[must_use]
    pub fn values(&self, drawn: &[Drawn], nominal: &[f64]) -> Vec<(&SettingPath, NewValue)> {
        let mut nominal = nominal.iter();
        let mut values = Vec::new();
        for (target, drawn) in self.targets.iter().zip(drawn) {
            for path in &target.paths {
                let factor = nominal.next().copied().filter(|_| self.relative);
                values.push((path, self.value(drawn, factor)));
            }
        }
        values
    }

    fn value(&self, drawn: &Drawn, nominal: Option<f64>) -> NewValue {
        match drawn {
            Drawn::Number(number) => match nominal {
                Some(nominal) => NewValue::Number(nominal * number),
                None => NewValue::Number(*number),
            },
            Drawn::Whole(whole) => match nominal {
                Some(nominal) => NewValue::Number(nominal * *whole as f64),
                None => NewValue::Integer(*whole),
            },
            Drawn::Text(text) => {
                let meant = self.choices.iter().find(|choice| match choice {
                    NewValue::Text(choice) => choice == text,
                    other => other.to_string() == *text,
                });
                meant.cloned().unwrap_or_else(|| NewValue::Text(text.clone()))
            }
        }
    }
}
