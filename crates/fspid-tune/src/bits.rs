//! Numbers as their bits, so that none is rounded on its way, and NaN and infinity get there.

use serde::de::{DeserializeOwned, Error as _};
use serde::{Deserialize as _, Deserializer, Serialize, Serializer};

/// What is written as bits: a number, or some.
pub(crate) trait AsBits: Sized {
    /// How it is written.
    type Bits: Serialize + DeserializeOwned;

    fn bits(&self) -> Self::Bits;

    /// None for what was not written so.
    fn of_bits(bits: Self::Bits) -> Option<Self>;
}

impl AsBits for f64 {
    type Bits = u64;

    fn bits(&self) -> u64 {
        self.to_bits()
    }

    fn of_bits(bits: u64) -> Option<Self> {
        Some(Self::from_bits(bits))
    }
}

impl<T: AsBits> AsBits for Option<T> {
    type Bits = Option<T::Bits>;

    fn bits(&self) -> Self::Bits {
        self.as_ref().map(T::bits)
    }

    fn of_bits(bits: Self::Bits) -> Option<Self> {
        match bits {
            None => Some(None),
            Some(bits) => T::of_bits(bits).map(Some),
        }
    }
}

impl<T: AsBits> AsBits for Vec<T> {
    type Bits = Vec<T::Bits>;

    fn bits(&self) -> Self::Bits {
        self.iter().map(T::bits).collect()
    }

    fn of_bits(bits: Self::Bits) -> Option<Self> {
        bits.into_iter().map(T::of_bits).collect()
    }
}

impl<T: AsBits, const N: usize> AsBits for [T; N] {
    type Bits = Vec<T::Bits>;

    fn bits(&self) -> Self::Bits {
        self.iter().map(T::bits).collect()
    }

    fn of_bits(bits: Self::Bits) -> Option<Self> {
        Vec::of_bits(bits)?.try_into().ok()
    }
}

/// For `#[serde(with = "bits")]`.
pub(crate) fn serialize<T: AsBits, S: Serializer>(value: &T, out: S) -> Result<S::Ok, S::Error> {
    value.bits().serialize(out)
}

/// For `#[serde(with = "bits")]`.
pub(crate) fn deserialize<'de, T: AsBits, D: Deserializer<'de>>(input: D) -> Result<T, D::Error> {
    let bits = T::Bits::deserialize(input)?;
    T::of_bits(bits).ok_or_else(|| D::Error::custom("another number of numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Serialize, Deserialize)]
    struct Numbers {
        #[serde(with = "super")]
        some: [Option<f64>; 4],
        #[serde(with = "super")]
        many: Vec<f64>,
    }

    #[test]
    fn every_number_comes_back_with_its_bits() {
        let odd = [f64::NAN, -f64::NAN, f64::INFINITY, -0.0, 5e-324, f64::MAX, 0.1];
        let one = Numbers { some: [Some(odd[1]), None, Some(-0.0), Some(1.5)], many: odd.to_vec() };
        let text = serde_json::to_string(&one).expect("numbers");
        let other: Numbers = serde_json::from_str(&text).expect("the same");
        assert_eq!(one.some.bits(), other.some.bits());
        assert_eq!(one.many.bits(), other.many.bits());
        assert!(serde_json::from_str::<Numbers>(r#"{"some":[1],"many":[]}"#).is_err());
    }
}
