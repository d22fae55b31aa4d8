//! Values of all lanes side by side, and comparisons between them as masks.

/// One number a lane.
pub(super) type Lanes<const W: usize> = [f64; W];
/// One truth a lane, as wide as a number: [`YES`] or [`NO`].
pub(super) type Mask<const W: usize> = [u64; W];

/// True.
pub(super) const YES: u64 = u64::MAX;
/// False.
pub(super) const NO: u64 = 0;

/// A truth as a mask.
#[inline(always)]
pub(super) fn mask(truth: bool) -> u64 {
    if truth { YES } else { NO }
}

/// True if all lanes are.
#[inline(always)]
pub(super) fn all<const W: usize>(truths: &Mask<W>) -> bool {
    truths.iter().fold(YES, |all, truth| all & truth) == YES
}
