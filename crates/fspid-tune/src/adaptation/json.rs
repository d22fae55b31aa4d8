//! The answer for programs.

use fspid_core::Gains;
use fspid_study::json::with_null_reasons;
use serde_json::{Value, json};

use super::answer::{Answer, Followed, Following, Moved, PlantRow, Row, Step};
use super::draws::Estimate;

impl Answer {
    /// For programs, schema 1.
    #[must_use]
    pub fn json(&self) -> Value {
        let (seeds, seed, budget) = self.effort;
        let answer = json!({
            "schema": 1,
            "scenario": self.scenario,
            "digest": self.digest,
            "controller": self.controller,
            "against": self.against,
            "seeds": seeds,
            "seed": seed,
            "budget": budget,
            "answer": self.headline(),
            "barred": self.barred,
            "flights": self.flights,
            "kept": self.kept,
            "plants_kept": self.plants_kept(),
            "win": { "iae_ratio": estimate(self.win), "travel_ratio": estimate(self.win_travel) },
            "steps": self.steps.iter().map(|it| step(it, self.called(it).0)).collect::<Vec<_>>(),
            "flown": self.rows.iter().map(row).collect::<Vec<_>>(),
            "gains": self.moved.iter().map(moved).collect::<Vec<_>>(),
            "follows": self.following.iter().map(following).collect::<Vec<_>>(),
            "plants": self.plants.iter().map(plant).collect::<Vec<_>>(),
        });
        with_null_reasons(answer, &NULL)
    }
}

const FEW: &str = "of the flights that are compared too few are left";
const STILL: &str = "what it is a share of, or follows, does not move";
const REPLAYED: &str =
    "gains or inputs of other moments have no rest, or nobody knows its equations";
/// Why what may be missing is missing.
const NULL: [(&str, &str); 17] = [
    ("barred", "nothing keeps a win from being one"),
    ("unstable", REPLAYED),
    ("undecided", REPLAYED),
    ("iae_ratio", FEW),
    ("travel_ratio", FEW),
    ("share", "there is no win of which it would be a share, or too few flights are left"),
    (
        "interval",
        "it is of fewer than five plants, or nothing is left of it without some of them, or it is a share of what may be nothing",
    ),
    ("breaks_a_requirement", "nothing is required"),
    ("share_between_plants", STILL),
    ("share_between_flights", STILL),
    ("share_within_flights", STILL),
    ("effectiveness", STILL),
    ("best_by_effectiveness", "no best gains of each plant were found, or they do not move"),
    ("airspeed", STILL),
    ("best", "no best gains of each plant were found, or they do not move"),
    ("amplitude_per_deg", STILL),
    (
        "best_gains",
        "no best gains of each plant were searched for, or no candidate kept its travel and what it keeps",
    ),
];

fn estimate(found: Option<Estimate>) -> Value {
    found.map_or(Value::Null, |it| json!({ "value": it.value, "interval": it.interval }))
}

fn step(it: &Step, name: &str) -> Value {
    json!({
        "step": name,
        "to": it.treatment.name(),
        "iae_ratio": estimate(it.iae),
        "travel_ratio": estimate(it.travel),
        "share": estimate(it.share),
    })
}

fn row(it: &Row) -> Value {
    json!({
        "flown": it.treatment.name(),
        "iae_ratio": estimate(it.iae),
        "travel_ratio": estimate(it.travel),
        "lost": it.lost,
        "flights": it.flights,
        "breaks_a_requirement": it.broken,
        "unstable": it.unstable,
        "undecided": it.undecided,
    })
}

fn moved(it: &Moved) -> Value {
    json!({
        "gain": it.gain,
        "nominal": it.nominal,
        "mean": it.mean,
        "deviation": it.deviation,
        "share_between_plants": estimate(it.between_plants),
        "share_between_flights": estimate(it.between_flights),
        "share_within_flights": estimate(it.within_flights),
    })
}

fn followed(found: Option<Followed>) -> Value {
    found.map_or(Value::Null, |it| {
        json!({
            "correlation": estimate(Some(it.correlation)),
            "slope": estimate(Some(it.slope)),
        })
    })
}

fn following(it: &Following) -> Value {
    json!({
        "gain": it.gain,
        "effectiveness": followed(it.effectiveness),
        "best_by_effectiveness": followed(it.best_by_effectiveness),
        "airspeed": followed(it.airspeed),
        "best": followed(it.best),
        "amplitude_per_deg": followed(it.amplitude),
    })
}

fn plant(it: &PlantRow) -> Value {
    let gains = |it: Gains<f64>| json!({ "kp": it.kp, "ki": it.ki, "kd": it.kd });
    json!({
        "first_case": it.name,
        "written": it.written,
        "flights": it.flights,
        "kept": it.kept,
        "effectiveness_1_s2": it.effectiveness_1_s2,
        "airspeed_m_s": it.airspeed_m_s,
        "mean_gains": gains(it.mean),
        "best_gains": it.best.map(gains),
    })
}
