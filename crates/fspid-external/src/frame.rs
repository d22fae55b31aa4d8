//! What both sides write: numbers of fixed places, in the order of bytes of the machine that both run on.
//!
//! A process begins with one [`Start`]; each sample is answered by one answer with the sample's number.

use std::io::{self, Read, Write};

use fspid_sim::core::{Faults, Gains, Sample, Step};

/// Longest text of a refusal, in bytes.
const LONGEST_TEXT: usize = 4096;
/// Bytes of a sample: three numbers.
const SAMPLE: usize = 24;
/// Bytes of an answer: the sample's number, command, three gains, whether the command was cut, faults.
const ANSWER: usize = 48;

/// The first words of a process.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Start {
    /// The controller is at rest. Its period, s; 0 where it has none.
    Ready { period_s: f64 },
    /// It cannot fly.
    Refused { reason: String, allowed: String },
}

impl Start {
    pub(crate) fn write(&self, to: &mut impl Write) -> io::Result<()> {
        let mut bytes = Vec::new();
        match self {
            Self::Ready { period_s } => {
                bytes.push(0);
                bytes.extend(period_s.to_ne_bytes());
            }
            Self::Refused { reason, allowed } => {
                bytes.push(1);
                for text in [reason, allowed] {
                    let text = text.as_bytes();
                    let text = text.get(..text.len().min(LONGEST_TEXT)).unwrap_or_default();
                    bytes.extend((text.len() as u32).to_ne_bytes());
                    bytes.extend(text);
                }
            }
        }
        to.write_all(&bytes)
    }

    pub(crate) fn read(from: &mut impl Read) -> io::Result<Self> {
        match read::<1>(from)? {
            [0] => Ok(Self::Ready { period_s: f64::from_ne_bytes(read(from)?) }),
            [1] => Ok(Self::Refused { reason: text(from)?, allowed: text(from)? }),
            _ => Err(io::ErrorKind::InvalidData.into()),
        }
    }
}

pub(crate) fn text(from: &mut impl Read) -> io::Result<String> {
    let length = u32::from_ne_bytes(read(from)?) as usize;
    let mut bytes = vec![0; length.min(LONGEST_TEXT)];
    from.read_exact(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

pub(crate) fn read<const N: usize>(from: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    from.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// Numbers, one behind the other.
pub(crate) fn numbers<const N: usize>(bytes: &[u8]) -> [f64; N] {
    let mut found = [0.0; N];
    for (number, bytes) in found.iter_mut().zip(bytes.chunks_exact(8)) {
        *number = f64::from_ne_bytes(bytes.try_into().unwrap_or_default());
    }
    found
}

pub(crate) fn write_sample(to: &mut impl Write, sample: &Sample<f64>) -> io::Result<()> {
    let mut bytes = [0; SAMPLE];
    let values = [sample.setpoint_rad, sample.measurement_rad, sample.rate_rad_s];
    for (place, value) in bytes.chunks_exact_mut(8).zip(values) {
        place.copy_from_slice(&value.to_ne_bytes());
    }
    to.write_all(&bytes)
}

pub(crate) fn read_sample(from: &mut impl Read) -> io::Result<Sample<f64>> {
    let [setpoint_rad, measurement_rad, rate_rad_s] = numbers(&read::<SAMPLE>(from)?);
    Ok(Sample { setpoint_rad, measurement_rad, rate_rad_s })
}

/// The number of no sample: there is a status in place of an answer.
const REFUSED: u64 = u64::MAX;

/// That there is no answer, and the status with which.
pub(crate) fn write_refusal(to: &mut impl Write, status: i32) -> io::Result<()> {
    let mut bytes = [0; ANSWER];
    let all = REFUSED.to_ne_bytes().into_iter().chain(status.to_ne_bytes());
    bytes.iter_mut().zip(all).for_each(|(place, byte)| *place = byte);
    to.write_all(&bytes)
}

/// The answer to the sample of that number.
pub(crate) fn write_answer(to: &mut impl Write, number: u64, step: &Step<f64>) -> io::Result<()> {
    let Gains { kp, ki, kd } = step.gains;
    let mut bytes = [0; ANSWER];
    let values = [step.command_rad, kp, ki, kd].map(f64::to_ne_bytes);
    let ends = [u32::from(step.saturated), u32::from(step.faults.bits())].map(u32::to_ne_bytes);
    let all = [number.to_ne_bytes()].into_iter().chain(values).flatten();
    let all = all.chain(ends.into_iter().flatten());
    bytes.iter_mut().zip(all).for_each(|(place, byte)| *place = byte);
    to.write_all(&bytes)
}

/// The next answer and the number of its sample, or the status in its place.
pub(crate) fn read_answer(from: &mut impl Read) -> io::Result<Result<(u64, Step<f64>), i32>> {
    let bytes = read::<ANSWER>(from)?;
    let word = |at: usize| {
        let bytes = bytes.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
        u32::from_ne_bytes(bytes.unwrap_or_default())
    };
    if bytes.starts_with(&REFUSED.to_ne_bytes()) {
        return Ok(Err(i32::from_ne_bytes(word(8).to_ne_bytes())));
    }
    let [number, command_rad, kp, ki, kd] = numbers(&bytes);
    let step = Step {
        command_rad,
        gains: Gains { kp, ki, kd },
        saturated: word(40) != 0,
        faults: Faults::from_bits((word(44) & 0xff) as u8),
    };
    Ok(Ok((number.to_bits(), step)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_with_the_same_bits() {
        let mut bytes = Vec::new();
        let sample = Sample { setpoint_rad: 0.1, measurement_rad: -0.0, rate_rad_s: f64::INFINITY };
        write_sample(&mut bytes, &sample).expect("memory");
        assert_eq!(read_sample(&mut bytes.as_slice()).expect("a sample"), sample);
        let gains = Gains { kp: 1.5, ki: -2.0, kd: 5e-324 };
        let faults = Faults::OVERFLOW;
        let step = Step { command_rad: -0.3, gains, saturated: true, faults };
        bytes.clear();
        write_answer(&mut bytes, 7, &step).expect("memory");
        assert_eq!(read_answer(&mut bytes.as_slice()).expect("a frame"), Ok((7, step)));
        bytes.clear();
        write_refusal(&mut bytes, 3).expect("memory");
        assert_eq!(read_answer(&mut bytes.as_slice()).expect("a frame"), Err(3));
    }

    #[test]
    fn a_refusal_keeps_its_words_and_what_is_no_start_is_refused() {
        let refused = Start::Refused { reason: "no".to_owned(), allowed: "yes".to_owned() };
        for start in [refused, Start::Ready { period_s: 0.01 }] {
            let mut bytes = Vec::new();
            start.write(&mut bytes).expect("memory");
            assert_eq!(Start::read(&mut bytes.as_slice()).expect("a start"), start);
        }
        assert!(Start::read(&mut [9_u8].as_slice()).is_err());
    }
}
