//! Telemetry by UDP.

use std::net::UdpSocket;

use serde_json::{Value, json};

use crate::common::Served;

fn heard() -> (Served, UdpSocket) {
    let served = Served::with(|settings| settings.telemetry_port = Some(0));
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let port = served.server.telemetry_port().expect("a port");
    socket.connect(("127.0.0.1", port)).expect("connected");
    (served, socket)
}

#[test]
fn lines_come_through_with_their_numbers_and_bad_ones_are_counted_and_told() {
    let (served, socket) = heard();
    let mut events = served.stream("/api/telemetry/events", "");
    assert_eq!(events.next().expect("the first").1, "begun");
    let lines = "{\"time_s\":0.1,\"measurement_deg\":1.25}\nnonsense\n\n{\"time_s\":0.2,\"command_deg\":-3}\n";
    socket.send(lines.as_bytes()).expect("sent");
    let (mut good, mut bad) = (Vec::new(), 0);
    while good.len() < 2 || bad < 1 {
        let (_, name, data) = events.next().expect("more");
        assert_eq!(name, "telemetry");
        good.extend(data["lines"].as_array().expect("a list").clone());
        bad = data["bad"].as_u64().expect("a count");
    }
    let expected = [
        json!({ "time_s": 0.1, "measurement_deg": 1.25 }),
        json!({ "time_s": 0.2, "command_deg": -3 }),
    ];
    assert_eq!(good, expected);
    let health = served.json("/api/health");
    assert_eq!(
        (&health["telemetry"]["lines"], &health["telemetry"]["bad"]),
        (&json!(2), &json!(1))
    );
    assert!(health["telemetry"]["last_bad"].is_string(), "{health}");
}

#[test]
fn without_telemetry_the_stream_says_how_to_have_it() {
    let told = Served::new().get("/api/telemetry/events").error(404);
    assert!(told.contains("--telemetry udp:PORT"), "{told}");
}

#[test]
fn telemetry_is_heard_on_this_machine_alone_and_nothing_is_sent_back() {
    let (served, socket) = heard();
    (0..50).for_each(|k| {
        socket.send(format!("{{\"time_s\":{k}}}").as_bytes()).expect("sent");
    });
    served.until(|health| health["telemetry"]["lines"] == json!(50));
    socket.set_nonblocking(true).expect("set");
    assert!(socket.recv(&mut [0; 8]).is_err());
}

/// The sequence of packets that pymavlink made, and what a loop makes of them.
fn made_by_pymavlink(name: &str) -> (Vec<Vec<u8>>, Value) {
    let rows = include_str!("../../fspid-mavlink/tests/data/packets.jsonl").lines();
    let mut rows = rows.map(|row| serde_json::from_str::<Value>(row).expect("JSON"));
    let row = rows.find(|row| row["name"] == name).expect("its row");
    let packets = row["packets"].as_array().expect("a list").iter();
    let packets = packets.map(|digits| bytes(digits.as_str().expect("digits")));
    (packets.collect(), row["lines"].clone())
}

fn bytes(digits: &str) -> Vec<u8> {
    let pairs = (0..digits.len()).step_by(2).map(|at| &digits[at..at + 2]);
    pairs.map(|pair| u8::from_str_radix(pair, 16).expect("a byte")).collect()
}

#[test]
fn mavlink_on_the_same_port_comes_through_as_lines_with_the_set_point_beside_the_attitude() {
    let (served, socket) = heard();
    let mut events = served.stream("/api/telemetry/events", "");
    let begun = events.next().expect("the first").2;
    assert_eq!((&begun["form"], &begun["mavlink"]), (&json!(null), &json!(null)));
    let (packets, expected) = made_by_pymavlink(
        "version 2: set-points, speeds and servos beside attitudes, in packets of several frames",
    );
    packets.iter().for_each(|packet| assert!(socket.send(packet).expect("sent") > 0));
    let expected = expected.as_array().expect("a list");
    let mut lines = Vec::new();
    while lines.len() < expected.len() {
        let (_, name, data) = events.next().expect("more");
        assert_eq!((name.as_str(), &data["form"]), ("telemetry", &json!("mavlink")));
        lines.extend(data["lines"].as_array().expect("a list").clone());
    }
    for (line, known) in lines.iter().zip(expected) {
        let (line, known) = (line.as_object().expect("one"), known.as_object().expect("one"));
        assert_eq!(line.len(), known.len(), "{line:?}");
        for (name, value) in known {
            let difference = line[name].as_f64().expect("a number") - value.as_f64().expect("one");
            assert!(difference.abs() < 2e-5, "{name}: {line:?}");
        }
    }
    let told = &served.json("/api/health")["telemetry"];
    assert_eq!((&told["lines"], &told["bad"]), (&json!(5), &json!(0)), "{told}");
    let who = json!({ "frames": 11, "unused": 2, "others": 0, "system": 1, "component": 1 });
    assert_eq!(told["mavlink"], who);
    socket.set_nonblocking(true).expect("set");
    assert!(socket.recv(&mut [0; 8]).is_err(), "nothing is sent back");
}

#[test]
fn damaged_mavlink_is_counted_and_told_and_lines_of_json_come_through_beside_it() {
    let (served, socket) = heard();
    let (packets, _) = made_by_pymavlink("what is no number is told and not passed on");
    packets.iter().for_each(|packet| assert!(socket.send(packet).expect("sent") > 0));
    socket.send(b"{\"time_s\":7}").expect("sent");
    served.until(|health| health["telemetry"]["form"] == json!("json"));
    served.until(|health| health["telemetry"]["lines"] == json!(3));
    let told = &served.json("/api/health")["telemetry"];
    assert_eq!(told["bad"], json!(7), "{told}");
    let last = told["last_bad"].as_str().expect("a sentence");
    assert_eq!(last, "the quaternion of ATTITUDE_TARGET has the square 4; allowed is 0.99 to 1.01");
}
