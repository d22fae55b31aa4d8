//! The program of a controller answers what the controller answers, bit for bit, for every option.

use fspid_core::{Controller, Sample, State, Step};
use fspid_export::interpret::{Cell, Machine};
use fspid_export::program::Part;
use fspid_export::{Angles, program};
use fspid_numeric::Real;
use proptest::prelude::*;

use fspid_export::vectors::{Event, eventful, samples};

fn real<R: Real>(machine: &Machine<'_, R>, part: Part, name: &str) -> R {
    match machine.member(part, name) {
        Some(Cell::Real(value)) => *value,
        other => panic!("{name} is {other:?}"),
    }
}

/// All that a step answers, in bits.
fn bits<R: Real>(step: &Step<R>) -> ([u64; 4], bool, u8) {
    let reals = [step.command_rad, step.gains.kp, step.gains.ki, step.gains.kd];
    (reals.map(|value| value.to_f64().to_bits()), step.saturated, step.faults.bits())
}

fn answered<R: Real>(machine: &Machine<'_, R>) -> ([u64; 4], bool, u8) {
    let reals = ["command_rad", "kp", "ki", "kd"].map(|name| real(machine, Part::Answer, name));
    let saturated = machine.member(Part::Answer, "saturated") == Some(&Cell::Truth(true));
    let Some(Cell::Byte(faults)) = machine.member(Part::Answer, "faults") else {
        panic!("no faults")
    };
    (reals.map(|value| value.to_f64().to_bits()), saturated, *faults)
}

fn fly<R: Real>(controller: &Controller<R>, samples: &[Sample<R>]) -> Result<(), TestCaseError> {
    let program = program(controller, Angles::Radians).expect("no sampled vertices are drawn");
    let mut machine = Machine::new(&program);
    let mut state = State::new();
    for (k, sample) in samples.iter().enumerate() {
        machine.set(Part::Sample, "setpoint_rad", Cell::Real(sample.setpoint_rad));
        machine.set(Part::Sample, "measurement_rad", Cell::Real(sample.measurement_rad));
        machine.set(Part::Sample, "rate_rad_s", Cell::Real(sample.rate_rad_s));
        machine.run("step");
        let step = controller.step(&mut state, *sample);
        prop_assert_eq!(answered(&machine), bits(&step), "sample {}: {:?}", k, sample);
    }
    Ok(())
}

/// What the machine answers to vectors is what they say.
fn eventful_flight<R: Real>(
    controller: &Controller<R>,
    angles: Angles,
) -> Result<(), TestCaseError> {
    let program = program(controller, angles).expect("no sampled vertices are drawn");
    let mut machine = Machine::new(&program);
    let names = |part| program.members(part).iter().map(|member| member.name.clone());
    let (sample, answer): (Vec<_>, Vec<_>) =
        (names(Part::Sample).collect(), names(Part::Answer).collect());
    machine.run("reset");
    for (k, vector) in eventful(controller, angles, 7, 1500).iter().enumerate() {
        for (name, value) in sample.iter().zip(&vector.sample) {
            machine.set(Part::Sample, name, Cell::Real(*value));
        }
        let given = Cell::Real(vector.event.given());
        match vector.event {
            Event::Hold => drop(machine.ask("hold", &[Cell::Byte(1)])),
            Event::Track(_) => drop(machine.ask("track", &[given])),
            event => {
                match event {
                    Event::Reset => machine.run("reset"),
                    Event::Faults => machine.run("faults"),
                    Event::Memory(..) => machine.set(Part::State, event.name(), given),
                    _ => {}
                }
                machine.run("step");
            }
        }
        let found = [0, 1, 2, 3]
            .map(|it| real::<R>(&machine, Part::Answer, &answer[it]).to_f64().to_bits());
        let expected: Vec<u64> = vector.answer.iter().map(|it| it.to_f64().to_bits()).collect();
        prop_assert_eq!(found.to_vec(), expected, "{}: {:?}", k, vector);
        let marks = [Cell::Truth(vector.marks[0] == 1), Cell::Byte(vector.marks[1])];
        let found = ["saturated", "faults"].map(|it| machine.member(Part::Answer, it).cloned());
        prop_assert_eq!(found, marks.map(Some), "{}: {:?}", k, vector);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_program_of_any_controller_answers_as_the_controller_in_both_precisions(
        controller in fspid_options::any_controller(),
        seed in any::<u64>(),
    ) {
        fly(&controller, &samples::<f64>(seed, 150))?;
        if let Ok(single) = controller.rounded::<f32>() {
            fly(&single, &samples::<f32>(seed, 150))?;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn resets_holds_and_taking_over_are_those_of_the_controller_for_every_option(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        eventful_flight(&controller, angles)?;
        if let Ok(single) = controller.rounded::<f32>() {
            eventful_flight(&single, angles)?;
        }
    }
}
