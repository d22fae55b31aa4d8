//! What is certified beside what a scenario flies, field by field.

use super::around::not_held_in_words;
use super::comparison::{Comparison, Difference};
use fspid_proof::{Asked, LeftOut, LoopDescription, Way, ways_of};
use fspid_sim::SimError;
use serde_json::{Value, json};

use super::checked::CheckedFile;
use super::controller_file::ControllerFile;
use super::loop_file::LoopFile;
use super::nonlinear_file::AircraftFile;
use super::scope::commands_in_words;
use super::{asked, cases, family, nonlinear};
use fspid_scenario::file::{Study, Template};
use fspid_study::analysis::lasting_plants;

/// What stands in for something that is not there.
const NOTHING: &str = "nothing";

impl CheckedFile {
    /// Compares with what a scenario flies: its controller of that name, with the lasting plant that is
    /// nearest to the certified one.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model.
    pub fn compare(&mut self, study: &Study) -> Result<(), SimError> {
        let origin = &self.origin;
        let (mut differences, mut partly) = (Vec::new(), None);
        tell(&mut differences, "origin.scenario", &origin.scenario, &study.scenario.name);
        let certified = fields(&self.certificate.description);
        match flown(study, &origin.controller)? {
            Flown::Loops(loops) => {
                let compared = loops.iter().map(|(flown, asked, ways)| {
                    let mut found = Vec::new();
                    walk(&mut found, "", &certified, flown);
                    self.beyond(&mut found, asked);
                    self.other_ways(&mut found, ways);
                    found
                });
                differences.extend(compared.min_by_key(Vec::len).unwrap_or_default());
                partly = loops.iter().find_map(|(_, asked, _)| self.partly(asked));
                if self.certificate.claim.is_of_stability() {
                    differences.extend(not_held(study, &origin.controller));
                }
            }
            Flown::Without { path, flown } => {
                let certified = match path {
                    "origin.controller" => origin.controller.clone(),
                    _ => "a loop that a proof can speak of".to_owned(),
                };
                differences.push(Difference { path: path.to_owned(), certified, flown });
            }
        }
        if self.is_of_one_choice() && cases::only_choices_differ(study) {
            differences.retain(|it: &Difference| it.flown != quoted(LeftOut::Dispersions));
        }
        let digests = [origin.digest.clone(), study.digest.clone()];
        self.against = Some(Comparison {
            scenario: study.scenario.name.clone(),
            differences,
            partly,
            members: None,
            other_text: (digests[0] != digests[1]).then_some(digests),
        });
        Ok(())
    }
}

impl CheckedFile {
    /// As [`compare`](Self::compare) with a scenario that can be built with what its dispersions draw, so that a certified
    /// family is compared as well, and the aircraft of a claim about the nonlinear one.
    ///
    /// # Errors
    /// As [`compare`](Self::compare).
    pub fn compare_family(&mut self, template: &Template) -> Result<(), SimError> {
        let study = template.study();
        self.compare(study)?;
        let of_one_choice = self.is_of_one_choice();
        self.compare_nonlinear(study);
        let (Some(family), Some(against)) = (&self.certificate.family, &mut self.against) else {
            return Ok(());
        };
        let scenario = &study.scenario;
        let own = &self.certificate.description;
        let named = scenario.controllers.iter().find(|it| it.name == self.origin.controller);
        let plants = lasting_plants(scenario)?;
        let loops = plants.iter().filter_map(|(_, plant)| {
            let described = LoopDescription::of(scenario, plant, &named?.controller).ok()?;
            (described == *own).then_some(plant)
        });
        let compared = |plant| family::compared(family, template, (own, plant));
        let flown = loops.map(compared).next();
        // What the family is about is left out of nothing.
        against.differences.retain(|it| it.flown != quoted(LeftOut::Dispersions));
        if cases::has_choices(study) && !of_one_choice {
            against.differences.push(not_left_out(LeftOut::OtherChoices));
        }
        let another_loop = || {
            let certified = family::box_in_words(&family.parameters);
            Err(family::Differs { path: "family", certified, flown: "another loop".to_owned() })
        };
        match flown.unwrap_or_else(another_loop) {
            Ok(as_flown) => against.members = as_flown.not_proved_between(),
            Err(family::Differs { path, certified, flown }) => {
                let path = path.to_owned();
                against.differences.push(Difference { path, certified, flown });
            }
        }
        Ok(())
    }

