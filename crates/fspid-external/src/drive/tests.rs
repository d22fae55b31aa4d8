//! Flights of an autopilot that speaks MAVLink from its documents, byte by byte.

use std::cell::Cell;
use std::sync::mpsc::{Receiver, channel};

use super::*;

/// ATTITUDE, message 30, whose checksum ends with 39: time, roll, pitch, yaw, rates.
fn attitude(time_ms: u32, pitch_rad: f32, rate_rad_s: f32) -> Vec<u8> {
    let mut payload = time_ms.to_le_bytes().to_vec();
    for number in [0.0, pitch_rad, 0.5, 0.0, rate_rad_s, 0.001_f32] {
        payload.extend(number.to_le_bytes());
    }
    let mut bytes = vec![0xFD, payload.len() as u8, 0, 0, 3, 1, 1, 30, 0, 0];
    bytes.extend(payload);
    let sum = checksum(bytes[1..].iter().copied().chain([39]));
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// CRC-16/MCRF4XX.
fn checksum(bytes: impl Iterator<Item = u8>) -> u16 {
    bytes.fold(0xFFFF, |crc: u16, byte| {
        let mut low = byte ^ (crc & 0xFF) as u8;
        low ^= low << 4;
        let low = u16::from(low);
        (crc >> 8) ^ (low << 8) ^ (low << 3) ^ (low >> 4)
    })
}

/// A message as it came: its number and its payload, with its zeros.
type Message = (u8, Vec<u8>);

/// An autopilot that tells one attitude over and over until it hears nothing for half a second, or is quiet behind so many.
fn autopilot(to: SocketAddr, most: usize) -> Receiver<Vec<Message>> {
    let (done, heard) = channel();
    std::thread::spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        socket.set_read_timeout(Some(Duration::from_millis(2))).expect("allowed");
        let (mut messages, mut quiet, mut sent) = (Vec::new(), 0, 0);
        let mut bytes = [0; 512];
        // Somebody answers at some time, and then nobody any more.
        while messages.is_empty() || quiet < 500 {
            // What is sent before somebody hears it does not count.
            if messages.is_empty() || sent < most {
                let _ = socket.send_to(&attitude(sent as u32, 0.125, 0.5), to);
                sent += usize::from(!messages.is_empty());
            }
            match socket.recv_from(&mut bytes) {
                Ok((length, _)) => {
                    quiet = 0;
                    let mut payload = bytes[10..length - 2].to_vec();
                    payload.resize(64, 0);
                    messages.push((bytes[7], payload));
                }
                Err(_) => quiet += 1,
            }
        }
        let _ = done.send(messages);
    });
    heard
}

fn flight(way: Way, setpoint_rad: &[f64]) -> Drive<'_> {
    Drive {
        to: None,
        way,
        period_s: 0.005,
        setpoint_rad,
        trim_rad: 0.025,
        connect_limit_s: 60.0,
        stale_s: [60.0, 120.0],
    }
}

/// A flight with an autopilot that tells so many attitudes, and what the autopilot heard.
fn flown(
    flight: &Drive<'_>,
    most: usize,
    answer: impl FnMut(Sample<f64>) -> Result<f64, String>,
    is_over: impl Fn() -> bool,
) -> (Driven, Vec<Message>) {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let heard = autopilot(socket.local_addr().expect("an address"), most);
    let driven = drive(socket, flight, answer, is_over).expect("can be read");
    (driven, heard.recv().expect("heard"))
}

const OVERRIDE: Way = Way::Override { channel: 1, full_rad: 0.5 };

/// Proportional, with pitch rate.
fn law(sample: Sample<f64>) -> Result<f64, String> {
    Ok(1.5 * (sample.setpoint_rad - sample.measurement_rad) - 0.1 * sample.rate_rad_s)
}

fn pulses(messages: &[Message]) -> Vec<[u16; 8]> {
    let overrides = messages.iter().filter(|(id, _)| *id == 70);
    let pulse =
        |payload: &[u8], at: usize| u16::from_le_bytes([payload[2 * at], payload[2 * at + 1]]);
    overrides.map(|(_, payload)| std::array::from_fn(|at| pulse(payload, at))).collect()
}

