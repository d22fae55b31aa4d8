//! The supervisor's surface as a table: in C in two widths, as CSV, and a program that tries to refute its bound.

use fspid_core::{Controller, SelfTuner};
use fspid_numeric::Real;

use super::{Flown, Source, Written};
use crate::compose::Refusal;
use crate::file::File;
use crate::table::{Deviation, SurfaceTable};
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Result<Written, Refusal> {
    let Source { prefix, heading, vectors, .. } = source;
    let Flown { controller, points, .. } = source.flown.as_ref().ok_or(Refusal::NoController)?;
    let tuner = rounded(controller)?;
    let table = SurfaceTable::of(&tuner, *points)?;
    let files = write::table(&table, prefix, heading);
    let check = write::table_harness(&table, tuner.supervisor(), prefix, vectors.len());
    let files = vec![
        File::text(format!("{prefix}_table.h"), files.header),
        File::text(format!("{prefix}_table_f32.c"), files.single),
        File::text(format!("{prefix}_table_i16.c"), files.short),
        File::text(format!("{prefix}_table_check.c"), check),
        File::text(format!("{prefix}_table.csv"), write::table_csv(&table)),
    ];
    Ok(Written { files, notes: notes(&table) })
}

/// The tuner with the settings of 32 bits that the table has, in numbers of 64.
fn rounded<R: Real>(controller: &Controller<R>) -> Result<SelfTuner<f64>, Refusal> {
    let single = controller.rounded::<f32>().and_then(|single| single.rounded::<f64>());
    match single {
        Ok(Controller::SelfTuning(fspid)) => Ok(*fspid.tuner()),
        Ok(Controller::Fixed(_)) => Err(Refusal::NoSupervisor),
        Err(_) => Err(Refusal::NotSingle),
    }
}

fn notes(table: &SurfaceTable) -> Vec<String> {
    let points = table.points;
    let mut notes = vec![format!(
        "{points} x {points} points: {} bytes of 32 bits, {} of 16; {} boxes of inputs proved",
        table.values.len() * 12,
        table.values.len() * 6,
        table.boxes
    )];
    for (width, deviations) in [("32", &table.single), ("16", &table.short)] {
        for (name, Deviation { proved, seen, rms }) in ["kp", "ki", "kd"].iter().zip(deviations) {
            let [seen, rms] = [seen, rms].map(|value| told(*value));
            let proved = told_above(*proved);
            notes.push(format!(
                "increment of {name}, {width} bits: off by at most {proved} (proved), {seen} (seen), {rms} (rms)"
            ));
        }
    }
    notes.push("the rest of the controller is not in the table; --to c writes it, with the exact supervisor".to_owned());
    notes
}

/// Below it a number is told with its power of ten.
const SMALL: f64 = 1e-3;

fn told(value: f64) -> String {
    if value < SMALL { format!("{value:.1e}") } else { format!("{value:.5}") }
}

/// A bound in digits that are not below it.
fn told_above(bound: f64) -> String {
    // Two digits are off by a twentieth of the first at most.
    told(if bound < SMALL { 1.05 * bound } else { (1e5 * bound).ceil() / 1e5 })
}
