//! What disturbances do at most in every case: the largest of the bounds, up to the smallest size at which no limit acts.

use fspid_proof::{Disturbed, Scope};
use serde_json::{Value, json};

use super::CertifiedCases;
use crate::disturbances;
use crate::text::found;

/// How gains move, after such a bound.
const MOVING: &str = ", in every case, with gains moving as its certificate says";

impl CertifiedCases {
    /// Whether bounds were asked for.
    fn asks_for_disturbances(&self) -> bool {
        let mut results = self.cases.iter().flat_map(|case| &case.certification.results);
        results.any(|it| it.disturbances.is_some())
    }

    /// What is bounded in all cases of a controller; none where one is missing.
    fn disturbed_everywhere(&self, controller: &str) -> Option<Scope> {
        let scopes = self.in_every_change(controller)?.into_iter().map(|certified| {
            let is_bounded = certified.disturbances.as_ref().is_some_and(|it| it.is_bounded());
            let (certificate, rechecked) =
                found(certified.outcome.as_ref().ok()?).filter(|_| is_bounded)?;
            Some(certificate.scope(rechecked))
        });
        scopes.collect::<Option<Vec<Scope>>>()?.into_iter().reduce(both)
    }

    /// Sentences about all cases of a controller; empty where bounds were not asked for.
    pub(super) fn disturbed_in_words(&self, controller: &str) -> Vec<String> {
        if !self.asks_for_disturbances() {
            return Vec::new();
        }
        match self.disturbed_everywhere(controller) {
            Some(scope) if !scope.disturbed.is_empty() => disturbances::sentences(&scope, MOVING),
            _ => vec!["nothing is bounded in every case".to_owned()],
        }
    }

    /// For programs: what is bounded in all cases of a controller; empty where bounds were not asked for.
    pub(super) fn disturbed_in_json(&self, controller: &str) -> Value {
        if !self.asks_for_disturbances() {
            return json!({});
        }
        let none = || json!({ "disturbances": [] });
        let scope = self.disturbed_everywhere(controller);
        scope.map_or_else(none, |scope| disturbances::in_json(&scope))
    }
}

/// What holds of two loops together: what is bounded of both, by the larger bound.
fn both(one: Scope, other: Scope) -> Scope {
    let same = |a: &Disturbed, b: &Disturbed| {
        (a.way.name(), a.quantity, a.extent) == (b.way.name(), b.quantity, b.extent)
    };
    let joined = one.disturbed.iter().filter_map(|a| {
        let b = other.disturbed.iter().find(|b| same(a, b))?;
        let unlimited_up_to = a.unlimited_up_to.zip(b.unlimited_up_to);
        Some(Disturbed {
            at_servo: a.at_servo && b.at_servo,
            per_unit: a.per_unit.max(b.per_unit),
            unlimited_up_to: unlimited_up_to.map(|(a, b)| a.min(b)),
            ..a.clone()
        })
    });
    let disturbed = joined.collect();
    let mut limits = one.limits.clone();
    limits.extend(other.limits.iter().filter(|it| !one.limits.contains(it)));
    let remains_rad = one.remains_rad.max(other.remains_rad);
    Scope { disturbed, limits, remains_rad, ..one }
}
