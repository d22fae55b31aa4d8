//! What a front may be called, and what bars it from that: the same as bars the winner of a contest.

use crate::contest::{Bar, Judged, barred};

/// How one front stands beside another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dominance {
    /// Less error at every travel.
    Dominates,
    /// More error at every travel.
    Dominated,
    /// Less at some and at none more; the rest is open.
    BetterInPart,
    /// More at some and at none less.
    WorseInPart,
    /// Less at some and more at others.
    Crosses,
    /// Nothing is significant.
    Open,
    /// The band leaves zero, and the signed ranks of the cases, lost ones among them, say nothing.
    OpenByRanks,
    /// Less error, on all of it or in part, of a controller that is not called better for it.
    Barred(FrontBar),
    /// The same of the one compared with.
    OtherBarred(FrontBar),
    /// Nothing is told.
    NotTold(Missing),
}

/// Why a controller is not better on a front, whatever its error: on one effort, or over all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontBar {
    /// Every flight of it fails.
    AllFail,
    /// None of its tunings for an effort found anything that was allowed, or fewer did than of the other.
    NotAllowed,
    /// A flight of it is of a loop that is unstable at rest.
    Unstable,
    /// A flight of it is of a loop of which nobody can tell whether it is stable.
    Undecided,
    /// It loses a larger share of its flights.
    LosesMore,
    /// It fails more flights, by the signed ranks of the shares that fail of each case.
    FailsMore,
}

/// What a front lacks to be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// Three tunings of each.
    Seeds,
    /// Six cases of which neither loses a flight and in which both have a common range of travel.
    Cases,
}

impl Dominance {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Dominates => "better on the whole front",
            Self::Dominated => "worse on the whole front",
            Self::BetterInPart => "better on a part of the front",
            Self::WorseInPart => "worse on a part of the front",
            Self::Crosses => "better on one part, worse on another",
            Self::Open => "not significant anywhere",
            Self::OpenByRanks => "not significant by the signed ranks of its cases",
            Self::Barred(FrontBar::AllFail) => {
                "not better, for all its flights at some effort fail"
            }
            Self::Barred(FrontBar::NotAllowed) => {
                "not better, for its tunings for some effort found nothing allowed"
            }
            Self::OtherBarred(FrontBar::NotAllowed) => {
                "not worse, for the tunings of what it is compared with found nothing allowed at some effort"
            }
            Self::Barred(FrontBar::Unstable) => "not better, for it is unstable at rest",
            Self::Barred(FrontBar::Undecided) => {
                "not better, for nobody can tell whether it is stable"
            }
            Self::Barred(FrontBar::LosesMore) => "not better, for it loses more flights",
            Self::Barred(FrontBar::FailsMore) => "not better, for more of its flights fail",
            Self::OtherBarred(FrontBar::LosesMore) => {
                "not worse, for what it is compared with loses more flights"
            }
            Self::OtherBarred(_) => "not worse, for what it is compared with fails",
            Self::NotTold(Missing::Seeds) => "not told: it takes three seeds",
            Self::NotTold(Missing::Cases) => {
                "not told: it takes six cases without lost flights and with a common range of travel"
            }
        }
    }
}

/// All flights of a ladder, and those of each rung.
pub(super) struct Everywhere<'a> {
    /// All designs of all rungs as if they were of one contest.
    pub(super) together: Judged,
    rungs: &'a [&'a Judged],
}

impl<'a> Everywhere<'a> {
    /// None without a rung.
    pub(super) fn of(rungs: &'a [&'a Judged]) -> Option<Self> {
        let (first, rest) = rungs.split_first()?;
        let mut together = Judged::clone(first);
        for judged in rest {
            let others = together.contestants.iter_mut().zip(&judged.contestants);
            others.for_each(|(it, more)| it.designs.extend_from_slice(&more.designs));
        }
        Some(Self { together, rungs })
    }

    /// Why one is not better than the other, if it is not: what is said of a front is said of each of its efforts, so
    /// that each is asked, and all together, where few of each add up.
    pub(super) fn bar(&self, one: usize, other: usize) -> Option<FrontBar> {
        let all = self.rungs.iter().copied().chain([&self.together]);
        all.into_iter().find_map(|judged| bar(judged, one, other))
    }
}

/// As a contest has it for its winner, with the lost flights that come before.
fn bar(judged: &Judged, one: usize, other: usize) -> Option<FrontBar> {
    let (mine, theirs) = (judged.contestants.get(one)?, judged.contestants.get(other)?);
    let count = |it| judged.count(it, &judged.all());
    let found = barred(judged, one, other);
    match found {
        Some(Bar::AllFail) => Some(FrontBar::AllFail),
        Some(Bar::NotAllowed) => Some(FrontBar::NotAllowed),
        // Who has one does not win, also where the other has as many.
        _ if count(mine).unstable > 0 => Some(FrontBar::Unstable),
        _ if count(mine).undecided > 0 => Some(FrontBar::Undecided),
        _ if count(mine).cmp_lost(count(theirs)).is_gt() => Some(FrontBar::LosesMore),
        Some(Bar::FailsMore) => Some(FrontBar::FailsMore),
        Some(Bar::Unstable | Bar::Undecided) | None => None,
    }
}