#[test]
fn commands_go_to_a_channel_and_are_given_back_at_the_end() {
    let setpoint_rad = vec![0.2; 40];
    let flight = flight(OVERRIDE, &setpoint_rad);
    let (driven, messages) = flown(&flight, usize::MAX, law, || false);
    assert_eq!((driven.ending.clone(), driven.rows.len(), driven.held()), (None, 40, 0));
    // 0.2 - (0.125 - 0.025) is 0.1, and 0.15 less a tenth of 0.5 is 0.1: a fifth of 500 µs.
    let given = pulses(&messages);
    let taken = given.iter().filter(|pulses| pulses[1] == 1600).count();
    let back = given.iter().filter(|pulses| pulses[1] == 0).count();
    assert_eq!((taken, back), (40, 3), "{given:?}");
    assert_eq!(given.last().map(|pulses| pulses[1]), Some(0));
    assert!(given.iter().all(|pulses| pulses[0] == 65535 && pulses[7] == 65535));
    // A heartbeat, and a wish for ATTITUDE at the loop's rate: MAV_CMD_SET_MESSAGE_INTERVAL, 30, 5000 µs.
    assert!(messages.iter().any(|(id, _)| *id == 0));
    let wish = messages.iter().find(|(id, _)| *id == 76).expect("a wish");
    assert_eq!(wish.1[..8], [30.0_f32.to_le_bytes(), 5000.0_f32.to_le_bytes()].concat());
    assert_eq!(wish.1[28..30], 511_u16.to_le_bytes());
    let csv = driven.csv();
    assert_eq!(csv.lines().count(), 41);
    assert!(csv.lines().nth(1).expect("a row").starts_with("0.0,11.45915590"), "{csv}");
}

#[test]
fn the_set_point_goes_as_an_attitude_with_the_heading_that_is_flown() {
    let setpoint_rad = vec![0.2; 5];
    let flight = flight(Way::AttitudeTarget { thrust: Some(0.5) }, &setpoint_rad);
    let (driven, messages) = flown(&flight, usize::MAX, law, || false);
    assert_eq!(driven.ending, None);
    let targets: Vec<_> = messages.iter().filter(|(id, _)| *id == 82).collect();
    assert_eq!(targets.len(), 5);
    let payload = &targets[0].1;
    let number =
        |at: usize| f64::from(f32::from_le_bytes(payload[at..at + 4].try_into().expect("four")));
    let [w, x, y, z] = [4, 8, 12, 16].map(number);
    // Pitch counts from the horizon there: the trim is added.
    assert!(((2.0 * (w * y - z * x)).asin() - 0.225).abs() < 1e-6);
    let yaw_rad = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
    assert!((yaw_rad - 0.5).abs() < 1e-6, "{yaw_rad}");
    assert_eq!((number(32), payload[38]), (0.5, 7));
}

#[test]
fn a_joystick_is_pulled_for_nose_up() {
    let setpoint_rad = vec![0.2; 5];
    let flight = flight(Way::Manual { full_rad: 0.5 }, &setpoint_rad);
    let (_, messages) = flown(&flight, usize::MAX, law, || false);
    let sticks: Vec<i16> = messages
        .iter()
        .filter(|(id, _)| *id == 69)
        .map(|(_, payload)| i16::from_le_bytes([payload[0], payload[1]]))
        .collect();
    assert_eq!(sticks, [-200; 5]);
}

#[test]
fn attitudes_that_stay_out_hold_the_command_and_then_give_it_back() {
    let setpoint_rad = vec![0.2; 100_000];
    let flight = Drive { stale_s: [0.2, 0.4], ..flight(OVERRIDE, &setpoint_rad) };
    let (driven, messages) = flown(&flight, 5, law, || false);
    assert!(
        matches!(driven.ending, Some(Ending::Stale { limit_s: 0.4, .. })),
        "{:?}",
        driven.ending
    );
    assert!(driven.held() > 0, "{driven:?}");
    let given = pulses(&messages);
    assert_eq!(given.last().map(|pulses| pulses[1]), Some(0));
    assert!(given.iter().all(|pulses| [1600, 0].contains(&pulses[1])), "{given:?}");
}

#[test]
fn a_wish_to_stop_and_a_lost_controller_give_the_command_back() {
    let setpoint_rad = vec![0.2; 100_000];
    let flight = flight(OVERRIDE, &setpoint_rad);
    let asked = Cell::new(0);
    let is_over = || {
        asked.set(asked.get() + 1);
        asked.get() > 200
    };
    let (driven, messages) = flown(&flight, usize::MAX, law, is_over);
    assert!(matches!(driven.ending, Some(Ending::Stopped { .. })), "{:?}", driven.ending);
    assert_eq!(pulses(&messages).last().map(|pulses| pulses[1]), Some(0));

    let lost = |_: Sample<f64>| Err("answered a command that is not finite".to_owned());
    let (driven, messages) = flown(&flight, usize::MAX, lost, || false);
    let ending = driven.ending.expect("lost").to_string();
    assert_eq!(
        ending,
        "at t = 0.000 s the controller answered a command that is not finite; the command was given back"
    );
    assert_eq!(pulses(&messages).len(), 3);
}

/// A socket whose attitudes go to a flight, and that hears what comes back.
fn speaker(to: SocketAddr) -> UdpSocket {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    socket.connect(to).expect("an address");
    socket.set_read_timeout(Some(Duration::from_millis(200))).expect("allowed");
    socket
}

