//! Long work: followed, taken up again, cancelled, limited.

use serde_json::{Value, json};

use crate::common::Served;

/// A tuning that nobody waits for to end.
fn endless() -> Value {
    json!({ "budget": 10_000_000 })
}

fn names(events: &[(u64, String, Value)]) -> Vec<&str> {
    events.iter().map(|(_, name, _)| name.as_str()).collect()
}

/// The data of the only event of a name.
fn one<'e>(events: &'e [(u64, String, Value)], name: &str) -> &'e Value {
    let mut found = events.iter().filter(|(_, it, _)| it == name);
    let first = found.next().unwrap_or_else(|| panic!("no {name}: {events:?}"));
    assert!(found.next().is_none(), "{name} twice");
    &first.2
}

/// How a job ended, and what it found.
fn ended(events: &[(u64, String, Value)]) -> (&str, &Value) {
    let (_, name, data) = events.last().expect("an event");
    assert!(["done", "failed", "cancelled"].contains(&name.as_str()), "{events:?}");
    (name, data)
}

#[test]
fn a_tuning_tells_every_candidate_the_best_design_and_its_summary() {
    let served = Served::new();
    let job = served.begin("tune", json!({ "budget": 30, "seed": 3 }));
    let events = served.followed(&job);
    assert_eq!(ended(&events).0, "done", "{events:?}");
    assert_eq!(one(&events, "begun")["numbers"].as_array().map(Vec::len), Some(2));
    let candidates = events.iter().filter(|(_, name, _)| name == "candidates");
    let told: usize =
        candidates.map(|(_, _, it)| it["trials"].as_array().map_or(0, Vec::len)).sum();
    assert_eq!(told, 31, "the start and thirty");
    let best =
        events.iter().rfind(|(_, name, _)| name == "best").map(|(_, _, it)| it).expect("one");
    let summary = ended(&events).1;
    assert_eq!(best["cost"], summary["json"]["best"]["cost"]);
    let design = summary["design"].as_str().expect("a text");
    assert!(design.contains("# A comment that stays.") && !design.contains("tune = ["), "{design}");
    let ids: Vec<u64> = events.iter().map(|(id, ..)| *id).collect();
    assert_eq!(ids, (0..ids.len() as u64).collect::<Vec<_>>());
}

#[test]
fn a_tuning_here_finds_the_bits_that_the_library_finds() {
    let served = Served::new();
    let events = served.followed(&served.begin("tune", json!({ "budget": 24, "seed": 5 })));
    let source = fspid_tune::Source { path: served.path("mine.toml"), overrides: Vec::new() };
    let problem = fspid_tune::TuningProblem::new(&source, None).expect("a problem");
    let effort = fspid_tune::Effort {
        optimiser: problem.tuning().optimiser.clone(),
        budget: 24,
        seed: 5,
        population: None,
        anywhere: false,
    };
    let crew = fspid_tune::Crew::UNSTOPPED;
    let mut search = fspid_tune::Search::begin(&problem, effort, crew).expect("it begins");
    let stop = loop {
        if let Some(stop) = search.advance().expect("it flies") {
            break stop;
        }
    };
    let tuned = fspid_tune::Tuned::of(&problem, &search, stop).expect("flown");
    assert_eq!(ended(&events).1["json"], tuned.json());
}

#[test]
fn a_campaign_tells_its_rows_and_what_they_say() {
    let served = Served::new();
    let job = served.begin("campaign", json!({ "runs": 40, "measures": ["overshoot_pct"] }));
    let events = served.followed(&job);
    assert_eq!(ended(&events).0, "done", "{events:?}");
    let rows: Vec<&Value> = events
        .iter()
        .filter(|(_, name, _)| name == "rows")
        .flat_map(|(_, _, it)| it["rows"].as_array().expect("a list"))
        .collect();
    assert_eq!(rows.len(), 80, "a row for each run and controller");
    assert!(rows.iter().all(|row| row[3].is_f64()), "{rows:?}");
    assert!(ended(&events).1["text"].as_str().is_some_and(|it| it.contains("PID")));
}

