//! ArduPilot in the loop and a live autopilot, as the program has them: with peers that speak from the documents.

use std::io::{BufReader, Read as _};
use std::net::{SocketAddr, UdpSocket};
use std::process::Child;
use std::time::Duration;

use serde_json::Value;

use crate::common::{code, fspid, json, started, text};

const STACK: &str = "controller[]={ name = \"sitl\", kind = \"ardupilot\", listen = \"127.0.0.1:0\", elevator_channel = 2, elevator_deg = [-20.0, 20.0], airspeed_m_s = 50.0, altitude_m = 300.0 }";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(code(&fspid(&["init", "pitch.toml"], folder.path())), 0);
    folder
}

/// What a child tells first on standard error that has an address in it, and that address.
fn address(errors: &mut impl std::io::BufRead) -> SocketAddr {
    loop {
        let mut line = String::new();
        assert!(errors.read_line(&mut line).expect("a line") > 0, "no address was told");
        let words = line.split_whitespace().map(|word| word.trim_end_matches(','));
        if let Some(address) = words.filter_map(|word| word.parse().ok()).next() {
            return address;
        }
    }
}

/// What a child answers, tells, and ends with.
fn ended(mut child: Child, mut errors: impl std::io::Read) -> (i32, String, String) {
    let (mut out, mut told) = (String::new(), String::new());
    child.stdout.take().expect("a pipe").read_to_string(&mut out).expect("a text");
    errors.read_to_string(&mut told).expect("a text");
    (child.wait().expect("it ends").code().expect("a code"), out, told)
}

fn socket_to(address: SocketAddr) -> UdpSocket {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    socket.connect(address).expect("an address");
    socket.set_read_timeout(Some(Duration::from_millis(100))).expect("allowed");
    socket
}

/// A flight of 1 s with an ArduPilot whose elevator stands still, or that sends something else at some count.
fn simulated(garbage_at: u32) -> (i32, Value, String) {
    let folder = folder();
    let arguments = [
        "simulate",
        "pitch.toml",
        "--set",
        "loop.duration_s=1",
        "--set",
        STACK,
        "--format",
        "json",
    ];
    let mut child = started(&arguments, folder.path());
    let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
    let socket = socket_to(address(&mut errors));
    let peer = std::thread::spawn(move || {
        let (mut bytes, mut quiet) = ([0; 4096], 0);
        for count in 1.. {
            let mut packet = 18_458_u16.to_le_bytes().to_vec();
            packet.extend(100_u16.to_le_bytes());
            packet.extend((count as u32).to_le_bytes());
            packet.extend([0xDC, 0x05].repeat(16));
            if count as u32 == garbage_at {
                packet.truncate(11);
            }
            let _ = socket.send(&packet);
            // Until nobody flies any more.
            while socket.recv(&mut bytes).is_err() {
                quiet += 1;
                if quiet > 100 {
                    return;
                }
            }
        }
    });
    let (code, out, told) = ended(child, errors);
    peer.join().expect("the peer is content");
    (code, serde_json::from_str(&out).expect("JSON"), told)
}

fn row(answer: &Value) -> String {
    let rows = answer["controllers"].as_array().expect("a list");
    rows.iter().find(|row| row["name"] == "sitl").expect("its row").to_string()
}

#[test]
fn ardupilot_flies_beside_the_controllers_of_a_scenario() {
    let (code, answer, told) = simulated(u32::MAX);
    assert!([0, 1].contains(&code), "{told}");
    assert!(!row(&answer).contains("controller lost"), "{answer}");
    assert!(told.contains("packets repeated 0, missing 0, late 0, of others 0"), "{told}");
}

#[test]
fn what_it_does_wrong_is_a_verdict_and_the_code_is_1() {
    let (code, answer, told) = simulated(30);
    assert_eq!(code, 1, "{told}");
    let row = row(&answer);
    assert!(row.contains("sent a packet of 11 bytes; allowed are 40"), "{row}");
}

