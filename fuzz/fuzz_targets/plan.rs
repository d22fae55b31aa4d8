//! Arbitrary text as the plan of a campaign: refused, or written and read again as itself.

#![no_main]

use fspid_campaign::Plan;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(plan) = Plan::from_json(text) {
        let again = Plan::from_json(&plan.json().to_string()).expect("what is written can be read");
        assert_eq!(again.json(), plan.json());
        assert!(plan.shard(0).is_some() && plan.shard(plan.shards()).is_none());
    }
});
