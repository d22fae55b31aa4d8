//! Arbitrary text as the saved state of a tuning: refused, or a search that goes on. What no optimiser can have been in
//! is refused, so that one which is resumed asks for points of the cube and takes their costs.

use fspid_optimise::{NsgaII, Snapshot};
use fspid_tune::State;
use serde_json::Value;

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let text = std::str::from_utf8(bytes).ok()?;
    let state = serde_json::from_str::<State>(text).is_ok();
    // The part of a state that is the optimiser's own memory.
    let value: Value = serde_json::from_str(text).ok()?;
    if let Some(front) = value.pointer("/engine/front") {
        let front: NsgaII = serde_json::from_value(front.clone()).ok()?;
        return front.resumed().ok().filter(|_| state).map(drop);
    }
    let snapshot: Snapshot = serde_json::from_value(value.pointer("/engine/one")?.clone()).ok()?;
    let mut optimiser = snapshot.resume().ok()?;
    for _ in 0..2 {
        let asked = optimiser.ask();
        for point in &asked {
            assert!(point.iter().all(|x| (0.0..=1.0).contains(x)), "{point:?}");
        }
        let costs: Vec<f64> = (0..asked.len()).map(|place| place as f64).collect();
        optimiser.tell(&costs);
    }
    state.then_some(())
}