#[test]
fn many_flights_are_refused_by_name() {
    let folder = folder();
    let init = ["init", "--template", "campaign", "campaign.toml"];
    assert_eq!(code(&fspid(&init, folder.path())), 0);
    let output = fspid(
        &[
            "campaign",
            "run",
            "campaign.toml",
            "--runs",
            "4",
            "--quiet",
            "--out",
            "run",
            "--set",
            STACK,
        ],
        folder.path(),
    );
    assert_eq!(code(&output), 2, "{}", text(&output.stderr));
    let told = text(&output.stderr);
    assert!(
        told.contains("ArduPilot in the loop: it flies once for each start of its own"),
        "{told}"
    );
}

const NAVION: &str = r#"
schema = 1
name = "ArduPilot in a Navion"
[aircraft]
name = "navion"
airspeed_m_s = 54.0
altitude_m = 500.0
[loop]
sample_period_s = 0.01
duration_s = 2.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
at_s = 0.0
[[controller]]
name = "sitl"
kind = "ardupilot"
listen = "127.0.0.1:0"
elevator_channel = 2
elevator_deg = [-20.0, 20.0]
throttle_channel = 3
"#;

fn numbers(line: &Value, path: &str) -> [f64; 3] {
    std::array::from_fn(|axis| {
        line.pointer(path).and_then(|it| it[axis].as_f64()).unwrap_or_else(|| panic!("{path}"))
    })
}

/// What is told of a trimmed aircraft hangs together, and its throttle follows a channel.
#[test]
fn an_aircraft_tells_all_of_its_motion_and_its_throttle_follows() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("navion.toml"), NAVION).expect("written");
    let arguments = ["simulate", "navion.toml", "--trace", "flown.csv", "--format", "json"];
    let mut child = started(&arguments, folder.path());
    let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
    let socket = socket_to(address(&mut errors));
    socket.set_read_timeout(Some(Duration::from_secs(60))).expect("allowed");
    let peer = std::thread::spawn(move || {
        let (mut bytes, mut lines) = ([0; 4096], Vec::<Value>::new());
        for count in 1_u32..=202 {
            let mut packet = 18_458_u16.to_le_bytes().to_vec();
            packet.extend(100_u16.to_le_bytes());
            packet.extend(count.to_le_bytes());
            // Full throttle from the second sample on.
            let throttle_us: u16 = if count > 2 { 2000 } else { 1500 };
            for channel in 1..=16 {
                packet.extend((if channel == 3 { throttle_us } else { 1500 }).to_le_bytes());
            }
            let _ = socket.send(&packet);
            if count <= 201 {
                let length = socket.recv(&mut bytes).expect("a line");
                lines.push(serde_json::from_slice(&bytes[..length]).expect("JSON"));
            }
        }
        lines
    });
    let (_, out, told) = ended(child, errors);
    let lines = peer.join().expect("content");
    assert!(out.contains("sitl") && !out.contains("controller lost"), "{out}\n{told}");
    // At the trim: still, level, and a weight upwards.
    let [north_m_s, east_m_s, down_m_s] = numbers(&lines[0], "/velocity");
    assert!((north_m_s - 54.0).abs() < 1e-9 && east_m_s.abs() < 1e-9 && down_m_s.abs() < 1e-9);
    let [x, y, z] = numbers(&lines[0], "/imu/accel_body");
    let weight_m_s2 = (x * x + y * y + z * z).sqrt();
    assert!((weight_m_s2 - 9.80665).abs() < 1e-3, "{weight_m_s2}");
    let [bank, pitch, _] = numbers(&lines[0], "/attitude");
    assert!(bank.abs() < 1e-9 && (x.atan2(-z) - pitch).abs() < 1e-6, "{pitch} {x} {z}");
    assert!((numbers(&lines[0], "/position")[2] + 500.0).abs() < 1e-9);
    // Later: ways are what velocities add up to, by Simpson's rule.
    for axis in 0..3 {
        let velocity = |k: usize| numbers(&lines[k], "/velocity")[axis];
        let way = numbers(&lines[200], "/position")[axis] - numbers(&lines[0], "/position")[axis];
        let sum: f64 = (0..200)
            .step_by(2)
            .map(|k| velocity(k) + 4.0 * velocity(k + 1) + velocity(k + 2))
            .sum();
        // The throttle jumps at two samples, which Simpson's rule does not like.
        assert!((sum * 0.01 / 3.0 - way).abs() < 1e-4, "{axis}: {way} {sum}");
    }
    let flown = std::fs::read_to_string(folder.path().join("flown.csv")).expect("a trace");
    let rows: Vec<Vec<&str>> = flown.lines().map(|row| row.split(',').collect()).collect();
    let place = rows[0].iter().position(|name| name.ends_with("throttle")).expect("a column");
    let throttle = |row: usize| rows[row][place].parse::<f64>().expect("a number");
    assert!(throttle(201) > throttle(1) + 1e-3, "{} {}", throttle(1), throttle(201));
    assert!((throttle(50) - throttle(201)).abs() < 1e-12);
}