    /// Compares the aircraft of a claim about the nonlinear one with what flies, number by number.
    fn compare_nonlinear(&mut self, study: &Study) {
        let (Some(claim), Some(against)) = (&self.certificate.nonlinear, &mut self.against) else {
            return;
        };
        let certified = json!(AircraftFile::of(&claim.aircraft));
        match nonlinear::numbers(study, claim.aircraft.height_m) {
            Ok(flown) => {
                let flown = json!(AircraftFile::of(&flown));
                walk(&mut against.differences, "nonlinear.aircraft", &certified, &flown);
            }
            Err(reason) => against.differences.push(Difference {
                path: "nonlinear.aircraft".to_owned(),
                certified: said(&certified),
                flown: reason.to_string(),
            }),
        }
    }

    /// What a scenario has that the claim does not cover and does not say that it leaves out.
    fn beyond(&self, differences: &mut Vec<Difference>, asked: &Asked) {
        let Ok(rechecked) = &self.result else { return };
        if !self.certificate.claim.is_of_stability() {
            return;
        }
        let scope = self.certificate.scope(rechecked);
        // With limits even a claim about every set-point is one about those that they leave.
        let unlimited = scope.limits.is_empty();
        let mut short = |path: &str, any: bool, certified: f64, flown: f64| {
            let covered = (any && unlimited) || certified >= flown;
            if !covered {
                let path = path.to_owned();
                let [certified, flown] = [certified, flown].map(|it| format!("{it:?}"));
                differences.push(Difference { path, certified, flown });
            }
        };
        let (range, flown) = (scope.range, asked.range);
        short("range.setpoint_rad", scope.any_setpoint, range.setpoint_rad, flown.setpoint_rad);
        short("range.load_rad", scope.any_load, range.load_rad, flown.load_rad);
        differences.extend(self.other_commands(asked));
        for one in asked.left_out.iter().filter(|one| !scope.left_out.contains(one)) {
            differences.push(not_left_out(*one));
        }
    }

    /// What is commanded, where flights are certified and those of the scenario are others.
    fn other_commands(&self, asked: &Asked) -> Option<Difference> {
        let certified = &self.certificate.commanded.as_ref()?.commands;
        let dt_s = self.certificate.description.controller.config().dt_s;
        let flown = match &asked.commands {
            Ok(None) => return None,
            // Of larger ones than are shown the certificate says that they are not.
            Ok(Some(flown)) if certified.is_of_the_shape_of(flown) => return None,
            Ok(Some(flown)) => commands_in_words(flown, dt_s),
            Err(reason) => (*reason).to_owned(),
        };
        let path = "commanded".to_owned();
        Some(Difference { path, certified: commands_in_words(certified, dt_s), flown })
    }

    /// In words, where flights of the shape that is flown are certified up to a smaller size alone.
    fn partly(&self, asked: &Asked) -> Option<String> {
        let certified = &self.certificate.commanded.as_ref()?.commands;
        let flown = asked.commands.as_ref().ok()?.as_ref()?;
        if certified.covers(flown) || !certified.is_of_the_shape_of(flown) {
            return None;
        }
        let dt_s = self.certificate.description.controller.config().dt_s;
        let [shown, flown] = [certified, flown].map(|it| commands_in_words(it, dt_s));
        Some(format!(
            "flights are shown up to {shown}, and {flown} is commanded: OF LARGER ONES THAN THOSE THIS IS NOT SHOWN"
        ))
    }

    /// True for a certificate that says that others are about other choices.
    fn is_of_one_choice(&self) -> bool {
        self.certificate.left_out.contains(&LeftOut::OtherChoices)
    }
}

/// What the flight does at rest of which the certificate does not speak.
fn not_held(study: &Study, controller: &str) -> Option<Difference> {
    let scenario = &study.scenario;
    let named = scenario.controllers.iter().find(|named| named.name == controller)?;
    let flown = not_held_in_words(scenario, named)?;
    Some(Difference { path: "at_rest".to_owned(), certified: "stable".to_owned(), flown })
}

/// What a scenario has and a claim neither covers nor leaves out.
fn not_left_out(what: LeftOut) -> Difference {
    let path = "not_in_this_claim".to_owned();
    Difference { path, certified: NOTHING.to_owned(), flown: quoted(what) }
}

fn quoted(what: LeftOut) -> String {
    format!("\"{}\"", what.name())
}

