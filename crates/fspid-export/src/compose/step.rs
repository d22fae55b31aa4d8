//! The step of a controller: what is believed, the gains of the moment, the command, what is remembered.

use fspid_core::equations::{Free, Memory, PidEquations, SecondInputKind, TunerEquations};
use fspid_core::{Faults, Gains, InputSets, ModelState, Sample, SetCentres, largest_remembered};
use fspid_numeric::Real;
use fspid_numeric::scalar::Scalar as _;
use fspid_numeric::units::{DEGREE_RAD, RADIAN_DEG};

mod around;
mod track;

use self::around::nominal_gain;
use super::infer::{self, GAINS};
use super::members::Configuration;
use super::{Angles, precision_of};
use crate::program::{
    Argument, Expression, Function, Kind, Member, Operator, Part, Statement, Value, element, local,
    member, number, whole,
};
use crate::trace::{Listing, Traced};
use fspid_core::Controller;

const NOT_FINITE: u8 = Faults::NOT_FINITE.bits();
const IMPLAUSIBLE: u8 = Faults::IMPLAUSIBLE.bits();
const OVERFLOW: u8 = Faults::OVERFLOW.bits();

impl Angles {
    /// The end of a name.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Radians => "rad",
            Self::Degrees => "deg",
        }
    }

    /// Radians in a unit.
    pub(crate) const fn radians(self) -> Option<f64> {
        match self {
            Self::Radians => None,
            Self::Degrees => Some(DEGREE_RAD),
        }
    }

    /// Units in a radian.
    pub(crate) const fn per_radian(self) -> Option<f64> {
        match self {
            Self::Radians => None,
            Self::Degrees => Some(RADIAN_DEG),
        }
    }
}

fn described(name: impl Into<String>, doc: &str, value: Value) -> Member {
    Member { name: name.into(), doc: doc.to_owned(), value }
}

/// What a sample holds.
pub(super) fn sample<R: Real>(controller: &Controller<R>, angles: Angles) -> Vec<Member> {
    let unit = angles.unit();
    let real = |name: String, doc| described(name, doc, Value::Real(0.0));
    let mut members = vec![
        real(format!("setpoint_{unit}"), "Commanded pitch; nose up is positive."),
        real(format!("measurement_{unit}"), "Measured pitch; nose up is positive."),
    ];
    if controller.uses_rate() {
        members.push(real(format!("rate_{unit}_s"), "Measured pitch rate; nose up is positive."));
    }
    members
}

/// What a step answers.
pub(super) fn answer(angles: Angles) -> Vec<Member> {
    let real = |name: &str, doc| described(name, doc, Value::Real(0.0));
    vec![
        real(&format!("command_{}", angles.unit()), "Command; nose up is positive."),
        real("kp", "Proportional gain used, command per error."),
        real("ki", "Integral gain used, 1/s."),
        real("kd", "Derivative gain used, s."),
        described("saturated", "The command was cut by a limit.", Value::Truth(false)),
        described("faults", "Faults latched so far.", Value::Byte(0)),
    ]
}

/// What is remembered, as it begins.
pub(super) fn state<R: Real>(controller: &Controller<R>) -> Vec<Member> {
    let real = |name: &str, doc, value: R| described(name, doc, Value::Real(value.to_f64()));
    let Gains { kp, ki, kd } = controller.nominal();
    vec![
        real("command_rad", "The last command, rad.", R::ZERO),
        real("integral", "The integral's memory.", R::ZERO),
        real("derivative_rad_s", "The filtered derivative, rad/s.", R::ZERO),
        real("error_rad", "The last error, rad.", R::ZERO),
        real("derivative_input_rad", "What the derivative acted on, rad.", R::ZERO),
        real("kp", "The last proportional gain.", kp),
        real("ki", "The last integral gain.", ki),
        real("kd", "The last derivative gain.", kd),
        real("model_rad", "Pitch of the reference model at the next sample, rad.", R::ZERO),
        real("model_rad_s", "Its rate, rad/s.", R::ZERO),
        described("started", "There was a good sample.", Value::Truth(false)),
        described("faults", "Faults latched so far.", Value::Byte(0)),
    ]
}

/// The functions that others call.
pub(super) fn functions<R: Real>(
    configuration: &mut Configuration,
    controller: &Controller<R>,
    angles: Angles,
) -> Vec<Function> {
    let mut functions = Vec::new();
    if let Controller::SelfTuning(fspid) = controller
        && !fspid.tuner().settings().input_sets.are_even()
    {
        functions.push(infer::warp_function::<R>(fspid.tuner().supervisor().out_of_range()));
    }
    functions.push(around::reset(configuration, controller));
    functions.push(around::hold(configuration, controller, angles));
    let step =
        Composer { configuration, controller, angles, listing: Listing::new(precision_of::<R>()) };
    functions.push(step.step());
    let step =
        Composer { configuration, controller, angles, listing: Listing::new(precision_of::<R>()) };
    functions.push(step.track());
    functions.extend([track::saturated(), track::faults()]);
    functions
}

