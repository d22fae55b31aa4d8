//! Telemetry by UDP.

use std::net::UdpSocket;

use serde_json::json;

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
