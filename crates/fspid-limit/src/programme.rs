//! The least error as a linear or quadratic programme over all samples, solved by an interior-point method.
//!
//! States stay variables, so that the equations are a band and their factors are as well; angles are in degrees and states
//! in units of their own, so that all numbers are of one size.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use fspid_numeric::units::RADIAN_DEG;

use crate::bound::Multipliers;
use crate::error::LimitError;
use crate::measure::Measure;
use crate::question::Question;

/// A question with what is known of its beginning, ready to be solved.
#[derive(Clone, Debug)]
pub struct Programme<'a> {
    question: &'a Question,
    measure: Measure,
    /// Middles of the sampled plant, in units of its own.
    a: Vec<f64>,
    by_target: Vec<f64>,
    units: Vec<f64>,
    /// What enters the states in every sample, degrees.
    entering: Vec<Vec<f64>>,
}

/// Solution of the linear or quadratic programme.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Least measure by the solver's own words, rad.
    pub value: f64,
    /// Target of the actuator's lag at each sample, rad; what it amounts to where rate or stops hold the elevator.
    pub target_rad: Vec<f64>,
    /// Deflection at each sample, rad.
    pub deflection_rad: Vec<f64>,
    /// Multipliers for a bound.
    pub multipliers: Multipliers,
}

/// What travel costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Spending {
    /// No more than this, rad.
    Within(f64),
    /// This much of the measure for each radian.
    At(f64),
}

/// What is taken to come: set-point, rad, and what enters the states in every sample, in the programme's own units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coming<'a> {
    pub(crate) setpoint_rad: &'a [f64],
    pub(crate) entering: &'a [Vec<f64>],
    /// What targets are within at the first samples of the flight, rad.
    pub(crate) quiet_rad: &'a [(f64, f64)],
}

/// Where a programme begins: at rest, or in flight at an event.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Begin {
    /// First sample that is planned.
    pub(crate) sample: usize,
    /// States there, rad and in the plant's own units.
    pub(crate) state: Vec<f64>,
    /// What counted as travel at the sample before, rad.
    pub(crate) counted_rad: Option<f64>,
    /// Targets that are on their way, rad, from this sample on.
    pub(crate) before_rad: Vec<f64>,
}

impl<'a> Programme<'a> {
    /// Of a question.
    #[must_use]
    pub fn new(question: &'a Question, measure: Measure) -> Self {
        let plant = &question.plant;
        let a: Vec<f64> = plant.a.entries().map(|it| it.midpoint()).collect();
        let by_target: Vec<f64> = plant.by_target.iter().map(|it| it.midpoint()).collect();
        let units = units(&a, &by_target, question.rows);
        let states = plant.states;
        let entering = (0..question.rows)
            .map(|k| {
                let enters = question.entering(k);
                let all = enters.iter().zip(&units);
                let mut all: Vec<f64> = all.map(|(it, u)| it.midpoint() * RADIAN_DEG / u).collect();
                all.resize(states, 0.0);
                all
            })
            .collect();
        let scaled =
            |(place, value): (usize, &f64)| value * units[place % states] / units[place / states];
        Self {
            question,
            measure,
            a: a.iter().enumerate().map(scaled).collect(),
            by_target: by_target.iter().zip(&units).map(|(b, u)| b / u).collect(),
            units,
            entering,
        }
    }

    /// The least measure within a travel, rad, from rest.
    ///
    /// # Errors
    /// [`LimitError::TravelTooSmall`], [`LimitError::Solver`], and [`LimitError::Stopped`] where `stop` says so.
    pub fn solve(&self, travel_rad: f64, stop: fn() -> bool) -> Result<Solution, LimitError> {
        let begin = Begin {
            sample: 0,
            state: vec![0.0; self.question.plant.states],
            counted_rad: None,
            before_rad: self.question.before_rad.clone(),
        };
        self.solve_from(&begin, Spending::Within(travel_rad), self.coming(), stop)
    }