/// What came to a socket so far, as pulses of the channel.
fn pulses_at(socket: &UdpSocket) -> Vec<u16> {
    let (mut bytes, mut pulses) = ([0; 512], Vec::new());
    while let Ok(length) = socket.recv(&mut bytes) {
        let mut payload = bytes[10..length - 2].to_vec();
        payload.resize(64, 0);
        pulses.extend((bytes[7] == 70).then(|| u16::from_le_bytes([payload[2], payload[3]])));
    }
    pulses
}

#[test]
fn who_speaks_after_the_first_neither_steers_nor_is_steered() {
    let setpoint_rad = vec![0.2; 100_000];
    let flight = Drive { stale_s: [0.2, 0.4], ..flight(OVERRIDE, &setpoint_rad) };
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let to = socket.local_addr().expect("an address");
    let (first, other) = (speaker(to), speaker(to));
    first.send(&attitude(1, 0.125, 0.5)).expect("sent");
    let mut time_ms = 1;
    let asked = |sample: Sample<f64>| {
        time_ms += 5;
        let _ = other.send(&attitude(time_ms, -0.5, 0.0));
        law(sample)
    };
    let driven = drive(socket, &flight, asked, || false).expect("can be read");
    assert!(matches!(driven.ending, Some(Ending::Stale { .. })), "{:?}", driven.ending);
    assert!(driven.rows.iter().all(|row| (row.command_rad - 0.1).abs() < 1e-6));
    assert_eq!(pulses_at(&other), Vec::<u16>::new());
    let back = pulses_at(&first);
    assert!(back.contains(&1600) && back.ends_with(&[0, 0, 0]), "{back:?}");
}

#[test]
fn an_autopilot_whose_clock_stands_or_goes_back_is_stale() {
    let setpoint_rad = vec![0.2; 100_000];
    let flight = Drive { stale_s: [0.2, 0.4], ..flight(OVERRIDE, &setpoint_rad) };
    for step_ms in [0, 1] {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        let speaker = speaker(socket.local_addr().expect("an address"));
        speaker.send(&attitude(900_000, 0.125, 0.5)).expect("sent");
        let looked = Cell::new(0);
        let is_over = || {
            looked.set(looked.get() + 1);
            let _ = speaker.send(&attitude(900_000 - step_ms * looked.get(), -0.5, 0.5));
            false
        };
        let driven = drive(socket, &flight, law, is_over).expect("can be read");
        assert!(matches!(driven.ending, Some(Ending::Stale { .. })), "{:?}", driven.ending);
        assert!(driven.held() > 0 && driven.heard > 10, "{}", driven.heard);
        assert!(driven.rows.iter().all(|row| (row.command_rad - 0.1).abs() < 1e-6));
    }
}

#[test]
fn a_late_sample_takes_the_newest_attitude_and_one_that_is_too_late_ends_the_flight() {
    let setpoint_rad = vec![0.2; 1000];
    for (stale_s, ends) in [([60.0, 120.0], false), ([0.1, 0.2], true)] {
        let flight =
            Drive { stale_s, setpoint_rad: &setpoint_rad[..3], ..flight(OVERRIDE, &setpoint_rad) };
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        let speaker = speaker(socket.local_addr().expect("an address"));
        speaker.send(&attitude(1, 0.125, 0.5)).expect("sent");
        let mut is_first = true;
        let stands = |sample: Sample<f64>| {
            if std::mem::take(&mut is_first) {
                for time_ms in 2..=50 {
                    let _ = speaker.send(&attitude(time_ms, 0.01 * time_ms as f32, 0.5));
                }
                std::thread::sleep(Duration::from_millis(400));
            }
            law(sample)
        };
        let driven = drive(socket, &flight, stands, || false).expect("can be read");
        let is_late = matches!(driven.ending, Some(Ending::Late { .. }));
        assert_eq!((is_late, driven.rows.len()), (ends, if ends { 1 } else { 3 }), "{driven:?}");
        let newest = driven.rows.get(1).map(|row| (row.sample.measurement_rad - 0.475).abs());
        assert!(newest.is_none_or(|apart| apart < 1e-6), "{driven:?}");
        assert!(pulses_at(&speaker).ends_with(&[0, 0, 0]));
    }
}

#[test]
fn where_nobody_speaks_nothing_is_sent() {
    let setpoint_rad = [0.0];
    let flight = Drive { connect_limit_s: 0.05, ..flight(OVERRIDE, &setpoint_rad) };
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let driven = drive(socket, &flight, law, || false).expect("can be read");
    assert_eq!(driven.ending, Some(Ending::NotHeard { limit_s: 0.05 }));
    assert!(driven.rows.is_empty());
}

#[test]
fn ends_of_channels_cut_commands() {
    assert_eq!([-9.0, -1.0, 0.0, 0.5, 7.0].map(pulse_us), [1000, 1000, 1500, 1750, 2000]);
    assert_eq!([-9.0, 0.25, 7.0].map(forward), [1000, -250, -1000]);
}
