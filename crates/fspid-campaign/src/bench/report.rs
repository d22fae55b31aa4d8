//! The measurements for people and for programs.

use serde_json::{Map, Value, json};

use super::{Bench, Kind, Rates, instruction_set, program};

/// A spread beyond this share of the median, in per cent, and the numbers mean little: differences below
/// it are what other programs on the machine make of the same work.
pub(super) const LARGE_SPREAD_PCT: f64 = 15.0;

/// Independent work that scales worse than this, in per cent, does not have the processors to itself.
const SMALL_SCALING_PCT: f64 = 75.0;

impl Bench {
    /// The rate that stands for a kind: of one thread, but of all threads for flights, 1/s.
    #[must_use]
    pub fn rate_per_s(&self, kind: Kind) -> f64 {
        let rates = self.rates(kind);
        let rates = rates.map(|(one, all)| if kind == Kind::Flights { all } else { one });
        rates.map_or(f64::NAN, Rates::median_per_s)
    }

    /// How many times as fast one thread is with a batch as one by one.
    #[must_use]
    pub fn times_by_batch(&self, scalar: Kind, batch: Kind) -> f64 {
        match (self.rates(scalar), self.rates(batch)) {
            (Some((scalar, _)), Some((batch, _))) => batch.times(scalar),
            _ => f64::NAN,
        }
    }

    /// What all threads together reach of as many times one thread's rate, %.
    #[must_use]
    pub fn scaling_pct(&self, kind: Kind) -> f64 {
        let times = self.rates(kind).map_or(f64::NAN, |(one, all)| all.times(one));
        100.0 * times / self.threads as f64
    }

    /// The largest spread among the measurements, %.
    #[must_use]
    pub fn largest_spread_pct(&self) -> f64 {
        let rates = self.measurements.iter().flat_map(|it| [&it.one, &it.all]);
        rates.map(Rates::spread_pct).fold(0.0, f64::max)
    }

    /// True where the machine was so busy with other things that the numbers mean little.
    #[must_use]
    pub fn is_noisy(&self) -> bool {
        // Written so that NaN is noise.
        !(self.largest_spread_pct() <= LARGE_SPREAD_PCT)
    }

    fn rates(&self, kind: Kind) -> Option<(&Rates, &Rates)> {
        let found = self.measurements.iter().find(|measurement| measurement.kind == kind);
        found.map(|measurement| (&measurement.one, &measurement.all))
    }

