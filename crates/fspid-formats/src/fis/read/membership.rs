//! `'label':'type',[parameters]`.

use fspid_fuzzy::FuzzyError;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::Membership;

use super::source::Entry;
use super::value::{Number, list, over, quoted, sign};
use crate::cursor::Cursor;
use crate::fis::shape::{SHAPES, ShapeWord, by_name};
use crate::report::{Report, one_of, wrong};
use fspid_diagnostics::{Place, Problem};

/// A membership function as it is written.
#[derive(Debug)]
pub(super) struct Written<'a> {
    pub(super) label: String,
    /// Name of the function and its place.
    pub(super) name: String,
    pub(super) place: Place,
    pub(super) numbers: Vec<Number<'a>>,
}

/// Takes a value apart.
pub(super) fn written<'a>(entry: &Entry<'a>) -> Result<Written<'a>, Problem> {
    let mut cursor = entry.value;
    let label = quoted(&mut cursor)?;
    sign(&mut cursor, ':', "between label and type")?;
    let place = cursor.place();
    let name = quoted(&mut cursor)?;
    sign(&mut cursor, ',', "between type and parameters")?;
    let numbers = parameters(&mut cursor, &name, place)?;
    over(cursor)?;
    Ok(Written { label, name, place, numbers })
}

fn parameters<'a>(
    cursor: &mut Cursor<'a>,
    name: &str,
    place: Place,
) -> Result<Vec<Number<'a>>, Problem> {
    if name.eq_ignore_ascii_case("function") {
        let message = "a formula in a file is never run";
        return Err(wrong(place, name, message, "a membership function with numbers"));
    }
    list(cursor)
}

/// The set that is written; of a pair the last number is the height.
pub(super) fn set(
    written: &Written,
    paired: bool,
    report: &mut Report,
) -> Result<Membership, Problem> {
    let row = known(written)?;
    let count = row.order.len();
    let (numbers, height) = match written.numbers.split_last() {
        Some((last, rest)) if paired && rest.len() == count && !row.kind.repeats() => {
            (rest, height(last)?)
        }
        _ => (&written.numbers[..], 1.0),
    };
    let wanted = if row.kind.repeats() {
        !numbers.is_empty() && numbers.len() % count == 0
    } else {
        numbers.len() == count
    };
    if !wanted {
        let message = format!("has {} parameters", numbers.len());
        return Err(wrong(written.place, &written.name, message, row.usage));
    }
    let (kind, params) = repaired(row, numbers, report);
    checked(row, kind, &params, numbers)?;
    Ok(Membership::Shape { kind, params, height })
}

fn known(written: &Written) -> Result<&'static ShapeWord, Problem> {
    let Written { name, place, .. } = written;
    by_name(name).ok_or_else(|| {
        let of_matlab = SHAPES.iter().filter(|row| row.matlab).map(|row| row.name);
        let message = match name.as_str() {
            "constant" | "linear" => "stands for a number, but a fuzzy set is needed here",
            _ => "unknown membership function; functions of one's own are never run",
        };
        wrong(*place, name, message, one_of(of_matlab, name))
    })
}

fn height(number: &Number) -> Result<f64, Problem> {
    if number.value > 0.0 && number.value <= 1.0 {
        return Ok(number.value);
    }
    let expected = "a number above 0, at most 1";
    Err(wrong(number.place, number.word, "is no height", expected))
}

/// Our parameters, and another kind where the named one has no such member.
fn repaired(row: &ShapeWord, numbers: &[Number], report: &mut Report) -> (ShapeKind, Vec<f64>) {
    let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
    if let Some(other) = degenerate(row.kind, &values) {
        return other;
    }
    if let (ShapeKind::Step, &[threshold, direction]) = (row.kind, &values[..]) {
        // fuzzylite writes infinities; 0 is no direction and stays, to be refused.
        let sign = if direction.abs() > 0.0 { direction.signum() } else { direction };
        return (row.kind, vec![threshold, sign]);
    }
    if row.kind.repeats() {
        return (row.kind, values);
    }
    let params = row.order.iter().filter_map(|&index| {
        let number = numbers.get(index)?;
        Some(if row.even.contains(&index) { positive(number, report) } else { number.value })
    });
    (row.kind, params.collect())
}

/// The width of a bell is squared: its sign makes no difference.
fn positive(number: &Number, report: &mut Report) -> f64 {
    if number.value < 0.0 {
        report.note(number.place, format!("the sign of `{}` makes no difference", number.word));
    }
    number.value.abs()
}

/// Sets of no width, and triangles with a foot at infinity.
fn degenerate(kind: ShapeKind, values: &[f64]) -> Option<(ShapeKind, Vec<f64>)> {
    match (kind, values) {
        (ShapeKind::Triangle, &[a, b, c]) if a.is_infinite() || c.is_infinite() => {
            Some((ShapeKind::Trapezoid, vec![a, b, b, c]))
        }
        (ShapeKind::Triangle | ShapeKind::Trapezoid, &[a, .., d])
            if a.is_finite()
                && a.to_bits() == d.to_bits()
                && values.iter().all(|v| v.to_bits() == a.to_bits()) =>
        {
            Some((ShapeKind::Singleton, vec![a]))
        }
        _ => None,
    }
}

/// Refuses parameters that no member has, at the one that is wrong.
fn checked(
    row: &ShapeWord,
    kind: ShapeKind,
    params: &[f64],
    numbers: &[Number],
) -> Result<(), Problem> {
    let Err(error) = kind.check(params) else { return Ok(()) };
    let at = match &error {
        FuzzyError::Parameter { name, found, .. } => culprit(row, kind, name, *found, numbers),
        _ => None,
    };
    let at = at.or(numbers.first());
    let (place, word) = at.map_or((Place { line: 1, column: 1 }, ""), |n| (n.place, n.word));
    Err(wrong(place, word, format!("`{}` {}: {error}", row.name, row.usage), ""))
}

/// The number in the file that a parameter was read from.
fn culprit<'n, 'a>(
    row: &ShapeWord,
    kind: ShapeKind,
    name: &str,
    found: f64,
    numbers: &'n [Number<'a>],
) -> Option<&'n Number<'a>> {
    if kind.repeats() || kind != row.kind {
        return numbers.iter().find(|number| number.value.to_bits() == found.to_bits());
    }
    let ours = kind.params().iter().position(|param| param.name == name)?;
    numbers.get(*row.order.get(ours)?)
}