#[test]
fn a_campaign_tells_while_it_flies_how_its_measures_spread_and_what_pitch_does() {
    let served = Served::new();
    let job = served.begin("campaign", json!({ "runs": 60, "measures": ["iae_deg_s"] }));
    let events = served.followed(&job);
    let summary = &ended(&events).1["json"];
    let spread = events.iter().find(|(_, name, _)| name == "spread").map(|(_, _, it)| it);
    let spread = spread.unwrap_or_else(|| panic!("no spread: {events:?}"));
    assert!(spread["runs"].as_u64().is_some_and(|runs| runs < 60), "{spread}");
    assert_eq!(spread["planned_runs"], 60);
    let measures = spread["controllers"][0]["measures"].as_array().expect("a list");
    assert_eq!((measures.len(), &measures[0]["name"]), (1, &json!("iae_deg_s")));
    let last = events.iter().rfind(|(_, name, _)| name == "envelope").map(|(_, _, it)| it);
    let last = last.unwrap_or_else(|| panic!("no envelope: {events:?}"));
    assert_eq!(last["runs"], 60);
    let of_pid = &last["controllers"][0];
    let (all, end) = (&of_pid["bands"][0], of_pid["time_s"].as_array().expect("a list").len() - 1);
    let at_end = |list: &Value| list[end].as_f64().expect("a number");
    assert!(at_end(&all["lower"]) < at_end(&of_pid["median"]), "{all}");
    assert!(at_end(&of_pid["median"]) < at_end(&all["upper"]), "{all}");
    assert_eq!(summary["controllers"][0]["name"], of_pid["name"]);
}

#[test]
fn a_run_of_a_campaign_is_had_as_a_scenario_that_flies_the_numbers_of_its_row() {
    let served = Served::new();
    let job = served.begin("campaign", json!({ "runs": 40, "measures": ["iae_deg_s"] }));
    let events = served.followed(&job);
    let rows = events.iter().filter(|(_, name, _)| name == "rows");
    let mut rows = rows.flat_map(|(_, _, it)| it["rows"].as_array().expect("a list"));
    let row = rows.find(|row| row[0] == 17 && row[1] == "PID").expect("its row");
    let run = served.json(&format!("/api/jobs/{job}/runs/17"));
    let text = run["text"].as_str().expect("a text");
    assert!(text.contains("# A comment that stays."), "{text}");
    let study = fspid_scenario::file::parse(text, "run", None, &[]).expect("a scenario");
    let flown = fspid_study::simulation::Simulation::of(&study).expect("flown").json();
    assert_eq!(flown["controllers"][0]["metrics"]["iae"], row[3], "{flown}");
    let changes = run["changes"].as_array().expect("a list");
    assert!(changes[0].as_str().is_some_and(|it| it.starts_with("setpoint.amplitude_deg=")));
    for (wrong, why) in [("40", "39"), ("x", "numbers"), ("-1", "numbers")] {
        let told = served.get(&format!("/api/jobs/{job}/runs/{wrong}")).error(404);
        assert!(told.contains(why), "{told}");
    }
    let page = served.json(&format!("/api/jobs/{job}/report"));
    assert!(
        page["html"].as_str().is_some_and(|it| it.contains("Envelope") || it.contains("Responses"))
    );
    let proof = served.begin("certify", json!({ "controller": "slow" }));
    served.followed(&proof);
    let told = served.get(&format!("/api/jobs/{proof}/runs/1")).error(404);
    assert!(told.contains("certify"), "{told}");
}

#[test]
fn the_list_of_jobs_says_what_was_asked_for_so_that_it_can_be_asked_for_again() {
    let served = Served::new();
    let options = json!({ "budget": 8, "seed": 3 });
    let job = served.begin("tune", options.clone());
    served.followed(&job);
    assert_eq!(served.json("/api/jobs")[0]["options"], options);
}

#[test]
fn a_search_for_a_front_tells_the_trade_offs_that_it_has() {
    let served = Served::new();
    let two = "\n[[tuning.objective]]\nmeasure = \"largest_command_deg\"\n";
    let text =
        crate::common::SCENARIO.replace("[[tuning.case]]", &format!("{two}\n[[tuning.case]]"));
    std::fs::write(served.path("mine.toml"), text).expect("written");
    let job = served.begin("tune", json!({ "budget": 60, "optimiser": "nsga-ii", "seed": 1 }));
    let events = served.followed(&job);
    let front = events.iter().rfind(|(_, name, _)| name == "front").map(|(_, _, it)| it);
    let front = front.unwrap_or_else(|| panic!("no front: {:?}", ended(&events)));
    let trials = front["trials"].as_array().expect("a list");
    let told = &ended(&events).1["json"];
    assert_eq!(Some(trials.len()), told["front"].as_array().map(Vec::len), "{told}");
    assert!(trials.len() > 1 && trials[0]["values"].as_array().is_some_and(|it| it.len() == 2));
}

