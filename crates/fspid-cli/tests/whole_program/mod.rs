//! Laws that hold of every scenario that `check` accepts, whatever is asked of it.
//!
//! Scenarios are drawn from the schema: parts of all shipped ones and of those that have every key are exchanged, keys
//! come and go, words become others, numbers move (`draw`). `FSPID_WHOLE_DRAWS=2000` draws more of them and
//! `FSPID_WHOLE_FIRST` others; `FSPID_WHOLE_KEYS=1` tells which keys and words of the schema no accepted one had.

mod draw;
mod exported;
mod schema;

use std::collections::BTreeSet;
use std::io::Write as _;
use std::path::Path;

use fspid_campaign::engine;
use fspid_scenario::file;
use fspid_study::simulation::Simulation;
use serde_json::Value;

use crate::accepted::{Drawn, answer, asked, changes, numbers, setting};
use crate::common::{code, json, text};
use draw::{Parts, written};
use exported::Exports;
use schema::Schema;

/// A proof takes seconds: it is looked for in one of so many.
const CERTIFY_EVERY: u64 = 40;
/// Draws of the tests.
const USUAL: u64 = 5;

/// What `analyse` says where it gives no numbers: too many samples on their way, no equations, an aircraft that leaves its trim.
const UNANSWERED: [&str; 3] = ["on their way", "no equations", "begun at its trim"];

/// An accepted scenario with its overrides.
struct Accepted<'a> {
    path: &'a Path,
    set: Vec<String>,
}

impl Accepted<'_> {
    fn words(&self, question: &[&str]) -> Vec<String> {
        let mut words = vec![question[0].to_owned(), self.path.display().to_string()];
        words.extend(question[1..].iter().map(|&word| word.to_owned()));
        words.extend(self.set.iter().flat_map(|set| ["--set".to_owned(), set.clone()]));
        words
    }

    fn json(&self, question: &[&str]) -> Result<Value, String> {
        let question = [question, &["--format", "json"]].concat();
        answer(&self.words(&question), &[0, 1]).map(|output| json(&output))
    }
}

#[test]
fn every_law_holds_of_every_scenario_that_check_accepts() {
    let folder = tempfile::tempdir().expect("a folder");
    let (schema, parts) = (Schema::of_scenarios(), Parts::shipped());
    let (first, count) = (setting("FSPID_WHOLE_FIRST", 0), setting("FSPID_WHOLE_DRAWS", USUAL));
    let (mut wrong, mut accepted, mut reached) = (Vec::new(), 0, BTreeSet::new());
    let mut exports = Exports::default();
    for draw in first..first + count {
        let mut drawn = Drawn(draw.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ 0x5851_f42d);
        let document = parts.draw(&mut drawn, &schema, folder.path());
        let path = folder.path().join(format!("draw-{draw}.toml"));
        std::fs::write(&path, written(&document)).expect("written");
        if let Some(scenario) = accepted_by_check(&path, &mut drawn) {
            accepted += 1;
            reached.extend(schema.reached(&document));
            wrong.extend(
                laws(&scenario, draw, &mut exports)
                    .into_iter()
                    .map(|what| kept(&path, draw, &what)),
            );
        }
        std::fs::remove_file(&path).expect("removed");
    }
    // Past what tests hold back: a night tells what of it was asked.
    let _ = writeln!(std::io::stderr(), "{accepted} of {count} accepted; {}", exports.told());
    if std::env::var_os("FSPID_WHOLE_KEYS").is_some() {
        let missed: Vec<&String> = schema.all().difference(&reached).collect();
        let all = schema.all().len();
        panic!("{accepted} of {count} accepted, {} of {all}: {missed:#?}", all - missed.len());
    }
    assert!(wrong.is_empty(), "{} things:\n{}", wrong.len(), wrong.join("\n"));
    assert!(2 * accepted > count, "{accepted} of {count} were accepted, which says little");
}

