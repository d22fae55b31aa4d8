//! The vectors of a machine as [`Lanes`].

use core::marker::PhantomData;
use core::ops::{Add, Div, Mul, Sub};

use fearless_simd::{Simd, SimdFloat};

use crate::lanes::{Lanes, of_lane};
use crate::real::Real;
use crate::real::sealed::Sealed;

/// A vector `V` of the instruction set `S`.
pub struct Vector<S, V>(pub V, PhantomData<S>);

impl<S, V> Vector<S, V> {
    #[inline(always)]
    /// Lanes of a vector.
    pub fn new(vector: V) -> Self {
        Self(vector, PhantomData)
    }
}

impl<S, V: Copy> Clone for Vector<S, V> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, V: Copy> Copy for Vector<S, V> {}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<S: Simd, V: SimdFloat<S>> $trait for Vector<S, V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::new(self.0.$method(other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<S: Simd, V: SimdFloat<S>> Lanes for Vector<S, V>
where
    V::Element: Real,
{
    type Number = V::Element;

    #[inline(always)]
    fn same(self, value: V::Element) -> Self {
        Self::new(V::simd_from(self.0.token(), value))
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::new(self.0.min(other.0))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::new(self.0.max(other.0))
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        let shift = self.same(V::Element::ROUND);
        self.same(V::Element::ONE).raised(self + shift)
    }

    #[inline(always)]
    fn raised(self, shifted: Self) -> Self {
        let exponent = shifted.0.to_bits() << V::Element::MANTISSA_BITS;
        Self::new(V::from_bits(self.0.to_bits() + exponent))
    }

    fn lane_by_lane(
        numbers: &[Self],
        zero: Self,
        function: impl Fn(&[V::Element]) -> V::Element,
    ) -> Self {
        let mut answers = zero.0;
        for (lane, answer) in answers.as_mut_slice().iter_mut().enumerate() {
            let of_lane_number =
                |number: Self| number.0.as_slice().get(lane).copied().unwrap_or(V::Element::ZERO);
            *answer = of_lane(numbers, of_lane_number, &function);
        }
        Self::new(answers)
    }
}