#[test]
fn a_contest_and_a_proof_tell_their_answers() {
    let served = Served::new();
    let contest = served.begin("contest", json!({ "budget": 8, "seeds": 1 }));
    let proof = served.begin("certify", json!({ "controller": "slow" }));
    let events = served.followed(&contest);
    assert_eq!(ended(&events).0, "done", "{events:?}");
    assert!(names(&events).contains(&"progress"), "{events:?}");
    assert!(ended(&events).1["text"].as_str().is_some_and(|it| it.contains("slow")));
    let events = served.followed(&proof);
    assert_eq!(ended(&events).0, "done", "{events:?}");
    let summary = ended(&events).1;
    assert!(summary["certificates"].is_array() && summary["text"].is_string(), "{summary}");
}

#[test]
fn a_proof_answers_what_is_asked_beside_stability_and_its_certificates_hold_alone() {
    let served = Served::new();
    std::fs::write(served.path("mine.toml"), include_str!("data/navion.toml")).expect("written");
    let asked = |options: Value| {
        let events = served.followed(&served.begin("certify", options));
        assert_eq!(ended(&events).0, "done", "{events:?}");
        let progress =
            events.iter().rfind(|(_, name, _)| name == "progress").map(|it| it.2.clone());
        (ended(&events).1.clone(), progress.expect("progress"))
    };
    let (found, progress) = asked(json!({ "nonlinear": true }));
    assert_eq!((&progress["done"], &progress["total"]), (&json!(1), &json!(2)));
    let told = progress["text"].as_str().expect("a text");
    assert!(told.ends_with("certifying the nonlinear aircraft with PID"), "{told}");
    let controller = &found["json"]["controllers"][0];
    assert_eq!(controller["nonlinear"]["verdict"], "proved", "{controller:#}");
    let certificate = found["certificates"][0]["text"].as_str().expect("a certificate");
    let checked = fspid_certify::check_text(certificate).expect("a certificate");
    assert!(checked.holds());
    assert_eq!(checked.json()["nonlinear"]["verdict"], "proved");
    let (found, _) = asked(json!({ "disturbances": true }));
    let controller = &found["json"]["controllers"][0];
    let bounds = controller["scope"]["disturbances"].as_array().map_or(0, Vec::len);
    assert!(bounds > 0, "{controller:#}");
    let (alone, progress) = asked(json!({}));
    assert_eq!(progress["total"], 1);
    let controller = &alone["json"]["controllers"][0];
    assert!(controller["nonlinear"].is_null(), "{controller:#}");
    assert!(controller["scope"]["disturbances"].is_null(), "{controller:#}");
}

