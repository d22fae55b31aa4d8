//! Looks for the proof of a family: a form at the middle of a part, asked for the whole part, which is cut where it fails.

use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopModel;

use super::{Family, MOST_PARTS, Parameter, Part};
use crate::certificate::Claim;
use crate::check::{EnclosedPlant, NotProved};
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

/// What came of a family.
#[derive(Clone, Debug, PartialEq)]
pub enum FamilyVerdict {
    /// Every member is stable.
    Proved(Family),
    /// A member grows: with gains that the controller has, standing still.
    Refuted {
        /// The member, parameter by parameter.
        at: Vec<f64>,
        /// At which gains its loop grows, and how: a certificate, whose loop is the one as it is, and the member's plant.
        claim: Claim,
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
    /// No plant can be enclosed there.
    #[error("{0}")]
    Plant(NotProved),
}

/// Proves or refutes the stability of every member around rest.
///
/// `enclose` answers a plant that holds those of all members with parameters in these intervals.
///
/// # Errors
/// As [`certify`](crate::certify).
pub fn prove_family(
    description: &LoopDescription,
    parameters: &[Parameter],
    effort: &Effort,
    enclose: &dyn Fn(&[Interval]) -> Result<EnclosedPlant, NotProved>,
) -> Result<FamilyVerdict, NotProvable> {
    let asked = Asked::rest();
    let prover = Prover::new(description, &asked, effort)?;
    let set = prover.set(1.0);
    let whole: Vec<[f64; 2]> = parameters.iter().map(|one| one.ends).collect();
    let mut search = Search { prover, set, enclose, whole, searches: 0, stops: effort.stops };
    search.run(parameters)
}

struct Search<'a> {
    prover: Prover<'a>,
    set: GainSet,
    enclose: &'a dyn Fn(&[Interval]) -> Result<EnclosedPlant, NotProved>,
    whole: Vec<[f64; 2]>,
    searches: usize,
    stops: fn() -> bool,
}

/// A piece of the box, and a claim that held near it.
struct Piece {
    ends: Vec<[f64; 2]>,
    claim: Option<Claim>,
}

impl Search<'_> {
    fn run(&mut self, parameters: &[Parameter]) -> Result<FamilyVerdict, NotProvable> {
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
        Ok(FamilyVerdict::Proved(Family { parameters: parameters.to_vec(), parts }))
    }

    /// A proof of a piece, or its halves; an answer for all where there is one.
    fn piece(&mut self, piece: Piece) -> Result<Found, FamilyVerdict> {
        let open = |because| FamilyVerdict::Open { ends: piece.ends.clone(), because };
        let plant = match (self.enclose)(&intervals(&piece.ends)) {
            Ok(plant) => plant,
            // A narrower piece may do.
            Err(reason) => {
                let halves = self.halves(&piece).ok_or_else(|| open(Uncertain::Plant(reason)))?;
                return Ok(Found::Halves(halves));
            }
        };
        let model = self.model(&plant).ok();
        let kept = piece
            .claim
            .clone()
            .filter(|claim| model.as_ref().is_some_and(|model| self.holds(claim, model)));
        if let Some(claim) = kept {
            return Ok(Found::Part(Part { ends: piece.ends, plant, claim }));
        }
        let claim = self.claim_at_middle(&piece)?;
        if model.as_ref().is_some_and(|model| self.holds(&claim, model)) {
            return Ok(Found::Part(Part { ends: piece.ends, plant, claim }));
        }
        let ends = piece.ends.clone();
        let halves = self.halves(&Piece { ends, claim: Some(claim) });
        halves.map(Found::Halves).ok_or_else(|| open(Uncertain::Narrow))
    }

    /// A claim about the member in the middle of a piece.
    fn claim_at_middle(&mut self, piece: &Piece) -> Result<Claim, FamilyVerdict> {
        let open = |because| FamilyVerdict::Open { ends: piece.ends.clone(), because };
        let middle: Vec<f64> =
            piece.ends.iter().map(|&[from, to]| from + 0.5 * (to - from)).collect();
        self.searches += 1;
        if self.searches > MOST_SEARCHES {
            return Err(open(Uncertain::Work));
        }
        let prover = self.member(&middle).map_err(|reason| open(Uncertain::Plant(reason)))?;
        if let Some(Verdict::Refuted(certificate, _)) = prover.frozen_growth() {
            return Err(FamilyVerdict::Refuted { at: middle, claim: certificate.claim });
        }
        let found = prover.stable(&self.set).map(|(certificate, _)| certificate.claim);
        found.ok_or_else(|| open(Uncertain::Member))
    }

    /// A corner of the box whose loop grows: asked first, since it ends most searches that end so.
    fn growing_corner(&self) -> Option<FamilyVerdict> {
        (0..1_usize << self.whole.len()).find_map(|corner| {
            let end = |(place, ends): (usize, &[f64; 2])| ends[corner >> place & 1];
            let at: Vec<f64> = self.whole.iter().enumerate().map(end).collect();
            match self.member(&at).ok()?.frozen_growth()? {
                Verdict::Refuted(certificate, _) => {
                    Some(FamilyVerdict::Refuted { at, claim: certificate.claim })
                }
                Verdict::Proved(..) | Verdict::Open => None,
            }
        })
    }

    /// The prover of one member.
    fn member(&self, at: &[f64]) -> Result<Prover<'_>, NotProved> {
        let at: Vec<Interval> = at.iter().map(|&value| Interval::point(value)).collect();
        Ok(self.prover.of(self.model(&(self.enclose)(&at)?)?))
    }

    fn model(&self, plant: &EnclosedPlant) -> Result<LoopModel<Interval>, NotProved> {
        let description = self.prover.description();
        let dt_s = description.controller.config().dt_s;
        Ok(LoopModel::new(plant.sampled(dt_s)?, description.settings()))
    }

    /// True if a claim is proved of every loop within a model.
    fn holds(&self, claim: &Claim, model: &LoopModel<Interval>) -> bool {
        self.prover.of(model.clone()).rechecked(claim.clone(), 1.0, None).is_some()
    }

    /// A piece, cut across the side that widens its loop most.
    fn halves(&self, piece: &Piece) -> Option<[Piece; 2]> {
        let wide = |side: &usize| {
            let ([from, to], [first, last]) = (piece.ends[*side], self.whole[*side]);
            to - from > SMALLEST * (last - first)
        };
        let sides = (0..piece.ends.len()).filter(wide);
        let side = sides.min_by(|one, other| {
            let width = |side: usize| self.width_without(piece, side);
            width(*one).total_cmp(&width(*other))
        })?;
        let [from, to] = piece.ends[side];
        let at = from + 0.5 * (to - from);
        Some([[from, at], [at, to]].map(|half| {
            let mut ends = piece.ends.clone();
            ends[side] = half;
            Piece { ends, claim: piece.claim.clone() }
        }))
    }

    /// How wide the loop of a piece is where one side stands in its middle.
    fn width_without(&self, piece: &Piece, side: usize) -> f64 {
        let mut ends = piece.ends.clone();
        let [from, to] = ends[side];
        ends[side] = [from + 0.5 * (to - from); 2];
        let model = (self.enclose)(&intervals(&ends)).and_then(|plant| self.model(&plant));
        model.map_or(f64::INFINITY, |model| model.plant().rows.iter().map(|it| it.width()).sum())
    }
}

enum Found {
    Part(Part),
    Halves([Piece; 2]),
}

fn intervals(ends: &[[f64; 2]]) -> Vec<Interval> {
    ends.iter().map(|&[from, to]| Interval::between(from, to)).collect()
}
