//! Search for the admissible rate of parameter variation in a proved family: overlapping patches of the parameter box, each
//! with a Lyapunov function of its own.

use fspid_lti::{Matrix, spectral_radius};

use super::moves::Off;
use super::pace::common;
use super::search::{Piece, Search, halves, middle};
use super::{Family, Pace, Parameter, Part, Patch, cover};
use crate::caps::{MOST_PARTS, MOST_PATCHES};
use crate::certificate::Claim;
use crate::gain_set::GainSet;

/// How far a patch goes beyond what it is cut for, on each side, as a share of that.
const BEYOND: f64 = 0.25;
/// Times in which numbers may cross their ranges, s, fastest first; in the last of them next to nothing moves in a sample.
const TIMES_S: [f64; 14] =
    [0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 3600.0];
/// Shares of each side of the box that patches have at most, one after the other as long as that makes it faster.
const LARGEST: [f64; 3] = [1.0, 0.5, 0.25];
/// Most searches for a form.
const MOST_SEARCHES: usize = 64;
/// Most points of a patch that a form is made for: those at which one that was made for fewer did not fall.
const MOST_POINTS: usize = 24;
/// Pieces of a patch that are looked at for one form: so many for each part of the family that stands still, and more.
const LOOKS_A_PART: usize = 16;
const LOOKS_AT_LEAST: usize = 256;
/// More are not looked at.
const MOST_LOOKS: usize = 2048;
/// A pace is not worth a certificate of many times the size: so many parts for each of the family that stands still, and more.
const MORE_PARTS: usize = 2;
const PARTS_AT_LEAST: usize = 128;
/// Pieces that are looked at where each takes long.
const FEW_LOOKS: usize = 32;
/// The fall of a form in a sample is asked for as a power of a half, down to this one.
const HALVINGS: i32 = 24;
/// What a faster pace leaves of a form's fall in a sample.
const LEFT: f64 = 0.75;
/// Sweeps over the factors between forms.
const SWEEPS: usize = 50;

/// Looks for the pace of a family that is proved standing still.
pub(super) struct PaceSearch<'s, 'a> {
    search: &'s Search<'a>,
    still: &'s Family,
    /// Gains that forms are made for.
    set: GainSet,
    /// What plants are off at the slowest pace.
    off: Off,
    /// Searches for a form that were made.
    searches: usize,
    most_looks: usize,
}

/// A family at the fastest pace that is found for it; none where its numbers have to stand still.
pub(super) fn moving(search: &Search<'_>, still: &Family) -> Option<Family> {
    let may_move = still.parameters.iter().all(|one| one.may_move(search.description()));
    // Where scales alone differ and may change as they like, there is no pace to be found.
    let is_free = still.scales_may_change() && !still.parameters.iter().any(Parameter::is_of_plant);
    if !may_move || is_free {
        return None;
    }
    let off = off(search, &still.parts, TIMES_S[TIMES_S.len() - 1])?;
    let most_looks = (LOOKS_A_PART * still.parts.len() + LOOKS_AT_LEAST).min(MOST_LOOKS);
    let set = search.set();
    let with = |set: GainSet, most_looks: usize| {
        PaceSearch { search, still, set, off: off.clone(), searches: 0, most_looks }.run()
    };
    if set.cells.len() < 2 {
        return with(set.clone(), most_looks);
    }
    // The box around all gains has a few corners where the set has thousands, each of which is asked for each piece.
    with(set.bounding_box(), most_looks).or_else(|| with(set.clone(), most_looks.min(FEW_LOOKS)))
}

/// What plants of parts are off within a sample where numbers cross their ranges in some time.
fn off(search: &Search<'_>, parts: &[Part], crosses_in_s: f64) -> Option<Off> {
    let pace = Pace { crosses_in_s, overlap: 0.0, patches: Vec::new() };
    Off::of(&pace, (search.parameters(), parts), search.description()).ok()
}

impl PaceSearch<'_, '_> {
    fn run(&mut self) -> Option<Family> {
        let mut best: Option<(f64, Family)> = None;
        // Smaller patches have forms that fall faster, and go over into each other sooner, until their margins are too small.
        for largest in LARGEST {
            let found = self.patches(largest).and_then(|pace| self.fastest(&pace));
            let time_s = best.as_ref().map_or(f64::INFINITY, |it| it.0);
            let (is_one, better) = match found {
                Some((pace, family)) if pace.crosses_in_s < time_s => {
                    (pace.patches.len() == 1, Some((pace.crosses_in_s, family)))
                }
                _ if best.is_some() => break,
                _ => continue,
            };
            best = better;
            if is_one {
                break;
            }
        }
        best.map(|(_, family)| family)
    }

    /// The fastest pace of some patches at which a family is proved.
    fn fastest(&self, slowest: &Pace) -> Option<(Pace, Family)> {
        let (mut too_fast, mut found) = (0, None);
        let mut slow = TIMES_S.len();
        // A pace that holds holds for everything slower.
        while too_fast < slow {
            let middle = (too_fast + slow) / 2;
            let pace = Pace { crosses_in_s: TIMES_S[middle], ..slowest.clone() };
            match self.at_pace(&pace) {
                Some(family) => (slow, found) = (middle, Some((pace, family))),
                None => too_fast = middle + 1,
            }
        }
        found
    }

