//! The numbers of an aircraft beyond pitching, and where some of them stand in the order in which
//! [`AircraftFlight::beyond`](crate::aircraft::AircraftFlight::beyond) answers them.

/// How many there are.
pub(crate) const BEYOND: usize = 10;
/// Altitude.
pub(crate) const ALTITUDE: usize = 0;
/// Heading.
pub(crate) const HEADING: usize = 1;
/// Roll rate.
pub(crate) const ROLLING: usize = 3;
/// Power of the engine.
pub(crate) const POWER: usize = 6;
/// Aileron.
pub(crate) const AILERON: usize = 7;
/// Throttle that is asked for.
pub(crate) const THROTTLE: usize = 9;

/// Rates of roll and yaw.
pub(crate) const TURNING: [usize; 2] = [ROLLING, 4];
