//! Derivatives on their way back from the answer to inputs and parameters.

use alloc::vec;
use alloc::vec::Vec;

use super::super::defuzzifier::{Defuzzifier, SetReading};
use super::super::firing::hedged;
use super::super::parts::{
    Activation, Conclusion, Membership, Output, Statement, Universe, Variable,
};
use super::super::program::{self, STACK, Step};
use super::super::workspace::Workspace;
use super::nodes::{Node, Top};
use super::{Differentiator, Parameter, zeros};
use fspid_numeric::scalar::{Dual, Scalar};

/// Derivatives that are computed at once.
const LANES: usize = 8;
type Lanes = Dual<f64, LANES>;

/// Derivatives of one answer, filled in from its end to its beginnings.
#[derive(Debug)]
pub(crate) struct Adjoint<'d> {
    of: &'d Differentiator<'d>,
    pub(crate) inputs: Vec<f64>,
    pub(crate) parameters: Vec<f64>,
    /// With respect to the degree of each conclusion.
    degrees: Vec<f64>,
    /// With respect to the grade of each statement.
    grades: Vec<f64>,
}

/// Which term a membership function belongs to.
#[derive(Clone, Copy)]
enum Owner {
    Input { input: usize, term: usize },
    Output { output: usize, term: usize },
}

impl Owner {
    fn shape(self, index: usize) -> Parameter {
        match self {
            Self::Input { input, term } => Parameter::InputShape { input, term, index },
            Self::Output { output, term } => Parameter::OutputShape { output, term, index },
        }
    }

    fn height(self) -> Parameter {
        match self {
            Self::Input { input, term } => Parameter::InputHeight { input, term },
            Self::Output { output, term } => Parameter::OutputHeight { output, term },
        }
    }
}

fn at(list: &[f64], index: usize) -> f64 {
    list.get(index).copied().unwrap_or(0.0)
}

fn add(list: &mut [f64], index: usize, value: f64) {
    // A factor of 0 times an infinite slope does not count.
    if let Some(place) = list.get_mut(index)
        && !value.is_nan()
    {
        *place += value;
    }
}

impl<'d> Adjoint<'d> {
    pub(crate) fn new(of: &'d Differentiator<'d>, inputs: usize) -> Self {
        Self {
            of,
            inputs: zeros(inputs),
            parameters: zeros(of.parameters.len()),
            degrees: zeros(of.system.conclusions.len()),
            grades: zeros(of.system.program.statements.len()),
        }
    }

    fn add_parameter(&mut self, parameter: Parameter, value: f64) {
        if let Some(position) = self.of.position(parameter) {
            add(&mut self.parameters, position, value);
        }
    }

    /// Adds `weight` times the derivatives of a grade with respect to everything but `x`; answers
    /// the derivative with respect to `x`.
    fn through_grade(
        &mut self,
        membership: &Membership,
        owner: Owner,
        x: f64,
        inputs: &[f64],
        weight: f64,
    ) -> f64 {
        match membership {
            Membership::Shape { kind, params, height } => {
                let slope = derivatives(params, |lifted| kind.grade(lifted, Lanes::constant(x)));
                for (index, derivative) in slope.into_iter().enumerate() {
                    self.add_parameter(owner.shape(index), weight * height * derivative);
                }
                self.add_parameter(owner.height(), weight * kind.grade(params, x));
                let lifted: Vec<Dual<f64, 1>> = params.iter().map(|&p| Dual::constant(p)).collect();
                height * kind.grade(&lifted, Dual::variable(x, 0)).derivative[0]
            }
            Membership::Formula { formula, height } => {
                let values: Vec<f64> = [x].into_iter().chain(inputs.iter().copied()).collect();
                let slope = derivatives(&values, |lifted| formula.evaluate(lifted).unit());
                for (index, derivative) in slope.iter().skip(1).enumerate() {
                    add(&mut self.inputs, index, weight * height * derivative);
                }
                self.add_parameter(owner.height(), weight * formula.evaluate(&values).unit());
                height * at(&slope, 0)
            }
        }
    }

