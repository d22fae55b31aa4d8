//! A fake PX4, and flights with it.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use super::*;

/// The checksum of MAVLink: CRC-16/MCRF4XX, as "MAVLink packet serialization" has it.
fn checksum(bytes: impl Iterator<Item = u8>) -> u16 {
    bytes.fold(0xFFFF, |crc: u16, byte| {
        let mut low = byte ^ (crc & 0xFF) as u8;
        low ^= low << 4;
        let low = u16::from(low);
        (crc >> 8) ^ (low << 8) ^ (low << 3) ^ (low >> 4)
    })
}

/// A frame of MAVLink 2 and the byte that its checksum ends with.
fn frame(id: u32, extra: u8, payload: &[u8]) -> Vec<u8> {
    let [low, middle, high, _] = id.to_le_bytes();
    let mut bytes = vec![0xFD, payload.len() as u8, 0, 0, 7, 1, 1, low, middle, high];
    bytes.extend(payload);
    let sum = checksum(bytes[1..].iter().copied().chain([extra]));
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// HIL_ACTUATOR_CONTROLS, message 93, whose checksum ends with 47: time, flags, controls, mode.
fn controls(time_us: u64, flags: u64, elevator: f32) -> Vec<u8> {
    let mut payload = time_us.to_le_bytes().to_vec();
    payload.extend(flags.to_le_bytes());
    for channel in 0..16 {
        let value: f32 = if channel == 1 { elevator } else { 0.0 };
        payload.extend(value.to_le_bytes());
    }
    payload.push(128);
    frame(93, 47, &payload)
}

/// HEARTBEAT, message 0, whose checksum ends with 50.
fn heartbeat() -> Vec<u8> {
    frame(0, 50, &[0, 0, 0, 0, 1, 12, 81, 4, 3])
}

/// What is told of a sample.
#[derive(Default)]
struct Seen {
    time_us: u64,
    rate_rad_s: f64,
    pitch_rad: f64,
    rc_us: u64,
    heights_mm: Vec<i32>,
    beats: usize,
}

/// A fake PX4: controls out, sensors in.
struct FakePx4(TcpStream);

impl FakePx4 {
    fn at(address: SocketAddr) -> Self {
        let stream = TcpStream::connect(address).expect("a connection");
        stream.set_nodelay(true).expect("allowed");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("allowed");
        Self(stream)
    }

    fn send(&mut self, bytes: &[u8]) {
        let _ = self.0.write_all(bytes);
    }

    /// Hears messages until sensors come; nothing once nobody flies any more.
    fn hear(&mut self) -> Option<Seen> {
        let mut seen = Seen::default();
        loop {
            let mut head = [0; 10];
            self.0.read_exact(&mut head).ok()?;
            assert_eq!(head[0], 0xFD);
            let mut rest = vec![0; usize::from(head[1]) + 2];
            self.0.read_exact(&mut rest).expect("bytes");
            let (sent, sum) = rest.split_at(rest.len() - 2);
            let extra = |id| match id {
                0 => 50,
                92 => 54,
                107 => 108,
                113 => 124,
                115 => 4,
                other => panic!("message {other}"),
            };
            let id = head[7];
            let whole = head[1..].iter().chain(sent).copied().chain([extra(id)]);
            assert_eq!(checksum(whole).to_le_bytes(), sum, "message {id}");
            // Zeros at the end are left out.
            let mut payload = sent.to_vec();
            payload.resize(255, 0);
            let at = |place: usize| payload[place..place + 4].try_into().expect("four");
            let single = |place: usize| f64::from(f32::from_le_bytes(at(place)));
            match id {
                0 => seen.beats += 1,
                92 => seen.rc_us = u64::from(u16::from_le_bytes([payload[10], payload[11]])),
                113 => seen.heights_mm.push(i32::from_le_bytes(at(16))),
                115 => {
                    let [w, x, y, z] = [8, 12, 16, 20].map(single);
                    seen.pitch_rad = (2.0 * (w * y - z * x)).asin();
                }
                _ => {
                    seen.time_us = u64::from_le_bytes(payload[..8].try_into().expect("eight"));
                    seen.rate_rad_s = single(24);
                    return Some(seen);
                }
            }
        }
    }
}

/// A controller without the difference of a pitch that is rounded to 32 bits.
fn calm() -> Pilot {
    let gains = Gains { kp: 1.2, ki: 0.4, kd: 0.0 };
    let config = PidConfig { rate_gain_s: 0.5, ..PidConfig::sampled_every(DT_S) };
    let pid = Controller::Fixed(Pid::new(gains, config).expect("allowed"));
    Pilot { pid, state: State::new() }
}

/// What the pilot makes of a sample: its command over the elevator's whole way.
fn control(pilot: &mut Pilot, seen: &Seen) -> f32 {
    let command_rad = pilot.command_rad(seen.rc_us, seen.pitch_rad, seen.rate_rad_s);
    (command_rad / FULL_RAD) as f32
}

const ROWS: usize = 301;

/// Flies until the end, with somebody who says what else is sent before and behind the answer at a time, of samples
/// behind the step of the set-point. Samples before the flight are at rest, and leave a controller at rest.
fn fly_with(
    address: SocketAddr,
    mut beside: impl FnMut(usize, u64) -> [Vec<u8>; 2],
) -> (usize, usize) {
    let (mut peer, mut pilot) = (FakePx4::at(address), calm());
    let (mut fixes, mut beats, mut samples, mut behind_step) = (0, 0, 0_usize, 0);
    // It begins late: what was told before is not answered, and is no part of the flight.
    let woken = [peer.hear(), peer.hear()].map(|seen| seen.expect("a sample").time_us);
    assert_eq!(woken, [10_000, 20_000]);
    peer.send(&controls(woken[1], 1, 0.9));
    while let Some(seen) = peer.hear() {
        samples += 1;
        fixes += seen.heights_mm.len();
        beats += seen.beats;
        assert!(seen.heights_mm.iter().all(|height_mm| *height_mm == 300_000));
        behind_step += usize::from(seen.rc_us != 1500);
        let [before, behind] = match behind_step {
            0 => [Vec::new(), Vec::new()],
            _ => beside(behind_step, seen.time_us),
        };
        peer.send(&before);
        let control = control(&mut pilot, &seen);
        peer.send(&controls(seen.time_us, 1, control));
        peer.send(&behind);
    }
    // One a second.
    assert!(beats.abs_diff(samples / 100) <= 1, "{beats} {samples}");
    (fixes, samples)
}

/// Of a flight over the wire no number is further from that of the same controller inside than this, rad and rad/s.
///
/// A quaternion of 32 bits is off by half a unit in its last place, 3·10⁻⁸ of each part, so that its pitch is off by
/// some 10⁻⁷, as are the rate and the control; the command is off by (1.2 + 0.5) of that, and the loop, which is damped,
/// makes a few times that of an error that stands.
const SINGLE: f64 = 2e-6;

fn assert_near(trace: &Trace) {
    let scenario = scenario(stack(Protocol::Px4), 30.0);
    let prepared = scenario.prepare().expect("allowed");
    let (mut pilot, mut rows) = (calm(), Vec::new());
    fly_commanded(
        &prepared,
        |sample| pilot.pid.step(&mut pilot.state, sample).command_rad,
        |instant| {
            rows.push([instant.theta_rad, instant.q_rad_s, instant.step.command_rad]);
            std::ops::ControlFlow::Continue(())
        },
    )
    .expect("flies");
    assert_eq!(trace.outcome, Outcome::Completed);
    assert_eq!(trace.rows(), rows.len());
    for (k, row) in rows.iter().enumerate() {
        let found = [trace.theta_rad[k], trace.q_rad_s[k], trace.command_rad[k]];
        let far = row.iter().zip(found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far < SINGLE, "{k}: {row:?} {found:?}");
    }
    assert!((trace.theta_rad[ROWS - 1] - STEP_RAD).abs() < 0.02, "{:?}", trace.theta_rad.last());
}

/// The flight with two samples told in vain before it.
fn woken(beside: impl FnMut(usize, u64) -> [Vec<u8>; 2] + Send + 'static) -> (Trace, String) {
    flown(&scenario(stack(Protocol::Px4), 30.0), |address| {
        let (fixes, samples) = fly_with(address, beside);
        // Five a second, of a hundred samples a second.
        assert!(fixes.abs_diff(samples / 20) <= 1, "{fixes} {samples}");
    })
}

#[test]
fn a_controller_over_the_wire_flies_as_the_same_one_inside_but_for_32_bits() {
    let (trace, told) = woken(|_, _| [heartbeat(), heartbeat()]);
    assert_near(&trace);
    assert!(told.contains("before the flight; packets repeated 0, missing 0, late 0"), "{told}");
    assert!(!told.contains("armed"), "{told}");
}

#[test]
fn repeated_and_late_controls_are_counted_and_move_nothing() {
    let (trace, told) = woken(|k, time_us| {
        let late = if k % 100 == 5 { controls(time_us - 1, 1, 1.0) } else { Vec::new() };
        let again = if k % 100 == 40 { controls(time_us, 1, -1.0) } else { Vec::new() };
        [late, again]
    });
    assert_near(&trace);
    assert!(told.contains("packets repeated 3, missing 0, late 3"), "{told}");
}

#[test]
fn a_frame_in_pieces_is_a_frame() {
    let (trace, _) = flown(&scenario(stack(Protocol::Px4), 30.0), |address| {
        let (mut peer, mut pilot) = (FakePx4::at(address), calm());
        while let Some(seen) = peer.hear() {
            let bytes = controls(seen.time_us, 1, control(&mut pilot, &seen));
            let piece = if seen.time_us % 500_000 == 0 { 7 } else { 200 };
            bytes.chunks(piece).for_each(|piece| peer.send(piece));
        }
    });
    assert_near(&trace);
}

/// What is lost with a peer that answers eleven samples and then does something else, and how many it answered, those
/// before the flight among them.
fn lost_by(limit_s: f64, then: impl FnOnce(FakePx4, u64) + Send + 'static) -> (usize, String) {
    let (trace, told) = flown(&scenario(stack(Protocol::Px4), limit_s), |address| {
        let mut peer = FakePx4::at(address);
        for _ in 0..11 {
            let seen = peer.hear().expect("a sample");
            peer.send(&controls(seen.time_us, 1, 0.0));
        }
        let seen = peer.hear().expect("a sample");
        then(peer, seen.time_us);
    });
    let (rows, words) = loss(&trace);
    let lead = told.split_once(" samples told, ").and_then(|(_, rest)| rest.split(' ').next());
    (rows + lead.and_then(|lead| lead.parse::<usize>().ok()).expect("a number"), words)
}

#[test]
fn whatever_else_it_does_is_a_verdict_in_words() {
    // Kept until nobody waits any more.
    let send_within = |limit_s: f64, bytes: fn(u64) -> Vec<u8>| {
        lost_by(limit_s, move |mut peer, time_us| {
            peer.send(&bytes(time_us));
            let _ = std::io::copy(&mut peer.0, &mut std::io::sink());
        })
    };
    let send = |bytes| send_within(30.0, bytes);
    let words = |words: &str| (11, words.to_owned());
    assert_eq!(lost_by(30.0, |peer, _| drop(peer)), words("closed its connection"));
    assert_eq!(
        send(|time_us| controls(time_us, 1, f32::NAN)),
        words("answered a command that is not finite")
    );
    assert_eq!(
        send(|_| b"GET / HTTP/1.1\r\n\r\n".to_vec()),
        words("sent what is no whole frame of MAVLink")
    );
    let damaged = |time_us| {
        let mut bytes = controls(time_us, 1, 0.0);
        bytes[30] ^= 1;
        bytes
    };
    assert_eq!(send(damaged), words("sent what is no whole frame of MAVLink"));
    assert_eq!(
        send(|time_us| controls(time_us, 0, 0.0)),
        words(
            "does not fly in lockstep, so that its controls belong to no sample; allowed is a build with it"
        )
    );
    // How many samples are flown before depends on how busy the machine is.
    let silent = "gave no answer within 1.0 s";
    assert_eq!(send_within(1.0, |_| Vec::new()).1, silent);
    assert_eq!(send_within(1.0, |time_us| controls(time_us - 10_000, 1, 0.0)).1, silent);
}

#[test]
fn who_does_not_come_or_never_wakes_is_lost_at_the_first_sample() {
    let lost = |limit_s: f64, peer: fn(SocketAddr)| {
        let mut stack = stack(Protocol::Px4);
        stack.connect_limit_s = limit_s;
        loss(&flown(&scenario(stack, 30.0), peer).0)
    };
    assert_eq!(lost(0.05, |_| {}), (0, "did not come within 0.05 s".to_owned()));
    let sleeps = |address| {
        let mut peer = FakePx4::at(address);
        let _ = std::io::copy(&mut peer.0, &mut std::io::sink());
    };
    assert_eq!(lost(0.3, sleeps), (0, "did not come within 0.3 s".to_owned()));
}
