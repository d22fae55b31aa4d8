//! Arbitrary text as a DAVE-ML model: refused, or one that answers at its initial inputs and checks its check cases.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(reading) = fspid_daveml::read(text) {
        let model = reading.model;
        let mut outputs = vec![0.0; model.outputs().count()];
        model.evaluate(&model.initial_inputs(), &mut outputs).expect("as many as it has");
        let _ = model.check().passed();
    }
});