    /// From the grades of the joined set at some places to degrees and output terms.
    pub(crate) fn through_joined(
        &mut self,
        index: usize,
        output: &Output,
        nodes: &[Node],
        workspace: &Workspace,
    ) {
        let own = self.of.system.outputs.get(index).map_or(&[][..], |o| &o.conclusions);
        let mut room = workspace.scratch.room.clone();
        let mut links = vec![Link::default(); own.len()];
        for node in nodes.iter().filter(|node| node.weight.abs() > 0.0) {
            self.join_links(own, output, node.x, workspace, &mut room, &mut links);
            let mut carried = node.weight;
            // Backwards through the chain of s-norms.
            for (link, &position) in links.iter().zip(own).rev() {
                let here = carried * link.by_shaped;
                carried *= link.by_joined;
                if here.abs() > 0.0 {
                    add(&mut self.degrees, position, here * link.by_degree);
                    let slope = here * link.by_grade;
                    if slope.abs() > 0.0 {
                        self.through_set(index, output, position, node.x, slope, workspace);
                    }
                }
            }
        }
    }

    fn through_set(
        &mut self,
        index: usize,
        output: &Output,
        position: usize,
        x: f64,
        weight: f64,
        workspace: &Workspace,
    ) {
        let Some(resolved) = self.of.system.conclusions.get(position) else { return };
        let Some(Conclusion::Set { membership, .. }) =
            output.terms.get(resolved.term).map(|t| &t.conclusion)
        else {
            return;
        };
        let owner = Owner::Output { output: index, term: resolved.term };
        self.through_grade(membership, owner, x, &workspace.inputs, weight);
    }

    /// The slopes of each step of the joining at `x`.
    fn join_links(
        &self,
        own: &[usize],
        output: &Output,
        x: f64,
        workspace: &Workspace,
        room: &mut [f64],
        links: &mut [Link],
    ) {
        let system = self.of.system;
        let mut joined = 0.0;
        for (link, &position) in links.iter_mut().zip(own) {
            *link = Link { by_joined: 1.0, ..Link::default() };
            let Some(resolved) = system.conclusions.get(position) else { continue };
            let (Some(block), Some(term)) =
                (system.parts.blocks.get(resolved.block), output.terms.get(resolved.term))
            else {
                continue;
            };
            let Conclusion::Set { membership, .. } = &term.conclusion else { continue };
            let degree = at(&workspace.degrees, position);
            let grade = membership.grade(x, &workspace.inputs, room);
            let [d, g] = Dual::variables([degree, grade]);
            let shaped = block.implication.apply(d, g);
            let [j, s] = Dual::variables([joined, shaped.value]);
            let next: Dual<f64, 2> = output.aggregation.apply(j, s);
            *link = Link {
                by_degree: shaped.derivative[0],
                by_grade: shaped.derivative[1],
                by_joined: next.derivative[0],
                by_shaped: next.derivative[1],
            };
            joined = next.value;
        }
    }

    /// From a weighted average or sum to degrees and what is concluded.
    pub(crate) fn through_average(
        &mut self,
        index: usize,
        output: &Output,
        value: f64,
        workspace: &Workspace,
    ) {
        let (reading, averages) = match output.defuzzifier {
            Defuzzifier::WeightedAverage(reading) => (reading, true),
            Defuzzifier::WeightedSum(reading) => (reading, false),
            _ => return,
        };
        let system = self.of.system;
        let own = system.outputs.get(index).map_or(&[][..], |o| &o.conclusions);
        let total: f64 = own.iter().map(|&position| at(&workspace.degrees, position)).sum();
        let (total, about) = if averages { (total, value) } else { (1.0, 0.0) };
        let mut room = workspace.scratch.room.clone();
        for &position in own {
            let Some(resolved) = system.conclusions.get(position) else { continue };
            let Some(term) = output.terms.get(resolved.term) else { continue };
            let degree = at(&workspace.degrees, position);
            let place = [index, resolved.term];
            let weight = degree / total;
            let number = super::super::output::value(
                &term.conclusion,
                reading,
                degree,
                &workspace.inputs,
                &mut room,
            );
            let by_degree = self.through_number(
                &term.conclusion,
                place,
                reading,
                [degree, weight],
                &workspace.inputs,
            );
            add(&mut self.degrees, position, (number - about) / total + weight * by_degree);
        }
    }

