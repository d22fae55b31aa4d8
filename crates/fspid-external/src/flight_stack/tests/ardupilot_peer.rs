//! A fake ArduPilot, and flights with it.

use std::net::UdpSocket;
use std::time::Duration;

use serde_json::Value;

use super::*;

/// A fake ArduPilot: packets of pulses out, lines of JSON in.
struct FakeArduPilot {
    socket: UdpSocket,
    /// Count of the last packet.
    count: u32,
}

impl FakeArduPilot {
    fn at(address: SocketAddr) -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        socket.connect(address).expect("an address");
        // Long beside everything: a peer that hangs shall not hang the tests.
        socket.set_read_timeout(Some(Duration::from_secs(60))).expect("allowed");
        Self { socket, count: 0 }
    }

    fn packet(magic: u16, count: u32, pulses_us: &[u16]) -> Vec<u8> {
        let mut bytes = magic.to_le_bytes().to_vec();
        bytes.extend(100_u16.to_le_bytes());
        bytes.extend(count.to_le_bytes());
        pulses_us.iter().for_each(|pulse_us| bytes.extend(pulse_us.to_le_bytes()));
        bytes
    }

    /// Sends the pulse of the elevator, channel 2, under a count.
    fn send_as(&self, count: u32, pulse_us: u16) {
        let mut pulses_us = [1500; 16];
        pulses_us[1] = pulse_us;
        let _ = self.socket.send(&Self::packet(18_458, count, &pulses_us));
    }

    /// Sends the next packet.
    fn send(&mut self, pulse_us: u16) {
        self.count += 1;
        self.send_as(self.count, pulse_us);
    }

    /// The next line; nothing once nobody flies any more.
    fn line(&self) -> Value {
        let mut bytes = [0; 4096];
        let length = self.socket.recv(&mut bytes).expect("a line");
        let text = std::str::from_utf8(&bytes[..length]).expect("a text");
        assert!(text.starts_with('\n') && text.ends_with('\n'), "{text:?}");
        serde_json::from_str(text).expect("JSON")
    }
}

fn number(line: &Value, path: &str) -> f64 {
    line.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {line}"))
}

/// What a pilot makes of a line.
fn answered(pilot: &mut Pilot, line: &Value) -> u16 {
    let rc_us = line["rc"]["rc_2"].as_u64().expect("a pulse");
    pulse_us(pilot.command_rad(rc_us, number(line, "/attitude/1"), number(line, "/imu/gyro/1")))
}

/// Flies samples with somebody who interferes with each before its answer.
fn fly_with(
    address: SocketAddr,
    samples: usize,
    mut interfere: impl FnMut(&mut FakeArduPilot, usize),
) {
    let (mut peer, mut pilot) = (FakeArduPilot::at(address), Pilot::new());
    peer.send(1500);
    for k in 0..samples {
        let line = peer.line();
        assert!((number(&line, "/timestamp") - (k + 1) as f64 * DT_S).abs() < 1e-12);
        let pulse_us = answered(&mut pilot, &line);
        interfere(&mut peer, k);
        peer.send(pulse_us);
    }
}

const ROWS: usize = 301;

fn expected() -> Vec<[u64; 4]> {
    let command = |pulse_us: u16| {
        -FULL_RAD + (FULL_RAD - -FULL_RAD) * ((f64::from(pulse_us) - 1000.0) / 1000.0)
    };
    let scenario = scenario(stack(ARDUPILOT), 30.0);
    let rows = inside(&scenario, |command_rad| command(pulse_us(command_rad)));
    rows.into_iter().map(|row| row.map(f64::to_bits)).collect()
}

#[test]
fn a_controller_over_the_wire_flies_with_the_bits_of_the_same_one_inside() {
    let scenario = scenario(stack(ARDUPILOT), 30.0);
    let (trace, told) = flown(&scenario, |address| fly_with(address, ROWS, |_, _| {}));
    assert_eq!(trace.outcome, Outcome::Completed);
    assert_eq!(bits(&trace), expected());
    // It does fly: the step is followed.
    assert!((trace.theta_rad[ROWS - 1] - STEP_RAD).abs() < 0.02, "{:?}", trace.theta_rad.last());
    assert!(told.contains("301 samples told, 0 before the flight; packets repeated 0, missing 0, late 0, of others 0"), "{told}");
}

