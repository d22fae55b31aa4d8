//! The Earth under a flight.

/// Mean radius of the Earth, m: that of a sphere on which ways over ground are laid (IUGG, 6371.0088 km).
pub(crate) const EARTH_RADIUS_M: f64 = 6_371_008.8;