/// The scenario of a file, every second one with numbers that are set if `check` allows them; none where it is refused.
fn accepted_by_check<'a>(path: &'a Path, drawn: &mut Drawn) -> Option<Accepted<'a>> {
    let is_accepted = |it: &Accepted<'_>| code(&asked(&to_str(&it.words(&["check"])))) == 0;
    let scenario = Some(Accepted { path, set: Vec::new() }).filter(is_accepted)?;
    let is_changed = drawn.below(2) == 0;
    let changed = || {
        let set = changes(drawn, &numbers(&path.display().to_string()));
        Some(Accepted { path, set }).filter(is_accepted)
    };
    let scenario = is_changed.then(changed).flatten().unwrap_or(scenario);
    is_flown_here(&scenario).then_some(scenario)
}

/// False where another simulator flies it that this machine has not.
fn is_flown_here(scenario: &Accepted<'_>) -> bool {
    let text = std::fs::read_to_string(scenario.path).unwrap_or_default();
    if !text.contains("[simulator]") {
        return true;
    }
    let told = asked(&to_str(&scenario.words(&["simulate"])));
    !self::text(&told.stderr).contains("could not be asked")
}

fn to_str(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).collect()
}

/// What is wrong, with the scenario it is wrong of, so that it can become a fixture.
fn kept(path: &Path, draw: u64, what: &str) -> String {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    format!("draw {draw}: {what}\n--- its scenario\n{text}---")
}

/// The laws that a scenario breaks.
fn laws(scenario: &Accepted<'_>, draw: u64, exports: &mut Exports) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut law = |held: Result<(), String>| wrong.extend(held.err());
    law(twice_the_same(scenario));
    law(text_says_what_json_says(scenario));
    law(flights_and_analysis_agree(scenario));
    law(scenario.json(&["verify", "--set", "ctms"]).map(|_| ()));
    law(lanes_are_single_flights(scenario));
    law(campaign_is_flown_again(scenario));
    law(exports.law(scenario, draw));
    // What is learned from answers knows no key that none of them has.
    let is_learning = std::env::var_os("FSPID_ANSWERS").is_some();
    if draw.is_multiple_of(if is_learning { CERTIFY_EVERY / 10 } else { CERTIFY_EVERY }) {
        law(what_is_proved_flies(scenario, draw));
    }
    wrong
}

fn twice_the_same(scenario: &Accepted<'_>) -> Result<(), String> {
    let words = scenario.words(&["simulate", "--format", "json"]);
    let (one, other) = (answer(&words, &[0, 1])?, answer(&words, &[0, 1])?);
    match one.stdout == other.stdout && one.status == other.status {
        true => Ok(()),
        false => Err(format!("fspid {}: told other bytes the second time", words.join(" "))),
    }
}

fn list<'a>(answer: &'a Value, name: &str) -> &'a [Value] {
    answer[name].as_array().map_or(&[], Vec::as_slice)
}

fn word<'a>(answer: &'a Value, name: &str) -> &'a str {
    answer[name].as_str().unwrap_or_default()
}

/// Verdicts and requirements; each of the JSON stands in the text, and the two end with the same code.
fn text_says_what_json_says(scenario: &Accepted<'_>) -> Result<(), String> {
    let asked = answer(&scenario.words(&["simulate", "--format", "json"]), &[0, 1])?;
    let told = answer(&scenario.words(&["simulate"]), &[0, 1])?;
    if code(&asked) != code(&told) {
        return Err(format!("text ends with {}, JSON with {}", code(&told), code(&asked)));
    }
    let (answer, told) = (json(&asked), text(&told.stdout));
    for controller in list(&answer, "controllers") {
        let (name, verdict) = (word(controller, "name"), word(controller, "verdict"));
        let stands = told.lines().any(|line| line.contains(name) && line.contains(verdict));
        if !stands {
            return Err(format!(
                "JSON says {verdict:?} of {name:?}, and the text does not: {told}"
            ));
        }
    }
    Ok(())
}