#[test]
fn a_proof_of_all_cases_tells_each_and_its_certificates_are_proved_anew_against_what_flies() {
    let served = Served::new();
    let text = include_str!("data/navion.toml").to_owned()
        + "\n[[tuning.objective]]\nmeasure = \"iae_deg_s\"\n[[tuning.case]]\nname = \"as it is\"\nset = []\n[[tuning.case]]\nname = \"slow servo\"\nset = [\"actuator.time_constant_s=0.2\"]\n";
    std::fs::write(served.path("mine.toml"), text).expect("written");
    let done = |kind: &str, options: Value| {
        let events = served.followed(&served.begin(kind, options));
        assert_eq!(ended(&events).0, "done", "{events:?}");
        (ended(&events).1.clone(), events)
    };
    let (found, events) = done("certify", json!({ "cases": "tuning" }));
    let told = found["text"].as_str().expect("a text");
    assert!(told.contains("PID: PROVED at all 2 cases of [tuning]"), "{told}");
    let progress = events.iter().rfind(|(_, name, _)| name == "progress").map(|it| &it.2);
    let progress = progress.expect("progress");
    assert_eq!((&progress["done"], &progress["total"]), (&json!(1), &json!(2)));
    assert!(progress["text"].as_str().is_some_and(|it| it.ends_with("PID at slow servo")));
    let names: Vec<_> = found["certificates"].as_array().expect("a list").iter().collect();
    let of = |place: usize, key: &str| names[place][key].as_str().expect("a text").to_owned();
    assert_eq!(
        [of(0, "name"), of(1, "name")],
        ["as-it-is/pid.certificate.json", "slow-servo/pid.certificate.json"]
    );
    let slow = json!(["actuator.time_constant_s=0.2"]);
    let (checked, _) = done("check", json!({ "certificate": of(1, "text"), "set": slow }));
    assert_eq!((&checked["holds"], &checked["json"]["answer"]), (&json!(true), &json!("holds")));
    let (checked, _) = done("check", json!({ "certificate": of(1, "text") }));
    assert_eq!(checked["json"]["answer"], "another loop");
    let listed = served.json("/api/jobs")[0]["options"].clone();
    assert!(listed["certificate"].is_null() && listed["certificate_digest"].is_string());
    let events = served.followed(&served.begin("check", json!({ "certificate": "{}" })));
    assert_eq!(ended(&events).0, "failed", "{events:?}");
    let refused = |options: Value| {
        let asked = json!({ "kind": "certify", "id": served.id("mine.toml"), "options": options });
        served.ask("POST", "/api/jobs", Some(asked)).error(400)
    };
    let told = refused(json!({ "cases": "tunning" }));
    assert!(told.contains("`tuning`"), "{told}");
    let told = refused(json!({ "steps": true }));
    assert!(told.contains("`steps` goes with `cases`"), "{told}");
}

#[test]
fn a_question_that_there_is_not_is_refused_with_those_that_there_are() {
    let served = Served::new();
    let asked =
        json!({ "kind": "certify", "id": served.id("mine.toml"), "options": { "nonlinar": true } });
    let told = served.ask("POST", "/api/jobs", Some(asked)).error(400);
    assert!(told.contains("`nonlinear`"), "{told}");
}

#[test]
fn a_stream_that_is_taken_up_again_goes_on_behind_the_last_event() {
    let served = Served::new();
    let job = served.begin("tune", endless());
    let mut first = served.events(&job, None);
    let seen: Vec<_> = first.by_ref().take(3).collect();
    drop(first);
    let last = seen.last().expect("three").0;
    let next = served.events(&job, Some(last)).next().expect("more");
    assert_eq!(next.0, last + 1);
    served.ask("DELETE", &format!("/api/jobs/{job}"), None).json(200);
    let again: Vec<_> = served.events(&job, None).collect();
    assert_eq!(again[..3], seen[..]);
    assert_eq!(ended(&again).0, "cancelled");
    let refused = served.raw(
        served
            .head(
                "GET",
                &format!("/api/jobs/{job}/events"),
                "Last-Event-ID: x\r\nConnection: close\r\n\r\n",
            )
            .as_bytes(),
    );
    assert_eq!(refused.status, 400);
}

#[test]
fn a_job_that_is_cancelled_ends_and_begun_again_it_goes_on() {
    let served = Served::new();
    let job = served.begin("tune", endless());
    let mut events = served.events(&job, None);
    while events.next().expect("more").1 != "best" {}
    served.ask("DELETE", &format!("/api/jobs/{job}"), None).json(200);
    assert_eq!(events.last().expect("the end").1, "cancelled");
    let again = served.begin("tune", endless());
    let begun = served.events(&again, None).next().expect("the first");
    assert!(begun.2["goes_on_after"].is_u64(), "{begun:?}");
}