    /// Adds `weight` times the derivatives of a conclusion's number; answers its derivative with
    /// respect to the degree.
    fn through_number(
        &mut self,
        conclusion: &Conclusion,
        [output, term]: [usize; 2],
        reading: SetReading,
        [degree, weight]: [f64; 2],
        inputs: &[f64],
    ) -> f64 {
        match conclusion {
            Conclusion::Constant(_) => {
                self.add_parameter(Parameter::Constant { output, term }, weight);
            }
            Conclusion::Interval(_) => {}
            Conclusion::Linear { coefficients, .. } => {
                self.add_parameter(Parameter::Constant { output, term }, weight);
                for (input, (&coefficient, &x)) in coefficients.iter().zip(inputs).enumerate() {
                    self.add_parameter(Parameter::Coefficient { output, term, input }, weight * x);
                    add(&mut self.inputs, input, weight * coefficient);
                }
            }
            Conclusion::Formula(formula) => {
                let slope = derivatives(inputs, |lifted| formula.evaluate(lifted));
                for (input, derivative) in slope.into_iter().enumerate() {
                    add(&mut self.inputs, input, weight * derivative);
                }
            }
            Conclusion::Set { membership, .. } => {
                let owner = Owner::Output { output, term };
                return match (reading, membership) {
                    (SetReading::InverseTsukamoto, _) => {
                        self.through_grade(membership, owner, degree, inputs, weight)
                    }
                    (SetReading::Tsukamoto, Membership::Shape { kind, params, height }) => {
                        let ratio = degree / height;
                        let values: Vec<f64> =
                            [ratio.min(1.0)].into_iter().chain(params.iter().copied()).collect();
                        let slope = derivatives(&values, |lifted| {
                            let Some((&grade, params)) = lifted.split_first() else {
                                return Lanes::zero();
                            };
                            kind.inverse(params, grade).unwrap_or_else(Lanes::zero)
                        });
                        for (index, derivative) in slope.iter().skip(1).enumerate() {
                            self.add_parameter(owner.shape(index), weight * derivative);
                        }
                        let by_ratio = if ratio < 1.0 { at(&slope, 0) } else { 0.0 };
                        self.add_parameter(owner.height(), -weight * by_ratio * ratio / height);
                        by_ratio / height
                    }
                    (SetReading::Tsukamoto, Membership::Formula { .. }) => 0.0,
                };
            }
        }
        0.0
    }

    /// From the ends of the highest plateau to the degree that cuts it and the set that is cut: with
    /// $\mu(a) = d$ at an end, $\mu'(a)\ da = dd - \partial_p\mu\ dp$.
    pub(crate) fn through_top(
        &mut self,
        index: usize,
        output: &Output,
        method: Defuzzifier,
        top: &Top,
        workspace: &Workspace,
    ) {
        let Some(resolved) = self.of.system.conclusions.get(top.conclusion) else { return };
        let Some(Conclusion::Set { membership, .. }) =
            output.terms.get(resolved.term).map(|t| &t.conclusion)
        else {
            return;
        };
        let owner = Owner::Output { output: index, term: resolved.term };
        for (x, share) in top.ends.into_iter().zip(Top::shares(method)) {
            let is_end = |u: Universe| x <= u.lower || x >= u.upper;
            if share <= 0.0 || output.universe.is_none_or(is_end) {
                continue;
            }
            if !top.cut {
                self.through_corner(membership, owner, x, share);
                continue;
            }
            let slope = self.through_grade(membership, owner, x, &workspace.inputs, 0.0);
            if slope.abs() > 0.0 {
                self.through_grade(membership, owner, x, &workspace.inputs, -share / slope);
                add(&mut self.degrees, top.conclusion, share / slope);
            }
        }
    }

    /// A corner of a piecewise-linear set moves with the parameter that it is.
    #[allow(clippy::float_cmp, reason = "the corner is the parameter, bit for bit")]
    fn through_corner(&mut self, membership: &Membership, owner: Owner, x: f64, share: f64) {
        let Membership::Shape { params, .. } = membership else { return };
        if let Some(index) = params.iter().position(|&parameter| parameter == x) {
            self.add_parameter(owner.shape(index), share);
        }
    }

    /// From the degrees of conclusions to inputs, input terms and weights.
    pub(crate) fn through_rules(&mut self, workspace: &Workspace) {
        let system = self.of.system;
        let mut acting = zeros(system.rules.len());
        for (position, conclusion) in system.conclusions.iter().enumerate() {
            let strength: Dual<f64, 1> = Dual::variable(at(&workspace.acting, conclusion.rule), 0);
            let slope = hedged(&conclusion.hedges, strength).derivative[0];
            add(&mut acting, conclusion.rule, at(&self.degrees, position) * slope);
        }
        for (rules, block) in system.block_rules.iter().zip(&system.parts.blocks) {
            let strengths = workspace.strengths.get(rules.clone()).unwrap_or_default();
            let Some(acting) = acting.get_mut(rules.clone()) else { continue };
            match block.activation {
                Activation::General => {}
                Activation::Proportional => through_proportion(strengths, acting),
                _ => {
                    let acts = workspace.acting.get(rules.clone()).unwrap_or_default();
                    for (slope, &acts) in acting.iter_mut().zip(acts) {
                        *slope = if acts > 0.0 { *slope } else { 0.0 };
                    }
                }
            }
        }
        for (rule, slope) in acting.into_iter().enumerate() {
            if slope.abs() > 0.0 {
                self.through_rule(rule, slope, workspace);
            }
        }
        for (statement, slope) in core::mem::take(&mut self.grades).into_iter().enumerate() {
            if let Some(found) = system.program.statements.get(statement)
                && slope.abs() > 0.0
            {
                self.through_statement(found, slope, workspace);
            }
        }
    }