const PARTS: &[Part] = &[Part::Configuration, Part::State, Part::Sample, Part::Answer];

/// Command and gains of the answer.
fn answered(
    angles: Angles,
    command: &str,
    mut gain: impl FnMut(usize) -> Expression,
) -> Vec<Statement> {
    let mut command = local(command);
    if let Some(factor) = angles.per_radian() {
        command = command * number(factor);
    }
    let mut statements =
        vec![Statement::set_member(Part::Answer, &format!("command_{}", angles.unit()), command)];
    statements
        .extend((0..3).map(|place| Statement::set_member(Part::Answer, GAINS[place], gain(place))));
    statements
}

/// Puts the statements of a step together.
struct Composer<'a, R> {
    configuration: &'a mut Configuration,
    controller: &'a Controller<R>,
    angles: Angles,
    listing: Listing,
}

fn read(name: &str) -> Traced {
    Traced::read(local(name))
}

fn held(fault: u8) -> Vec<Statement> {
    let fault = Argument::Value(Expression::Byte(fault));
    vec![Statement::Call("hold", vec![fault]), Statement::Return(None)]
}

fn both(truths: impl IntoIterator<Item = Expression>) -> Expression {
    let all = truths.into_iter().reduce(Expression::and);
    all.unwrap_or(Expression::Truth(true))
}

/// True where something may cut the command.
fn is_limited<R: Real>(controller: &Controller<R>) -> bool {
    let config = controller.config();
    config.limits.is_some() || config.slew_rad_s.is_some()
}

/// Answers whether two finite numbers are not the same, without asking whether they are equal; they are where nothing
/// limits the command.
fn cut<R: Real>(
    controller: &Controller<R>,
    left: &Expression,
    right: &Expression,
) -> Vec<Statement> {
    let mark = |is| Statement::set_member(Part::Answer, "saturated", Expression::Truth(is));
    let differs = left.clone().less(right.clone()).or(right.clone().less(left.clone()));
    let mut marked = vec![mark(false)];
    if is_limited(controller) {
        marked.push(Statement::when(differs, vec![mark(true)]));
    }
    marked
}