    /// What will come.
    pub(crate) fn coming(&self) -> Coming<'_> {
        let setpoint_rad = self.question.setpoint_rad();
        Coming { setpoint_rad, entering: &self.entering, quiet_rad: self.question.quiet_rad() }
    }

    /// The states a sample later, rad, with a target and what enters at it.
    pub(crate) fn moved(&self, state: &[f64], target_rad: f64, entering: &[f64]) -> Vec<f64> {
        let states = state.len();
        let scaled: Vec<f64> = state.iter().zip(&self.units).map(|(x, u)| x / u).collect();
        (0..states)
            .map(|i| {
                let row = &self.a[i * states..(i + 1) * states];
                let free: f64 = row.iter().zip(&scaled).map(|(a, x)| a * x).sum();
                let enters = entering.get(i).copied().unwrap_or(0.0) / RADIAN_DEG;
                (free + self.by_target[i] * target_rad + enters) * self.units[i]
            })
            .collect()
    }

    /// The same from a sample on, with what is taken to come.
    pub(crate) fn solve_from(
        &self,
        begin: &Begin,
        spending: Spending,
        coming: Coming<'_>,
        stop: fn() -> bool,
    ) -> Result<Solution, LimitError> {
        let mut rows = Rows::default();
        let layout = Layout::new(self.question, begin, self.measure);
        self.motion(&mut rows, &layout, begin, coming.entering);
        let equalities = rows.bounds.len();
        let places = self.inequalities(&mut rows, &layout, begin, spending, coming);
        let (cost, squares) = self.cost(&layout, spending, &places);
        let cones = [
            SupportedConeT::ZeroConeT(equalities),
            SupportedConeT::NonnegativeConeT(rows.bounds.len() - equalities),
        ];
        let a = rows.matrix(layout.variables);
        let mut solver = DefaultSolver::new(&squares, &cost, &a, &rows.bounds, &cones, settings())
            .map_err(|error| LimitError::Solver { status: error.to_string() })?;
        solver.set_termination_callback(move |_| stop());
        solver.solve();
        let solution = &solver.solution;
        match solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => {}
            SolverStatus::CallbackTerminated => return Err(LimitError::Stopped),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
                return Err(LimitError::TravelTooSmall);
            }
            // Numbers that are not quite good are good enough to be checked.
            SolverStatus::InsufficientProgress | SolverStatus::MaxIterations => {}
            other => return Err(LimitError::Solver { status: format!("{other:?}") }),
        }
        let solved = Solved {
            layout: &layout,
            begin,
            places: &places,
            x: &solution.x,
            z: &solution.z,
            setpoint_rad: coming.setpoint_rad,
        };
        Ok(self.read(&solved))
    }

    /// $z_{k+1} = A z_k + B v_k + w_k$.
    fn motion(&self, rows: &mut Rows, layout: &Layout, begin: &Begin, entering: &[Vec<f64>]) {
        let states = layout.states;
        for k in layout.first..layout.last {
            for i in 0..states {
                let mut bound = entering.get(k).and_then(|it| it.get(i)).copied().unwrap_or(0.0);
                let mut row = vec![(layout.state(k + 1, i), 1.0)];
                for (j, &a) in self.a[i * states..(i + 1) * states].iter().enumerate() {
                    if k == layout.first {
                        bound += a * begin.state[j] * RADIAN_DEG / self.units[j];
                    } else {
                        row.push((layout.state(k, j), -a));
                    }
                }
                match layout.target(k) {
                    Some(place) => row.push((place, -self.by_target[i])),
                    None => bound += self.by_target[i] * begin.before(k) * RADIAN_DEG,
                }
                rows.push(&row, bound);
            }
        }
    }

    /// The deflection or target at a sample as a term, or as a number where it is known, deg.
    fn counted(&self, layout: &Layout, begin: &Begin, k: usize) -> (Option<(usize, f64)>, f64) {
        match self.question.counted.state {
            Some(place) if k == layout.first => (None, begin.state[place] * RADIAN_DEG),
            Some(place) => (Some((layout.state(k, place), self.units[place])), 0.0),
            None => match layout.target(k) {
                Some(place) => (Some((place, 1.0)), 0.0),
                None => (None, begin.before(k) * RADIAN_DEG),
            },
        }
    }

    fn deflection(&self, layout: &Layout, begin: &Begin, k: usize) -> (Option<(usize, f64)>, f64) {
        let place = self.question.plant.deflection;
        if k == layout.first {
            return (None, begin.state[place] * RADIAN_DEG);
        }
        (Some((layout.state(k, place), self.units[place])), 0.0)
    }

    fn inequalities(
        &self,
        rows: &mut Rows,
        layout: &Layout,
        begin: &Begin,
        spending: Spending,
        coming: Coming<'_>,
    ) -> Places {
        let question = self.question;
        let mut places = Places::default();
        // Errors: r - θ within ± s; of a quadratic cost they are variables of their own.
        for k in layout.first + 1..=layout.last {
            let theta = (layout.state(k, 0), self.units[0]);
            let setpoint = coming.setpoint_rad.get(k).copied().unwrap_or(0.0) * RADIAN_DEG;
            if let Some(size) = layout.error(k) {
                places.error.push((k, rows.len()));
                rows.push(&[(theta.0, -theta.1), (size, -1.0)], -setpoint);
                rows.push(&[theta, (size, -1.0)], setpoint);
            }
        }
        let counted = &question.counted;
        let begins = layout.first.max(counted.first);
        let mut whole = Vec::new();
        for k in begins..counted.end.min(layout.last + 1) {
            let before = match (k == begins, begin.counted_rad) {
                (true, Some(counted_rad)) => (None, counted_rad * RADIAN_DEG),
                (true, None) if counted.from_rest => (None, 0.0),
                (true, None) => continue,
                (false, _) => {
                    let (term, value) = self.counted(layout, begin, k - 1);
                    (term, value + counted.offset(k - 1) * RADIAN_DEG)
                }
            };
            let (term, value) = self.counted(layout, begin, k);
            let known = value + counted.offset(k) * RADIAN_DEG - before.1;
            let size = layout.travel(k);
            whole.push((size, 1.0));
            let signed = |sign: f64| {
                let own = term.map(|(place, by)| (place, sign * by));
                let other = before.0.map(|(place, by)| (place, -sign * by));
                own.into_iter().chain(other).chain([(size, -1.0)]).collect::<Vec<_>>()
            };
            places.travel.push((k, rows.len()));
            rows.push(&signed(1.0), -known);
            rows.push(&signed(-1.0), known);
        }
        if let Spending::Within(travel_rad) = spending {
            rows.push(&whole, (travel_rad + counted.more_rad) * RADIAN_DEG);
        }
        for k in layout.first..=layout.last {
            let Some(place) = layout.target(k) else { continue };
            let (low, high) = question.within(coming.quiet_rad.get(k));
            rows.push(&[(place, 1.0)], high * RADIAN_DEG);
            rows.push(&[(place, -1.0)], -low * RADIAN_DEG);
        }
        self.held(rows, layout, begin, &mut places);
        places
    }

    /// Rate limit and stops.
    fn held(&self, rows: &mut Rows, layout: &Layout, begin: &Begin, places: &mut Places) {
        let most = self.question.most_change_rad;
        for k in layout.first..layout.last {
            let (next, _) = self.deflection(layout, begin, k + 1);
            let (here, value) = self.deflection(layout, begin, k);
            if let Some(most) = most {
                places.change.push((k, rows.len()));
                for sign in [1.0, -1.0] {
                    let own = next.map(|(place, by)| (place, sign * by));
                    let other = here.map(|(place, by)| (place, -sign * by));
                    let row: Vec<(usize, f64)> = own.into_iter().chain(other).collect();
                    rows.push(&row, most * RADIAN_DEG + sign * value);
                }
            }
            if let (Some((least, most)), Some((place, by))) = (self.question.stops(), next) {
                places.stop.push((k + 1, rows.len()));
                rows.push(&[(place, by)], most * RADIAN_DEG);
                rows.push(&[(place, -by)], -least * RADIAN_DEG);
            }
        }
    }

    fn cost(
        &self,
        layout: &Layout,
        spending: Spending,
        places: &Places,
    ) -> (Vec<f64>, CscMatrix<f64>) {
        let mut cost = vec![0.0; layout.variables];
        if let Spending::At(price) = spending {
            // Squares are of degrees.
            let price = if self.measure == Measure::Ise { price * RADIAN_DEG } else { price };
            places.travel.iter().for_each(|(k, _)| cost[layout.travel(*k)] = price);
        }
        let dt_s = self.question.dt_s;
        let mut squares = Vec::new();
        for k in layout.first + 1..=layout.last {
            match (self.measure, layout.error(k)) {
                (Measure::Iae, Some(place)) => cost[place] = dt_s,
                (Measure::Peak, Some(place)) => cost[place] = 1.0,
                (Measure::Ise, Some(place)) => squares.push((place, 2.0 * dt_s)),
                _ => {}
            }
        }
        let (places, values): (Vec<usize>, Vec<f64>) = squares.into_iter().unzip();
        let size = layout.variables;
        (cost, CscMatrix::new_from_triplets(size, size, places.clone(), places, values))
    }

    fn read(&self, solved: &Solved<'_>) -> Solution {
        let Solved { layout, begin, .. } = solved;
        let rows = self.question.rows;
        let errors = self.errors(solved);
        let mut target_rad = vec![0.0; rows];
        let mut deflection_rad = vec![0.0; rows];
        for k in layout.first..=layout.last {
            let last = target_rad.get(k.wrapping_sub(1)).copied().unwrap_or(0.0);
            target_rad[k] = match layout.target(k) {
                Some(place) => solved.of(place) / RADIAN_DEG,
                None if k < layout.last => begin.before(k),
                None => last,
            };
            let (term, value) = self.deflection(layout, begin, k);
            deflection_rad[k] =
                term.map_or(value, |(place, by)| solved.of(place) * by) / RADIAN_DEG;
        }
        let value = self.measure.of(&errors, self.question.dt_s);
        let multipliers = self.multipliers(solved, &errors);
        Solution { value, target_rad, deflection_rad, multipliers }
    }

    /// Errors from the first sample that is planned, rad.
    fn errors(&self, solved: &Solved<'_>) -> Vec<f64> {
        let Solved { layout, begin, .. } = solved;
        let setpoint = |k: usize| solved.setpoint_rad.get(k).copied().unwrap_or(0.0);
        let error_at =
            |k: usize| setpoint(k) - solved.of(layout.state(k, 0)) * self.units[0] / RADIAN_DEG;
        let later = (layout.first + 1..=layout.last).map(error_at);
        std::iter::once(setpoint(layout.first) - begin.state[0]).chain(later).collect()
    }

    fn multipliers(&self, solved: &Solved<'_>, errors: &[f64]) -> Multipliers {
        let (rows, dt_s, first) = (self.question.rows, self.question.dt_s, solved.layout.first);
        let places = solved.places;
        let mut error = solved.spread(&places.error, rows);
        match (self.measure, errors.first()) {
            // The first error is what it is.
            (Measure::Iae, Some(first_error)) => error[first] = dt_s.copysign(*first_error),
            (Measure::Ise, _) => {
                error.iter_mut().skip(first).zip(errors).for_each(|(g, e)| *g = 2.0 * dt_s * e);
            }
            _ => {}
        }
        // The cost is in degrees, of squares in square degrees.
        let per_rad = |pairs: &[(usize, usize)]| {
            let values = solved.spread(pairs, rows);
            match self.measure {
                Measure::Ise => values.into_iter().map(|it| it / RADIAN_DEG).collect(),
                Measure::Iae | Measure::Peak => values,
            }
        };
        Multipliers {
            error,
            travel: per_rad(&places.travel),
            change: per_rad(&places.change),
            stop: per_rad(&places.stop),
        }
    }
}

