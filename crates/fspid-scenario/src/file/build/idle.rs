//! Controllers that do nothing or the opposite, and supervisors that see nothing: right as they are written, and hardly meant.

use fspid_core::{Gains, PidConfig, SelfTuner};
use fspid_diagnostics::Report;
use fspid_sim::Controller;

use crate::file::spec::controller as keys;
use crate::keyed::Section;
use crate::turned::turned_and_asked_in_words;

/// Warns of a controller whose command never moves, of one with gains of a sign that turns the loop around, and of a
/// supervisor that is blind.
pub(super) fn warn(report: &mut Report, section: &Section, controller: &Controller) {
    let (config, gains_are_zero) = match controller {
        Controller::Fixed(pid) => (pid.config(), pid.gains() == Gains::ZERO),
        Controller::SelfTuning(fspid) => {
            let tuner = fspid.tuner();
            if is_blind(tuner) {
                warn_of_blindness(report, section);
            }
            (fspid.config(), gains_stay_zero(tuner))
        }
    };
    if let Some(turned) = turned_and_asked_in_words(controller.nominal()) {
        report.warn(format!("{}: {turned}", section.path));
    }
    if gains_are_zero && adds_nothing(config) {
        report.warn(format!(
            "{}: all gains are 0 and nothing is fed forward: this controller commands nothing",
            section.path
        ));
    }
}

/// True where the command has nothing beside the gains.
fn adds_nothing(config: &PidConfig<f64>) -> bool {
    [config.feedforward, config.rate_gain_s].iter().all(|it| *it == 0.0)
}

/// True where error and second input are both times 0.
fn is_blind(tuner: &SelfTuner<f64>) -> bool {
    let scale = tuner.settings().input_scale;
    [scale.error_per_rad, scale.change_per_rad].iter().all(|it| *it == 0.0)
}

/// True where the gains are 0 and the supervisor does not move them.
fn gains_stay_zero(tuner: &SelfTuner<f64>) -> bool {
    let is_still = tuner.settings().output_scale == Gains::ZERO
        || (is_blind(tuner) && tuner.gains_at_rest() == Gains::ZERO);
    tuner.nominal() == Gains::ZERO && is_still
}

fn warn_of_blindness(report: &mut Report, section: &Section) {
    let Some(part) = section.get(keys::SUPERVISOR) else { return };
    report.warn(format!(
        "{}: error_scale and change_scale are 0: the supervisor sees nothing, and answers as at rest whatever happens",
        part.path
    ));
}
