//! What disturbances do at most, proved anew from their forms.

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::LoopModel;

use super::moving::RowAt;
use super::{Corner, Recheck, RecheckError, malformed, points};
use crate::certificate::{BoundedRate, Claim};
use crate::check::{
    Driven, Ellipsoid, IntervalMatrix, MovingDrive, NotProved, grows_no_faster, printed,
};
use crate::disturbances::{DisturbanceBound, Disturbed, Extent, Quantity, exact, first_of};
use crate::gain_set::HeldGains;
use crate::limits;

/// The loop at some gains, with everything that a bound asks of it.
pub(crate) struct DrivenLoop {
    gains: Gains<f64>,
    matrix: IntervalMatrix,
    command: Vec<Interval>,
    /// Rows to everything that is limited, each with its limit; none where limits are not covered.
    limits: Option<Vec<(Vec<Interval>, f64)>>,
}

impl DrivenLoop {
    /// M in the middle.
    pub(crate) fn matrix(&self) -> Matrix {
        self.matrix.midpoint()
    }

    /// Rows to a quantity; to all that is limited as shares of the limits, none where that cannot be told.
    pub(crate) fn rows(&self, quantity: Quantity) -> Vec<Vec<Interval>> {
        match quantity {
            Quantity::Pitch => vec![first_of(self.matrix.rows())],
            Quantity::Command => vec![self.command.clone()],
            Quantity::Limits => self.shares().unwrap_or_default(),
        }
    }

    fn shares(&self) -> Option<Vec<Vec<Interval>>> {
        let share = |(row, limit): &(Vec<Interval>, f64)| {
            let limit = Some(Interval::point(*limit)).filter(|_| *limit > 0.0)?;
            Some(row.iter().map(|entry| *entry / limit).collect())
        };
        self.limits.as_ref()?.iter().map(share).collect()
    }
}