/// What a solver answered, and to what.
struct Solved<'a> {
    layout: &'a Layout,
    begin: &'a Begin,
    places: &'a Places,
    x: &'a [f64],
    z: &'a [f64],
    setpoint_rad: &'a [f64],
}

impl Solved<'_> {
    /// A variable.
    fn of(&self, place: usize) -> f64 {
        self.x.get(place).copied().unwrap_or(0.0)
    }

    /// Multipliers of pairs of inequalities, upper less lower, at their samples.
    fn spread(&self, pairs: &[(usize, usize)], rows: usize) -> Vec<f64> {
        let of = |place: usize| self.z.get(place).copied().unwrap_or(0.0);
        let mut values = vec![0.0; rows];
        for &(k, place) in pairs {
            if let Some(value) = values.get_mut(k) {
                *value = of(place) - of(place + 1);
            }
        }
        values
    }
}

impl Begin {
    /// A target that was given before, rad.
    pub(crate) fn before(&self, k: usize) -> f64 {
        let place = k.checked_sub(self.sample);
        place.and_then(|place| self.before_rad.get(place)).copied().unwrap_or(0.0)
    }
}

/// Where everything stands among the variables, sample by sample.
struct Layout {
    states: usize,
    first: usize,
    last: usize,
    free_from: usize,
    target_end: usize,
    per_sample: usize,
    variables: usize,
    measure: Measure,
}