/// The verdict of a flight and that of the analysis never contradict each other.
fn flights_and_analysis_agree(scenario: &Accepted<'_>) -> Result<(), String> {
    let flown = scenario.json(&["simulate"])?;
    let words = scenario.words(&["analyse", "--map", "0", "--format", "json"]);
    // What has no equations, or too much on its way, is refused by name.
    let analysed = match answer(&words, &[0, 1]) {
        Ok(output) => json(&output),
        Err(told) if UNANSWERED.iter().any(|reason| told.contains(reason)) => {
            return Ok(());
        }
        Err(told) => return Err(told),
    };
    for controller in list(&flown, "controllers") {
        let name = word(controller, "name");
        let Some(other) =
            list(&analysed, "controllers").iter().find(|other| word(other, "name") == name)
        else {
            continue;
        };
        let (verdict, stability) = (word(controller, "verdict"), word(other, "stability"));
        let grows = verdict.starts_with("unstable at rest");
        let is_good =
            ["settled", "not settled", "flown"].iter().any(|good| verdict.starts_with(good));
        let undecided = verdict.contains("undecided") || stability == "undecided";
        if !undecided && (grows && stability == "stable" || is_good && stability == "unstable") {
            return Err(format!("{name}: the flight is {verdict:?}, the analysis {stability:?}"));
        }
    }
    Ok(())
}

/// Flights side by side, as campaigns fly them, are those of `simulate` to the bit.
fn lanes_are_single_flights(scenario: &Accepted<'_>) -> Result<(), String> {
    let text = std::fs::read_to_string(scenario.path).map_err(|error| error.to_string())?;
    let folder = scenario.path.parent().map(Path::to_path_buf);
    let study = match file::parse(&text, "draw.toml", folder.as_deref(), &scenario.set) {
        Ok(study) => study,
        Err(problems) => {
            return Err(format!("check accepts it, and it cannot be read: {problems}"));
        }
    };
    // Another program flies these, and is asked for by the commands.
    if study.scenario.plant.external().is_some() || !study.scenario.externals.is_empty() {
        return Ok(());
    }
    let single = Simulation::of(&study).map_err(|error| format!("simulate: {error}"))?;
    for flights in engine::fly(&[study.clone(), study.clone(), study]) {
        let flights = flights.map_err(|error| format!("campaign: {error}"))?;
        for (flight, single) in flights.iter().zip(&single.results) {
            if format!("{:?}", flight.metrics) != format!("{:?}", single.metrics) {
                let (lane, alone) = (&flight.metrics, &single.metrics);
                return Err(format!("{}: in a lane {lane:?}, alone {alone:?}", flight.controller));
            }
        }
    }
    Ok(())
}

/// A campaign of three, of which each run is flown again with the numbers that its command names.
fn campaign_is_flown_again(scenario: &Accepted<'_>) -> Result<(), String> {
    let out = scenario.path.with_extension("campaign");
    let shown = out.display().to_string();
    let run = ["campaign", "run", "--runs", "3", "--seed", "1", "--quiet", "--out", &shown];
    let run = [&run[..], &["--format", "json"]].concat();
    let mut words: Vec<String> = run.iter().map(|&word| word.to_owned()).collect();
    words.insert(2, scenario.path.display().to_string());
    words.extend(scenario.set.iter().flat_map(|set| ["--set".to_owned(), set.clone()]));
    let output = asked(&to_str(&words));
    let told = text(&output.stderr);
    if code(&output) == 2 {
        // Nothing is drawn, or a drawn one is not allowed with the overrides: both are named.
        let is_named = told.contains("nothing differs") || told.contains("not allowed");
        return if is_named { Ok(()) } else { Err(format!("fspid {}: {told}", words.join(" "))) };
    }
    let held = (0..3).try_for_each(|run| is_flown_again(scenario, &shown, run));
    std::fs::remove_dir_all(&out).map_err(|error| error.to_string())?;
    answer(&words, &[0, 1]).map(|_| ())?;
    std::fs::remove_dir_all(&out).map_err(|error| error.to_string())?;
    held
}

