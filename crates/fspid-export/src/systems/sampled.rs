//! Numbers read off samples of the joined set, as `output/sampled` of `fspid-fuzzy`.

use fspid_fuzzy::SNormKind;
use fspid_fuzzy::norm::TNormKind;
use fspid_fuzzy::system::{Conclusion, Defuzzifier, Output, Sampling};
use fspid_numeric::Real;

use super::outputs::{FORMULA, VERTICES, flat, repeat};
use super::polygon::PIECE;
use super::{Composer, Trouble, at, count_of, put};
use crate::compose::precision_of;
use crate::program::{
    Argument, Expression, Kind, Operator, Statement, element, local, number, reads, whole,
};

/// Most samples that are kept for the bisector, which walks over them twice: 8 KiB of stack with 64 bits (assumed to be there).
const MOST_KEPT: u32 = 1024;

/// Where samples lie, and the names of what is computed from them.
struct Samples {
    count: u32,
    cells: u32,
    offset: f64,
    /// Both ends of the universe.
    ends: [Expression; 2],
    /// Behind the names of values, so that those of two outputs differ.
    suffix: String,
}

impl Samples {
    fn of(sampling: Sampling, ends: [Expression; 2], index: usize) -> Result<Self, Trouble> {
        let (count, cells, offset) = match sampling {
            Sampling::Endpoints(n) | Sampling::Trapezoid(n) => (n, n - 1, 0.0),
            Sampling::Midpoint(n) => (n, n, 0.5),
            Sampling::LeftEnd(n) => (n, n, 0.0),
            Sampling::Vertices(_) | Sampling::Exact => return Err(VERTICES),
        };
        Ok(Self { count, cells, offset, ends, suffix: index.to_string() })
    }

    fn name(&self, name: &str) -> String {
        format!("{name}_{}", self.suffix)
    }

    fn real(&self, name: &str) -> Expression {
        local(&self.name(name))
    }

    fn set(&self, name: &str, value: Expression) -> Statement {
        Statement::set(&self.name(name), value)
    }

    fn begin(&self, name: &str) -> Statement {
        Statement::real(&self.name(name), number(0.0))
    }

    fn cells(&self) -> Expression {
        number(f64::from(self.cells))
    }

    /// A place, so many cells from the lower end.
    fn place(&self, cell: Expression) -> Expression {
        let [lower, upper] = self.ends.clone();
        lower.clone() + cell * (upper - lower) / self.cells()
    }

    /// The places of the samples, as `x`.
    fn x(&self) -> [Statement; 2] {
        let sample = Expression::ToReal(Box::new(self.real("sample")));
        // The first sample of a rule without offset is moved by 0, which changes no bit.
        let cell = sample + number(self.offset);
        let cell_name = self.real("cell");
        let inside = cell_name.clone().less(self.cells());
        let x = inside.select(self.place(cell_name), self.ends[1].clone());
        [Statement::real(&self.name("cell"), cell), Statement::real(&self.name("x"), x)]
    }

    /// A walk over the samples, with their places where the body asks for them: sets that are the same everywhere do not.
    fn each(&self, body: Vec<Statement>) -> Statement {
        let placed = reads(&body, &self.name("x"));
        let places = if placed { self.x().into() } else { Vec::new() };
        let body = places.into_iter().chain(body).collect();
        repeat(&self.name("sample"), self.count as usize, body)
    }
}

