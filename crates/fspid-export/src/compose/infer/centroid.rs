//! The centre of gravity of seven triangles, cut at the strengths of their labels.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange};
use fspid_numeric::Real;

use super::super::Refusal;
use super::limited;
use crate::program::{
    Expression, Function, Kind, Operator, Parameter, Statement, element, local, number, whole,
};

/// The function `centroid`.
pub(in crate::compose) fn function<R: Real>(
    defuzzifier: Defuzzifier,
    policy: OutOfRange,
) -> Result<Function, Refusal> {
    let mut function = of::<R>("centroid", defuzzifier, 7)?;
    function.body = bounded(policy, function.body);
    Ok(function)
}

/// A function like it for any number of triangles, with one at either end of the universe.
pub(crate) fn of<R: Real>(
    name: &'static str,
    defuzzifier: Defuzzifier,
    triangles: usize,
) -> Result<Function, Refusal> {
    let sampled = |count, cells, offset, end_weight| {
        Grid { count, cells, offset, end_weight, triangles }.body::<R>()
    };
    let (doc, body) = match defuzzifier {
        Defuzzifier::Exact => (
            "Centre of gravity of the cut triangles in closed form, in spacings from the middle.",
            exact::<R>(triangles),
        ),
        Defuzzifier::Endpoints(n) => (SAMPLED, sampled(n, n - 1, 0.0, 1.0)),
        Defuzzifier::Trapezoid(n) => (SAMPLED, sampled(n, n - 1, 0.0, 0.5)),
        Defuzzifier::Midpoint(n) => (SAMPLED, sampled(n, n, 0.5, 1.0)),
        Defuzzifier::LeftEnd(n) => (SAMPLED, sampled(n, n, 0.0, 1.0)),
        Defuzzifier::Vertices(_) => return Err(Refusal::Defuzzifier(defuzzifier)),
    };
    let strengths = Parameter { name: "strengths", kind: Kind::Reals(triangles), written: false };
    Ok(Function {
        name,
        doc,
        parts: &[],
        parameters: vec![strengths],
        answers: Some(Kind::Real),
        body,
    })
}

/// The centre lies between the outermost ones, and the area is not small where an input is within its range: said so that
/// a proof in intervals sees it. It changes no bit.
fn bounded(policy: OutOfRange, mut body: Vec<Statement>) -> Vec<Statement> {
    let Some(Statement::Return(Some(Expression::Binary(_, moment, area)))) = body.pop() else {
        return body;
    };
    // Outside of the range there are areas of every size.
    let is_bounded = policy != OutOfRange::Evaluate;
    let area = if is_bounded { area.larger(number(SMALL_AREA)) } else { *area };
    let centre = limited(local("centre"), number(-3.0), number(3.0));
    body.extend([Statement::real("centre", *moment / area), Statement::Return(Some(centre))]);
    body
}

/// Far below the area of any set that is cut where the weakest of all strongest rules cuts it.
const SMALL_AREA: f64 = 1.0 / (1_u64 << 40) as f64;
/// Spacings from the middle of the universe to its ends.
fn half_span(triangles: usize) -> f64 {
    0.5 * triangles.saturating_sub(1) as f64
}

fn count_of(triangles: usize) -> i32 {
    i32::try_from(triangles).unwrap_or(i32::MAX)
}

const SAMPLED: &str =
    "Centre of gravity of the cut triangles by samples, in spacings from the middle.";

fn strength(index: Expression) -> Expression {
    element("strengths", index)
}

fn next(name: &str) -> Expression {
    Expression::binary(Operator::Add, local(name), whole(1))
}

/// Half of a triangle cut at a strength.
fn half_of(strength: &str) -> Expression {
    local(strength) - number(0.5) * local(strength) * local(strength)
}

/// As `exact` of `fspid-fuzzy`, operation by operation.
fn exact<R: Real>(triangles: usize) -> Vec<Statement> {
    let sixth = number(R::from_f64(1.0 / 6.0).to_f64());
    let inner_moment = |s: &dyn Fn() -> Expression| {
        s() * (number(0.5) - s() * (number(0.5) - s() * sixth.clone()))
    };
    let (area, moment, position) = (|| local("area"), || local("moment"), || local("position"));
    let halves = local("left_half") + local("right_half") - local("overlap");
    let moments = position() * local("left_half")
        + (position() + number(1.0)) * local("right_half")
        - (position() + number(0.5)) * local("overlap");
    let gap = vec![
        Statement::real("right", strength(next("gap"))),
        Statement::real("right_half", half_of("right")),
        Statement::real("lower", local("left").smaller(local("right"))),
        Statement::real("height", local("lower").smaller(number(0.5))),
        Statement::real("overlap", local("height") - local("height") * local("height")),
        Statement::set("area", area() + halves),
        Statement::set("moment", moment() + moments),
        Statement::set("position", position() + number(1.0)),
        Statement::set("left", local("right")),
        Statement::set("left_half", local("right_half")),
    ];
    let ends = inner_moment(&|| local("first")) - inner_moment(&|| local("left"));
    vec![
        Statement::real("first", strength(whole(0))),
        Statement::real("left", local("first")),
        Statement::real("left_half", half_of("left")),
        Statement::real("area", number(0.0)),
        Statement::real("moment", number(0.0)),
        Statement::real("position", number(-half_span(triangles))),
        Statement::Remark("Both halves in each gap between two peaks, less their overlap.".into()),
        Statement::repeat("gap", count_of(triangles) - 1, gap),
        Statement::Return(Some((moment() + ends) / area())),
    ]
}

/// Equally spaced samples, as `sampled` of `fspid-fuzzy` takes them.
struct Grid {
    count: u32,
    cells: u32,
    offset: f64,
    end_weight: f64,
    triangles: usize,
}

impl Grid {
    fn body<R: Real>(&self) -> Vec<Statement> {
        let last = i32::try_from(self.count).unwrap_or(i32::MAX) - 1;
        let half_span = half_span(self.triangles);
        let cell = R::from_f64(2.0 * half_span) / R::from_f64(f64::from(self.cells));
        let real = |index: &str| Expression::ToReal(Box::new(local(index)));
        let x = (real("sample") + number(self.offset)) * number(cell.to_f64()) - number(half_span);
        let triangle = number(1.0) - (local("x") - local("peak")).magnitude();
        let union = vec![
            Statement::real("triangle", triangle),
            Statement::real("strength", strength(local("label"))),
            Statement::set("triangle", local("triangle").smaller(local("strength"))),
            Statement::set("grade", local("grade").larger(local("triangle"))),
            Statement::set("peak", local("peak") + number(1.0)),
        ];
        let is = |end| Expression::binary(Operator::Equal, local("sample"), whole(end));
        let mut sample = vec![
            Statement::real("x", x),
            Statement::real("grade", number(0.0)),
            Statement::real("peak", number(-half_span)),
            Statement::repeat("label", count_of(self.triangles), union),
        ];
        if self.end_weight < 1.0 {
            let weighted = number(self.end_weight) * local("grade");
            sample
                .push(Statement::when(is(0).or(is(last)), vec![Statement::set("grade", weighted)]));
        }
        sample.extend([
            Statement::set("area", local("area") + local("grade")),
            Statement::set("moment", local("moment") + local("x") * local("grade")),
        ]);
        vec![
            Statement::real("area", number(0.0)),
            Statement::real("moment", number(0.0)),
            Statement::For("sample".to_owned(), 0, last, sample),
            Statement::Return(Some(local("moment") / local("area"))),
        ]
    }
}
