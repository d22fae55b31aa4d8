//! Looking for what disturbances do at most: forms in ordinary arithmetic, each believed after its re-check.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;

use super::{Effort, Prover, disturbed_moving};
use crate::certificate::{Certificate, Claim};
use crate::description::NotProvable;
use crate::disturbances::{DisturbanceBound, Extent, Quantity, Way};
use crate::recheck::{DrivenLoop, Recheck, RecheckError, Rechecked};
use crate::scope::Asked;
use crate::solve::{
    self, CountedRow, DrivenCorner, DrivenProblem, driven_form, form_at, kept_of, least_gain,
};

/// As in proofs of stability, corners are left away that lie outside of the others by no more than this; the gain is then
/// asked of all that span the set.
const THINNED: f64 = 0.01;
/// What is claimed of a gain beyond what ordinary arithmetic finds: first little, then what a form asks for whose
/// inequalities hold by little.
const CLAIMED: [f64; 3] = [1.0 + 1e-7, 1.0 + 1e-5, 1.0 + 1e-3];
/// The same of a form that moves with the gains, which is asked at some gains and has to hold between them.
const CLAIMED_MOVING: [f64; 4] = [1.0 + 1e-3, 1.0 + 1e-2, 1.0 + 5e-2, 1.2];
/// Times that conditions are added to a search for a form that moves, at gains that ask for more than this times what
/// those that were looked at do; and how many at a time.
const ROUNDS: usize = 3;
const MORE: f64 = 1.02;
const ADDED: usize = 16;
/// Such a search takes long, as the same condition is asked of every motion from every gain: fewer decays are tried, and
/// the least level is looked for less closely.
const CUTS_MOVING: usize = 1;
/// Such a form is looked for as if it had to fall faster, by this share of what that at the start leaves, so that it falls
/// at gains that were not looked at too.
const SPARED: f64 = 0.03;
const FINE_MOVING: f64 = 4.0;
/// Ends of $1 - \alpha$ of a peak, as shares of what the form of the claim leaves, and how often the range is cut.
const SHARES: [f64; 2] = [0.02, 0.95];
const CUTS: usize = 4;
/// How near to the least level a form is looked for, along the way and at its end.
const COARSE: f64 = 20.0;
const FINE: f64 = 0.5;
/// The golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Why no bound of disturbances is found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unbounded {
    /// The claim ties gains to something, and its form is another kind.
    #[error(
        "bounded are disturbances of loops that are stable however fast their gains move, or at a rate that their law keeps to; this one is proved with gains that are tied to something"
    )]
    OtherClaim,
    /// The law is not shown to keep its gains to the rate.
    #[error("the law is not shown to keep its gains to the rate of the proof")]
    RateNotKept,
    /// Nothing was found for any way.
    #[error("no form was found that bounds what a disturbance does")]
    NotFound,
    /// The loop is not one that a proof can speak of, or the search was stopped.
    #[error(transparent)]
    NotProvable(#[from] NotProvable),
    /// What was found is not proved.
    #[error(transparent)]
    Recheck(#[from] RecheckError),
}

/// A proved certificate with bounds of what disturbances do that enter these ways, re-checked.
///
/// Each bound has a form of its own. What is not found is left away, as long as something is found.
///
/// # Errors
/// [`Unbounded`].
pub fn bound_disturbances(
    certificate: &Certificate,
    ways: &[Way],
    effort: &Effort,
) -> Result<(Certificate, Rechecked), Unbounded> {
    let (range, left_out) = (certificate.range, certificate.left_out.clone());
    let asked = Asked { range, left_out, commands: Ok(None) };
    let prover = Prover::new(&certificate.description, &asked, effort)?;
    let set = prover.set(certificate.output_factor);
    let recheck = Recheck::with(certificate, prover.enclosed.clone(), set, &prover.slopes)?;
    let recheck = recheck.until(effort.stops);
    let rechecked = recheck.run()?;
    let places = match &certificate.claim {
        Claim::CommonQuadratic { form, .. } => Places::still(&recheck, form)?,
        Claim::BoundedRate(_) if !rechecked.keeps_to_the_rate => {
            return Err(Unbounded::RateNotKept);
        }
        Claim::BoundedRate(claim) => {
            let set = prover.set(certificate.output_factor);
            let places = disturbed_moving::places(&prover, &recheck, &set, claim)?;
            places.ok_or(Unbounded::NotFound)?
        }
        _ => return Err(Unbounded::OtherClaim),
    };
    let kept = kept_of(&places.start, &places.motions());
    let search = Search {
        left: kept.map_or(0.0, |kept| (1.0 - kept).max(0.0)),
        remains_rad: rechecked.remains_rad,
        corners: recheck.driven_corners()?,
        places,
        recheck: &recheck,
        certificate,
        effort: solve::Effort { stops: effort.stops, ..solve::Effort::default() },
    };
    let mut found = Vec::new();
    for way in ways {
        found.extend(search.of_way(way)?);
    }
    if (effort.stops)() {
        return Err(NotProvable::Stopped.into());
    }
    if found.is_empty() {
        return Err(Unbounded::NotFound);
    }
    let whole = Certificate { disturbances: found, ..certificate.clone() };
    let set = prover.set(certificate.output_factor);
    let rechecked = Recheck::with(&whole, prover.enclosed.clone(), set, &prover.slopes)?
        .until(effort.stops)
        .run()?;
    Ok((whole, rechecked))
}

struct Search<'a> {
    recheck: &'a Recheck<'a>,
    /// All corners of the gains, where the form does not move.
    corners: Vec<DrivenLoop>,
    places: Places,
    certificate: &'a Certificate,
    effort: solve::Effort,
    remains_rad: f64,
    /// What the form at the start leaves of 1 in a sample.
    left: f64,
}

