//! Arbitrary text as a formula: refused or computed, never a panic.

#![no_main]

use fspid_fuzzy::formula::Formula;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(formula) = Formula::parse(text, &["x", "error", "change"]) {
        let value: f64 = formula.evaluate(&[0.5, -1.25, 3.0]);
        let again = Formula::parse(&formula.to_string(), &["x", "error", "change"]);
        let again: f64 = again.expect("a printed formula is one").evaluate(&[0.5, -1.25, 3.0]);
        assert!(value.to_bits() == again.to_bits() || value.is_nan() && again.is_nan());
    }
});
