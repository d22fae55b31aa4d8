//! Packets that pymavlink made, and packets that nobody made.

mod sent;

use fspid_mavlink::{Counts, Damage, Line, Listener, is_frame};
use proptest::prelude::*;
use serde_json::Value;

/// What pymavlink made: `oracles/make_mavlink.py`.
const PACKETS: &str = include_str!("data/packets.jsonl");

/// Degrees that differ by no more than this are the same: quaternions come as single floats.
const SINGLE_DEG: f64 = 2e-5;

fn sequences() -> Vec<Value> {
    let rows = PACKETS.lines().map(|row| serde_json::from_str(row).expect("JSON"));
    let rows: Vec<Value> = rows.collect();
    assert!(rows.len() > 15, "{}", rows.len());
    rows
}

fn packets(row: &Value) -> Vec<Vec<u8>> {
    let byte = |pair: &[u8]| {
        let digits = std::str::from_utf8(pair).expect("digits");
        u8::from_str_radix(digits, 16).expect("a byte")
    };
    let packet = |it: &Value| {
        it.as_str().expect("a text").as_bytes().chunks(2).map(byte).collect::<Vec<u8>>()
    };
    row["packets"].as_array().expect("a list").iter().map(packet).collect()
}

/// The packets of the sequence of a name.
fn named(name: &str) -> Vec<Vec<u8>> {
    let rows = sequences();
    packets(rows.iter().find(|row| row["name"] == name).expect("its row"))
}

fn heard(packets: &[Vec<u8>]) -> (Vec<Line>, Vec<Damage>, Counts) {
    let mut listener = Listener::default();
    let (mut lines, mut damages) = (Vec::new(), Vec::new());
    for told in packets.iter().flat_map(|packet| listener.hear(packet)) {
        match told {
            Ok(line) => lines.push(line),
            Err(damage) => damages.push(damage),
        }
    }
    (lines, damages, listener.counts())
}

fn assert_same(line: &Line, expected: &Value, of: &Value) {
    let expected = expected.as_object().expect("an object");
    assert_eq!(line.len(), expected.len(), "{of}: {line:?} where {expected:?}");
    for (name, value) in line {
        let known = expected.get(*name).and_then(Value::as_f64);
        let known = known.unwrap_or_else(|| panic!("{of}: {name} in {line:?}"));
        let most = if *name == "setpoint_deg" { SINGLE_DEG } else { 1e-12 };
        assert!((value - known).abs() <= most, "{of}: {name} is {value}, not {known}");
    }
}

#[test]
fn lines_are_those_that_the_messages_of_pymavlink_say() {
    for row in sequences() {
        let (lines, damages, _) = heard(&packets(&row));
        let expected = row["lines"].as_array().expect("a list");
        assert_eq!(lines.len(), expected.len(), "{}: {lines:?}", row["name"]);
        lines.iter().zip(expected).for_each(|(line, known)| assert_same(line, known, &row["name"]));
        assert_eq!(damages.len() as u64, row["damages"], "{}: {damages:?}", row["name"]);
    }
}

#[test]
fn what_is_heard_is_counted_and_told_by_whom_it_was_sent() {
    let (_, _, counts) = heard(&named("another system is not joined"));
    assert_eq!((counts.frames, counts.others, counts.unused), (4, 2, 0));
    assert_eq!(counts.followed.map(|sender| (sender.system, sender.component)), Some((1, 1)));
    let (_, _, counts) = heard(&named("an unknown message is passed over"));
    assert_eq!((counts.frames, counts.others, counts.unused), (2, 0, 1));
}