impl<R: Real> Composer<'_, R> {
    pub(super) fn sampled(
        &mut self,
        index: usize,
        output: &Output,
        sampling: Sampling,
    ) -> Result<String, Trouble> {
        let Some(universe) = output.universe else { return Err(VERTICES) };
        let name = self.names.outputs[index].clone();
        let ends = self.range(&name, universe);
        let samples = Samples::of(sampling, ends, index)?;
        let sample = self.joined(index, output, &samples)?;
        match output.defuzzifier {
            Defuzzifier::Bisector(_) => self.sampled_bisector(sampling, &samples, sample)?,
            method => self.sampled_in_one_walk(method, sampling, &samples, sample),
        }
        Ok(format!("{}, {sampling}", output.defuzzifier.name()))
    }

    /// Statements that compute the grade of the joined set at `x`.
    fn joined(
        &mut self,
        index: usize,
        output: &Output,
        samples: &Samples,
    ) -> Result<Vec<Statement>, Trouble> {
        let mut statements = vec![samples.begin("grade")];
        let mut graded: Vec<usize> = Vec::new();
        for (own, actor) in self.system.actors(index).into_iter().enumerate() {
            let Conclusion::Set { membership, .. } = &output.terms[actor.term].conclusion else {
                return Err(FORMULA);
            };
            let set = samples.name(&format!("set_{}", actor.term));
            if !graded.contains(&actor.term) {
                graded.push(actor.term);
                let name = self.term_name(index, actor.term);
                let grade = self.graded(&name, membership, samples.real("x"))?;
                statements.push(Statement::real(&set, grade));
            }
            let level = at("levels", own);
            let cut = match actor.implication.is(TNormKind::Minimum) {
                true => level.clone().smaller(local(&set)),
                false => {
                    self.library.t_norm::<R>(&actor.implication, level.clone(), local(&set))?
                }
            };
            let grade = samples.real("grade");
            let joined = match output.aggregation.is(SNormKind::Maximum) {
                true => self.library.larger::<R>(cut, grade)?,
                false => self.library.s_norm::<R>(&output.aggregation, grade, cut)?,
            };
            let fires = number(0.0).less(level);
            statements.push(Statement::when(fires, vec![samples.set("grade", joined)]));
        }
        Ok(statements)
    }

    /// Centroids and maxima: sums, and the highest grade so far with the places that have it.
    fn sampled_in_one_walk(
        &mut self,
        method: Defuzzifier,
        sampling: Sampling,
        samples: &Samples,
        mut sample: Vec<Statement>,
    ) {
        let [lower, upper] = samples.ends.clone();
        let middle = number(0.5) * lower + number(0.5) * upper;
        let (grade, x) = (|| samples.real("grade"), || samples.real("x"));
        let is = |end: i32| Expression::binary(Operator::Equal, samples.real("sample"), whole(end));
        self.body.extend(["top", "sum", "moment"].map(|name| samples.begin(name)));
        let answer;
        if let Defuzzifier::Centroid(_) = method {
            sample.push(Statement::when(
                samples.real("top").less(grade()),
                vec![samples.set("top", grade())],
            ));
            if matches!(sampling, Sampling::Trapezoid(_)) {
                let half = samples.set("grade", number(0.5) * grade());
                let last = count_of(samples.count as usize) - 1;
                sample.push(Statement::when(is(0).or(is(last)), vec![half]));
            }
            sample.push(samples.set("sum", samples.real("sum") + grade()));
            let moment = samples.real("moment") + (x() - middle.clone()) * grade();
            sample.push(samples.set("moment", moment));
            answer = middle + samples.real("moment") / samples.real("sum");
        } else {
            let by_magnitude = matches!(sampling, Sampling::Endpoints(_));
            let again = again(method, by_magnitude, samples);
            // A sum begins at 0, which turns -0 around.
            let first = match method {
                Defuzzifier::MeanOfMaximum(_) => number(0.0) + x(),
                _ => x(),
            };
            let anew = vec![
                samples.set("top", grade()),
                samples.set("moment", first),
                samples.set("sum", number(1.0)),
            ];
            let equal = Expression::binary(Operator::Equal, grade(), samples.real("top"));
            let higher = samples.real("top").less(grade());
            sample.push(Statement::If(higher, anew, vec![Statement::when(equal, again)]));
            answer = match method {
                Defuzzifier::MeanOfMaximum(_) => samples.real("moment") / samples.real("sum"),
                _ => samples.real("moment"),
            };
        }
        self.body.push(samples.each(sample));
        let least = number(super::library::least(precision_of::<R>()));
        let has_area =
            least.at_most(samples.real("top")).and(number(0.0).less(samples.real("sum")));
        let found = vec![put("found", 0, number(1.0)), put("found", 1, answer)];
        self.body.push(Statement::when(has_area, found));
    }

    /// The bisector: the grades are kept and read as pieces, or counted.
    fn sampled_bisector(
        &mut self,
        sampling: Sampling,
        samples: &Samples,
        mut sample: Vec<Statement>,
    ) -> Result<(), Trouble> {
        if samples.count > MOST_KEPT {
            return Err(Trouble::Said(
                "a bisector keeps its samples, of which 1024 are allowed",
                "possible are fewer samples, or the centroid",
            ));
        }
        if !matches!(sampling, Sampling::Endpoints(_)) {
            self.bisector_of_pieces(sampling, samples, sample);
            return Ok(());
        }
        let kept = samples.name("kept");
        self.body.push(Statement::Array(kept.clone(), samples.count as usize));
        self.body.extend(["top", "sum", "below"].map(|name| samples.begin(name)));
        let grade = || samples.real("grade");
        sample.push(Statement::when(
            samples.real("top").less(grade()),
            vec![samples.set("top", grade())],
        ));
        sample.push(samples.set("sum", samples.real("sum") + grade()));
        sample.push(Statement::set_element(&kept, samples.real("sample"), grade()));
        self.body.push(samples.each(sample));
        let half = number(0.5) * samples.real("sum");
        let mut walk = vec![
            samples.set("below", samples.real("below") + element(&kept, samples.real("sample"))),
        ];
        let open = at("found", 0).less(number(0.5));
        let reached = half.at_most(samples.real("below"));
        let found = vec![put("found", 0, number(1.0)), put("found", 1, samples.real("x"))];
        walk.push(Statement::when(open.and(reached), found));
        let least = number(super::library::least(precision_of::<R>()));
        let walk = samples.each(walk);
        self.body.push(Statement::when(least.at_most(samples.real("top")), vec![walk]));
        Ok(())
    }
}

