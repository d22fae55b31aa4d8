//! The rules in the order in which they are fastest evaluated.

use crate::label::{LABEL_COUNT, Label};
use crate::rule_table::Grid;
use fspid_numeric::Real;
use fspid_numeric::lanes::Lanes;

/// Rules in the base.
const RULE_COUNT: usize = LABEL_COUNT * LABEL_COUNT;
/// Rules whose strongest is looked for at once.
const GROUP: usize = 4;
/// Most groups: each of the seven labels may have one that is not full.
const GROUP_COUNT: usize = (RULE_COUNT + LABEL_COUNT * (GROUP - 1)) / GROUP;

/// Declares [`Rule`] with as many names as there are rules.
macro_rules! rules {
    ($($name:ident)*) => {
        /// The number of a rule, row by row. Not a `u8`, so that the compiler knows it to be within
        /// an array of all rules: no bounds check, no panic path.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(u8)]
        enum Rule { $($name),* }

        impl Rule {
            const ALL: [Self; RULE_COUNT] = [$(Self::$name),*];
        }
    };
}

rules! {
    R00 R01 R02 R03 R04 R05 R06
    R10 R11 R12 R13 R14 R15 R16
    R20 R21 R22 R23 R24 R25 R26
    R30 R31 R32 R33 R34 R35 R36
    R40 R41 R42 R43 R44 R45 R46
    R50 R51 R52 R53 R54 R55 R56
    R60 R61 R62 R63 R64 R65 R66
}

/// The rules of one output, sorted by label and in groups of one label each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Consequents {
    /// Where a label has too few rules to fill its last group, that group's first stands again.
    groups: [[Rule; GROUP]; GROUP_COUNT],
    /// How many groups each label has.
    counts: [u8; LABEL_COUNT],
}

impl Consequents {
    // Counting loops, so that the compiler can sort the rules of a constant, which has no iterators.
    pub(crate) const fn new(grid: &Grid) -> Self {
        let mut sorted =
            Self { groups: [[Rule::R00; GROUP]; GROUP_COUNT], counts: [0; LABEL_COUNT] };
        // The next group to begin.
        let mut next = 0;
        let mut label = 0;
        while label < LABEL_COUNT {
            let (mut found, mut rule) = (0, 0);
            while rule < RULE_COUNT {
                let (row, column) = (rule / LABEL_COUNT, rule % LABEL_COUNT);
                if grid.at(Label::ALL[row], Label::ALL[column]).index() == label {
                    // Asked for although it holds, so that no path leads to a panic.
                    if found % GROUP == 0 && next < GROUP_COUNT {
                        sorted.groups[next] = [Rule::ALL[rule]; GROUP];
                        sorted.counts[label] += 1;
                        next += 1;
                    } else if next > 0 && next <= GROUP_COUNT {
                        sorted.groups[next - 1][found % GROUP] = Rule::ALL[rule];
                    }
                    found += 1;
                }
                rule += 1;
            }
            label += 1;
        }
        sorted
    }

    /// The grid that was sorted.
    pub(crate) fn grid(&self) -> Grid {
        let mut rows = [[Label::ZO; LABEL_COUNT]; LABEL_COUNT];
        let mut groups = self.groups.iter();
        for (label, &count) in Label::ALL.into_iter().zip(&self.counts) {
            for &rule in groups.by_ref().take(usize::from(count)).flatten() {
                if let Some(place) = rows.as_flattened_mut().get_mut(rule as usize) {
                    *place = label;
                }
            }
        }
        Grid::new(rows)
    }

    /// Strength of each label: that of its strongest rule.
    #[inline(always)]
    pub(crate) fn strengths<L: Lanes>(&self, firing: &Firing<L>) -> [L; LABEL_COUNT] {
        let mut groups = self.groups.iter();
        let mut strengths = [firing.0[0].same(L::Number::ZERO); LABEL_COUNT];
        for (strength, &count) in strengths.iter_mut().zip(&self.counts) {
            for &[a, b, c, d] in groups.by_ref().take(usize::from(count)) {
                let ab = firing.of(a).larger(firing.of(b));
                let cd = firing.of(c).larger(firing.of(d));
                *strength = strength.larger(ab.larger(cd));
            }
        }
        strengths
    }
}

/// Firing strength of each rule.
pub(crate) struct Firing<L>([L; RULE_COUNT]);

impl<L: Lanes> Firing<L> {
    /// The weaker one of the grades of a rule's two inputs.
    #[inline(always)]
    pub(crate) fn new(error: &[L; LABEL_COUNT], change: &[L; LABEL_COUNT]) -> Self {
        let mut firing = [error[0]; RULE_COUNT];
        for (row, &error) in firing.chunks_exact_mut(LABEL_COUNT).zip(error) {
            for (strength, &change) in row.iter_mut().zip(change) {
                *strength = error.smaller(change);
            }
        }
        Self(firing)
    }

    #[inline(always)]
    fn of(&self, rule: Rule) -> L {
        self.0[rule as usize]
    }
}
