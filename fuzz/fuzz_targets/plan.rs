//! Arbitrary text as the plan of a campaign: refused, or written and read again as itself.

use fspid_campaign::Plan;

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let plan = Plan::from_json(std::str::from_utf8(bytes).ok()?).ok()?;
    let again = Plan::from_json(&plan.json().to_string()).expect("what is written can be read");
    assert_eq!(again.json(), plan.json());
    assert!(plan.shard(0).is_some() && plan.shard(plan.shards()).is_none());
    Some(())
}