#[test]
fn a_lost_answer_is_sent_again_and_no_sample_is_flown_for_it() {
    let scenario = scenario(stack(ARDUPILOT), 30.0);
    let (trace, told) = flown(&scenario, |address| {
        fly_with(address, ROWS, |peer, k| {
            if k % 50 == 7 {
                // As if the line had not come: the packet before once more.
                peer.send_as(peer.count, 1111);
                let again = peer.line();
                assert!((number(&again, "/timestamp") - (k + 1) as f64 * DT_S).abs() < 1e-12);
            }
        });
    });
    assert_eq!(bits(&trace), expected());
    assert!(told.contains("packets repeated 6, missing 0, late 0"), "{told}");
}

#[test]
fn missing_and_late_packets_are_counted_and_a_late_one_moves_nothing() {
    let scenario = scenario(stack(ARDUPILOT), 30.0);
    let (trace, told) = flown(&scenario, |address| {
        fly_with(address, ROWS, |peer, k| {
            if k % 100 == 30 {
                // Three packets do not arrive, and the first of them does later.
                peer.count += 3;
            }
            if k % 100 == 31 {
                peer.send_as(peer.count - 3, 2000);
            }
        });
    });
    assert_eq!(bits(&trace), expected());
    assert!(told.contains("packets repeated 0, missing 9, late 3"), "{told}");
}

#[test]
fn packets_of_others_and_thirty_two_channels_change_nothing() {
    let scenario = scenario(stack(ARDUPILOT), 30.0);
    let (trace, told) = flown(&scenario, |address| {
        let other = FakeArduPilot::at(address);
        let (mut peer, mut pilot) = (FakeArduPilot::at(address), Pilot::new());
        peer.send(1500);
        for count in 2..ROWS as u32 + 2 {
            let mut pulses_us = [1500; 32];
            let line = peer.line();
            pulses_us[1] = answered(&mut pilot, &line);
            if count == 9 {
                other.send_as(count, 1000);
                let _ = other.socket.send(b"hello");
            }
            let packet = FakeArduPilot::packet(29_569, count, &pulses_us);
            peer.socket.send(&packet).expect("sent");
        }
    });
    assert_eq!(bits(&trace), expected());
    assert!(told.contains("of others 2"), "{told}");
}

#[test]
fn before_the_flight_it_flies_straight_on_and_its_commands_move_nothing() {
    let mut stack = stack(ARDUPILOT);
    stack.lead_in_s = 1.0;
    let (trace, told) = flown(&scenario(stack, 30.0), |address| {
        let (mut peer, mut pilot) = (FakeArduPilot::at(address), Pilot::new());
        peer.send(1500);
        for k in 0..ROWS + 100 {
            let line = peer.line();
            let north_m = number(&line, "/position/0");
            assert!((north_m - 50.0 * k as f64 * DT_S).abs() < 1e-9, "{k}: {north_m}");
            assert!((number(&line, "/position/2") + 300.0).abs() < 1e-12);
            let pulse_us = if k < 100 { 1900 } else { answered(&mut pilot, &line) };
            peer.send(pulse_us);
        }
    });
    assert_eq!(bits(&trace), expected());
    assert!(told.contains("401 samples told, 100 before the flight"), "{told}");
}

#[test]
fn no_pulse_is_the_trim_and_is_told() {
    let (trace, told) = flown(&scenario(stack(ARDUPILOT), 30.0), |address| {
        let mut peer = FakeArduPilot::at(address);
        peer.send(0);
        (0..ROWS).for_each(|_| {
            peer.line();
            peer.send(0);
        });
    });
    assert_eq!(trace.outcome, Outcome::Completed);
    assert!(trace.command_rad.iter().all(|command_rad| *command_rad == 0.0));
    assert!(told.contains("at 301 of the samples the elevator's channel had no pulse"), "{told}");
}

