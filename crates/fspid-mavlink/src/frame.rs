//! Frames of MAVLink 1 and 2 in a packet: where each ends, and whether it is what was sent.

use mavlink::dialects::common::MavMessage;
use mavlink::{MAV_STX, MAV_STX_V2, MavlinkVersion, Message as _, calculate_crc};

/// Bytes before the payload, the first one among them.
const HEAD_V1: usize = 6;
const HEAD_V2: usize = 10;
const CHECKSUM: usize = 2;
/// Bytes behind the checksum of a frame that is signed.
const SIGNATURE: usize = 13;
/// The flag that says so. A frame with another one is not to be read by who does not know it.
const SIGNED: u8 = 1;

/// What is wrong with bytes or with a message.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Damage {
    /// Something else stands where a frame should begin.
    #[error("a frame begins with 0xFD or 0xFE, and here is {byte:#04X}")]
    NoFrame {
        /// What stands there.
        byte: u8,
    },
    /// The packet ends within a frame.
    #[error("the packet ends within a frame: {left} bytes of {needed}")]
    CutOff {
        /// Bytes that the frame has.
        needed: usize,
        /// Bytes that there are.
        left: usize,
    },
    /// A frame has a flag that changes its form.
    #[error("a frame has the flags {flags:#04X}; the only one known here is 0x01, a signature")]
    Flags {
        /// All flags.
        flags: u8,
    },
    /// What came is not what was sent.
    #[error("message {id} has a wrong checksum")]
    Checksum {
        /// Number of the message.
        id: u32,
    },
    /// A message does not hold what it should.
    #[error("message {id} cannot be read: {reason}")]
    Unreadable {
        /// Number of the message.
        id: u32,
        /// Why.
        reason: String,
    },
    /// A message holds a value that is no number.
    #[error("`{name}` of {message} is no finite number")]
    NotFinite {
        /// The message.
        message: &'static str,
        /// The value as lines name it.
        name: &'static str,
    },
    /// A quaternion is none of a rotation.
    #[error("the quaternion of ATTITUDE_TARGET has the square {square}; allowed is 0.99 to 1.01")]
    NoRotation {
        /// Sum of the squares of its parts.
        square: f64,
    },
}

/// True for a packet of MAVLink, by its first byte, with which no line of JSON begins.
#[must_use]
pub fn is_frame(packet: &[u8]) -> bool {
    packet.first().is_some_and(|byte| [MAV_STX, MAV_STX_V2].contains(byte))
}

/// A frame whose bytes are those that were sent, or whose message is not known, so that nobody can say.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<'a> {
    pub(crate) version: MavlinkVersion,
    pub(crate) system: u8,
    pub(crate) component: u8,
    pub(crate) id: u32,
    pub(crate) payload: &'a [u8],
}

/// The frames of a packet. A packet holds whole frames: what stands behind bytes that are none is not looked at.
pub(crate) struct Frames<'a>(pub(crate) &'a [u8]);

impl Frames<'_> {
    /// Bytes of the whole frame in front of others.
    pub(crate) fn first_length(bytes: &[u8]) -> Option<usize> {
        let mut frames = Frames(bytes);
        frames.next()?.ok()?;
        Some(bytes.len() - frames.0.len())
    }
}

impl<'a> Iterator for Frames<'a> {
    type Item = Result<Frame<'a>, Damage>;

    fn next(&mut self) -> Option<Self::Item> {
        let first = *self.0.first()?;
        let found = match first {
            MAV_STX => v1(self.0),
            MAV_STX_V2 => v2(self.0),
            byte => Err(Damage::NoFrame { byte }),
        };
        let (found, rest) = match found {
            Ok((frame, rest)) => (checked(frame), rest),
            Err(damage) => (Err(damage), [].as_slice()),
        };
        self.0 = rest;
        Some(found)
    }
}

/// A frame, what its checksum is of, and the checksum.
type Parts<'a> = (Frame<'a>, &'a [u8], u16);

fn v1(packet: &[u8]) -> Result<(Parts<'_>, &[u8]), Damage> {
    let [head, payload, rest] = parted(packet, HEAD_V1, 0)?;
    let (system, component, id) = match head {
        [.., system, component, id] => (*system, *component, u32::from(*id)),
        _ => return Err(cut_off(HEAD_V1, packet)),
    };
    ended(Frame { version: MavlinkVersion::V1, system, component, id, payload }, packet, rest, 0)
}

fn v2(packet: &[u8]) -> Result<(Parts<'_>, &[u8]), Damage> {
    let flags = packet.get(2).copied().unwrap_or_default();
    if flags & !SIGNED != 0 {
        return Err(Damage::Flags { flags });
    }
    let signature = if flags == SIGNED { SIGNATURE } else { 0 };
    let [head, payload, rest] = parted(packet, HEAD_V2, signature)?;
    let (system, component, id) = match head {
        [.., system, component, low, middle, high] => {
            (*system, *component, u32::from_le_bytes([*low, *middle, *high, 0]))
        }
        _ => return Err(cut_off(HEAD_V2, packet)),
    };
    let frame = Frame { version: MavlinkVersion::V2, system, component, id, payload };
    ended(frame, packet, rest, signature)
}

/// Head, payload, and what follows the payload; the whole frame is there.
fn parted(packet: &[u8], head: usize, signature: usize) -> Result<[&[u8]; 3], Damage> {
    let length = packet.get(1).copied().map_or(0, usize::from);
    let needed = head + length + CHECKSUM + signature;
    if packet.len() < needed {
        return Err(cut_off(needed, packet));
    }
    let (head, behind) = packet.split_at(head);
    let (payload, rest) = behind.split_at(length);
    Ok([head, payload, rest])
}

fn cut_off(needed: usize, packet: &[u8]) -> Damage {
    Damage::CutOff { needed, left: packet.len() }
}

/// Takes the checksum and the signature off what follows a payload.
fn ended<'a>(
    frame: Frame<'a>,
    packet: &'a [u8],
    rest: &'a [u8],
    signature: usize,
) -> Result<(Parts<'a>, &'a [u8]), Damage> {
    let summed = packet.get(1..packet.len() - rest.len()).unwrap_or_default();
    let Some(([low, high], rest)) = rest.split_first_chunk() else {
        return Err(cut_off(packet.len() + CHECKSUM, packet));
    };
    let rest = rest.get(signature..).unwrap_or_default();
    Ok(((frame, summed, u16::from_le_bytes([*low, *high])), rest))
}

/// The frame, if its checksum is right. That of an unknown message cannot be computed.
fn checked((frame, summed, checksum): Parts<'_>) -> Result<Frame<'_>, Damage> {
    let id = frame.id;
    let is_right = || calculate_crc(summed, MavMessage::extra_crc(id)) == checksum;
    match !is_known(id) || is_right() {
        true => Ok(frame),
        false => Err(Damage::Checksum { id }),
    }
}

fn is_known(id: u32) -> bool {
    MavMessage::default_message_from_id(id).is_some()
}