#[test]
fn damage_is_told_in_a_sentence_with_what_was_found_and_what_is_allowed() {
    let told = |name: &str| heard(&named(name)).1.first().expect("a damage").to_string();
    for (name, sentence) in [
        ("a wrong checksum is told, and what follows is read", "message 30 has a wrong checksum"),
        ("a frame that is cut off is told", "the packet ends within a frame: 37 bytes of 40"),
        ("what is no frame is told", "a frame begins with 0xFD or 0xFE, and here is 0x7B"),
        (
            "a flag that nobody knows is told",
            "a frame has the flags 0x02; the only one known here is 0x01, a signature",
        ),
        (
            "what is no number is told and not passed on",
            "`measurement_deg` of ATTITUDE is no finite number",
        ),
    ] {
        assert_eq!(told(name), sentence, "{name}");
    }
}

/// Any bit, and then any two next to each other, of an attitude and of a set-point in one packet.
#[test]
fn a_flipped_bit_takes_lines_away_and_changes_none() {
    for version in ["version 1", "version 2"] {
        let name = format!(
            "{version}: set-points, speeds and servos beside attitudes, in packets of several frames"
        );
        let packet = named(&name).swap_remove(1);
        let (whole, ..) = heard(std::slice::from_ref(&packet));
        let mut lost = 0;
        for bit in 0..packet.len() * 8 - 1 {
            for flips in [vec![bit], vec![bit, bit + 1]] {
                let mut flipped = packet.clone();
                flips.iter().for_each(|bit| flipped[bit / 8] ^= 1 << (bit % 8));
                let (lines, damages, counts) = heard(&[flipped]);
                let changed = lines.iter().find(|line| !is_part(line, &whole));
                assert_eq!(changed, None, "{version}: bits {flips:?}");
                let is_noticed = !damages.is_empty() || counts.unused > 0;
                // Who signs and what it was signed with is not looked at, and is not here.
                assert!(is_noticed, "{version}: bits {flips:?}");
                lost += usize::from(lines.len() < whole.len());
            }
        }
        assert!(lost > 500, "{version}: {lost}");
    }
}

/// A line that was sent, with or without the set-point, whose own frame may be the damaged one.
fn is_part(line: &Line, whole: &[Line]) -> bool {
    let is_said = |known: &Line| line.iter().all(|value| known.contains(value));
    whole.iter().any(is_said)
}

#[test]
fn a_packet_of_mavlink_is_known_by_its_first_byte_and_no_line_of_json_begins_so() {
    assert!(sequences().iter().flat_map(packets).all(|packet| is_frame(&packet)));
    for other in [b"{\"time_s\":1}".as_slice(), b"", b" {}", b"\n", "é".as_bytes(), &[0xff]] {
        assert!(!is_frame(other), "{other:?}");
    }
}

#[test]
fn an_endless_sender_of_ever_new_systems_is_remembered_in_bounded_memory() {
    let packet = named("version 1: an attitude").swap_remove(0);
    let mut listener = Listener::default();
    for _ in 0..10_000 {
        listener.hear(&packet);
    }
    assert_eq!(listener.counts().frames, 10_000);
    assert!(format!("{listener:?}").len() < 1000, "{listener:?}");
}

/// Bytes that begin like frames more often than not.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let marked =
        (prop::sample::select(vec![0xfd, 0xfe]), prop::collection::vec(any::<u8>(), 0..60));
    let marked = marked.prop_map(|(first, rest)| [vec![first], rest].concat());
    let made: Vec<Vec<u8>> = sequences().iter().flat_map(packets).collect();
    let piece = prop_oneof![marked, prop::sample::select(made)];
    prop::collection::vec(piece, 0..6).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn any_bytes_are_answered_and_every_line_is_of_finite_numbers(packet in bytes(), cut in 0_usize..200) {
        let mut listener = Listener::default();
        let end = packet.len().saturating_sub(cut);
        for line in listener.hear(&packet[..end]).into_iter().flatten() {
            prop_assert!(line.iter().all(|(_, value)| value.is_finite()), "{:?}", line);
            prop_assert_eq!(line.first().map(|(name, _)| *name), Some("time_s"));
            prop_assert!(line.len() <= 32);
        }
    }
}