/// The loop at some gains, and where a form that moves with them may be a sample later.
pub(super) struct Place {
    pub(super) at: DrivenLoop,
    /// In half widths, of the gains that the form moves with.
    pub(super) now: Vec<f64>,
    pub(super) next: Vec<Vec<f64>>,
}

/// Where a search looks.
pub(super) struct Places {
    /// Gains to solve for, and more that a form is measured at.
    pub(super) solved: Vec<Place>,
    pub(super) all: Vec<Place>,
    /// A form that decreases at all of them: $P_0$, then $P_j$ for each gain that it moves with.
    pub(super) start: Vec<Matrix>,
    /// Which gains those are.
    pub(super) moving: Vec<usize>,
}

impl Places {
    /// The loop at all gains, with every motion and without a disturbance.
    pub(super) fn motions(&self) -> Vec<DrivenCorner> {
        let none = Matrix::zeros(self.start.first().map_or(0, Matrix::rows), 0);
        self.all.iter().flat_map(|place| place.corners(&none, None)).collect()
    }

    /// Of a form that does not move: gains that nearly span all, and that do.
    fn still(recheck: &Recheck<'_>, form: &Matrix) -> Result<Self, RecheckError> {
        let place = |at| Place { at, now: Vec::new(), next: vec![Vec::new()] };
        let hull = |tolerance: f64| -> Result<Vec<Place>, RecheckError> {
            Ok(recheck.held_hull(tolerance)?.into_iter().map(place).collect())
        };
        let (solved, all) = (hull(THINNED)?, hull(0.0)?);
        Ok(Self { solved, all, start: vec![form.clone()], moving: Vec::new() })
    }
}

impl Place {
    /// The loop with each motion, for a disturbance, and what is seen of the state.
    fn corners<'a>(
        &'a self,
        entry: &'a Matrix,
        seen: Option<Vec<f64>>,
    ) -> impl Iterator<Item = DrivenCorner> + 'a {
        self.next.iter().map(move |next| DrivenCorner {
            matrix: self.at.matrix(),
            entry: entry.clone(),
            seen: seen.clone(),
            gains: [self.now.clone(), next.clone()],
        })
    }
}

/// A form, with what it is good for.
struct Found {
    /// $P_0$, then what each gain that it moves with adds.
    forms: Vec<Matrix>,
    decay: f64,
    gain: f64,
    /// What is to be small.
    measure: f64,
}

/// The loop at corners to solve for and at those that span all, for one bound, and rows whose largest values count.
struct Question {
    solved: Vec<DrivenCorner>,
    all: Vec<DrivenCorner>,
    rows: Vec<CountedRow>,
    all_rows: Vec<CountedRow>,
}