impl Recheck<'_> {
    /// Proves all bounds of the certificate; `remains_rad` is what never ceases without a disturbance.
    pub(super) fn disturbed(&self, remains_rad: f64) -> Result<Vec<Disturbed>, RecheckError> {
        let bounds = &self.certificate.disturbances;
        if bounds.is_empty() {
            return Ok(Vec::new());
        }
        let corners = self.driven_corners()?;
        let proved = bounds.iter().map(|bound| self.bounded(bound, &corners, remains_rad));
        let proved = proved.collect::<Result<Vec<Disturbed>, RecheckError>>()?;
        let best = |of: &Disturbed| {
            let same = proved.iter().filter(|it| it.way == of.way && it.extent == of.extent);
            same.filter_map(|it| it.unlimited_up_to).reduce(f64::max)
        };
        let told = proved.iter().filter(|it| it.quantity != Quantity::Limits);
        Ok(told.map(|it| Disturbed { unlimited_up_to: best(it), ..it.clone() }).collect())
    }

    /// The loop at all corners of its gains; none where the form moves with the gains, and the corners of each bound are
    /// those of its own proof.
    pub(crate) fn driven_corners(&self) -> Result<Vec<DrivenLoop>, RecheckError> {
        match &self.certificate.claim {
            Claim::CommonQuadratic { .. } => {
                self.held.held_corners().map(|(_, held)| self.driven_corner(held)).collect()
            }
            Claim::BoundedRate(_) => Ok(Vec::new()),
            _ => Err(malformed(
                "disturbances: bounded are those of a loop that is stable however fast its gains move, or at a rate that its law keeps to",
            )),
        }
    }

    /// The loop at corners that span the others but for a share of half the set's extent.
    pub(crate) fn held_hull(&self, tolerance: f64) -> Result<Vec<DrivenLoop>, RecheckError> {
        let hull = self.held.held_hull(tolerance);
        hull.into_iter().map(|held| self.driven_corner(held)).collect()
    }

    /// The loop at some gains, with what is held there.
    fn driven_corner(&self, held: HeldGains) -> Result<DrivenLoop, RecheckError> {
        let matrix = self.held_loop(held)?;
        let model = self.model.with_change_gain(Interval::point(held.change_gain));
        Ok(self.driven_loop(matrix, &model, points(held.gains)))
    }

    /// The loop at some gains at which nothing is held.
    pub(crate) fn driven_at(&self, gains: Gains<Interval>) -> Result<DrivenLoop, RecheckError> {
        Ok(self.driven_loop(self.closed(gains)?, &self.model, gains))
    }

    fn driven_loop(
        &self,
        matrix: IntervalMatrix,
        model: &LoopModel<Interval>,
        at: Gains<Interval>,
    ) -> DrivenLoop {
        let mut command = model.command_row(at);
        // Gains that remember what is held add to the command; it is not bounded then.
        command.resize(matrix.rows(), Interval::ZERO);
        let description = &self.certificate.description;
        let limits = self.covers_limits().then(|| limits::rows(description, model, at, &self.rest));
        let Gains { kp, ki, kd } = at;
        let gains = Gains { kp: kp.midpoint(), ki: ki.midpoint(), kd: kd.midpoint() };
        DrivenLoop { gains, matrix, command, limits }
    }

    /// What a disturbance of measure 1 takes of a limit beside what it reaches of the state: one that enters at the servo is
    /// there in the servo's command and, through its lag, in its deflection.
    fn beside_limits(&self, bound: &DisturbanceBound) -> Interval {
        let at_servo = bound.way.is_at_servo_too(&self.certificate.description);
        let most = if at_servo && bound.extent == Extent::Peak { 2.0 } else { 0.0 };
        Interval::point(most)
    }

    /// Whether it can be told where limits act: not where something else keeps the loop from rest.
    fn covers_limits(&self) -> bool {
        self.is_exact() && limits::not_covered(&self.certificate.description).is_none()
    }

    /// True where nothing but disturbances has a way into the deviation from rest.
    fn is_exact(&self) -> bool {
        !self.is_blurred() && self.off_rad == 0.0 && self.held.remembered.is_none()
    }

    /// Why a quantity is not bounded, if so.
    pub(crate) fn not_bounded(
        &self,
        quantity: Quantity,
        extent: Extent,
        remains_rad: f64,
    ) -> Option<&'static str> {
        if quantity == Quantity::Command && !self.is_exact() {
            return Some(
                "the command also answers to what a sensor rounds, or gains make of a held command",
            );
        }
        if quantity == Quantity::Limits
            && (!self.covers_limits() || self.certificate.description.limits().is_empty())
        {
            return Some("there are no limits, or it cannot be told where they act");
        }
        (extent == Extent::Energy && remains_rad > 0.0).then_some(
            "something of bounded size never ceases in the loop, so that its deviations have no finite energy",
        )
    }

    /// Proves one bound; the corners are those of a claim whose form does not move.
    pub(crate) fn bounded(
        &self,
        bound: &DisturbanceBound,
        corners: &[DrivenLoop],
        remains_rad: f64,
    ) -> Result<Disturbed, RecheckError> {
        let DisturbanceBound { way, quantity, extent, decay, .. } = bound;
        let description = &self.certificate.description;
        let not = self.not_bounded(*quantity, *extent, remains_rad);
        if let Some(what) = not.or_else(|| way.not_covered(description)) {
            return Err(malformed(what));
        }
        let is_of = match extent {
            Extent::Energy => decay.total_cmp(&1.0).is_eq(),
            Extent::Peak => *decay < 1.0,
        };
        if !is_of {
            return Err(malformed(
                "disturbances: the decay is 1 of an energy and below it of a peak",
            ));
        }
        match (&self.certificate.claim, &bound.by_gain) {
            (Claim::CommonQuadratic { .. }, None) => {
                self.driven_at_corners(bound, corners)?;
                let ellipsoid = Ellipsoid::of(&bound.form)?;
                let places = corners.iter().map(|corner| (corner, &ellipsoid));
                self.reached(bound, places.collect())
            }
            (Claim::BoundedRate(claim), Some(by_gain)) => {
                let places = self.driven_while_moving(bound, by_gain, claim)?;
                self.reached(bound, places.iter().map(|(at, own)| (at, own)).collect())
            }
            _ => Err(malformed(
                "disturbances: a form moves with the gains where the claim is about their rate, and only there",
            )),
        }
    }

    /// What is reached, by a proved bound, over ellipsoids at gains between which all lie.
    fn reached(
        &self,
        bound: &DisturbanceBound,
        places: Vec<(&DrivenLoop, &Ellipsoid)>,
    ) -> Result<Disturbed, RecheckError> {
        let DisturbanceBound { way, quantity, extent, gain, .. } = bound;
        let reached = Reached { places, size: reached_size(bound, self.root_of_period()) };
        Ok(Disturbed {
            way: way.clone(),
            quantity: *quantity,
            extent: *extent,
            at_servo: way.is_at_servo_too(&self.certificate.description),
            per_unit: match (extent, quantity) {
                (Extent::Energy, Quantity::Pitch | Quantity::Command) => {
                    Interval::point(*gain).sqrt().upper()
                }
                (Extent::Peak, _) | (_, Quantity::Limits) => reached.largest(*quantity)?,
            },
            unlimited_up_to: reached.unlimited(self.beside_limits(bound))?,
        })
    }

    fn root_of_period(&self) -> Interval {
        printed(self.certificate.description.controller.config().dt_s).sqrt()
    }

    /// Proves the inequality of a bound whose form does not move, at each corner.
    fn driven_at_corners(
        &self,
        bound: &DisturbanceBound,
        corners: &[DrivenLoop],
    ) -> Result<(), RecheckError> {
        let DisturbanceBound { way, quantity, decay, gain, form, .. } = bound;
        let size = self.model.size() + self.more_states();
        let entry = exact(&way.entry(&self.certificate.description, size)?);
        let root_of_period = self.root_of_period();
        for corner in corners {
            self.unless_stopped()?;
            let scaled = |row: Vec<Interval>| -> Vec<Interval> {
                row.into_iter().map(|it| it * root_of_period).collect()
            };
            let is_seen = bound.is_seen();
            let seen = corner.rows(*quantity).into_iter().next().filter(|_| is_seen).map(scaled);
            if is_seen && seen.is_none() {
                return Err(malformed("disturbances: nothing is seen of the quantity"));
            }
            let driven = Driven { matrix: &corner.matrix, entry: &entry, seen: seen.as_deref() };
            grows_no_faster(form, [*decay, *gain], driven)
                .map_err(|reason| RecheckError::Inequality { gains: Some(corner.gains), reason })?;
        }
        Ok(())
    }

    fn unless_stopped(&self) -> Result<(), RecheckError> {
        if (self.stops)() { Err(malformed("nobody wants the answer any more")) } else { Ok(()) }
    }

    /// Proves the inequality of a bound whose form moves with the gains: everywhere in cells that hold all of them. The
    /// loop and the ellipsoid at the corners of the cells: how far a row reaches is convex in row and form together,
    /// which are affine in the gains, so that it reaches no further between the corners.
    fn driven_while_moving(
        &self,
        bound: &DisturbanceBound,
        by_gain: &[Matrix; 3],
        claim: &BoundedRate,
    ) -> Result<Vec<(DrivenLoop, Ellipsoid)>, RecheckError> {
        self.unless_stopped()?;
        let DisturbanceBound { way, quantity, decay, gain, form, .. } = bound;
        let [kp, ki, kd] = by_gain.clone();
        let forms = [form.clone(), kp, ki, kd];
        let own = BoundedRate { forms, rate: 1.0, ..claim.clone() };
        let size = self.model.size();
        let entry = exact(&way.entry(&self.certificate.description, size)?);
        let drive = MovingDrive { decay: *decay, gain: *gain, entry: &entry, seen: None };
        let root_of_period = self.root_of_period();
        let row = |[kp, ki, kd]: [Interval; 3]| {
            let row = match quantity {
                Quantity::Pitch => first_of(size),
                _ => self.model.command_row(Gains { kp, ki, kd }),
            };
            let row: Vec<Interval> = row.into_iter().map(|it| it * root_of_period).collect();
            IntervalMatrix::from_rows(&[row]).map_err(|error| NotProved::from(error).into())
        };
        let seen: Option<&RowAt<'_>> = if bound.is_seen() { Some(&row) } else { None };
        let decrease = self.moving_driven(&own, &drive, seen)?;
        // A disturbance may take the state anywhere: it is not enough that gains keep to the rate near rest. And the form
        // of this bound may move with other gains than that of the claim.
        if !self.keeps_everywhere(&own, &decrease) {
            return Err(malformed(
                "disturbances: the law is not shown to keep to the rate in every flight",
            ));
        }
        let corners = decrease.corners(&own)?;
        let place = |corner: &Corner| -> Result<(DrivenLoop, Ellipsoid), RecheckError> {
            Ok((self.driven_at(corner.gains)?, Ellipsoid::of_all(&corner.form)?))
        };
        corners.iter().map(place).collect()
    }
}

