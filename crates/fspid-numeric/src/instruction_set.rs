//! Which vector instructions a batch is computed with.

use core::fmt;

use fearless_simd::Level;
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use fearless_simd::Simd;

/// Vector instructions that this machine has.
#[derive(Clone, Copy, Debug)]
pub struct InstructionSet(Level);

impl InstructionSet {
    /// The widest that this machine has; found out once.
    #[must_use]
    pub fn best() -> Self {
        Self(Level::new())
    }

    /// All that this machine has, from those every machine of its kind has to the widest.
    pub fn available() -> impl Iterator<Item = Self> {
        let baseline = Self(Level::baseline());
        let wider = Self::known().into_iter().flatten();
        core::iter::once(baseline).chain(wider.filter(move |set| set.rank() > baseline.rank()))
    }

    /// Its usual name.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["baseline", "SSE4.2", "AVX2", "AVX-512"][self.rank()]
    }

    /// As what `fearless_simd` dispatches by.
    #[must_use]
    pub fn level(self) -> Level {
        self.0
    }
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
impl InstructionSet {
    fn known() -> [Option<Self>; 3] {
        let best = Level::new();
        [
            best.as_sse4_2().map(|token| Self(token.level())),
            best.as_avx2().map(|token| Self(token.level())),
            best.as_avx512().map(|token| Self(token.level())),
        ]
    }

    fn rank(self) -> usize {
        let ranks = [
            self.0.as_sse4_2().is_some(),
            self.0.as_avx2().is_some(),
            self.0.as_avx512().is_some(),
        ];
        ranks.into_iter().filter(|&has| has).count()
    }
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
impl InstructionSet {
    fn known() -> [Option<Self>; 3] {
        [None; 3]
    }

    fn rank(self) -> usize {
        0
    }
}

impl fmt::Display for InstructionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