impl Search<'_> {
    fn of_way(&self, way: &Way) -> Result<Vec<DisturbanceBound>, Unbounded> {
        let description = &self.certificate.description;
        if way.not_covered(description).is_some() {
            return Ok(Vec::new());
        }
        let Ok(entry) = way.entry(description, self.states()) else { return Ok(Vec::new()) };
        let mut bounds = Vec::new();
        for extent in Extent::ALL {
            for quantity in Quantity::ALL {
                if self.recheck.not_bounded(quantity, extent, self.remains_rad).is_some() {
                    continue;
                }
                let mut question = self.question(&entry, quantity, extent);
                let found = match extent {
                    Extent::Energy => self.energy(&mut question).into_iter().collect(),
                    Extent::Peak => self.peak(&mut question),
                };
                let named = (way.clone(), quantity, extent);
                bounds.extend(found.iter().find_map(|found| self.believed(&named, found)));
            }
        }
        Ok(bounds)
    }

    /// The bound by a form, with as little beyond what was found as is proved.
    fn believed(
        &self,
        (way, quantity, extent): &(Way, Quantity, Extent),
        found: &Found,
    ) -> Option<DisturbanceBound> {
        let (form, moved) = found.forms.split_first()?;
        let is_moving = matches!(self.certificate.claim, Claim::BoundedRate(_));
        let by_gain = is_moving.then(|| {
            let mut by_gain = [0; 3].map(|_| Matrix::zeros(form.rows(), form.columns()));
            for (&gain, moved) in self.places.moving.iter().zip(moved) {
                by_gain[gain] = moved.clone();
            }
            by_gain
        });
        let bound = DisturbanceBound {
            way: way.clone(),
            quantity: *quantity,
            extent: *extent,
            decay: found.decay,
            gain: found.gain,
            form: form.clone(),
            by_gain,
        };
        let claimed: &[f64] = if is_moving { &CLAIMED_MOVING } else { &CLAIMED };
        let claims = claimed
            .iter()
            .map(|more| DisturbanceBound { gain: found.gain * more, ..bound.clone() });
        let holds = |bound: &DisturbanceBound| {
            self.recheck.bounded(bound, &self.corners, self.remains_rad).is_ok()
        };
        let mut claims = claims;
        claims.find(holds)
    }

    fn states(&self) -> usize {
        self.places.start.first().map_or(0, Matrix::rows)
    }

    fn question(&self, entry: &Matrix, quantity: Quantity, extent: Extent) -> Question {
        let dt_s = self.certificate.description.controller.config().dt_s;
        let is_seen = extent == Extent::Energy && quantity != Quantity::Limits;
        let of = |corner: &DrivenLoop| -> Vec<Vec<f64>> {
            let middles = |row: Vec<Interval>| row.into_iter().map(Interval::midpoint).collect();
            corner.rows(quantity).into_iter().map(middles).collect()
        };
        let at = |place: &Place| -> Vec<DrivenCorner> {
            let seen = of(&place.at).into_iter().next().filter(|_| is_seen);
            let seen = seen.map(|row| row.iter().map(|it| it * dt_s.sqrt()).collect::<Vec<f64>>());
            place.corners(entry, seen).collect()
        };
        let rows = |places: &[Place]| -> Vec<CountedRow> {
            let mut rows: Vec<CountedRow> = Vec::new();
            for place in places.iter().filter(|_| !is_seen) {
                let own = of(&place.at).into_iter();
                let own = own.map(|row| CountedRow { row, gains: place.now.clone() });
                // Many are the same at all corners.
                for row in own {
                    if !rows.contains(&row) {
                        rows.push(row);
                    }
                }
            }
            rows
        };
        let Places { solved, all, .. } = &self.places;
        Question {
            solved: solved.iter().flat_map(at).collect(),
            all: all.iter().flat_map(at).collect(),
            rows: rows(solved),
            all_rows: rows(all),
        }
    }

    /// The form of the least level, with β at all gains that it is measured at; of a form that moves, gains that ask for
    /// clearly more than the others are looked at as well.
    fn form(&self, question: &mut Question, decay: f64, reach: f64) -> Option<(Vec<Matrix>, f64)> {
        let rounds = if self.is_moving() { ROUNDS } else { 1 };
        for round in 1..=rounds {
            let near = if round < rounds { reach.max(COARSE) } else { reach };
            let (corners, rows) = (&question.solved, &question.rows);
            let spared = if self.is_moving() { SPARED * self.left } else { 0.0 };
            let problem = DrivenProblem { corners, rows, decay: decay - spared };
            let forms = driven_form(&problem, &self.places.start, &self.effort, near)?;
            let is_last = round == rounds || near <= reach && !question.asks_more(&forms, decay);
            if is_last {
                let gain = question.gain(&forms, decay)?;
                return Some((forms, gain));
            }
            if near > reach {
                question.asks_more(&forms, decay);
            }
        }
        None
    }

    fn is_moving(&self) -> bool {
        !self.places.moving.is_empty()
    }

    /// How near to the least level the last form is looked for.
    fn fine(&self) -> f64 {
        if self.is_moving() { FINE_MOVING } else { FINE }
    }

    fn energy(&self, question: &mut Question) -> Option<Found> {
        let (forms, gain) = self.form(question, 1.0, self.fine())?;
        Some(Found { forms, decay: 1.0, gain, measure: gain })
    }

    /// Forms of some decays, by the golden section of the logarithm of $1 - \alpha$, the best first.
    fn peak(&self, question: &mut Question) -> Vec<Found> {
        let left = self.left;
        if !(left > 0.0) {
            return Vec::new();
        }
        let mut at = |log: f64, reach: f64| {
            let decay = 1.0 - libm::exp(log);
            let (forms, gain) = self.form(question, decay, reach)?;
            let size = question.reach(&forms)?;
            Some(Found { forms, decay, gain, measure: size * size * gain / (1.0 - decay) })
        };
        let measure = |found: &Option<Found>| found.as_ref().map_or(f64::INFINITY, |it| it.measure);
        let [mut low, mut high] = SHARES.map(|share| libm::log(share * left));
        let inner =
            |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let [mut one, mut other] = inner(low, high).map(|log| at(log, COARSE));
        for _ in 0..if self.is_moving() { CUTS_MOVING } else { CUTS } {
            if measure(&one) <= measure(&other) {
                high = inner(low, high)[1];
                other = one;
                one = at(inner(low, high)[0], COARSE);
            } else {
                low = inner(low, high)[0];
                one = other;
                other = at(inner(low, high)[1], COARSE);
            }
        }
        let [first, second] = inner(low, high);
        let best = if measure(&one) <= measure(&other) { first } else { second };
        let found = [at(best, self.fine()), one, other];
        let mut found: Vec<Found> = found.into_iter().flatten().collect();
        found.sort_by(|a, b| a.measure.total_cmp(&b.measure));
        found
    }
}