/// The root of the level that a disturbance of measure 1 reaches: $V \le \beta$ of an energy,
/// $V \le \beta T / (1 - \alpha)$ of a peak.
fn reached_size(bound: &DisturbanceBound, root_of_period: Interval) -> Interval {
    let root = Interval::point(bound.gain).sqrt();
    match bound.extent {
        Extent::Energy => root,
        Extent::Peak => {
            let left = Interval::ONE - Interval::point(bound.decay);
            root * root_of_period / left.sqrt()
        }
    }
}

/// What a disturbance of measure 1 reaches of the state: an ellipsoid at each of some gains.
struct Reached<'a> {
    places: Vec<(&'a DrivenLoop, &'a Ellipsoid)>,
    /// The root of the level.
    size: Interval,
}

impl Reached<'_> {
    /// The most that a quantity is off, at any of the gains.
    fn largest(&self, quantity: Quantity) -> Result<f64, NotProved> {
        let mut most = 0.0_f64;
        for (corner, ellipsoid) in &self.places {
            for row in corner.rows(quantity) {
                most = most.max((ellipsoid.reach(&row)? * self.size).upper());
            }
        }
        Ok(most)
    }

    /// The largest measure at which no limit acts, from below.
    fn unlimited(&self, beside: Interval) -> Result<Option<f64>, NotProved> {
        let mut most = f64::INFINITY;
        for (corner, ellipsoid) in &self.places {
            let Some(rows) = &corner.limits else { return Ok(None) };
            for (row, limit) in rows {
                // Written so that NaN is refused.
                if !(*limit > 0.0) {
                    return Ok(None);
                }
                let reached = ellipsoid.reach(row)? * self.size + beside;
                if reached.upper() > 0.0 {
                    most = most.min((Interval::point(*limit) / reached).lower());
                }
            }
        }
        Ok(Some(most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disturbances::Way;

    fn row(entries: [f64; 2]) -> Vec<Interval> {
        entries.map(Interval::point).to_vec()
    }

    fn driven(command: [f64; 2], limits: Option<Vec<(Vec<Interval>, f64)>>) -> DrivenLoop {
        DrivenLoop {
            gains: Gains { kp: 1.0, ki: 0.0, kd: 0.0 },
            matrix: IntervalMatrix::from_rows(&[row([0.5, 0.0]), row([0.0, 0.5])]).expect("square"),
            command: row(command),
            limits,
        }
    }

    fn ellipsoid(diagonal: [f64; 2]) -> Ellipsoid {
        let form = Matrix::from_rows(&[[diagonal[0], 0.0], [0.0, diagonal[1]]]).expect("square");
        Ellipsoid::of(&form).expect("positive")
    }

    /// At least the number, and hardly more.
    fn is_just(found: f64, number: f64) {
        assert!(found >= number && found <= number * (1.0 + 1e-9), "{found} {number}");
    }

    #[test]
    fn an_energy_reaches_the_root_of_its_gain_and_a_peak_what_it_does_for_ever() {
        let bound = |extent: Extent, decay: f64| DisturbanceBound {
            way: Way::Elevator,
            quantity: Quantity::Pitch,
            extent,
            decay,
            gain: 4.0,
            form: Matrix::identity(2),
            by_gain: None,
        };
        let root_of_period = Interval::point(0.125);
        is_just(reached_size(&bound(Extent::Energy, 1.0), root_of_period).upper(), 2.0);
        // $\sqrt{4} \cdot 0.125 / \sqrt{1 - 0.75}$
        is_just(reached_size(&bound(Extent::Peak, 0.75), root_of_period).upper(), 0.5);
    }

    #[test]
    fn the_most_of_a_quantity_is_that_at_the_gains_where_it_reaches_furthest() {
        // A limit of 4 on twice the pitch angle.
        let limits = || Some(vec![(row([2.0, 0.0]), 4.0)]);
        let (near, far) = (driven([1.0, 2.0], limits()), driven([1.0, 0.0], limits()));
        let (narrow, wide) = (ellipsoid([4.0, 1.0]), ellipsoid([1.0, 1.0]));
        let size = Interval::point(3.0);
        let alone = Reached { places: vec![(&near, &narrow)], size };
        let both = Reached { places: vec![(&near, &narrow), (&far, &wide)], size };
        let most = |reached: &Reached<'_>, quantity| reached.largest(quantity).expect("bounded");
        is_just(most(&alone, Quantity::Pitch), 1.5);
        is_just(most(&both, Quantity::Pitch), 3.0);
        is_just(most(&alone, Quantity::Command), 3.0 * 4.25_f64.sqrt());
        is_just(most(&both, Quantity::Command), 3.0 * 4.25_f64.sqrt());
        is_just(most(&alone, Quantity::Limits), 0.75);
        is_just(most(&both, Quantity::Limits), 1.5);
    }

    #[test]
    fn no_limit_acts_up_to_where_the_first_of_them_is_reached() {
        let size = Interval::point(3.0);
        let form = ellipsoid([4.0, 1.0]);
        let up_to = |limits: Option<Vec<(Vec<Interval>, f64)>>, beside: f64| {
            let place = driven([1.0, 2.0], limits);
            let reached = Reached { places: vec![(&place, &form)], size };
            reached.unlimited(Interval::point(beside)).expect("bounded")
        };
        // Twice the pitch angle reaches 3 of 4, or 5 with what is beside it.
        let pitch = (row([2.0, 0.0]), 4.0);
        let told = up_to(Some(vec![pitch.clone()]), 0.0).expect("told");
        assert!((4.0 / 3.0 - 1e-9..=4.0 / 3.0).contains(&told), "{told}");
        let told = up_to(Some(vec![pitch.clone()]), 2.0).expect("told");
        assert!((0.8 - 1e-9..=0.8).contains(&told), "{told}");
        let nearer = (row([0.0, 1.0]), 1.0);
        let told = up_to(Some(vec![pitch.clone(), nearer]), 0.0).expect("told");
        assert!((1.0 / 3.0 - 1e-9..=1.0 / 3.0).contains(&told), "{told}");
        for limit in [0.0, -1.0, f64::NAN] {
            assert_eq!(up_to(Some(vec![pitch.clone(), (row([0.0, 0.0]), limit)]), 0.0), None);
        }
        assert_eq!(up_to(None, 0.0), None, "it cannot be told where limits act");
        assert_eq!(up_to(Some(vec![(row([0.0, 0.0]), 1.0)]), 0.0), Some(f64::INFINITY));
    }

    #[test]
    fn limits_are_seen_as_shares_of_themselves_where_something_is_left_of_each() {
        let place = |limits| driven([1.0, 2.0], limits);
        let left = place(Some(vec![(row([2.0, 0.0]), 4.0), (row([0.0, 3.0]), 1.5)]));
        let seen = left.rows(Quantity::Limits);
        let middle =
            |row: &Vec<Interval>| -> Vec<f64> { row.iter().map(|it| it.midpoint()).collect() };
        assert_eq!(seen.iter().map(middle).collect::<Vec<_>>(), [[0.5, 0.0], [0.0, 2.0]]);
        assert_eq!(left.rows(Quantity::Pitch), [row([1.0, 0.0])]);
        assert_eq!(left.rows(Quantity::Command), [row([1.0, 2.0])]);
        assert!(place(Some(vec![(row([2.0, 0.0]), 0.0)])).rows(Quantity::Limits).is_empty());
        assert!(place(None).rows(Quantity::Limits).is_empty());
    }
}