    /// The family at a pace, in as many parts as that takes.
    fn at_pace(&self, pace: &Pace) -> Option<Family> {
        let Self { search, still, .. } = self;
        pace.keeps_up(&still.parameters, search.description()).ok()?;
        let off = off(search, &still.parts, pace.crosses_in_s)?;
        let parts = pace.patches.iter().map(|it| self.covered(&it.ends, &it.claim, &off).ok());
        let parts = with_all_scales(parts.collect::<Option<Vec<_>>>()?.concat(), still);
        let claim = &pace.patches.first()?.claim;
        let (parameters, pace) = (still.parameters.clone(), Some(pace.clone()));
        let family = Family { parameters, parts, pace };
        let most_parts = (MORE_PARTS * still.parts.len() + PARTS_AT_LEAST).min(MOST_PARTS);
        let may_be_checked =
            family.parts.len() <= most_parts && search.may_be_checked(claim, &family);
        (may_be_checked && self.holds_with_its_own_parts(&family, &off)).then_some(family)
    }

    /// True if a family that is proved with what other parts are off is so with its own.
    fn holds_with_its_own_parts(&self, family: &Family, known: &Off) -> bool {
        let pace = family.pace.as_ref();
        let own = pace.and_then(|pace| off(self.search, &family.parts, pace.crosses_in_s));
        own.is_some_and(|own| {
            let mut counted_on = family.parts.iter().filter(|it| family.moves_with(&it.claim));
            let is_whole =
                pace.is_some_and(|it| it.check(family, self.search.description()).is_ok());
            is_whole && (known.encloses(&own) || counted_on.all(|part| self.falls(part, &own)))
        })
    }

    fn falls(&self, part: &Part, off: &Off) -> bool {
        let loops = self.search.loops_of(&part.plants, &part.ends, Some(off));
        loops.is_ok_and(|loops| self.search.holds(&part.claim, &loops))
    }

    /// Patches that overlap and cover the box, none with more than some share of a side of it, at the slowest pace.
    fn patches(&mut self, largest: f64) -> Option<Pace> {
        let search = self.search;
        let mut pieces = vec![search.whole().to_vec()];
        let (mut patches, mut overlap) = (Vec::new(), 1.0_f64);
        while let Some(piece) = pieces.pop() {
            let side = search.widest(&piece)?;
            let (ends, margin) = beyond(&piece, search.whole());
            let is_small = search.share(&piece, side) <= largest;
            let claim = if is_small { self.one_form(&ends) } else { None };
            if let Some(claim) = claim {
                overlap = overlap.min(margin);
                patches.push(Patch { ends, claim });
            } else if self.is_done() || patches.len() + pieces.len() >= MOST_PATCHES {
                return None;
            } else {
                let piece = Piece { ends: piece, claim: None };
                pieces.extend(halves(&piece, side).map(|half| half.ends));
            }
        }
        if patches.len() > 1 {
            self.hasten(&mut patches)?;
            balance(&mut patches);
        }
        Some(Pace { crosses_in_s: TIMES_S[TIMES_S.len() - 1], overlap, patches })
    }

    fn is_done(&self) -> bool {
        self.searches >= MOST_SEARCHES || self.search.is_stopped()
    }

    /// A form that falls at all numbers of a patch. Where one falls at some points and not at another, that is one of them next.
    fn one_form(&mut self, ends: &[[f64; 2]]) -> Option<Claim> {
        let mut points = corners_and_middle(ends);
        while points.len() <= MOST_POINTS && !self.is_done() {
            self.searches += 1;
            let loops = points.iter().map(|at| self.search.loops(&standing(at)).ok());
            let loops: Vec<_> = loops.collect::<Option<Vec<_>>>()?;
            let all = loops.iter().flat_map(|(_, loops)| loops);
            let form = self.search.fast_of(all, &self.set)?;
            let claim = Claim::CommonQuadratic { form, rate: 1.0 };
            match self.covered(ends, &claim, &self.off) {
                Ok(_) => return Some(claim),
                Err(Some(at)) if !points.contains(&at) => points.push(at),
                // At a point that it was made for.
                Err(_) => return None,
            }
        }
        None
    }

    /// Parts that cover some ends, with one claim for all; a point at which it does not hold, if that is why there are none.
    fn covered(
        &self,
        ends: &[[f64; 2]],
        claim: &Claim,
        off: &Off,
    ) -> Result<Vec<Part>, Option<Vec<f64>>> {
        let search = self.search;
        let falling = |ends: &[[f64; 2]]| {
            let plants = search.plants(ends).ok()?;
            let part = Part { ends: ends.to_vec(), plants, claim: claim.clone() };
            self.falls(&part, off).then_some(part)
        };
        let mut pieces = vec![Piece { ends: ends.to_vec(), claim: None }];
        let (mut parts, mut looks) = (Vec::new(), 0);
        while let Some(piece) = pieces.pop() {
            looks += 1;
            if looks > self.most_looks || search.is_stopped() {
                return Err(None);
            }
            if let Some(part) = falling(&piece.ends) {
                parts.push(part);
                continue;
            }
            // No smaller piece is proved around a point that is not.
            let at = middle(&piece.ends);
            if falling(&standing(&at)).is_none() {
                return Err(Some(at));
            }
            let side = search.roughest(&piece.ends).ok_or(None)?;
            pieces.extend(halves(&piece, side));
        }
        Ok(parts)
    }