/// ATTITUDE of system 1, component 1: pitch 0.125 rad and 0.5 rad/s, 2 s after the start.
const ATTITUDE: [u8; 36] = [
    0xfe, 28, 0, 1, 1, 30, 0xd0, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x3e, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0x3f, 0, 0, 0, 0, 0x14, 0x99,
];

#[test]
fn a_live_autopilot_is_flown_and_gets_its_channel_back() {
    let folder = folder();
    let arguments = [
        "drive",
        "pitch.toml",
        "--controller",
        "FSPID",
        "--send",
        "override",
        "--channel",
        "3",
        "--listen",
        "127.0.0.1:0",
        "--stale",
        "10",
        "--trace",
        "flown.csv",
        "--format",
        "json",
        "--set",
        "loop.duration_s=0.5",
    ];
    let mut child = started(&arguments, folder.path());
    let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
    let to = address(&mut errors);
    // Without a connection: who is not there any more takes nothing of what came before.
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let peer = std::thread::spawn(move || {
        let (mut pulses, mut quiet, mut bytes) = (Vec::new(), 0, [0; 512]);
        socket.set_read_timeout(Some(Duration::from_millis(2))).expect("allowed");
        while pulses.is_empty() || quiet < 500 {
            let _ = socket.send_to(&ATTITUDE, to);
            match socket.recv_from(&mut bytes) {
                Ok(_) if bytes[7] == 70 => {
                    quiet = 0;
                    pulses.push(u16::from_le_bytes([bytes[14], bytes[15]]));
                }
                Ok(_) => quiet = 0,
                Err(_) => quiet += 1,
            }
        }
        pulses
    });
    let (code, out, told) = ended(child, errors);
    let pulses = peer.join().expect("content");
    assert_eq!(code, 0, "{told}");
    let answer: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((&answer["samples"], &answer["held"]), (&51.into(), &0.into()), "{answer}");
    assert_eq!(pulses.len(), 54);
    assert_eq!(pulses[51..], [0; 3]);
    assert!(pulses[..51].iter().all(|pulse_us| (1000..=2000).contains(pulse_us)), "{pulses:?}");
    let flown = std::fs::read_to_string(folder.path().join("flown.csv")).expect("a trace");
    assert_eq!(flown.lines().count(), 52);
}

