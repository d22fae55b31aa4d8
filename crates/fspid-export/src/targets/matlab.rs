//! MATLAB: the controller as a function, and the supervisor alone as a `.fis`, with what that loses.

use fspid_core::Controller;
use fspid_core::fuzzy::{Defuzzifier, Supervisor};
use fspid_formats::{WriteOptions, fis};
use fspid_fuzzy::system::Parts;
use fspid_numeric::Real;

use super::{File, Flown, Source, Written};
use crate::compose::Refusal;
use crate::table::infer;
use crate::vectors::Draw;
use crate::write;

/// Samples of a centre of gravity in MATLAB's Fuzzy Logic Toolbox, where nothing else is asked for.
const SAMPLES: u32 = 101;
/// Inputs that the loss is measured of.
const MEASURED: u32 = 20_000;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Result<Written, Refusal> {
    let Source { program, prefix, heading, vectors, .. } = source;
    let Flown { controller, .. } = source.flown.as_ref().ok_or(Refusal::NoController)?;
    let mut files = vec![
        File::text(format!("{prefix}.m"), write::matlab(program, prefix, heading)),
        File::text(format!("{prefix}_check.m"), write::matlab_harness(program, prefix)),
        File::text(format!("{prefix}_words.csv"), write::words(program, vectors)),
    ];
    let mut notes = Vec::new();
    if let Ok(Controller::SelfTuning(fspid)) = controller.rounded::<f64>() {
        let supervisor = fspid.tuner().supervisor();
        let (text, told) = system(supervisor);
        files.extend(text.map(|text| File::text(format!("{prefix}.fis"), text)));
        notes.extend(told);
    }
    Ok(Written { files, notes })
}

/// The supervisor as a `.fis`, and what there is to say of it.
fn system(supervisor: &Supervisor<f64>) -> (Option<String>, Vec<String>) {
    let sampled = as_sampled(supervisor);
    let parts = Parts::from(sampled.as_ref().unwrap_or(supervisor));
    let written = match fis::write(&parts, WriteOptions { lossy: true }) {
        Ok(written) => written,
        Err(problems) => return (None, vec![format!("no .fis: {problems}")]),
    };
    let mut notes: Vec<String> = written.notes.iter().map(|it| format!("the .fis: {it}")).collect();
    notes.push(match sampled {
        None => "the .fis has rules that conclude numbers: nothing is sampled, and it is off by rounding alone".to_owned(),
        Some(sampled) => loss(supervisor, &sampled),
    });
    (Some(written.text), notes)
}

/// The same supervisor with the centre of gravity that MATLAB samples; nothing where rules conclude numbers.
fn as_sampled(supervisor: &Supervisor<f64>) -> Option<Supervisor<f64>> {
    let table = supervisor.table()?;
    let rule = Defuzzifier::Endpoints(SAMPLES);
    Supervisor::new(&table, supervisor.range(), rule, supervisor.out_of_range()).ok()
}

fn loss(exact: &Supervisor<f64>, sampled: &Supervisor<f64>) -> String {
    let (mut draw, mut most, mut sum) = (Draw(3), [0.0_f64; 3], [0.0_f64; 3]);
    for _ in 0..MEASURED {
        let [error, change] = [(); 2].map(|()| draw.around(exact.range()));
        let (one, other) = (infer(exact, error, change), infer(sampled, error, change));
        for k in 0..3 {
            let off = (one[k] - other[k]).abs();
            most[k] = most[k].max(off);
            sum[k] += off * off;
        }
    }
    let told = |k: usize| {
        let rms = libm::sqrt(sum[k] / f64::from(MEASURED));
        format!("{} {:.5} ({rms:.5} rms)", ["kp", "ki", "kd"][k], most[k])
    };
    format!(
        "the .fis samples its centre of gravity at {SAMPLES} points, as MATLAB does: increments are off by at most {}, {}, {} of {MEASURED} drawn inputs within {}",
        told(0),
        told(1),
        told(2),
        exact.range()
    )
}