impl Layout {
    /// Of a sample: states (of the next), target, size of the error (of the next), size of the change.
    fn new(question: &Question, begin: &Begin, measure: Measure) -> Self {
        let states = question.plant.states;
        let (first, last) = (begin.sample, question.rows.saturating_sub(1));
        let per_sample = states + 3;
        let free_from = first + begin.before_rad.len();
        let variables = per_sample * (last - first + 1) + 1;
        let target_end = question.target_end();
        Self { states, first, last, free_from, target_end, per_sample, variables, measure }
    }

    fn base(&self, k: usize) -> usize {
        (k - self.first) * self.per_sample
    }

    fn state(&self, k: usize, place: usize) -> usize {
        self.base(k - 1) + place
    }

    fn target(&self, k: usize) -> Option<usize> {
        (k >= self.free_from && k < self.target_end).then(|| self.base(k) + self.states)
    }

    fn error(&self, k: usize) -> Option<usize> {
        match self.measure {
            Measure::Peak => Some(self.variables - 1),
            _ => (k > self.first).then(|| self.base(k - 1) + self.states + 1),
        }
    }

    fn travel(&self, k: usize) -> usize {
        self.base(k) + self.states + 2
    }
}

/// First rows of pairs of inequalities, with their samples.
#[derive(Default)]
struct Places {
    error: Vec<(usize, usize)>,
    travel: Vec<(usize, usize)>,
    change: Vec<(usize, usize)>,
    stop: Vec<(usize, usize)>,
}

