//! Arbitrary text as a DAVE-ML model: refused, or one that answers at its initial inputs and checks its check cases.

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let model = fspid_daveml::read(std::str::from_utf8(bytes).ok()?).ok()?.model;
    let mut outputs = vec![0.0; model.outputs().count()];
    model.evaluate(&model.initial_inputs(), &mut outputs).expect("as many as it has");
    let _ = model.check().passed();
    Some(())
}
