//! Words of a file in a number of bytes that is known, so that what is told of every sample needs no heap.

use std::fmt;

/// At most `N` bytes of text.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Words<const N: usize> {
    bytes: [u8; N],
    length: usize,
}

impl<const N: usize> Words<N> {
    /// The text, cut between two characters where it is longer.
    #[must_use]
    pub fn new(text: &str) -> Self {
        let length = text.floor_char_boundary(N);
        let mut bytes = [0; N];
        for (place, byte) in bytes.iter_mut().zip(text.bytes().take(length)) {
            *place = byte;
        }
        Self { bytes, length }
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        let text = self.bytes.get(..self.length).unwrap_or_default();
        std::str::from_utf8(text).unwrap_or_default()
    }
}

impl<const N: usize> fmt::Debug for Words<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_str().fmt(formatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_is_too_long_is_cut_between_two_characters() {
        assert_eq!(Words::<5>::new("alpha").as_str(), "alpha");
        assert_eq!(Words::<5>::new("alphas").as_str(), "alpha");
        assert_eq!(Words::<3>::new("ααα").as_str(), "α");
        assert_eq!(Words::<0>::new("a").as_str(), "");
    }
}