/// A self-tuner takes many searches, some of which take as long as all that a test may take.
#[test]
fn a_proof_that_is_cancelled_ends_without_an_answer() {
    let served = Served::new();
    let tuner = "\n[[controller]]\nname = \"tuner\"\nkind = \"fspid\"\nnominal = { kp = 2.0, ki = 0.5, kd = 1.0 }\nsupervisor = { table = \"mirrored\", range = 5.0, error_scale = 1.0, change_scale = 0.2, output_scale = { kp = 0.1, ki = 0.02, kd = 0.05 } }\n";
    let text =
        crate::common::SCENARIO.replace("\n[[dispersion]]", &format!("{tuner}\n[[dispersion]]"));
    std::fs::write(served.path("mine.toml"), text).expect("written");
    let job = served.begin("certify", json!({ "controller": "tuner" }));
    let mut events = served.events(&job, None);
    while events.next().expect("more").1 != "progress" {}
    served.ask("DELETE", &format!("/api/jobs/{job}"), None).json(200);
    assert_eq!(events.last().expect("the end").1, "cancelled");
    served.until(|health| health["jobs"]["running"] == json!(0));
}

#[test]
fn so_many_jobs_run_so_many_wait_and_one_more_is_refused_until_one_is_cancelled() {
    let served = Served::with(|settings| settings.limits.queue = 3);
    let running = served.begin("tune", endless());
    let waiting: Vec<String> =
        (0..3).map(|seed| served.begin("tune", json!({ "budget": 4, "seed": seed }))).collect();
    let id = served.id("mine.toml");
    let asked = || Some(json!({ "kind": "tune", "id": id, "options": {} }));
    let told = served.ask("POST", "/api/jobs", asked()).error(429);
    assert!(told.contains("1 running and 3 waiting"), "{told}");
    let health = served.json("/api/health");
    assert_eq!(health["jobs"], json!({ "running": 1, "most": 1, "waiting": 3, "most_waiting": 3 }));
    let last = served.ask("DELETE", &format!("/api/jobs/{}", waiting[2]), None).json(200);
    assert_eq!(last["state"], "cancelled");
    served.ask("POST", "/api/jobs", asked()).json(202);
    served.ask("DELETE", &format!("/api/jobs/{running}"), None).json(200);
    for job in &waiting[..2] {
        let events = served.followed(job);
        assert_eq!(ended(&events).0, "done");
    }
}

#[test]
fn a_job_that_may_not_take_so_long_is_ended_and_says_so() {
    let served = Served::with(|settings| settings.limits.job = std::time::Duration::ZERO);
    let events = served.followed(&served.begin("tune", endless()));
    let (state, end) = ended(&events);
    assert_eq!(state, "failed");
    assert!(end["reason"].as_str().is_some_and(|it| it.contains("a job may take")), "{end}");
}

/// Ten million samples are what a scenario may have at most.
#[test]
fn a_job_that_would_take_too_much_memory_is_refused_and_the_server_goes_on() {
    let served = Served::new();
    let long = json!(["loop.duration_s=99999.0"]);
    for (kind, options) in [
        ("tune", json!({ "budget": 8, "set": long })),
        ("campaign", json!({ "runs": 8, "set": long })),
        ("contest", json!({ "budget": 8, "seeds": 1, "set": long })),
        (
            "tune",
            json!({ "budget": 8, "population": 1_000_000, "set": ["loop.duration_s=40000.0"] }),
        ),
    ] {
        let events = served.followed(&served.begin(kind, options));
        let (state, end) = ended(&events);
        assert_eq!(state, "failed", "{kind}: {events:?}");
        let reason = end["reason"].as_str().expect("a sentence");
        assert!(reason.contains("would take some ") && reason.contains("2 048 MiB"), "{reason}");
    }
    let events = served.followed(&served.begin("tune", json!({ "budget": 4 })));
    assert_eq!(ended(&events).0, "done", "{events:?}");
}

/// Other tests of this process take memory too, so that the limit is one that any growth reaches.
#[cfg(target_os = "linux")]
#[test]
fn a_job_whose_memory_grows_beyond_what_it_may_take_is_ended_and_the_server_goes_on() {
    let served = Served::with(|settings| settings.limits.job_bytes = 8 << 20);
    let events = served.followed(&served.begin("tune", endless()));
    let (state, end) = ended(&events);
    assert_eq!(state, "failed");
    let reason = end["reason"].as_str().expect("a sentence");
    assert!(reason.contains("grown by more than 8 MiB"), "{reason}");
    // The end is told a moment before there is room again.
    served.until(|health| health["jobs"]["running"] == json!(0));
}