/// How many pieces a bisector reads off samples: a cell for each, or a line between two.
pub(super) fn pieces(defuzzifier: Defuzzifier) -> usize {
    match defuzzifier {
        Defuzzifier::Bisector(Sampling::Midpoint(n) | Sampling::LeftEnd(n)) => n as usize,
        Defuzzifier::Bisector(Sampling::Trapezoid(n)) => n as usize - 1,
        _ => 0,
    }
}

impl<R: Real> Composer<'_, R> {
    /// The bisector of cells of equal height, or of straight lines between samples.
    fn bisector_of_pieces(
        &mut self,
        sampling: Sampling,
        samples: &Samples,
        mut sample: Vec<Statement>,
    ) {
        let is_line = matches!(sampling, Sampling::Trapezoid(_));
        let number_of = Expression::ToReal(Box::new(samples.real("sample")));
        let edge = |cell: Expression| samples.place(cell);
        let [left, right, begin] = match is_line {
            true => ["x_before", "x", "grade_before"].map(|name| samples.real(name)),
            false => {
                let next = number_of.clone() + number(1.0);
                [edge(number_of), edge(next), samples.real("grade")]
            }
        };
        let row = if is_line { samples.name("line") } else { samples.name("sample") };
        let put = |column, value| {
            Statement::set_element("pieces", flat(local(&row), PIECE, column), value)
        };
        let half = |name: &str| number(0.5) * local(name);
        let names = ["left", "right", "begin", "ending"].map(|name| samples.name(name));
        let [from, to, first, last] = &names;
        let mut piece = vec![
            Statement::real(from, left),
            Statement::real(to, right),
            Statement::real(first, begin),
            Statement::real(last, samples.real("grade")),
        ];
        piece.extend(names.iter().zip(0..).map(|(name, column)| put(column, local(name))));
        let area = (local(to) - local(from)) * (half(first) + half(last));
        piece.push(samples.set("sum", samples.real("sum") + area));
        let higher = samples.real("top").less(samples.real("grade"));
        sample.push(Statement::when(higher, vec![samples.set("top", samples.real("grade"))]));
        self.body.extend(["top", "sum"].map(|name| samples.begin(name)));
        if is_line {
            self.body.extend(["x_before", "grade_before"].map(|name| samples.begin(name)));
            let line = Expression::binary(Operator::Add, samples.real("sample"), whole(-1));
            piece.insert(0, Statement::Let(row.clone(), Kind::Whole, line));
            let is_later = whole(0).less(samples.real("sample"));
            sample.push(Statement::when(is_later, piece));
            sample.push(samples.set("x_before", samples.real("x")));
            sample.push(samples.set("grade_before", samples.real("grade")));
        } else {
            sample.extend(piece);
        }
        self.body.push(samples.each(sample));
        self.halves(is_line, samples);
    }

    /// Reads the bisector off the pieces.
    fn halves(&mut self, is_line: bool, samples: &Samples) {
        let count = whole(count_of(samples.count as usize) - i32::from(is_line));
        let from_side = |turned| {
            let values = [count.clone(), number(1.0), samples.real("sum"), number(turned)];
            let mut given = vec![Argument::Array("pieces".to_owned())];
            given.extend(values.map(Argument::Value));
            Expression::Call("halfway", given)
        };
        let sides = ["from_left", "from_right"].map(|name| samples.name(name));
        let [from_left, from_right] = &sides;
        let middle = number(0.5) * local(from_left) + number(0.5) * local(from_right);
        let found = vec![
            Statement::real(from_left, from_side(0.0)),
            Statement::real(from_right, from_side(1.0)),
            super::put("found", 0, number(1.0)),
            super::put("found", 1, middle),
        ];
        let least = number(super::library::least(precision_of::<R>()));
        let has_area =
            least.at_most(samples.real("top")).and(number(0.0).less(samples.real("sum")));
        self.body.push(Statement::when(has_area, found));
    }
}

/// What a sample does that is as high as the highest so far.
fn again(method: Defuzzifier, by_magnitude: bool, samples: &Samples) -> Vec<Statement> {
    let (x, best) = (|| samples.real("x"), || samples.real("moment"));
    let take = samples.set("moment", x());
    match method {
        Defuzzifier::MeanOfMaximum(_) => vec![
            samples.set("moment", best() + x()),
            samples.set("sum", samples.real("sum") + number(1.0)),
        ],
        Defuzzifier::SmallestOfMaximum(_) if by_magnitude => {
            vec![Statement::when(x().magnitude().less(best().magnitude()), vec![take])]
        }
        Defuzzifier::LargestOfMaximum(_) if by_magnitude => {
            vec![Statement::when(best().magnitude().less(x().magnitude()), vec![take])]
        }
        Defuzzifier::LargestOfMaximum(_) => vec![take],
        _ => Vec::new(),
    }
}
