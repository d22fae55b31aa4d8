//! The loop with a self-tuner in the place of its PID; its form is not proved for it.

use fspid_core::{InputScale, Law, ReferenceModel, SecondInput};

use super::*;
use crate::gain_set::IncrementMap;
use crate::steps::tuned::tests::numbers;

pub(super) const LEAKAGE_PER_S: f64 = 0.6;
const MODEL: ReferenceModel<f64> = ReferenceModel { bandwidth_rad_s: 2.4, damping: 0.58 };

pub(in crate::steps) struct SelfTuned {
    description: LoopDescription,
    model: LoopModel<Interval>,
    pub(super) set: GainSet,
    pub(super) terminal: Terminal,
}

impl SelfTuned {
    /// One whose gains remember, and that sees the error of a model. A quarter of the way from each gain at rest to the ends of
    /// its reach is near.
    pub(in crate::steps) fn remembering() -> Self {
        let law = Law::Accumulating { leakage_per_s: LEAKAGE_PER_S };
        let second_input = SecondInput::ModelError(MODEL);
        let mut tuned = Self::of(TunerSettings { law, second_input, ..TunerSettings::literal() });
        let reach = around(&tuned.set, 1.0);
        let near = [0, 1, 2].map(|gain: usize| {
            let rest = tuned.set.rest[gain].midpoint();
            [reach[gain].lower(), reach[gain].upper()].map(|end| rest + 0.25 * (end - rest))
        });
        tuned.terminal.gains = Some(NearGains { gains: near, model_rad: 0.01 });
        tuned
    }

    /// One whose gains are what is seen now.
    pub(in crate::steps) fn without_memory() -> Self {
        Self::of(TunerSettings::literal())
    }

    fn of(settings: TunerSettings<f64>) -> Self {
        let loop_ = Loop::new();
        let steps = loop_.certificate.steps.as_ref().expect("steps are proved");
        let terminal = steps.terminal.clone();
        let mut description = loop_.certificate.description.clone();
        let settings = TunerSettings {
            input_scale: InputScale { error_per_rad: 40.0, change_per_rad: 8.0 },
            output_scale: Gains { kp: 0.02, ki: 0.005, kd: 0.01 },
            ..settings
        };
        let tuner = SelfTuner::new(GAINS, numbers(), settings).expect("allowed");
        let fspid = Fspid::new(tuner, *description.controller.config()).expect("allowed");
        let set = IncrementMap::of(fspid.tuner(), 12).expect("bounded").gains(1.0);
        description.controller = Controller::SelfTuning(fspid);
        let model = description.enclosed().expect("enclosed");
        Self { description, model, set, terminal }
    }

    pub(in crate::steps) fn ready(&self) -> Ready<'_> {
        let Self { description, model, set, terminal } = self;
        let slower = Terminal { rate: 1.0 - 0.5 * (1.0 - terminal.rate), ..terminal.clone() };
        let ready = Ready::of(description, model, set, [terminal, &slower], None);
        ready.expect("proved").expect("enclosed")
    }

    pub(super) fn near(&self) -> NearGains {
        self.terminal.gains.expect("of gains that remember")
    }
}
