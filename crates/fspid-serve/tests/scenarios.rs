//! Scenarios: found below the folder, read by an id, saved whole.

use std::fs;

use serde_json::json;

use crate::common::{SCENARIO, Served, settings};
use fspid_serve::{Opened, Server};

#[test]
fn scenarios_below_the_folder_are_listed_and_other_files_are_not() {
    let served = Served::new();
    for (name, text) in [
        ("deep/er/one.toml", SCENARIO),
        ("wrong.toml", "[[controller]]\nname = "),
        ("Cargo.toml", "[package]\nname = \"x\"\n"),
        ("notes.txt", SCENARIO),
        (".hidden/two.toml", SCENARIO),
        ("target/three.toml", SCENARIO),
        ("<script>alert(1)<script>.toml", SCENARIO),
    ] {
        let path = served.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, text).expect("written");
    }
    let list = served.json("/api/scenarios");
    let names: Vec<&str> =
        list.as_array().expect("a list").iter().filter_map(|it| it["name"].as_str()).collect();
    assert_eq!(
        names,
        ["<script>alert(1)<script>.toml", "deep/er/one.toml", "mine.toml", "wrong.toml"]
    );
    let read = served.json(&format!("/api/scenarios/{}", served.id("deep/er/one.toml")));
    assert_eq!(read["text"], SCENARIO);
}

#[test]
fn what_is_saved_is_what_is_read_and_tells_its_problems() {
    let served = Served::new();
    let path = format!("/api/scenarios/{}", served.id("mine.toml"));
    let read = served.json(&path);
    let text = SCENARIO.replace("ki = 0.5", "ki = 0.25");
    let saved = served.ask("PUT", &path, Some(json!({ "text": text, "digest": read["digest"] })));
    let saved = saved.json(200);
    assert_eq!(saved["problems"], json!(null), "{saved}");
    assert_eq!(fs::read_to_string(served.path("mine.toml")).expect("a file"), text);
    let again = served.json(&path);
    assert_eq!((&again["digest"], &again["text"]), (&saved["digest"], &json!(text)));
    let wrong = text.replace("kind = \"pid\"", "kind = \"pdi\"");
    let body = json!({ "text": wrong, "digest": again["digest"] });
    let told = served.ask("PUT", &path, Some(body)).json(200);
    let problem = &told["problems"]["problems"][0];
    assert_eq!(problem["path"], "controller[0].kind", "{told}");
    assert_eq!(fs::read_to_string(served.path("mine.toml")).expect("a file"), wrong);
}

#[test]
fn what_cases_and_dispersions_make_wrong_is_told_as_check_tells_it() {
    let served = Served::new();
    let path = format!("/api/scenarios/{}", served.id("mine.toml"));
    let saved = |text: &str| {
        let digest = served.json(&path)["digest"].clone();
        let body = json!({ "text": text, "digest": digest });
        served.ask("PUT", &path, Some(body)).json(200)["problems"].clone()
    };
    let wrong = SCENARIO.replace("setpoint.amplitude_deg=2", "setpoint.amplitude_dg=2");
    let told = saved(&wrong);
    let problem = &told["problems"][0];
    assert_eq!(
        (&problem["case"], &problem["path"]),
        (&json!("larger"), &json!("setpoint.amplitude_dg"))
    );
    assert_eq!(told["problems"].as_array().map(Vec::len), Some(1), "{told:#}");
    let told = saved(&SCENARIO.replace("\"setpoint.amplitude_deg\"", "\"setpoint.amplitud_deg\""));
    let told = told.to_string();
    assert!(told.contains("setpoint.amplitud_deg") && !told.contains("\"case\""), "{told}");
    let case = |at: usize| format!("\n[[tuning.case]]\nname = \"{at}\"\nset = []\n");
    let many: String = (0..600).map(case).collect();
    let told = saved(&SCENARIO.replace("\n[contest]", &(many + "\n[contest]")));
    assert!(told.to_string().contains("up to 512 are read here"), "{told}");
}

#[test]
fn a_file_that_changed_meanwhile_is_not_written_over() {
    let served = Served::new();
    let path = format!("/api/scenarios/{}", served.id("mine.toml"));
    let digest = served.json(&path)["digest"].clone();
    fs::write(served.path("mine.toml"), "# of an editor\n[[controller]]\n").expect("written");
    let answer = served.ask("PUT", &path, Some(json!({ "text": "mine", "digest": digest })));
    let told = answer.json(409);
    assert_eq!(told["text"], "# of an editor\n[[controller]]\n");
    assert_eq!(told["digest"], served.json(&path)["digest"]);
    let now = fs::read_to_string(served.path("mine.toml")).expect("a file");
    assert!(now.starts_with("# of an editor"), "{now}");
}