    fn through_rule(&mut self, rule: usize, slope: f64, workspace: &Workspace) {
        let system = self.of.system;
        let Some(resolved) = system.rules.get(rule) else { return };
        let Some(block) = system.parts.blocks.get(resolved.block) else { return };
        let steps = system.program.steps.get(resolved.steps.clone()).unwrap_or_default();
        let mut statements: Vec<usize> = steps
            .iter()
            .filter_map(|step| match step {
                Step::Statement(statement) => Some(*statement),
                _ => None,
            })
            .collect();
        statements.sort_unstable();
        statements.dedup();
        let mut stack = vec![Lanes::zero(); STACK];
        let mut strength = 0.0;
        for lanes in statements.chunks(LANES) {
            let answer = program::strength(steps, block, &mut stack, |statement| {
                let grade = at(&workspace.grades, statement);
                match lanes.iter().position(|&s| s == statement) {
                    Some(lane) => Lanes::variable(grade, lane),
                    None => Lanes::constant(grade),
                }
            });
            strength = answer.value;
            for (&statement, derivative) in lanes.iter().zip(answer.derivative) {
                add(&mut self.grades, statement, slope * resolved.weight * derivative);
            }
        }
        if statements.is_empty() {
            strength = 1.0;
        }
        let weight = Parameter::Weight { block: resolved.block, rule: resolved.rule };
        self.add_parameter(weight, slope * strength);
    }

    fn through_statement(&mut self, statement: &Statement, slope: f64, workspace: &Workspace) {
        let system = self.of.system;
        let Variable::Input(input) = statement.variable else { return };
        let Some(variable) = system.parts.inputs.get(input).filter(|v| v.enabled) else { return };
        let Some((term, found)) =
            statement.term.and_then(|term| Some((term, variable.terms.get(term)?)))
        else {
            return;
        };
        let x = at(&workspace.inputs, input);
        let mut room = workspace.scratch.room.clone();
        let grade = found.membership.grade(x, &workspace.inputs, &mut room);
        let lifted: Dual<f64, 1> = Dual::variable(grade, 0);
        let slope = slope * hedged(&statement.hedges, lifted).derivative[0];
        if !(slope.abs() > 0.0) {
            return;
        }
        let owner = Owner::Input { input, term };
        let by_x = self.through_grade(&found.membership, owner, x, &workspace.inputs, slope);
        add(&mut self.inputs, input, slope * by_x);
    }
}

/// What one conclusion does to the joined set at one place.
#[derive(Clone, Copy, Debug, Default)]
struct Link {
    by_degree: f64,
    by_grade: f64,
    by_joined: f64,
    by_shaped: f64,
}

/// Each strength is divided by the sum of all.
fn through_proportion(strengths: &[f64], slopes: &mut [f64]) {
    let sum: f64 = strengths.iter().sum();
    if !(sum > 0.0) {
        slopes.fill(0.0);
        return;
    }
    let common: f64 = slopes.iter().zip(strengths).map(|(slope, s)| slope * s / (sum * sum)).sum();
    for slope in slopes {
        *slope = *slope / sum - common;
    }
}

/// The derivatives of a function with respect to each of `values`.
fn derivatives(values: &[f64], function: impl Fn(&[Lanes]) -> Lanes) -> Vec<f64> {
    let mut lifted: Vec<Lanes> = values.iter().map(|&value| Lanes::constant(value)).collect();
    let mut slopes = Vec::with_capacity(values.len());
    let mut begin = 0;
    while begin < values.len() {
        let end = (begin + LANES).min(values.len());
        for (lane, place) in lifted.iter_mut().skip(begin).take(LANES).enumerate() {
            *place = Lanes::variable(place.value, lane);
        }
        slopes.extend(function(&lifted).derivative.into_iter().take(end - begin));
        for place in lifted.iter_mut().skip(begin).take(LANES) {
            *place = Lanes::constant(place.value);
        }
        begin = end;
    }
    slopes
}
