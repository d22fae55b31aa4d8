//! The gains of a self-tuner whose flight stays near the trim.
//!
//! A supervisor that sees little answers little. While a motion keeps to a box, error and what is seen beside it keep to
//! bounds; over these the increments of the gains have bounds of their own, and so have the gains that the law makes of them,
//! from the nominal ones on. With such gains the motion keeps to the box for one sample more.
//!
//! The reference model of a supervisor that sees one begins at rest at the first measurement. With the set-point at the trim
//! it comes there by itself, and is never further off than some factor times the pitch angle it began at.

use fspid_core::equations::SecondInputKind;
use fspid_core::{Change, Fspid};
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_sim::loop_model::{LoopModel, Sensing};

use crate::check::{NotProved, reach};
use crate::gain_set::{GainSet, GainsOver};
use crate::reference_model::most_from_rest;
use crate::steps::system_of;

use super::Reach;

/// A controller computes its inputs with some roundings, which are no larger than this share of them.
const ROUNDED_UP: f64 = 1.0 + 1e-12;

/// What a supervisor sees of a motion, and what its tuner makes of it.
pub(super) struct Near<'a> {
    fspid: &'a Fspid<f64>,
    /// Most that the reference model is off, in units of where it began; 0 without one.
    model: f64,
}

impl<'a> Near<'a> {
    /// None where nothing holds a reference model.
    pub(super) fn of(fspid: &'a Fspid<f64>) -> Option<Self> {
        let equations = fspid.tuner_equations();
        let model = match equations.structure.second_input {
            SecondInputKind::ModelError => most_from_rest(equations)?,
            SecondInputKind::Change | SecondInputKind::Rate => 0.0,
        };
        Some(Self { fspid, model })
    }

    fn second_input(&self) -> SecondInputKind {
        self.fspid.tuner_equations().structure.second_input
    }

    /// How far error and what is seen beside it come in a box, but for where a reference model is: pitch and pitch rate do, and
    /// so does the pitch angle within a sample.
    ///
    /// $$ |e_k - e_{k-1}| = \Big| \int_{(k-1) T}^{k T} q \ dt \Big| \le T r_q $$
    pub(super) fn in_box(&self, reach: &Reach) -> [f64; 2] {
        let [pitch_rad, rate_rad_s, ..] = reach.motion;
        let dt_s = self.fspid.config().dt_s;
        let second = match (self.second_input(), self.fspid.tuner().settings().change) {
            (SecondInputKind::ModelError, _) => pitch_rad,
            (SecondInputKind::Rate, _) | (SecondInputKind::Change, Change::Rate) => rate_rad_s,
            (SecondInputKind::Change, Change::Delta) => rate_rad_s * dt_s,
        };
        [pitch_rad, second]
    }

    /// Rows from the state of a loop to what is seen, each with its most in the box: of sensors that show what is and nothing
    /// else there are none, for they show what keeps to the box anyway.
    pub(super) fn rows(
        &self,
        model: &LoopModel<Interval>,
        reach: &Reach,
    ) -> Vec<(Vec<Interval>, f64)> {
        let [of_pitch, of_rate] = [&model.settings().pitch, &model.settings().rate];
        let [error_most, second_most] = self.in_box(reach);
        let [error, change] = model.error_rows();
        let is_direct = |sensing: &Sensing| *sensing == Sensing::DIRECT;
        let second = match (self.second_input(), self.fspid.tuner().settings().change) {
            (SecondInputKind::ModelError, _) => None,
            (SecondInputKind::Rate, _) => (!is_direct(of_rate)).then(|| {
                let [_, rate] = model.seen_rows();
                rate
            }),
            (SecondInputKind::Change, unit) => (!is_direct(of_pitch)).then(|| {
                let time_s = match unit {
                    Change::Rate => Interval::point(self.fspid.config().dt_s),
                    Change::Delta => Interval::ONE,
                };
                change.into_iter().map(|entry| entry / time_s).collect()
            }),
        };
        let error = (!is_direct(of_pitch)).then_some((error, error_most));
        error.into_iter().chain(second.map(|row| (row, second_most))).collect()
    }

    /// As [`in_box`](Self::in_box) of motions that keep to a box and, at samples, to $z^T P z \le$ `level` in it, where that
    /// bounds what sensors show which do not show what is.
    pub(super) fn within(
        &self,
        model: &LoopModel<Interval>,
        box_: &Reach,
        (form, level): (&Matrix, f64),
    ) -> Result<[f64; 2], NotProved> {
        for (row, most) in self.rows(model, box_) {
            // Written so that NaN is too much.
            if !(reach(form, level, &row)? <= most) {
                return Err(NotProved::NotKept);
            }
        }
        Ok(self.in_box(box_))
    }

    /// All gains from the nominal ones on while the rows keep to these sizes; none where nothing bounds them.
    pub(super) fn gains(&self, [error, second]: [f64; 2]) -> Option<GainSet> {
        let tuner = self.fspid.tuner();
        let scale = tuner.settings().input_scale;
        let seen = |row: f64, model: f64, per_rad: f64| {
            let most = Interval::point(row) + Interval::point(model) * Interval::point(error);
            (most * Interval::point(per_rad.abs() * ROUNDED_UP)).upper()
        };
        let seen =
            [seen(error, 0.0, scale.error_per_rad), seen(second, self.model, scale.change_per_rad)];
        let system = system_of(self.fspid);
        let mut over = GainsOver::any(tuner, system.as_ref());
        let law = tuner.settings().law;
        let [rest, gains] =
            [over.reached_from_nominal(law, [0.0; 2])?, over.reached_from_nominal(law, seen)?];
        Some(GainSet::boxed(tuner.nominal(), rest, gains))
    }
}