impl<R: Real> Composer<'_, R> {
    fn step(mut self) -> Function {
        let mut body = self.believed();
        let (pid, tuner) = self.equations();
        let (sample, nominal) = (self.traced_sample(), self.nominal());
        let memory = self.memory(&mut body, &pid, &sample, &nominal);
        let (gains, model) = match &tuner {
            None => (nominal, None),
            Some(tuner) => self.gains(&mut body, tuner, &memory, &sample),
        };
        self.command(&mut body, &pid, &memory, &sample, &gains, model);
        Function {
            name: "step",
            doc: "Answers one sample; to be called once every period.",
            parts: PARTS,
            parameters: Vec::new(),
            answers: None,
            body,
        }
    }

    fn largest(&self) -> Expression {
        number(precision_of::<R>().largest())
    }

    /// The names of what is sampled, and the sample in radians.
    fn sampled(&self) -> (Vec<&'static str>, Vec<Statement>) {
        let unit = self.angles.unit();
        let mut names = vec![
            ("setpoint_rad", format!("setpoint_{unit}")),
            ("measurement_rad", format!("measurement_{unit}")),
        ];
        if self.controller.uses_rate() {
            names.push(("rate_rad_s", format!("rate_{unit}_s")));
        }
        let read = |(name, given): &(&'static str, String)| {
            Statement::real(name, self.in_radians(member(Part::Sample, given)))
        };
        (names.iter().map(|(name, _)| *name).collect(), names.iter().map(read).collect())
    }

    fn in_radians(&self, given: Expression) -> Expression {
        match self.angles.radians() {
            Some(factor) => given * number(factor),
            None => given,
        }
    }

    /// The sample as the equations read it.
    fn traced_sample(&self) -> Sample<Traced> {
        let uses_rate = self.controller.uses_rate();
        Sample {
            setpoint_rad: read("setpoint_rad"),
            measurement_rad: read("measurement_rad"),
            rate_rad_s: if uses_rate { read("rate_rad_s") } else { Traced::zero() },
        }
    }

    /// The nominal gains as the equations read them.
    fn nominal(&mut self) -> Gains<Traced> {
        let [kp, ki, kd] = [0, 1, 2]
            .map(|gain| Traced::read(nominal_gain(self.configuration, self.controller, gain)));
        Gains { kp, ki, kd }
    }

    /// The sample in radians, and whether it is believed.
    fn believed(&mut self) -> Vec<Statement> {
        let (names, mut body) = self.sampled();
        let limit = self.guard();
        let within = |most: &Expression| {
            both(names.iter().map(|name| local(name).magnitude().at_most(most.clone())))
        };
        body.push(Statement::Remark("A sample that cannot be believed holds the command.".into()));
        body.push(Statement::when(within(&self.largest()).negated(), held(NOT_FINITE)));
        body.push(Statement::when(within(&limit).negated(), held(IMPLAUSIBLE)));
        body
    }

    fn guard(&mut self) -> Expression {
        let limit = self.controller.config().guard.limit_rad().to_f64();
        self.configuration.real(
            "guard_rad",
            "Largest sample that is believed, rad and rad/s.",
            limit,
        )
    }

    /// The equations with their numbers in the configuration.
    fn equations(&mut self) -> (PidEquations<Traced>, Option<TunerEquations<Traced>>) {
        let (configuration, uses_rate) = (&mut *self.configuration, self.controller.uses_rate());
        let mut pid = |equations: &PidEquations<R>| PidEquations {
            structure: equations.structure,
            numbers: equations.numbers.map_named(|name, doc, value| match value.to_f64() {
                // Without a rate its gain of 0 is no number of the design.
                value if name == "rate_gain_s" && !uses_rate && value.to_bits() == 0 => {
                    Traced::zero()
                }
                value => configuration.traced(name, doc, value),
            }),
        };
        match self.controller {
            Controller::Fixed(fixed) => (pid(fixed.equations()), None),
            Controller::SelfTuning(fspid) => {
                let pid = pid(fspid.equations());
                let tuner = fspid.tuner_equations();
                let numbers = tuner
                    .numbers
                    .map_named(|name, doc, value| configuration.traced(name, doc, value.to_f64()));
                let mut index = 0;
                let gains = tuner.gains.map(|gain| {
                    let of = GAINS[index];
                    index += 1;
                    gain.map_named(|name, doc, value| {
                        let doc = format!("{} ({of})", doc.trim_end_matches(['.', '"']));
                        configuration.traced(&format!("{name}_{of}"), &doc, value.to_f64())
                    })
                });
                (pid, Some(TunerEquations { structure: tuner.structure, numbers, gains }))
            }
        }
    }

    /// What is remembered; at the first sample as if it had stood for ever.
    fn memory(
        &mut self,
        body: &mut Vec<Statement>,
        pid: &PidEquations<Traced>,
        sample: &Sample<Traced>,
        nominal: &Gains<Traced>,
    ) -> Memory<Traced> {
        let first = pid.at_first(sample, nominal);
        let state = |name: &str| member(Part::State, name);
        let started = state("started");
        // Those that this controller does not use are left out, as nothing reads them.
        for (name, of_state, at_first) in [
            ("last_error_rad", "error_rad", first.error_rad),
            ("last_input_rad", "derivative_input_rad", first.derivative_input_rad),
            ("model_rad", "model_rad", first.model_rad),
        ] {
            let at_first = self.listing.value(at_first);
            let value = started.clone().select(state(of_state), at_first);
            body.push(Statement::real(name, value));
        }
        let kept = |name: &str| Traced::read(state(name));
        Memory {
            command_rad: kept("command_rad"),
            integral: kept("integral"),
            derivative_rad_s: kept("derivative_rad_s"),
            error_rad: read("last_error_rad"),
            derivative_input_rad: read("last_input_rad"),
            kp: kept("kp"),
            ki: kept("ki"),
            kd: kept("kd"),
            model_rad: read("model_rad"),
            model_rad_s: kept("model_rad_s"),
        }
    }

    /// The gains of the moment, and where the reference model is next.
    fn gains(
        &mut self,
        body: &mut Vec<Statement>,
        tuner: &TunerEquations<Traced>,
        memory: &Memory<Traced>,
        sample: &Sample<Traced>,
    ) -> (Gains<Traced>, Option<ModelState<Traced>>) {
        body.push(Statement::Remark("The gains of the moment.".into()));
        let error = sample.setpoint_rad - sample.measurement_rad;
        let second = tuner.second_rad(memory, sample);
        body.extend(self.listing.values(&[("error_rad", error), ("second_rad", second)]));
        body.push(Statement::Let("fault".to_owned(), Kind::Byte, Expression::Byte(0)));
        let scaled = GAINS.map(|gain| format!("scaled_{gain}"));
        body.extend(scaled.iter().map(|name| Statement::real(name, number(0.0))));
        let inferred = self.inferred(tuner, &scaled);
        body.extend(self.unless_silent(inferred));
        let before = [memory.kp, memory.ki, memory.kd];
        for (gain, last) in GAINS.into_iter().zip(before) {
            body.push(Statement::real(gain, self.listing.value(last)));
        }
        let moved = self.moved(tuner, before, &scaled);
        if self.refuses() {
            let (fault, refused) = (local("fault"), Expression::Byte(infer::OUT_OF_RANGE));
            let refused = Expression::binary(Operator::Equal, fault, refused);
            body.push(Statement::when(refused.negated(), moved));
        } else {
            body.extend(moved);
        }
        let latched =
            Expression::binary(Operator::BitOr, member(Part::State, "faults"), local("fault"));
        body.push(Statement::set_member(Part::State, "faults", latched));
        let has_model = tuner.structure.second_input == SecondInputKind::ModelError;
        let model = has_model.then(|| tuner.next_model(memory, sample));
        (Gains { kp: read("kp"), ki: read("ki"), kd: read("kd") }, model)
    }

    /// The gains as the supervisor moves them, within their limits.
    fn moved(
        &mut self,
        tuner: &TunerEquations<Traced>,
        before: [Traced; 3],
        scaled: &[String; 3],
    ) -> Vec<Statement> {
        let names = GAINS.map(|gain| format!("free_{gain}"));
        let gains = tuner.gains.iter().zip(before).zip(scaled);
        let free: Vec<Traced> = gains
            .map(|((numbers, before), scaled)| tuner.free_gain(numbers, before, read(scaled)))
            .collect();
        let named: Vec<(&str, Traced)> =
            names.iter().map(String::as_str).zip(free.iter().copied()).collect();
        let mut body = self.listing.values(&named);
        let finite = both(names.iter().map(|name| local(name).magnitude().at_most(self.largest())));
        body.push(Statement::when(finite.negated(), held(OVERFLOW)));
        for ((gain, numbers), free) in GAINS.into_iter().zip(&tuner.gains).zip(free) {
            body.push(Statement::set(gain, self.listing.value(numbers.limited(free))));
        }
        self.listing.forget(&names);
        body
    }

    fn refuses(&self) -> bool {
        matches!(self.controller, Controller::SelfTuning(fspid)
            if fspid.tuner().supervisor().out_of_range() == fspid_core::fuzzy::OutOfRange::Error)
    }

    /// What the supervisor adds, scaled.
    fn inferred(&mut self, tuner: &TunerEquations<Traced>, scaled: &[String; 3]) -> Vec<Statement> {
        let [error, change] = tuner.seen(read("error_rad"), read("second_rad"));
        let mut body = self.listing.values(&[("seen_error", error), ("seen_change", change)]);
        let finite = both(
            ["seen_error", "seen_change"]
                .map(|name| local(name).magnitude().at_most(self.largest())),
        );
        body.push(Statement::when(finite.negated(), held(OVERFLOW)));
        body.push(Statement::Array("increments".to_owned(), 3));
        let [error, change] = self.warped();
        let arguments = vec![
            Argument::Value(error),
            Argument::Value(change),
            Argument::Array("increments".to_owned()),
        ];
        body.push(Statement::set("fault", Expression::Call("infer", arguments)));
        for ((name, numbers), place) in scaled.iter().zip(&tuner.gains).zip(0..) {
            let scale = self.listing.value(numbers.scale);
            body.push(Statement::set(name, scale * element("increments", whole(place))));
        }
        self.listing.forget(&["seen_error".to_owned(), "seen_change".to_owned()]);
        body
    }

    /// Both inputs as the even sets see them.
    fn warped(&mut self) -> [Expression; 2] {
        let Controller::SelfTuning(fspid) = self.controller else {
            return [local("seen_error"), local("seen_change")];
        };
        let InputSets { error, change } = fspid.tuner().settings().input_sets;
        let configuration = &mut *self.configuration;
        [("error", error), ("change", change)].map(|(input, centres)| {
            let seen = local(&format!("seen_{input}"));
            centres.map_or(seen.clone(), |centres: SetCentres<R>| {
                let mut centre = |size: &str, value: R| {
                    let doc = format!("Centre of the {size} sets of the {input}, of the range.");
                    configuration.real(&format!("{size}_{input}"), &doc, value.to_f64())
                };
                let arguments =
                    [seen, centre("small", centres.small()), centre("medium", centres.medium())];
                Expression::Call("warp", arguments.map(Argument::Value).into())
            })
        })
    }

    /// Does something outside of the dead zone.
    fn unless_silent(&mut self, body: Vec<Statement>) -> Vec<Statement> {
        let Controller::SelfTuning(fspid) = self.controller else { return body };
        let Some(zone) = fspid.tuner().settings().dead_zone else {
            return body;
        };
        let mut within = |name: &str, doc: &str, value: R, input: &str| {
            let most = self.configuration.real(name, doc, value.to_f64());
            local(input).magnitude().at_most(most)
        };
        let error =
            within("zone_error_rad", "Dead zone of the error, rad.", zone.error_rad, "error_rad");
        let doc = "Dead zone of what is seen beside it.";
        let second = within("zone_change_rad", doc, zone.change_rad, "second_rad");
        vec![Statement::when(error.and(second).negated(), body)]
    }

    /// Command, what is remembered, and the answer.
    fn command(
        &mut self,
        body: &mut Vec<Statement>,
        pid: &PidEquations<Traced>,
        memory: &Memory<Traced>,
        sample: &Sample<Traced>,
        gains: &Gains<Traced>,
        model: Option<ModelState<Traced>>,
    ) {
        body.push(Statement::Remark("The command before and behind its limits.".into()));
        let free = pid.free(memory, sample, gains);
        let regulated = pid.regulated(memory, &free, gains.ki);
        let Free { error_rad, derivative_input_rad, derivative_rad_s, wound, command_rad, .. } =
            free;
        let mut values = vec![
            ("loop_error_rad", error_rad),
            ("derivative_input_rad", derivative_input_rad),
            ("derivative_rad_s", derivative_rad_s),
            ("wound", wound),
            ("free_rad", command_rad),
            ("command_rad", regulated.command_rad),
            ("excess_rad", regulated.excess_rad),
            ("integral", regulated.integral),
        ];
        if let Some(model) = model {
            values.push(("next_model_rad", model.pitch_rad));
            values.push(("next_model_rad_s", model.rate_rad_s));
        }
        body.extend(self.listing.values(&values));
        body.push(Statement::Remark(
            "What overflows, or would at the next sample, is held; before that nothing is remembered.".into(),
        ));
        body.push(Statement::when(self.is_clear(model.is_some()).negated(), held(OVERFLOW)));
        self.remembered(body, model.is_some());
    }

    /// True if the next sample has an answer, whatever it is.
    fn is_clear(&self, has_model: bool) -> Expression {
        let [rate, integral] = largest_remembered::<R>().map(|most| number(most.to_f64()));
        let dt_s = || member(Part::Configuration, "dt_s");
        let mut truths = vec![
            (local("loop_error_rad") / dt_s()).magnitude().at_most(rate.clone()),
            (local("derivative_input_rad") / dt_s()).magnitude().at_most(rate.clone()),
            local("wound").magnitude().at_most(integral.clone()),
            local("integral").magnitude().at_most(integral),
        ];
        if has_model {
            truths.push(local("next_model_rad").magnitude().at_most(rate.clone()));
            truths.push(local("next_model_rad_s").magnitude().at_most(rate));
        }
        truths.push(local("free_rad").magnitude().at_most(self.largest()));
        both(truths)
    }

    fn remembered(&mut self, body: &mut Vec<Statement>, has_model: bool) {
        let mut kept = vec![
            ("command_rad", "command_rad"),
            ("integral", "integral"),
            ("derivative_rad_s", "derivative_rad_s"),
            ("error_rad", "loop_error_rad"),
            ("derivative_input_rad", "derivative_input_rad"),
        ];
        let self_tuning = matches!(self.controller, Controller::SelfTuning(_));
        if self_tuning {
            kept.extend(GAINS.map(|gain| (gain, gain)));
        }
        if has_model {
            kept.extend([("model_rad", "next_model_rad"), ("model_rad_s", "next_model_rad_s")]);
        }
        let keep = |(member, value)| Statement::set_member(Part::State, member, local(value));
        body.extend(kept.into_iter().map(keep));
        body.push(Statement::set_member(Part::State, "started", Expression::Truth(true)));
        let (configuration, controller) = (&mut *self.configuration, self.controller);
        body.extend(answered(self.angles, "command_rad", |gain| match controller {
            Controller::Fixed(_) => nominal_gain(configuration, controller, gain),
            Controller::SelfTuning(_) => local(GAINS[gain]),
        }));
        body.extend(cut(self.controller, &local("excess_rad"), &number(0.0)));
        let faults = member(Part::State, "faults");
        body.push(Statement::set_member(Part::Answer, "faults", faults));
    }
}
