//! Looking for what disturbances do at most: forms in ordinary arithmetic, each believed after its re-check.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;

use super::{Effort, Prover};
use crate::certificate::{Certificate, Claim};
use crate::description::NotProvable;
use crate::disturbances::{DisturbanceBound, Extent, Quantity, Way};
use crate::recheck::{DrivenLoop, Recheck, RecheckError, Rechecked};
use crate::scope::Asked;
use crate::solve::{self, DrivenCorner, DrivenProblem, driven_form, kept_of, least_gain};

/// As in proofs of stability, corners are left away that lie outside of the others by no more than this; the gain is then
/// asked of all that span the set.
const THINNED: f64 = 0.01;
/// What is claimed of a gain beyond what ordinary arithmetic finds: first little, then what a form asks for whose
/// inequalities hold by little.
const CLAIMED: [f64; 3] = [1.0 + 1e-7, 1.0 + 1e-5, 1.0 + 1e-3];
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
        "bounded are disturbances of loops that are stable however fast their gains move; this one is proved with gains that are tied to something"
    )]
    OtherClaim,
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
    let Claim::CommonQuadratic { form, .. } = &certificate.claim else {
        return Err(Unbounded::OtherClaim);
    };
    let asked = Asked { range: certificate.range, left_out: certificate.left_out.clone() };
    let prover = Prover::new(&certificate.description, &asked, effort)?;
    let set = prover.set(certificate.output_factor);
    let recheck = Recheck::with(certificate, prover.enclosed.clone(), set, &prover.slopes)?;
    let recheck = recheck.until(effort.stops);
    let search = Search {
        remains_rad: recheck.run()?.remains_rad,
        corners: recheck.driven_corners()?,
        hull: recheck.held_hull(THINNED)?,
        spanning: recheck.held_hull(0.0)?,
        recheck: &recheck,
        start: form,
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
    /// All corners of the gains, those that span them, and nearly.
    corners: Vec<DrivenLoop>,
    spanning: Vec<DrivenLoop>,
    hull: Vec<DrivenLoop>,
    /// The form of the claim, which decreases at every corner.
    start: &'a Matrix,
    certificate: &'a Certificate,
    effort: solve::Effort,
    remains_rad: f64,
}

/// A form, with what it is good for.
struct Found {
    form: Matrix,
    decay: f64,
    gain: f64,
    /// What is to be small.
    measure: f64,
}

/// The loop at corners to solve for and at those that span all, for one bound, and rows whose largest values count.
struct Question {
    solved: Vec<DrivenCorner>,
    all: Vec<DrivenCorner>,
    rows: Vec<Vec<f64>>,
    all_rows: Vec<Vec<f64>>,
}

