//! The targets that the modes of an autopilot hold, as the scenario states them.

use crate::autopilot::{Autopilot, Mode, Quantity, Target};

/// Targets of a mode by the place of their quantity, in SI units, as far as they are written.
pub(super) type Targets = [Option<f64>; Quantity::ALL.len()];

/// What is written that each mode holds, or has to be so when it begins.
pub(super) fn written(autopilot: &Autopilot) -> Vec<Targets> {
    targets(autopilot, |_, _, value| value)
}

/// The same as it is in truth, where a loop sees it through a sensor that is off by its bias and its scale.
pub(super) fn true_ones(autopilot: &Autopilot) -> Vec<Targets> {
    targets(autopilot, |mode, quantity, seen| {
        let engaged = mode.engaged.iter().filter_map(|&number| autopilot.loops().get(number));
        let mut sensors = engaged.filter(|it| it.holds == quantity).filter_map(|it| it.sensor);
        let sensor = sensors.next();
        sensor.map_or(seen, |it| (seen - it.bias()) / (1.0 + it.model().scale_error))
    })
}

/// With what a written value means.
fn targets(autopilot: &Autopilot, meant: impl Fn(&Mode, Quantity, f64) -> f64) -> Vec<Targets> {
    let mut all: Vec<Targets> = Vec::new();
    let mut before: Option<&Mode> = None;
    for mode in autopilot.modes() {
        let last = all.last().copied().unwrap_or_default();
        all.push(Quantity::ALL.map(|quantity| match mode.target(quantity) {
            Target::Value(value) => Some(meant(mode, quantity, value)),
            Target::Hold if before.is_some_and(|it| is_kept(autopilot, it, mode, quantity)) => {
                last.get(quantity.place()).copied().flatten()
            }
            // What a condition asks is the truth.
            Target::Hold => {
                let mut conditions = mode.entry.conditions.iter();
                conditions.find(|it| it.quantity == quantity).map(|it| it.value)
            }
        }));
        before = Some(mode);
    }
    all
}

/// True where what holds a quantity stays engaged from one mode to the next.
fn is_kept(autopilot: &Autopilot, one: &Mode, next: &Mode, quantity: Quantity) -> bool {
    let both = one.total_energy && next.total_energy;
    let by_energy = both && matches!(quantity, Quantity::Altitude | Quantity::Airspeed);
    let stays = |number: &usize| {
        let holds = autopilot.loops().get(*number).is_some_and(|it| it.holds == quantity);
        holds && next.engaged.contains(number)
    };
    by_energy || one.engaged.iter().any(stays)
}
