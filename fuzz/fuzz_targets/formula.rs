//! Arbitrary text as a formula: refused or computed, never a panic.

use fspid_fuzzy::formula::Formula;

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let names = ["x", "error", "change"];
    let formula = Formula::parse(std::str::from_utf8(bytes).ok()?, &names).ok()?;
    let value: f64 = formula.evaluate(&[0.5, -1.25, 3.0]);
    let again = Formula::parse(&formula.to_string(), &names);
    let again: f64 = again.expect("a printed formula is one").evaluate(&[0.5, -1.25, 3.0]);
    assert!(value.to_bits() == again.to_bits() || value.is_nan() && again.is_nan());
    Some(())
}
