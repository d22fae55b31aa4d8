//! Vectors in space, for velocities, rates, forces and moments.

use std::ops::{Add, Mul, Neg, Sub};

/// Three components along the axes of a frame that the name of the value states; unit as the name states.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Vector3 {
    /// First component: forward in body axes, north on the ground.
    pub x: f64,
    /// Second component: right in body axes, east on the ground.
    pub y: f64,
    /// Third component: down in both.
    pub z: f64,
}

impl Vector3 {
    /// The vector without length.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);

    /// Vector of three components.
    #[inline(always)]
    #[must_use]
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

    /// The components in order.
    #[must_use]
    pub const fn to_array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// Scalar product.
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product, right-handed.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Length.
    #[inline(always)]
    #[must_use]
    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }
}

impl From<[f64; 3]> for Vector3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self::new(x, y, z)
    }
}

impl Add for Vector3 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl Sub for Vector3 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Neg for Vector3 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl Mul<Vector3> for f64 {
    type Output = Vector3;

    #[inline(always)]
    fn mul(self, vector: Vector3) -> Vector3 {
        Vector3::new(self * vector.x, self * vector.y, self * vector.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vector_product_of_forward_and_right_is_down() {
        let (forward, right) = (Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0));
        assert_eq!(forward.cross(right), Vector3::new(0.0, 0.0, 1.0));
    }

    #[test]
    fn sums_and_multiples_go_component_by_component() {
        let vector = Vector3::from([1.0, -2.0, 2.0]);
        assert_eq!(2.0 * vector + vector - -vector, 4.0 * vector);
        assert_eq!(vector.norm().to_bits(), 3.0_f64.to_bits());
    }
}
