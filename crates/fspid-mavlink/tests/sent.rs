//! What is sent is what pymavlink sends, byte by byte, and what a simulator is told is what pymavlink told.

use fspid_mavlink::{
    ActuatorControls, Damage, Encoder, HilAttitude, HilPlace, HilSensor, Outgoing, Sender, Stream,
};
use serde_json::Value;

/// What pymavlink made: `oracles/make_mavlink_sent.py`.
const SENT: &str = include_str!("data/sent.jsonl");

fn rows() -> Vec<Value> {
    SENT.lines().map(|row| serde_json::from_str(row).expect("JSON")).collect()
}

fn number(values: &Value, name: &str) -> f64 {
    values[name].as_f64().unwrap_or_else(|| panic!("{name} in {values}"))
}

fn whole<T: TryFrom<i64>>(values: &Value, name: &str) -> T {
    let found = values[name].as_i64().and_then(|it| T::try_from(it).ok());
    found.unwrap_or_else(|| panic!("{name} in {values}"))
}

fn numbers<const N: usize>(values: &Value, name: &str) -> [f64; N] {
    std::array::from_fn(|at| values[name][at].as_f64().expect("a number"))
}

fn to(values: &Value) -> Sender {
    let [system, component] = [0, 1].map(|at| values["to"][at].as_u64().expect("a number") as u8);
    Sender { system, component }
}

fn place(values: &Value) -> HilPlace {
    HilPlace {
        time_us: whole(values, "time_us"),
        latitude_deg: number(values, "latitude_deg"),
        longitude_deg: number(values, "longitude_deg"),
        altitude_m: number(values, "altitude_m"),
        velocity_m_s: numbers(values, "velocity_m_s"),
    }
}

fn sensors(values: &Value) -> HilSensor {
    HilSensor {
        time_us: whole(values, "time_us"),
        felt_m_s2: numbers(values, "felt_m_s2"),
        rates_rad_s: numbers(values, "rates_rad_s"),
        field_gauss: numbers(values, "field_gauss"),
        pressure_pa: number(values, "pressure_pa"),
        dynamic_pressure_pa: number(values, "dynamic_pressure_pa"),
        pressure_altitude_m: number(values, "pressure_altitude_m"),
        temperature_k: number(values, "temperature_k"),
    }
}

fn attitude(values: &Value) -> HilAttitude {
    HilAttitude {
        quaternion: numbers(values, "quaternion"),
        rates_rad_s: numbers(values, "rates_rad_s"),
        airspeed_m_s: number(values, "airspeed_m_s"),
        indicated_m_s: number(values, "indicated_m_s"),
        felt_g: numbers(values, "felt_g"),
    }
}

fn message(row: &Value) -> Option<Outgoing> {
    let values = &row["values"];
    Some(match row["kind"].as_str().expect("a kind") {
        "heartbeat" => Outgoing::Heartbeat,
        "sensors" => Outgoing::Sensors(sensors(values)),
        "gps" => Outgoing::Gps(place(values)),
        "state" => Outgoing::State(place(values), attitude(values)),
        "remote" => Outgoing::RemoteControl {
            time_us: whole(values, "time_us"),
            pulses_us: numbers::<12>(values, "pulses_us").map(|pulse_us| pulse_us as u16),
        },
        "target" => Outgoing::AttitudeTarget {
            to: to(values),
            time_ms: whole(values, "time_ms"),
            quaternion: numbers(values, "quaternion"),
            thrust: values["thrust"].as_f64(),
        },
        "override" => Outgoing::Override {
            to: to(values),
            channel: whole(values, "channel"),
            pulse_us: whole(values, "pulse_us"),
        },
        "manual" => Outgoing::Manual { to: to(values), forward: whole(values, "forward") },
        "ask" => {
            Outgoing::AskAttitude { to: to(values), interval_us: number(values, "interval_us") }
        }
        "controls" => return None,
        other => panic!("{other}"),
    })
}

fn bytes(row: &Value) -> Vec<u8> {
    let digits = row["frame"].as_str().expect("digits").as_bytes();
    let byte = |pair: &[u8]| {
        u8::from_str_radix(std::str::from_utf8(pair).expect("digits"), 16).expect("a byte")
    };
    digits.chunks(2).map(byte).collect()
}

#[test]
fn frames_are_those_of_pymavlink_byte_by_byte() {
    let mut encoder = Encoder::new(Sender { system: 42, component: 1 });
    let mut kinds = std::collections::BTreeSet::new();
    for row in rows() {
        let Some(message) = message(&row) else { continue };
        assert_eq!(encoder.frame(&message), bytes(&row), "{row}");
        kinds.insert(row["kind"].to_string());
    }
    assert_eq!(kinds.len(), 9, "{kinds:?}");
}

#[test]
fn numbers_of_frames_begin_again_behind_the_largest() {
    let mut encoder = Encoder::new(Sender { system: 1, component: 1 });
    let places: Vec<u8> = (0..258).map(|_| encoder.frame(&Outgoing::Heartbeat)[4]).collect();
    assert_eq!(places[255..], [255, 0, 1]);
}

fn told() -> Vec<(Vec<u8>, ActuatorControls)> {
    let rows = rows().into_iter().filter(|row| row["kind"] == "controls");
    rows.map(|row| {
        let values = &row["values"];
        let controls = ActuatorControls {
            time_us: whole(values, "time_us"),
            controls: numbers::<16>(values, "controls").map(|control| control as f32),
            is_armed: values["is_armed"] == true,
            is_lockstep: values["is_lockstep"] == true,
        };
        (bytes(&row), controls)
    })
    .collect()
}

/// In pieces of any length, with other messages between them.
#[test]
fn controls_come_out_of_a_stream_as_they_were_sent() {
    let told = told();
    assert_eq!(told.len(), 3);
    let others = rows().iter().map(bytes).next().expect("a heartbeat");
    let all: Vec<u8> =
        told.iter().flat_map(|(bytes, _)| [others.as_slice(), bytes].concat()).collect();
    for length in [1, 2, 7, 91, 92, 93, all.len()] {
        let (mut stream, mut found) = (Stream::default(), Vec::new());
        for piece in all.chunks(length) {
            stream.push(piece);
            while let Some(controls) = stream.next_controls().expect("whole frames") {
                found.push(controls);
            }
        }
        let expected: Vec<_> = told.iter().map(|(_, controls)| *controls).collect();
        assert_eq!(found, expected, "{length}");
    }
}

#[test]
fn bytes_of_a_stream_that_are_no_frame_are_damage_and_what_follows_is_read() {
    let (whole, controls) = told().swap_remove(0);
    let mut stream = Stream::default();
    stream.push(b"GET /");
    assert_eq!(stream.next_controls(), Err(Damage::NoFrame { byte: b'G' }));
    let mut damaged = whole.clone();
    damaged[40] ^= 4;
    stream.push(&damaged);
    assert_eq!(stream.next_controls(), Err(Damage::Checksum { id: 93 }));
    stream.push(&whole);
    assert_eq!(stream.next_controls(), Ok(Some(controls)));
    assert_eq!(stream.next_controls(), Ok(None));
}