#[test]
fn what_is_no_job_is_refused_with_the_words_of_the_command_line() {
    let served = Served::new();
    let id = served.id("mine.toml");
    for (body, status, why) in [
        (json!({ "kind": "tnue", "id": id }), 400, "did you mean `tune`?"),
        (json!({ "kind": "tune", "id": id, "options": { "budget": 0 } }), 400, "the budget is 0"),
        (
            json!({ "kind": "tune", "id": id, "options": { "bugdet": 1 } }),
            400,
            "did you mean `budget`?",
        ),
        (json!({ "kind": "tune", "id": id, "options": { "set": "a" } }), 400, "a list of texts"),
        (json!({ "kind": "campaign", "id": id, "options": { "runs": -1 } }), 400, "a whole number"),
        (
            json!({ "kind": "campaign", "id": id, "options": { "measures": ["x"] } }),
            400,
            "no measure `x`",
        ),
        (json!({ "kind": "tune", "id": "../../etc/passwd" }), 404, "no such scenario"),
        (json!({ "kind": "tune", "id": id, "path": "/etc" }), 400, "no `path` here"),
    ] {
        let told = served.ask("POST", "/api/jobs", Some(body)).error(status);
        assert!(told.contains(why), "{told}");
    }
    for path in ["/api/jobs/7/events", "/api/jobs/x/events", "/api/jobs/..%2f1/events"] {
        assert_eq!(served.get(path).status, 404, "{path}");
    }
    assert_eq!(served.ask("DELETE", "/api/jobs/7", None).status, 404);
}

#[test]
fn a_scenario_that_is_wrong_fails_its_job_with_every_problem() {
    let served = Served::new();
    std::fs::write(served.path("wrong.toml"), "schema = 1\n[[controller]]\nkind = \"pdi\"\n")
        .expect("written");
    let asked = json!({ "kind": "tune", "id": served.id("wrong.toml"), "options": {} });
    let job = served.ask("POST", "/api/jobs", Some(asked)).json(202);
    let events = served.followed(job["job"].as_str().expect("an id"));
    let (state, end) = ended(&events);
    assert_eq!(state, "failed");
    assert!(end["problems"]["problems"].as_array().is_some_and(|it| it.len() > 1), "{end}");
}

/// Problems of a case were told in a sentence alone.
#[test]
fn a_case_that_is_wrong_fails_its_job_with_every_problem_and_its_name() {
    let served = Served::new();
    let text = crate::common::SCENARIO;
    let text = text.replace("setpoint.amplitude_deg=2", "setpoint.amplitude_dg=2");
    std::fs::write(served.path("mine.toml"), text).expect("written");
    let events = served.followed(&served.begin("certify", json!({ "cases": "contest" })));
    let (state, end) = ended(&events);
    assert_eq!(state, "failed", "{events:?}");
    let problem = &end["problems"]["problems"][0];
    let told = (&problem["case"], &problem["path"]);
    assert_eq!(told, (&json!("larger"), &json!("setpoint.amplitude_dg")), "{end}");
}

/// Whoever has the token may save a text; that shall not become a program that runs.
#[test]
fn no_program_that_a_scenario_names_is_started() {
    let served = Served::new();
    let library = served.path("own.so");
    std::fs::write(&library, "no library").expect("written");
    let own = "\n[[controller]]\nname = \"own\"\nkind = \"external\"\nlibrary = \"own.so\"\n";
    let text = format!("{}{own}", crate::common::SCENARIO);
    std::fs::write(served.path("mine.toml"), text).expect("written");
    let events = served.followed(&served.begin("campaign", json!({ "runs": 2 })));
    let (state, end) = ended(&events);
    assert_eq!(state, "failed", "{events:?}");
    let reason = end["reason"].as_str().expect("a sentence");
    assert!(reason.contains("starts no external controllers"), "{reason}");
}

#[test]
fn a_server_that_ends_ends_its_jobs_and_takes_what_they_wrote_with_it() {
    let kept = tempfile::tempdir().expect("a folder");
    let served = Served::with(|settings| settings.kept = Some(kept.path().join("kept")));
    let job = served.begin("tune", endless());
    assert_eq!(served.events(&job, None).next().expect("the first").1, "begun");
    let Served { server, .. } = served;
    server.stop();
    let folders = std::fs::read_dir(kept.path().join("kept")).expect("a folder").count();
    assert_eq!(folders, 1, "what somebody asked to be kept stays");
}
