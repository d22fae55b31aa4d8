//! Search for a family's proof: a Lyapunov function for the midpoint of a part is verified for the whole part, which is
//! bisected where that fails.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopModel;

use super::moves::Off;
use super::patches::moving;
use super::{Family, Parameter, Part, bears, covers_scales, models, numbers};
use crate::caps::MOST_PARTS;
use crate::certificate::Claim;
use crate::check::{MakesPlant, NotProved, PlantSet};
use crate::description::{LoopDescription, NotProvable};
use crate::gain_set::GainSet;
use crate::prove::{Effort, Prover, Verdict};
use crate::scope::Asked;

/// Most searches for a form; one of a self-tuner takes a second or more.
const MOST_SEARCHES: usize = 200;
/// Most pieces of the box that are looked at.
const MOST_LOOKS: usize = 3 * MOST_PARTS;
/// A part of this share of the box along each side that is still open stays so.
const SMALLEST: f64 = 1.0 / 1024.0;

/// Outcome of the search for a family's proof.
#[derive(Clone, Debug, PartialEq)]
pub enum FamilyVerdict {
    /// Every member is stable.
    Proved(Family),
    /// A member grows: with gains that the controller has, standing still.
    Refuted {
        /// The member, parameter by parameter.
        at: Vec<f64>,
        /// At which gains its loop grows, and how: a certificate, whose loop is the one as it is, and the member's plant.
        claim: Box<Claim>,
    },
    /// Neither.
    Open {
        /// Where it is open: of each parameter from where to where.
        ends: Vec<[f64; 2]>,
        /// Why.
        because: Uncertain,
    },
}

/// Why a family stays open.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Uncertain {
    /// At the middle of the part nothing is proved, and nothing refuted.
    #[error("of the loop in the middle of it neither a proof nor a refutation is found")]
    Member,
    /// What is known of the plant there is too wide for a proof.
    #[error("a thousandth of the box is still too wide for what is proved in the middle of it")]
    Narrow,
    /// The work that is allowed is done.
    #[error("as many parts were tried as are allowed; narrower limits ask for fewer")]
    Work,
    /// What steps of a sensor leave is bounded for one loop, not for those between.
    #[error(
        "a sensor resolves in steps, and what they leave of a motion is bounded for the loop as it is alone; families need resolution_deg and resolution_deg_s of 0"
    )]
    Resolution,
    /// What proves the loop in the middle ties its gains to what the pitch sensor shows, whose scale differs.
    #[error(
        "no one form is found for all gains, and a proof in which gains are tied to what the pitch sensor shows covers no scale of it between ends; allowed there is a scale_error_pct that stands still"
    )]
    Tied,
    /// No plant can be enclosed there.
    #[error("{0}")]
    Plant(NotProved),
}

/// Proves or refutes the stability of every member around rest.
///
/// `plant` makes the plant of parameters, with slopes by them; of intervals all plants in them.
///
/// # Errors
/// As [`certify`](crate::certify).
pub fn prove_family(
    description: &LoopDescription,
    parameters: &[Parameter],
    effort: &Effort,
    plant: &MakesPlant<'_>,
) -> Result<FamilyVerdict, NotProvable> {
    let whole: Vec<[f64; 2]> = parameters.iter().map(|one| one.ends).collect();
    if description.resolves_in_steps() {
        return Ok(FamilyVerdict::Open { ends: whole, because: Uncertain::Resolution });
    }
    let asked = Asked::rest();
    let prover = Prover::new(description, &asked, effort)?;
    let set = prover.set(1.0);
    let stops = effort.stops;
    let mut search = Search { prover, set, parameters, plant, whole, searches: 0, stops };
    search.run()
}

/// Plants of a box, and the loops between which theirs lie.
type PlantsAndLoops = (PlantSet, Vec<LoopModel<Interval>>);

pub(super) struct Search<'a> {
    prover: Prover<'a>,
    set: GainSet,
    parameters: &'a [Parameter],
    plant: &'a MakesPlant<'a>,
    whole: Vec<[f64; 2]>,
    searches: usize,
    stops: fn() -> bool,
}