impl CheckedFile {
    /// Ways of disturbances that are not those of a plant.
    fn other_ways(&self, differences: &mut Vec<Difference>, flown: &[Way]) {
        for (place, bound) in self.certificate.disturbances.iter().enumerate() {
            if flown.contains(&bound.way) {
                continue;
            }
            let same = flown.iter().find(|way| way.name() == bound.way.name());
            let [certified, flown] = [Some(&bound.way), same].map(|way| match way {
                Some(Way::Air { numerator, .. }) => format!("{numerator:?}"),
                Some(Way::Elevator) | None => NOTHING.to_owned(),
            });
            let path = format!("disturbances[{place}].numerator");
            differences.push(Difference { path, certified, flown });
        }
    }
}

/// What a scenario flies under a controller's name.
enum Flown {
    /// The loop with each lasting plant, as in files, what is asked of a claim about it, and how it may be disturbed.
    Loops(Vec<(Value, Asked, Vec<Way>)>),
    /// No such loop: what stands at a path instead.
    Without { path: &'static str, flown: String },
}

fn flown(study: &Study, controller: &str) -> Result<Flown, SimError> {
    let scenario = &study.scenario;
    let Some(named) = scenario.controllers.iter().find(|named| named.name == controller) else {
        let names: Vec<&str> = scenario.controllers.iter().map(|it| it.name.as_str()).collect();
        return Ok(Flown::Without { path: "origin.controller", flown: names.join(", ") });
    };
    let mut loops = Vec::new();
    let mut refused = None;
    for (_, plant) in lasting_plants(scenario)? {
        match LoopDescription::of(scenario, &plant, &named.controller) {
            Ok(description) => {
                let asked = asked(study, &plant, &description);
                loops.push((fields(&description), asked, ways_of(&plant)));
            }
            Err(reason) => refused = Some(reason.to_string()),
        }
    }
    Ok(match refused {
        Some(flown) if loops.is_empty() => Flown::Without { path: "loop", flown },
        _ => Flown::Loops(loops),
    })
}

/// Every field of a loop, as in files.
fn fields(description: &LoopDescription) -> Value {
    json!({
        "loop": LoopFile::of(description),
        "controller": ControllerFile::of(&description.controller),
    })
}

fn tell(differences: &mut Vec<Difference>, path: &str, certified: &str, flown: &str) {
    if certified != flown {
        let [certified, flown] = [certified, flown].map(|text| format!("\"{text}\""));
        differences.push(Difference { path: path.to_owned(), certified, flown });
    }
}

fn walk(differences: &mut Vec<Difference>, path: &str, certified: &Value, flown: &Value) {
    match (certified, flown) {
        (Value::Object(one), Value::Object(other)) => {
            let more = other.keys().filter(|key| !one.contains_key(*key));
            for key in one.keys().chain(more) {
                let dot = if path.is_empty() { "" } else { "." };
                let [one, other] = [one, other].map(|map| map.get(key));
                either(differences, &format!("{path}{dot}{key}"), one, other);
            }
        }
        (Value::Array(one), Value::Array(other)) => {
            for place in 0..one.len().max(other.len()) {
                let [one, other] = [one, other].map(|values| values.get(place));
                either(differences, &format!("{path}[{place}]"), one, other);
            }
        }
        (one, other) if one == other => {}
        (one, other) => differences.push(Difference {
            path: path.to_owned(),
            certified: said(one),
            flown: said(other),
        }),
    }
}

fn either(
    differences: &mut Vec<Difference>,
    path: &str,
    certified: Option<&Value>,
    flown: Option<&Value>,
) {
    match (certified, flown) {
        (Some(one), Some(other)) => walk(differences, path, one, other),
        (one, other) => {
            let [certified, flown] =
                [one, other].map(|value| value.map_or(NOTHING.to_owned(), said));
            differences.push(Difference { path: path.to_owned(), certified, flown });
        }
    }
}

fn said(value: &Value) -> String {
    match value {
        Value::Null => NOTHING.to_owned(),
        _ => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_that_differs_is_told_with_its_path_and_both_values() {
        let one = json!({"a": {"b": [1.0, 2.0, 3.0]}, "c": null, "d": "x", "e": 1.0});
        let other = json!({"a": {"b": [1.0, 2.5]}, "c": {"f": 1.0}, "d": "x", "g": -0.0});
        let mut found = Vec::new();
        walk(&mut found, "", &one, &other);
        let told: Vec<String> =
            found.iter().map(|it| format!("{} {} {}", it.path, it.certified, it.flown)).collect();
        let expected = [
            "a.b[1] 2.0 2.5",
            "a.b[2] 3.0 nothing",
            "c nothing {\"f\":1.0}",
            "e 1.0 nothing",
            "g nothing -0.0",
        ];
        assert_eq!(told, expected);
    }
}