/// SIGTERM ended the program where it stood, and the autopilot's channel stayed overridden.
#[cfg(unix)]
#[test]
fn a_live_autopilot_gets_its_channel_back_from_a_program_that_is_terminated() {
    // A terminal that closes is told twice, by the system and by a shell; who started this test with `nohup` ignores it.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let hears_hangups =
        ignored.is_some_and(|mask| !mask.ends_with(['1', '3', '5', '7', '9', 'b', 'd', 'f']));
    let all = [["-TERM", "-TERM"], ["-INT", "-INT"], ["-HUP", "-HUP"], ["-HUP", "-TERM"]];
    for signals in all.into_iter().take(if hears_hangups { 4 } else { 2 }) {
        let folder = folder();
        let words = "drive pitch.toml --controller FSPID --send override --listen 127.0.0.1:0 --stale 10 \
                     --set loop.duration_s=300";
        let arguments: Vec<&str> = words.split_whitespace().collect();
        let mut child = started(&arguments, folder.path());
        let id = child.id().to_string();
        let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
        let to = address(&mut errors);
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        socket.set_read_timeout(Some(Duration::from_millis(2))).expect("allowed");
        let peer = std::thread::spawn(move || {
            let (mut pulses, mut bytes, mut asked) = (Vec::new(), [0; 512], false);
            while pulses.iter().filter(|&&pulse| pulse == 0_u16).count() < 3 {
                let _ = socket.send_to(&ATTITUDE, to);
                if socket.recv_from(&mut bytes).is_ok() && bytes[7] == 70 {
                    pulses.push(u16::from_le_bytes([bytes[12], bytes[13]]));
                }
                if pulses.len() >= 5 && !asked {
                    asked = signals.into_iter().all(|signal| {
                        let mut kill = std::process::Command::new("kill");
                        kill.args([signal, &id]).status().is_ok_and(|status| status.success())
                    });
                }
            }
            pulses
        });
        let (code, _, told) = ended(child, errors);
        assert_eq!(code, 130, "{told}");
        let pulses = peer.join().expect("content");
        let flown = &pulses[..pulses.len() - 3];
        assert!(flown.iter().all(|pulse_us| (1000..=2000).contains(pulse_us)), "{pulses:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_that_is_terminated_says_so_though_nobody_takes_its_answer() {
    let folder = folder();
    let words = "drive pitch.toml --controller FSPID --send override --listen 127.0.0.1:0";
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(words.split(' '))
        .current_dir(folder.path())
        .stdout(std::fs::File::options().write(true).open("/dev/full").expect("a device"))
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
    let to = address(&mut errors);
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let mut bytes = [0; 512];
    socket.set_read_timeout(Some(Duration::from_millis(2))).expect("allowed");
    while socket.recv_from(&mut bytes).is_err() {
        let _ = socket.send_to(&ATTITUDE, to);
    }
    let mut kill = std::process::Command::new("kill");
    assert!(kill.args(["-TERM", &child.id().to_string()]).status().expect("kill").success());
    let mut told = String::new();
    errors.read_to_string(&mut told).expect("a text");
    assert_eq!(child.wait().expect("it ends").code(), Some(130), "{told}");
    assert!(told.contains("given back"), "{told}");
}

/// Who says `nohup` wants it to go on when the terminal closes.
#[cfg(target_os = "linux")]
#[test]
fn a_command_that_nohup_started_outlives_its_terminal() {
    let folder = folder();
    let program = env!("CARGO_BIN_EXE_fspid");
    let script = format!(
        "trap '' HUP; exec {program} drive pitch.toml --controller FSPID --send target \
                          --listen 127.0.0.1:0 --connect-limit 1"
    );
    let mut child = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder.path())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("a shell");
    let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
    address(&mut errors);
    let killed =
        std::process::Command::new("kill").args(["-HUP", &child.id().to_string()]).status();
    assert!(killed.is_ok_and(|status| status.success()));
    let (code, _, told) = ended(child, errors);
    assert_eq!(code, 1, "{told}");
}

#[test]
fn where_no_autopilot_is_the_code_is_1_and_says_so() {
    let folder = folder();
    let output = fspid(
        &[
            "drive",
            "pitch.toml",
            "--controller",
            "FSPID",
            "--send",
            "target",
            "--listen",
            "127.0.0.1:0",
            "--connect-limit",
            "0.1",
            "--format",
            "json",
        ],
        folder.path(),
    );
    assert_eq!(code(&output), 1);
    let ending = json(&output)["ending"].to_string();
    assert!(ending.contains("no ATTITUDE came within 0.1 s"), "{ending}");
}