/// A piece of the box, and a claim that held near it.
pub(super) struct Piece {
    pub(super) ends: Vec<[f64; 2]>,
    pub(super) claim: Option<Claim>,
}

impl Search<'_> {
    fn run(&mut self) -> Result<FamilyVerdict, NotProvable> {
        if let Some(refuted) = self.growing_corner() {
            return Ok(refuted);
        }
        let mut pieces = vec![Piece { ends: self.whole.clone(), claim: None }];
        let (mut parts, mut looks) = (Vec::new(), 0);
        while let Some(piece) = pieces.pop() {
            if (self.stops)() {
                return Err(NotProvable::Stopped);
            }
            looks += 1;
            if looks > MOST_LOOKS || parts.len() + pieces.len() >= MOST_PARTS {
                return Ok(FamilyVerdict::Open { ends: piece.ends, because: Uncertain::Work });
            }
            match self.piece(piece) {
                Ok(Found::Part(part)) => parts.push(part),
                Ok(Found::Halves(halves)) => pieces.extend(halves),
                Err(verdict) => return Ok(verdict),
            }
        }
        let still = Family { parameters: self.parameters.to_vec(), parts, pace: None };
        let moving = moving(self, &still);
        if (self.stops)() {
            return Err(NotProvable::Stopped);
        }
        Ok(FamilyVerdict::Proved(moving.unwrap_or(still)))
    }

    /// A proof of a piece, or its halves; an answer for all where there is one.
    fn piece(&mut self, piece: Piece) -> Result<Found, FamilyVerdict> {
        let open = |because| FamilyVerdict::Open { ends: piece.ends.clone(), because };
        let (plants, loops) = match self.loops(&piece.ends) {
            Ok(found) => found,
            // A narrower piece may do.
            Err(reason) => {
                let side = self.roughest(&piece.ends);
                let halves = side.map(|side| halves(&piece, side));
                return halves.map(Found::Halves).ok_or_else(|| open(Uncertain::Plant(reason)));
            }
        };
        let part =
            |claim| Found::Part(Part { ends: piece.ends.clone(), plants: plants.clone(), claim });
        if let Some(claim) = piece.claim.as_ref().filter(|claim| self.holds(claim, &loops)) {
            return Ok(part(claim.clone()));
        }
        let found = self.found(&piece, &loops)?;
        if let Some(claim) = found.claim().filter(|claim| self.holds(claim, &loops)) {
            return Ok(part(claim.clone()));
        }
        // Scales of sensors leave nothing of second order, and may be too far apart for one form all the same.
        let is_wide =
            !matches!(found, Near::All(_)) && !self.parameters.iter().all(Parameter::is_of_plant);
        let side = if is_wide { self.widest(&piece.ends) } else { self.roughest(&piece.ends) };
        let because = if self.is_done() { Uncertain::Work } else { Uncertain::Narrow };
        let side = side.ok_or_else(|| open(because))?;
        let claim = found.claim().cloned().or(piece.claim);
        Ok(Found::Halves(halves(&Piece { ends: piece.ends, claim }, side)))
    }

    /// What is found near a piece. That the member in its middle is open is an answer for all: it is one of them.
    fn found(
        &mut self,
        piece: &Piece,
        loops: &[LoopModel<Interval>],
    ) -> Result<Near, FamilyVerdict> {
        if self.is_done() {
            return Ok(Near::Nothing);
        }
        // A member without one form for all gains lies on the edge of both halves of its piece.
        let has_common = |claim: &Claim| matches!(claim, Claim::CommonQuadratic { .. });
        if piece.claim.as_ref().is_none_or(has_common)
            && let Some(claim) = self.common(loops)
        {
            return Ok(Near::All(claim));
        }
        self.refuted_in_the_middle(piece)?;
        self.claim_at_middle(piece).map(Near::Middle)
    }

    /// True if as many forms were looked for as may be: what was found before is asked of narrower pieces all the same.
    fn is_done(&self) -> bool {
        self.searches >= MOST_SEARCHES
    }

    /// Plants of a box, and the loops between which theirs lie.
    pub(super) fn loops(&self, ends: &[[f64; 2]]) -> Result<PlantsAndLoops, NotProved> {
        let plants = self.plants(ends)?;
        let loops = self.loops_of(&plants, ends, None)?;
        Ok((plants, loops))
    }

    /// Loops between which those of some plants lie, which may be off by something.
    pub(super) fn loops_of(
        &self,
        plants: &PlantSet,
        ends: &[[f64; 2]],
        off: Option<&Off>,
    ) -> Result<Vec<LoopModel<Interval>>, NotProved> {
        models(plants, (self.parameters, ends), (self.prover.description(), off))
    }

    /// A form that falls fast under some loops with some gains.
    pub(super) fn fast_of<'m>(
        &self,
        loops: impl Iterator<Item = &'m LoopModel<Interval>>,
        set: &GainSet,
    ) -> Option<Matrix> {
        let middles: Vec<LoopModel<f64>> = loops.map(LoopModel::midpoint).collect();
        self.prover.fast_at(&self.prover.matrices_of(&middles, set)?)
    }

    /// All gains.
    pub(super) fn set(&self) -> &GainSet {
        &self.set
    }

    /// One form for all of some loops.
    fn common(&mut self, loops: &[LoopModel<Interval>]) -> Option<Claim> {
        self.searches += 1;
        let middles: Vec<LoopModel<f64>> = loops.iter().map(LoopModel::midpoint).collect();
        self.prover.common_of(&middles, &self.set)
    }
    /// A member in the middle of a piece that grows ends the search.
    fn refuted_in_the_middle(&self, piece: &Piece) -> Result<(), FamilyVerdict> {
        let at = middle(&piece.ends);
        let Ok(prover) = self.member(&at) else { return Ok(()) };
        match prover.frozen_growth() {
            Some(Verdict::Refuted(certificate, _)) => {
                Err(FamilyVerdict::Refuted { at, claim: Box::new(certificate.claim) })
            }
            _ => Ok(()),
        }
    }

    /// A claim about the member in the middle of a piece, of any form that bears scales as they differ.
    fn claim_at_middle(&mut self, piece: &Piece) -> Result<Claim, FamilyVerdict> {
        self.searches += 1;
        let open = |because| FamilyVerdict::Open { ends: piece.ends.clone(), because };
        let prover = self.member(&middle(&piece.ends));
        let prover = prover.map_err(|reason| open(Uncertain::Plant(reason)))?;
        let found = prover.stable(&self.set).map(|(certificate, _)| certificate.claim);
        let claim = found.ok_or_else(|| open(Uncertain::Member))?;
        match covers_scales(&claim, self.parameters) {
            true => Ok(claim),
            false => Err(open(Uncertain::Tied)),
        }
    }

    /// A corner of the box whose loop grows: asked first, since it ends most searches that end so.
    fn growing_corner(&self) -> Option<FamilyVerdict> {
        (0..1_usize << self.whole.len()).find_map(|corner| {
            let at = at_corner(&self.whole, corner);
            match self.member(&at).ok()?.frozen_growth()? {
                Verdict::Refuted(certificate, _) => {
                    Some(FamilyVerdict::Refuted { at, claim: Box::new(certificate.claim) })
                }
                Verdict::Proved(..) | Verdict::Open => None,
            }
        })
    }

    /// The prover of one member.
    fn member(&self, at: &[f64]) -> Result<Prover<'_>, NotProved> {
        let ends: Vec<[f64; 2]> = at.iter().map(|&value| [value; 2]).collect();
        let (_, mut loops) = self.loops(&ends)?;
        let what = "loops of one plant";
        let none = NotProved::Number { what, found: 0.0, allowed: "one" };
        loops.pop().map(|model| self.prover.of(model)).ok_or(none)
    }

    /// True if a claim is proved of each of some loops.
    pub(super) fn holds(&self, claim: &Claim, loops: &[LoopModel<Interval>]) -> bool {
        loops.iter().all(|model| {
            let found = self.prover.of(model.clone()).rest_rechecked(claim.clone(), &self.set);
            found.is_some_and(|rechecked| bears(claim, &rechecked))
        })
    }

    pub(super) fn description(&self) -> &LoopDescription {
        self.prover.description()
    }

    pub(super) fn is_stopped(&self) -> bool {
        (self.stops)()
    }

    /// From where to where each parameter goes.
    pub(super) fn whole(&self) -> &[[f64; 2]] {
        &self.whole
    }

    pub(super) fn parameters(&self) -> &[Parameter] {
        self.parameters
    }

    /// True if who re-checks a family is not refused the work.
    pub(super) fn may_be_checked(&self, claim: &Claim, family: &Family) -> bool {
        self.prover.may_be_checked(claim, family)
    }

    /// Plants of a box.
    pub(super) fn plants(&self, ends: &[[f64; 2]]) -> Result<PlantSet, NotProved> {
        PlantSet::of(&numbers(self.parameters, ends), self.plant)
    }

    /// Sides of a piece that may be cut.
    fn sides(&self, ends: &[[f64; 2]]) -> impl Iterator<Item = usize> {
        let shares = self.shares(ends);
        (0..shares.len()).filter(move |&side| shares[side] > SMALLEST)
    }

    /// How much of a side of the whole box a piece has.
    pub(super) fn share(&self, ends: &[[f64; 2]], side: usize) -> f64 {
        self.shares(ends)[side]
    }

    /// How much of each side of the whole box a piece has.
    fn shares(&self, ends: &[[f64; 2]]) -> Vec<f64> {
        let sides = ends.iter().zip(&self.whole);
        // Written so that a side that stands still has nothing.
        sides.map(|([from, to], [first, last])| ((to - from) / (last - first)).max(0.0)).collect()
    }

    /// The side of a piece that has most of its whole side.
    pub(super) fn widest(&self, ends: &[[f64; 2]]) -> Option<usize> {
        let shares = self.shares(ends);
        self.sides(ends).max_by(|&one, &other| shares[one].total_cmp(&shares[other]))
    }

    /// The side of a piece that leaves most of second order.
    pub(super) fn roughest(&self, ends: &[[f64; 2]]) -> Option<usize> {
        let left = |side: usize| self.width_without(ends, side);
        self.sides(ends).min_by(|&one, &other| left(one).total_cmp(&left(other)))
    }

    /// What is left of second order in a piece where one side stands in its middle.
    fn width_without(&self, ends: &[[f64; 2]], side: usize) -> f64 {
        let mut ends = ends.to_vec();
        let [from, to] = ends[side];
        ends[side] = [from + 0.5 * (to - from); 2];
        let widths = |model: &LoopModel<Interval>| {
            model.plant().rows.iter().map(|it| it.width()).sum::<f64>()
        };
        let first = |(_, loops): (_, Vec<LoopModel<Interval>>)| loops.first().map(widths);
        self.loops(&ends).ok().and_then(first).unwrap_or(f64::INFINITY)
    }
}