/// Rows of a sparse matrix with their bounds.
#[derive(Default)]
struct Rows {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    bounds: Vec<f64>,
}

impl Rows {
    fn len(&self) -> usize {
        self.bounds.len()
    }

    fn push(&mut self, terms: &[(usize, f64)], bound: f64) {
        for &(column, value) in terms {
            if value != 0.0 {
                self.rows.push(self.bounds.len());
                self.columns.push(column);
                self.values.push(value);
            }
        }
        self.bounds.push(bound);
    }

    fn matrix(&self, variables: usize) -> CscMatrix<f64> {
        let (rows, columns) = (self.rows.clone(), self.columns.clone());
        CscMatrix::new_from_triplets(self.len(), variables, rows, columns, self.values.clone())
    }
}

/// Sizes of the states beside the pitch angle, by their answer to an impulse.
fn units(a: &[f64], by_target: &[f64], rows: usize) -> Vec<f64> {
    let states = by_target.len();
    let mut state = by_target.to_vec();
    let mut largest = vec![0.0_f64; states];
    for _ in 0..rows.min(2000) {
        for (largest, value) in largest.iter_mut().zip(&state) {
            *largest = largest.max(value.abs());
        }
        state =
            a.chunks(states).map(|row| row.iter().zip(&state).map(|(a, x)| a * x).sum()).collect();
    }
    let pitch = largest.first().copied().filter(|it| *it > 0.0).unwrap_or(1.0);
    largest.iter().map(|it| if *it > 0.0 { it / pitch } else { 1.0 }).collect()
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_threads: 1,
        direct_solve_method: "qdldl".to_owned(),
        tol_gap_abs: 1e-9,
        tol_gap_rel: 1e-9,
        tol_feas: 1e-9,
        ..DefaultSettings::default()
    }
}