    /// For programs: the five rates at the top, everything else in `details`.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut answer = Map::new();
        for kind in Kind::ALL {
            answer.insert(format!("{}_per_s", kind.name()), json!(self.rate_per_s(kind)));
        }
        answer.insert("details".to_owned(), self.details());
        Value::Object(answer)
    }

    fn details(&self) -> Value {
        let measurements = self.measurements.iter().flat_map(|measurement| {
            let name = measurement.kind.name();
            [(1, &measurement.one), (self.threads, &measurement.all)]
                .map(|(threads, rates)| details(name, threads, rates))
        });
        let scaling = Kind::ALL.map(|kind| (kind.name().to_owned(), json!(self.scaling_pct(kind))));
        json!({
            "program": program(),
            "threads": self.threads,
            "instruction_set": instruction_set(),
            "lanes": fspid_sim::batch::LANES,
            "rounds": self.effort.rounds,
            "flights": self.effort.flights,
            "largest_spread_pct": self.largest_spread_pct(),
            "is_noisy": self.is_noisy(),
            "batch_times_scalar": {
                "inference": self.times_by_batch(Kind::InferenceScalar, Kind::InferenceBatch),
                "step": self.times_by_batch(Kind::StepScalar, Kind::StepBatch),
            },
            "scaling_pct": Value::Object(scaling.into_iter().collect()),
            "digest": self.digest,
            "measurements": measurements.collect::<Vec<_>>(),
        })
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        let threads = self.threads;
        let plural = if threads == 1 { "" } else { "s" };
        let heading = format!("{threads} thread{plural}");
        text.push_str(&format!("{}, vector instructions: {}\n\n", program(), instruction_set()));
        text.push_str(&format!("{:<28}{:>39}{heading:>39}\n", "", "1 thread"));
        let columns = format!("{:>15}{:>15}{:>9}", "median", "best", "spread");
        text.push_str(&format!("{:<28}{columns}{columns}{:>9}\n", "", "scaling"));
        for measurement in &self.measurements {
            let kind = measurement.kind;
            text.push_str(&format!("{:<28}", in_words(kind)));
            for rates in [&measurement.one, &measurement.all] {
                let (median, best) = (rate(rates.median_per_s()), rate(rates.best_per_s()));
                text.push_str(&format!("{median}{best}{:>7.1} %", rates.spread_pct()));
            }
            text.push_str(&format!("{:>7.0} %\n", self.scaling_pct(kind)));
        }
        self.summary(&mut text);
        text
    }

    fn summary(&self, text: &mut String) {
        let flights = self.rate_per_s(Kind::Flights);
        text.push_str(&format!(
            "\nOn one thread a batch makes {:.1} times as many inferences, and flights side by side {:.1} times as many steps, as one by one.\n",
            self.times_by_batch(Kind::InferenceScalar, Kind::InferenceBatch),
            self.times_by_batch(Kind::StepScalar, Kind::StepBatch)
        ));
        text.push_str(&format!(
            "1000 flights of 50 s at 100 Hz with all measures take {:.2} s on all threads, a million {:.1} min.\n",
            1e3 / flights,
            1e6 / flights / 60.0
        ));
        text.push_str(&format!(
            "Rates are medians of {} rounds; spread is from quartile to quartile, of the median. Digest of all answers, the same in every round: {}\n",
            self.effort.rounds,
            self.digest.get(..16).unwrap_or(&self.digest)
        ));
        // Inferences share nothing between threads, so that only the machine can hold them up.
        let scaling_pct = self.scaling_pct(Kind::InferenceScalar);
        if scaling_pct < SMALL_SCALING_PCT {
            text.push_str(&format!(
                "warning: {} threads make {scaling_pct:.0} % of what as many processors would: some are busy with something else, or are no whole processors\n",
                self.threads
            ));
        }
        if self.is_noisy() {
            text.push_str(&format!(
                "warning: a spread of {:.0} % is more than {LARGE_SPREAD_PCT:.0} %: something else uses this machine, and the numbers mean little\n",
                self.largest_spread_pct()
            ));
        }
    }
}

fn in_words(kind: Kind) -> &'static str {
    match kind {
        Kind::InferenceScalar => "inferences, one by one",
        Kind::InferenceBatch => "inferences, batch",
        Kind::StepScalar => "FSPID steps, one by one",
        Kind::StepBatch => "FSPID steps, side by side",
        Kind::Flights => "flights with all measures",
    }
}

/// Three digits and a unit, 15 characters wide.
fn rate(per_s: f64) -> String {
    let (value, unit) = match per_s {
        large if large >= 1e6 => (large / 1e6, "M/s"),
        some if some >= 1e4 => (some / 1e3, "k/s"),
        few => (few, "/s"),
    };
    let decimals = if value < 10.0 { 2 } else { usize::from(value < 100.0) };
    format!("{:>15}", format!("{value:.decimals$} {unit}"))
}

fn details(name: &str, threads: usize, rates: &Rates) -> Value {
    json!({
        "name": name,
        "threads": threads,
        "median_per_s": rates.median_per_s(),
        "lower_quartile_per_s": rates.lower_quartile_per_s(),
        "upper_quartile_per_s": rates.upper_quartile_per_s(),
        "best_per_s": rates.best_per_s(),
        "spread_pct": rates.spread_pct(),
        "rounds_per_s": rates.of_rounds(),
    })
}