enum Found {
    Part(Part),
    Halves([Piece; 2]),
}

/// A claim that is found near a piece.
enum Near {
    /// About all of it, but for what intervals add.
    All(Claim),
    /// About the member in its middle.
    Middle(Claim),
    Nothing,
}

impl Near {
    fn claim(&self) -> Option<&Claim> {
        match self {
            Self::All(claim) | Self::Middle(claim) => Some(claim),
            Self::Nothing => None,
        }
    }
}

/// A piece, cut across a side.
pub(super) fn halves(piece: &Piece, side: usize) -> [Piece; 2] {
    let [from, to] = piece.ends[side];
    let at = from + 0.5 * (to - from);
    [[from, at], [at, to]].map(|half| {
        let mut ends = piece.ends.clone();
        ends[side] = half;
        Piece { ends, claim: piece.claim.clone() }
    })
}

/// One of the corners of a box, by the bits of its number.
fn at_corner(ends: &[[f64; 2]], corner: usize) -> Vec<f64> {
    ends.iter().enumerate().map(|(side, ends)| ends[corner >> side & 1]).collect()
}

pub(super) fn middle(ends: &[[f64; 2]]) -> Vec<f64> {
    ends.iter().map(|&[from, to]| from + 0.5 * (to - from)).collect()
}