#[test]
fn a_body_that_is_not_what_a_save_is_changes_nothing_and_says_why() {
    let served = Served::new();
    let path = format!("/api/scenarios/{}", served.id("mine.toml"));
    let digest = served.json(&path)["digest"].clone();
    for (body, why) in [
        (json!({}), "no `text`"),
        (json!({ "text": 1, "digest": digest }), "`text` is 1"),
        (json!({ "text": "" }), "no `digest`"),
        (json!({ "text": "", "digest": digest, "path": "/etc/passwd" }), "no `path` here"),
        (json!([1]), "no object"),
    ] {
        let told = served.ask("PUT", &path, Some(body)).error(400);
        assert!(told.contains(why), "{told}");
    }
    assert_eq!(fs::read_to_string(served.path("mine.toml")).expect("a file"), SCENARIO);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_one_that_leads_out_of_the_folder_leads_nowhere() {
    let served = Served::new();
    let outside = tempfile::tempdir().expect("a folder");
    fs::write(outside.path().join("secret.toml"), SCENARIO).expect("written");
    let link = |to: &std::path::Path, name: &str| {
        std::os::unix::fs::symlink(to, served.path(name)).expect("linked");
    };
    link("mine.toml".as_ref(), "link.toml");
    link(&outside.path().join("secret.toml"), "out.toml");
    link(outside.path(), "folder");
    let list = served.json("/api/scenarios").to_string();
    assert!(!list.contains("out.toml") && !list.contains("secret"), "{list}");
    let path = format!("/api/scenarios/{}", served.id("link.toml"));
    let digest = served.json(&path)["digest"].clone();
    let text = format!("{SCENARIO}# more\n");
    served.ask("PUT", &path, Some(json!({ "text": text, "digest": digest }))).json(200);
    assert!(served.path("link.toml").is_symlink());
    assert_eq!(fs::read_to_string(served.path("mine.toml")).expect("a file"), text);
    // One that is bent after it was listed.
    fs::remove_file(served.path("link.toml")).expect("removed");
    link(&outside.path().join("secret.toml"), "link.toml");
    assert_eq!(served.get(&path).status, 404);
    let body = json!({ "text": "gone", "digest": served.id("mine.toml") });
    assert_eq!(served.ask("PUT", &path, Some(body)).status, 404);
    let secret = fs::read_to_string(outside.path().join("secret.toml")).expect("a file");
    assert_eq!(secret, SCENARIO);
}

/// 10 000 strings that lead out of a folder somewhere, as ids.
#[test]
fn ten_thousand_paths_in_place_of_an_id_find_nothing() {
    let served = Served::new();
    served.id("mine.toml");
    let steps = [
        "..",
        "%2e%2e",
        "..%2f",
        "%2e%2e%2f",
        "..%5c",
        "....//",
        "%252e%252e%252f",
        "%c0%ae%c0%ae",
        ".",
        "mine.toml%00",
    ];
    let targets = [
        "etc/passwd",
        "mine.toml",
        "%6dine.toml",
        "proc/self/environ",
        "C:%5cwindows",
        "",
        "~",
        "*",
        "con",
        "mine.toml/",
    ];
    let mut stream = std::io::BufReader::new(served.connect());
    let (mut asked, mut found) = (0, 0);
    for step in steps {
        for deep in 0..25 {
            for (target, slash) in targets.iter().zip(["/", "%2f", "%5c", "%252f"].iter().cycle()) {
                for prefix in ["", "/", "%2f", "0123456789abcdef"] {
                    let id = format!("{prefix}{}{target}", format!("{step}{slash}").repeat(deep));
                    let head = served.head("GET", &format!("/api/scenarios/{id}"), "\r\n");
                    let (status, body) = exchange(&mut stream, &head);
                    let is_list =
                        status == 200 && body.contains("mine.toml") && !body.contains("\"text\"");
                    found += u32::from(status != 404 && !is_list);
                    asked += 1;
                }
            }
        }
    }
    assert!(asked == 10_000 && found == 0, "{found} of {asked}");
}

/// One question and its answer on a connection that stays.
fn exchange(stream: &mut std::io::BufReader<std::net::TcpStream>, head: &str) -> (u16, String) {
    use std::io::{BufRead as _, Read as _, Write as _};
    stream.get_mut().write_all(head.as_bytes()).expect("asked");
    let (mut text, mut length) = (String::new(), 0);
    loop {
        let mut line = String::new();
        assert_ne!(stream.read_line(&mut line).expect("a line"), 0, "closed: {text}");
        if let Some(value) = line.to_ascii_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().expect("a number");
        }
        if line == "\r\n" {
            break;
        }
        text.push_str(&line);
    }
    let mut body = vec![0; length];
    stream.read_exact(&mut body).expect("a body");
    let status = text.split(' ').nth(1).and_then(|it| it.parse().ok()).expect("a status");
    (status, String::from_utf8(body).expect("UTF-8"))
}

#[test]
fn one_scenario_that_is_opened_shows_no_other() {
    let served = Served::new();
    fs::write(served.path("other.toml"), SCENARIO).expect("written");
    let mut alone = settings(&served.path(""));
    alone.opened = Opened::Scenario(served.path("mine.toml"));
    let server = Server::start(alone).expect("it begins");
    let head = format!(
        "GET /api/scenarios HTTP/1.1\r\nHost: {0}\r\nX-Fspid-Token: {1}\r\nConnection: close\r\n\r\n",
        server.address(),
        server.token()
    );
    let mut stream = std::net::TcpStream::connect(server.address()).expect("a connection");
    std::io::Write::write_all(&mut stream, head.as_bytes()).expect("asked");
    let list = crate::common::Answer::read(stream).json(200);
    assert!(
        list.as_array().is_some_and(|it| it.len() == 1 && it[0]["name"] == "mine.toml"),
        "{list}"
    );
}

#[test]
fn what_cannot_be_opened_is_told_and_nothing_begins() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = |opened: Opened| {
        let mut settings = settings(folder.path());
        settings.opened = opened;
        Server::start(settings).expect_err("it is not there").to_string()
    };
    let missing = folder.path().join("missing");
    assert!(told(Opened::Folder(missing.clone())).contains("there is no such file"));
    assert!(told(Opened::Scenario(missing)).contains("there is no such file"));
}

#[test]
fn a_port_that_is_taken_is_told_with_what_to_do() {
    let served = Served::new();
    let folder = tempfile::tempdir().expect("a folder");
    let mut settings = settings(folder.path());
    settings.port = served.server.address().port();
    let told = Server::start(settings).expect_err("it is taken").to_string();
    assert!(told.contains("is taken") && told.contains("--port"), "{told}");
}