impl Question {
    /// β at the corners that span all.
    fn gain(&self, forms: &[Matrix], decay: f64) -> Option<f64> {
        let gains = self.all.iter().map(|corner| least_gain(forms, decay, corner));
        let gain = gains.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max);
        (gain > 0.0 && gain.is_finite()).then_some(gain)
    }

    /// Takes those gains that ask for clearly more than the others to what is solved for; true if there are any.
    fn asks_more(&mut self, forms: &[Matrix], decay: f64) -> bool {
        let gain = |corner: &DrivenCorner| {
            least_gain(forms, decay, corner).filter(|it| it.is_finite()).unwrap_or(f64::INFINITY)
        };
        let most = self.solved.iter().map(gain).fold(0.0, f64::max);
        let mut beyond: Vec<(f64, &DrivenCorner)> = self
            .all
            .iter()
            .map(|corner| (gain(corner), corner))
            .filter(|(own, _)| *own > MORE * most)
            .collect();
        beyond.sort_by(|a, b| b.0.total_cmp(&a.0));
        let added: Vec<DrivenCorner> =
            beyond.into_iter().take(ADDED).map(|(_, corner)| corner.clone()).collect();
        let any = !added.is_empty();
        self.solved.extend(added);
        any
    }

    /// The root of the largest $r P^{-1} r^T$.
    fn reach(&self, forms: &[Matrix]) -> Option<f64> {
        let mut most = 0.0_f64;
        for CountedRow { row, gains } in &self.all_rows {
            let column: Vec<[f64; 1]> = row.iter().map(|value| [*value]).collect();
            let form = form_at(forms, gains)?;
            let solved = form.solve(&Matrix::from_rows(&column).ok()?).ok()?;
            most = most.max(row.iter().zip(solved.data()).map(|(r, x)| r * x).sum());
        }
        Some(most.sqrt())
    }
}