    /// The fastest fall that is proved of each form.
    fn hasten(&self, patches: &mut [Patch]) -> Option<()> {
        let halvings: Vec<i32> = (1..=HALVINGS).collect();
        for patch in patches {
            let form = common(&patch.claim)?.0.clone();
            let claim = |fall: f64| Claim::CommonQuadratic { form: form.clone(), rate: 1.0 - fall };
            let fall = |halvings: i32| libm::ldexp(1.0, -halvings);
            let falls = |halvings: i32| {
                self.covered(&patch.ends, &claim(fall(halvings)), &self.off).is_ok()
            };
            let fastest = halvings.partition_point(|&it| !falls(it));
            patch.claim = claim(LEFT * fall(*halvings.get(fastest)?));
        }
        Some(())
    }
}

/// What goes beyond some ends inside the box, and by how much of the whole side it does at least.
fn beyond(ends: &[[f64; 2]], whole: &[[f64; 2]]) -> (Vec<[f64; 2]>, f64) {
    let mut least = 1.0_f64;
    let wider = ends.iter().zip(whole).map(|(&[from, to], &[first, last])| {
        let by = BEYOND * (to - from);
        if from > first || to < last {
            // A little less, which rounding does not take away.
            least = least.min(0.999 * by / (last - first));
        }
        [(from - by).max(first), (to + by).min(last)]
    });
    let wider = wider.collect();
    (wider, least)
}

/// Parts for numbers that move, and those of a family that stands still whose scales may change, if these have no form for
/// all scales.
fn with_all_scales(mut parts: Vec<Part>, still: &Family) -> Vec<Part> {
    let alone = Family { parts: parts.clone(), ..still.clone() };
    if still.scales_may_change() && !alone.scales_may_change() {
        parts.extend(still.parts.iter().cloned());
    }
    parts
}

/// Ends of a point.
fn standing(at: &[f64]) -> Vec<[f64; 2]> {
    at.iter().map(|&it| [it; 2]).collect()
}

/// The middle of a box, and its corners or, where these are many, the middles of its faces.
fn corners_and_middle(ends: &[[f64; 2]]) -> Vec<Vec<f64>> {
    const MANY: usize = 4;
    let mut points = vec![middle(ends)];
    if ends.len() < MANY {
        let corner = |number: usize| -> Vec<f64> {
            ends.iter().enumerate().map(|(side, ends)| ends[number >> side & 1]).collect()
        };
        points.extend((0..1_usize << ends.len()).map(corner));
    } else {
        for (side, ends) in ends.iter().enumerate() {
            let face = |&end: &f64| {
                let mut at = points[0].clone();
                at[side] = end;
                at
            };
            let faces: Vec<_> = ends.iter().map(face).collect();
            points.extend(faces);
        }
    }
    points
}

/// A factor on each form, so that those that meet are as near to each other as they come.
fn balance(patches: &mut [Patch]) {
    let form = |at: usize| common(&patches[at].claim).map(|it| it.0);
    // What has to be added to the logarithm of the one to be in the middle of the other.
    let between = |own: usize, next: usize| {
        let [up, down] =
            [(own, next), (next, own)].map(|(one, other)| most(form(other), form(one)));
        0.5 * libm::log(up / down)
    };
    let places = 0..patches.len();
    let pairs: Vec<Vec<(usize, f64)>> = places
        .clone()
        .map(|own| {
            let meets = |next: &usize| {
                *next != own && cover::touches(&patches[own].ends, &patches[*next].ends)
            };
            places.clone().filter(meets).map(|next| (next, between(own, next))).collect()
        })
        .collect();
    let mut logarithms = vec![0.0_f64; patches.len()];
    for _ in 0..SWEEPS {
        for (own, next) in pairs.iter().enumerate().filter(|(_, next)| !next.is_empty()) {
            let sum: f64 = next.iter().map(|&(next, off)| logarithms[next] + off).sum();
            logarithms[own] = sum / next.len() as f64;
        }
    }
    for (patch, logarithm) in patches.iter_mut().zip(logarithms) {
        let factor = libm::exp(logarithm);
        if let Some((form, rate)) = common(&patch.claim)
            && factor.is_finite()
            && factor > 0.0
        {
            patch.claim = Claim::CommonQuadratic { form: form.scaled(factor), rate };
        }
    }
}

/// The most of one form over another; NaN where that is not known.
fn most(form: Option<&Matrix>, over: Option<&Matrix>) -> f64 {
    let found =
        form.zip(over).map(|(form, over)| over.solve(form).and_then(|it| spectral_radius(&it)));
    found.and_then(Result::ok).unwrap_or(f64::NAN)
}
