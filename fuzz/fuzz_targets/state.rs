//! Arbitrary text as the saved state of a tuning: refused, or a search that goes on. What no optimiser can have been in
//! is refused, so that one which is resumed asks for points of the cube and takes their costs.

#![no_main]

use fspid_optimise::Snapshot;
use fspid_tune::State;
use serde_json::Value;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = serde_json::from_str::<State>(text);
    // The part of a state that is the optimiser's own memory.
    let Ok(value) = serde_json::from_str::<Value>(text) else { return };
    let Some(engine) = value.pointer("/engine/one") else { return };
    let Ok(snapshot) = serde_json::from_value::<Snapshot>(engine.clone()) else { return };
    let Ok(mut optimiser) = snapshot.resume() else { return };
    for _ in 0..2 {
        let asked = optimiser.ask();
        for point in &asked {
            assert!(point.iter().all(|x| (0.0..=1.0).contains(x)), "{point:?}");
        }
        let costs: Vec<f64> = (0..asked.len()).map(|place| place as f64).collect();
        optimiser.tell(&costs);
    }
});