impl Search<'_> {
    fn of_way(&self, way: &Way) -> Result<Vec<DisturbanceBound>, Unbounded> {
        let description = &self.certificate.description;
        if way.not_covered(description).is_some() {
            return Ok(Vec::new());
        }
        let Ok(entry) = way.entry(description, self.start.rows()) else { return Ok(Vec::new()) };
        let mut bounds = Vec::new();
        for extent in Extent::ALL {
            for quantity in Quantity::ALL {
                if self.recheck.not_bounded(quantity, extent, self.remains_rad).is_some() {
                    continue;
                }
                let question = self.question(&entry, quantity, extent);
                let found = match extent {
                    Extent::Energy => self.energy(&question),
                    Extent::Peak => self.peak(&question),
                };
                let claim = |found: &Found, more: f64| DisturbanceBound {
                    way: way.clone(),
                    quantity,
                    extent,
                    decay: found.decay,
                    gain: found.gain * more,
                    form: found.form.clone(),
                };
                let believed = |bound: &DisturbanceBound| {
                    self.recheck.bounded(bound, &self.corners, self.remains_rad).is_ok()
                };
                let claims = found.iter().flat_map(|found| CLAIMED.map(|more| claim(found, more)));
                bounds.extend(claims.into_iter().find(believed));
            }
        }
        Ok(bounds)
    }

    fn question(&self, entry: &Matrix, quantity: Quantity, extent: Extent) -> Question {
        let dt_s = self.certificate.description.controller.config().dt_s;
        let is_seen = extent == Extent::Energy && quantity != Quantity::Limits;
        let of = |corner: &DrivenLoop| -> Vec<Vec<f64>> {
            let middles = |row: Vec<Interval>| row.into_iter().map(Interval::midpoint).collect();
            corner.rows(quantity).into_iter().map(middles).collect()
        };
        let at = |corner: &DrivenLoop| DrivenCorner {
            matrix: corner.matrix(),
            entry: entry.clone(),
            seen: of(corner)
                .first()
                .filter(|_| is_seen)
                .map(|row| row.iter().map(|it| it * dt_s.sqrt()).collect()),
        };
        let rows = |corners: &[DrivenLoop]| -> Vec<Vec<f64>> {
            let mut rows: Vec<Vec<f64>> = Vec::new();
            // Many are the same at all corners.
            for row in corners.iter().filter(|_| !is_seen).flat_map(of) {
                if !rows.contains(&row) {
                    rows.push(row);
                }
            }
            rows
        };
        Question {
            solved: self.hull.iter().map(at).collect(),
            all: self.spanning.iter().map(at).collect(),
            rows: rows(&self.hull),
            all_rows: rows(&self.spanning),
        }
    }

    fn energy(&self, question: &Question) -> Option<Found> {
        let (corners, rows) = (&question.solved, &question.rows);
        let problem = DrivenProblem { corners, rows, decay: 1.0 };
        let form = driven_form(&problem, self.start, &self.effort, FINE)?;
        let gain = question.gain(&form, 1.0)?;
        Some(Found { form, decay: 1.0, gain, measure: gain })
    }

    /// The best of some decays, by the golden section of the logarithm of $1 - \alpha$.
    fn peak(&self, question: &Question) -> Option<Found> {
        let left = 1.0 - kept_of(self.start, &question.all)?;
        if !(left > 0.0) {
            return None;
        }
        let at = |log: f64, reach: f64| {
            let decay = 1.0 - libm::exp(log);
            let problem = DrivenProblem { corners: &question.solved, rows: &question.rows, decay };
            let form = driven_form(&problem, self.start, &self.effort, reach)?;
            let gain = question.gain(&form, decay)?;
            let size = question.reach(&form)?;
            Some(Found { form, decay, gain, measure: size * size * gain / (1.0 - decay) })
        };
        let measure = |found: &Option<Found>| found.as_ref().map_or(f64::INFINITY, |it| it.measure);
        let [mut low, mut high] = SHARES.map(|share| libm::log(share * left));
        let inner =
            |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let [mut one, mut other] = inner(low, high).map(|log| at(log, COARSE));
        for _ in 0..CUTS {
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
        let found = [at(best, FINE), one, other];
        found.into_iter().flatten().min_by(|a, b| a.measure.total_cmp(&b.measure))
    }
}

impl Question {
    /// β at the corners that span all.
    fn gain(&self, form: &Matrix, decay: f64) -> Option<f64> {
        let gains = self.all.iter().map(|corner| least_gain(form, decay, corner));
        let gain = gains.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max);
        (gain > 0.0 && gain.is_finite()).then_some(gain)
    }

    /// The root of the largest $r P^{-1} r^T$.
    fn reach(&self, form: &Matrix) -> Option<f64> {
        let mut most = 0.0_f64;
        for row in &self.all_rows {
            let column: Vec<[f64; 1]> = row.iter().map(|value| [*value]).collect();
            let solved = form.solve(&Matrix::from_rows(&column).ok()?).ok()?;
            most = most.max(row.iter().zip(solved.data()).map(|(r, x)| r * x).sum());
        }
        Some(most.sqrt())
    }
}
