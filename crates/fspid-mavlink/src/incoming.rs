//! What a flight stack tells its simulator, out of a stream of bytes.

use mavlink::dialects::common::{
    HIL_ACTUATOR_CONTROLS_DATA, HilActuatorControlsFlags, MavMessage, MavModeFlag,
};
use mavlink::{MAV_STX, MAV_STX_V2, Message as _, MessageData as _};

use crate::frame::{Damage, Frame, Frames};

/// HIL_ACTUATOR_CONTROLS.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorControls {
    /// Time, µs.
    pub time_us: u64,
    /// Its channels, -1 to 1; what drives nothing may be NaN.
    pub controls: [f32; 16],
    /// True where it is armed.
    pub is_armed: bool,
    /// True where simulator and flight stack wait for each other.
    pub is_lockstep: bool,
}

/// Bytes of a connection, out of which frames are taken. A connection loses none, so that bytes which are no frame are damage.
#[derive(Clone, Debug, Default)]
pub struct Stream {
    bytes: Vec<u8>,
}

impl Stream {
    /// Takes bytes as they come.
    pub fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// The next controls; other messages are passed over. Nothing until more bytes come.
    ///
    /// # Errors
    /// [`Damage`] of what is no frame; the bytes are gone then.
    pub fn next_controls(&mut self) -> Result<Option<ActuatorControls>, Damage> {
        while let Some(length) = self.whole_frame()? {
            let frame: Vec<u8> = self.bytes.drain(..length).collect();
            for found in Frames(&frame) {
                if let Some(controls) = controls(&found?)? {
                    return Ok(Some(controls));
                }
            }
        }
        Ok(None)
    }

    /// Length of the frame in front, once all of it is there.
    fn whole_frame(&mut self) -> Result<Option<usize>, Damage> {
        let Some(&byte) = self.bytes.first() else { return Ok(None) };
        if ![MAV_STX, MAV_STX_V2].contains(&byte) {
            self.bytes.clear();
            return Err(Damage::NoFrame { byte });
        }
        match Frames(&self.bytes).next() {
            // It may still come: a frame has at most 280 bytes.
            Some(Err(Damage::CutOff { .. })) | None => Ok(None),
            Some(Err(damage)) => {
                self.bytes.clear();
                Err(damage)
            }
            Some(Ok(_)) => Ok(Frames::first_length(&self.bytes)),
        }
    }
}

fn controls(frame: &Frame<'_>) -> Result<Option<ActuatorControls>, Damage> {
    let id = frame.id;
    if id != HIL_ACTUATOR_CONTROLS_DATA::ID {
        return Ok(None);
    }
    let message = MavMessage::parse(frame.version, id, frame.payload)
        .map_err(|reason| Damage::Unreadable { id, reason: reason.to_string() })?;
    let MavMessage::HIL_ACTUATOR_CONTROLS(data) = message else { return Ok(None) };
    let lockstep = HilActuatorControlsFlags::HIL_ACTUATOR_CONTROLS_FLAGS_LOCKSTEP;
    Ok(Some(ActuatorControls {
        time_us: data.time_usec,
        controls: data.controls,
        is_armed: data.mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED),
        is_lockstep: data.flags.contains(lockstep),
    }))
}