/// What is lost with a peer that answers ten samples and then sends something else.
fn lost_by(
    limit_s: f64,
    then: impl FnOnce(&mut FakeArduPilot) + Send + 'static,
) -> (usize, String) {
    let (trace, _) = flown(&scenario(stack(ARDUPILOT), limit_s), |address| {
        let mut peer = FakeArduPilot::at(address);
        peer.count = 5000;
        peer.send(1500);
        (0..10).for_each(|_| {
            peer.line();
            peer.send(1500);
        });
        peer.line();
        then(&mut peer);
    });
    loss(&trace)
}

#[test]
fn whatever_else_it_does_is_a_verdict_in_words() {
    let send = |bytes: Vec<u8>| {
        lost_by(30.0, move |peer| {
            peer.socket.send(&bytes).expect("sent");
        })
    };
    let packet = |magic, count| FakeArduPilot::packet(magic, count, &[1500; 16]);
    assert_eq!(
        send(packet(18_457, 5012)),
        (10, "sent a packet that begins with 18457; allowed are 18458 and 29569".to_owned())
    );
    assert_eq!(
        send(packet(29_569, 5012)),
        (10, "sent a packet of 40 bytes; allowed are 72".to_owned())
    );
    assert_eq!(
        send(packet(18_458, 5012)[..39].to_vec()),
        (10, "sent a packet of 39 bytes; allowed are 40".to_owned())
    );
    assert_eq!(send(b"x".to_vec()), (10, "sent a packet of 1 bytes; allowed are 40".to_owned()));
    assert_eq!(send(packet(18_458, 1)), (10, "began anew in flight".to_owned()));
}

#[test]
fn silence_and_late_packets_alone_are_no_answer() {
    // How many samples are flown before depends on how busy the machine is.
    assert_eq!(lost_by(1.0, |_| {}).1, "gave no answer within 1.0 s");
    let (_, words) = lost_by(1.0, |peer| {
        for count in 4000..4100 {
            peer.send_as(count + 900, 1500);
        }
    });
    assert_eq!(words, "gave no answer within 1.0 s");
}

#[test]
fn who_does_not_come_or_comes_as_something_else_is_lost_at_the_first_sample() {
    let mut nobody = stack(ARDUPILOT);
    nobody.connect_limit_s = 0.05;
    let (trace, _) = flown(&scenario(nobody, 30.0), |_| {});
    assert_eq!(loss(&trace), (0, "did not come within 0.05 s".to_owned()));
    let (trace, _) = flown(&scenario(stack(ARDUPILOT), 30.0), |address| {
        FakeArduPilot::at(address).socket.send(b"GET / HTTP/1.1\r\n\r\n").expect("sent");
    });
    assert_eq!(loss(&trace).1, "sent a packet that begins with 17735; allowed are 18458 and 29569");
}

#[test]
fn a_channel_that_it_does_not_have_is_said() {
    let mut far = stack(ARDUPILOT);
    far.elevator.number = 19;
    let (trace, _) = flown(&scenario(far, 30.0), |address| {
        let mut peer = FakeArduPilot::at(address);
        peer.send(1500);
        peer.line();
        peer.send(1500);
    });
    let words = "sent 16 channels, and the elevator's or the throttle's is number 20";
    assert_eq!(loss(&trace), (0, words.to_owned()));
}

#[test]
fn an_address_that_somebody_has_is_the_machine_s_fault() {
    let taken = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let mut stack = stack(ARDUPILOT);
    stack.address = taken.local_addr().expect("an address");
    set_host(WithPeers);
    let refused = simulate(&scenario(stack, 30.0)).expect_err("taken");
    assert!(refused.is_of_host(), "{refused:?}");
    assert!(refused.to_string().contains("another program waits at this address"), "{refused}");
}