fn is_flown_again(scenario: &Accepted<'_>, folder: &str, run: u32) -> Result<(), String> {
    let replay = ["campaign", "replay", folder, "--run", &run.to_string(), "--format", "json"];
    let replay: Vec<String> = replay.iter().map(|&word| word.to_owned()).collect();
    let replayed = json(&answer(&replay, &[0, 1])?);
    let changes = list(&replayed, "changes").iter().filter_map(Value::as_str).map(str::to_owned);
    let set = scenario.set.iter().cloned().chain(changes).collect();
    let again = Accepted { path: scenario.path, set }.json(&["simulate"])?;
    match again["controllers"] == replayed["simulation"]["controllers"] {
        true => Ok(()),
        false => Err(format!("run {run} of the campaign is another flight by its command")),
    }
}

/// True where the number of draws was asked for.
fn by_night() -> bool {
    std::env::var_os("FSPID_WHOLE_DRAWS").is_some()
}

/// What is proved is not refuted by its own flight, and not called unstable; what is written of it is of what flies. Asked of
/// one controller of the scenario, whichever is drawn: each takes seconds, and the file of a contest has ten.
fn what_is_proved_flies(scenario: &Accepted<'_>, draw: u64) -> Result<(), String> {
    // A self-tuner that stays open takes minutes, which a night has.
    let text = std::fs::read_to_string(scenario.path).map_err(|error| error.to_string())?;
    if !by_night() && text.contains("kind = \"fspid\"") {
        return Ok(());
    }
    let flown = scenario.json(&["simulate"])?;
    let names = list(&flown, "controllers").iter().map(|it| word(it, "name"));
    let names: Vec<&str> = names.collect();
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let out = folder.path().display().to_string();
    let controller = format!("--controller={}", Drawn(draw).one_of(&names));
    let proofs = match scenario.json(&["certify", &controller, "--out", &out]) {
        Ok(proofs) => proofs,
        // Of several plants, of other simulators: refused by name, which is no panic.
        Err(told) if told.contains("exit code 2") => return Ok(()),
        Err(told) => return Err(told),
    };
    for proof in list(&proofs, "controllers") {
        let name = word(proof, "name");
        let result = list(&flown, "controllers").iter().find(|it| word(it, "name") == name);
        let verdict = result.map_or("", |result| word(result, "verdict"));
        if word(proof, "verdict") == "proved" && verdict.starts_with("unstable at rest") {
            return Err(format!("{name} is proved, and its flight is {verdict}"));
        }
    }
    // Where less is proved than was asked, the certificate is of that.
    let all = list(&proofs, "controllers").iter().all(|proof| word(proof, "verdict") == "proved");
    let files = std::fs::read_dir(folder.path()).map_err(|error| error.to_string())?;
    files.flatten().try_for_each(|file| is_of_what_flies(scenario, &file.path(), all))
}

/// A certificate that was written of a scenario, read again and held against it: in its range too where `all` is proved.
fn is_of_what_flies(scenario: &Accepted<'_>, certificate: &Path, all: bool) -> Result<(), String> {
    let shown = [certificate, scenario.path].map(|path| path.display().to_string());
    let words = ["certify", "--check", &shown[0], "--against", &shown[1], "--format", "json"];
    let mut words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
    words.extend(scenario.set.iter().flat_map(|set| ["--set".to_owned(), set.clone()]));
    let checked = json(&answer(&words, &[0, 1])?);
    let against = &checked["against"];
    let mut differences = list(against, "differences").iter();
    let is_range = |difference: &Value| word(difference, "path").starts_with("range.");
    let of_less = !all && differences.all(is_range);
    match checked["as_written"] == true && (against["same"] == true || of_less) {
        true => Ok(()),
        false => Err(format!("the certificate just written is of another loop: {against}")),
    }
}
