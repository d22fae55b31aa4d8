//! Arbitrary bytes.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use fspid_scenario::file;
use fspid_study::fly::{Angles, Pilot};

use super::{SCENARIO, said};

/// Pieces of lines and of what has nothing to do with them.
const PIECES: [&[u8]; 22] = [
    b"5 ",
    b"0.1 ",
    b"0.01 ",
    b"-3e8 ",
    b"1e308 ",
    b"-1e-320 ",
    b"nan ",
    b"-inf ",
    b",",
    b",,",
    b"\n",
    b"\n",
    b"\r\n",
    b"# ",
    b"reset\n",
    b"reset",
    b"\0",
    b"\xff\xfe",
    b"\xEF\xBB\xBF",
    b"x",
    b"5 4 0.01 2\n",
    b"1,2,0.01\n",
];

fn noise(random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = Vec::new();
    for _ in 0..random.next_u32() % 200 {
        let choice = random.next_u32();
        match PIECES.get((choice % 24) as usize) {
            Some(piece) => bytes.extend_from_slice(piece),
            None => bytes.extend_from_slice(&choice.to_le_bytes()),
        }
    }
    bytes
}

/// How many lines of it want an answer.
fn requests(bytes: &[u8]) -> usize {
    let text = |line: &[u8]| {
        line.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line).trim_ascii().first().copied()
    };
    let lines = bytes.split(|&byte| byte == b'\n');
    lines.filter(|line| text(line).is_some_and(|first| first != b'#')).count()
}

#[test]
fn whatever_the_bytes_each_request_gets_one_finite_answer() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for round in 0..3000 {
        let bytes = noise(&mut random);
        let name = ["P", "PID", "FSPID"][round % 3];
        let angles = [Angles::Degrees, Angles::Radians][round % 2];
        let mut pilot = pilot_of(&mut random, name, angles);
        let (answers, told) = said(&mut pilot, &bytes);
        assert_eq!(answers.lines().count(), requests(&bytes), "{}", bytes.escape_ascii());
        for answer in answers.lines().filter(|&answer| answer != "ok") {
            let command: f64 = answer.parse().expect("a number");
            assert!(command.is_finite() && format!("{command:?}") == answer, "{answer}");
        }
        assert!(told.len() < 4096);
    }
}

/// Now and then one with the largest gain that there may be.
fn pilot_of(random: &mut ChaCha8Rng, name: &str, angles: Angles) -> Pilot {
    let gain = ["1", "1e9", "1e100"][(random.next_u32() % 3) as usize];
    let change = format!("controller.P.kp={gain}");
    let study = file::parse(SCENARIO, "scenario.toml", None, &[change]).expect("still good");
    Pilot::new(&study.scenario, Some(name), angles).expect("one of the three")
}
