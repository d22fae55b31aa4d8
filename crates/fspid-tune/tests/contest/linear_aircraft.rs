//! A contest over aircraft of which nothing but a linear model is known.

use fspid_tune::contest::Options;

use crate::contest::place;

/// Other airliners' data: one tuned on an aircraft with derivatives, all judged on linear models as well.
const TRANSPORT: &str = r#"
schema = 1
name = "Transport"

[aircraft]
name = "b747-cruise-low"
airspeed_ft_s = 673.0
altitude_ft = 20000.0
model = "linear"

[actuator]
time_constant_s = 0.1
position_limit_deg = 20.0

[loop]
sample_period_s = 0.02
duration_s = 12.0

[setpoint]
kind = "step"
amplitude_deg = 5.0
at_s = 1.0

[[controller]]
name = "PID"
kind = "pid"
kp = { tune = [0.3, 3.0], scale = "log", start = 1.5 }
ki = 0.1
kd = 0.6
derivative_filter_s = 0.05

[[controller]]
name = "scheduled"
kind = "pid"
kp = 1.5
ki = 0.1
kd = 0.6
derivative_filter_s = 0.05
schedule = { dynamic_pressure_pa = 13732.0, exponent = -0.5 }

[[controller]]
name = "LQI"
kind = "lqi"
design = { pitch_damping_per_s = 2.98, elevator_power_per_s2 = 1.60 }
weights = { pitch = 4.0, rate = 1.0, integral = 0.1 }

[[controller]]
name = "FSPID"
kind = "fspid"
nominal = { kp = 1.5, ki = 0.1, kd = 0.6 }
derivative_filter_s = 0.05
law = "memoryless"
supervisor = { table = "mirrored", range = 5.0, error_scale = 0.5, change_scale = 0.3, output_scale = { kp = 0.02, ki = 0.01, kd = 0.0 } }

[tuning]
optimiser = "cma-es"
budget = 12

[[tuning.objective]]
measure = "iae_deg_s"

[contest]
seeds = 1

[[contest.case]]
name = "etkin-747"
group = "other airliners"
set = ["aircraft.name=etkin-747", "aircraft.airspeed_ft_s=774", "aircraft.altitude_ft=40000"]

[[contest.case]]
name = "ctms-transport"
group = "other airliners"
set = ["aircraft.name=ctms-transport", "aircraft.airspeed_ft_s=800", "aircraft.altitude_ft=30000"]

[[contest.case]]
name = "b747-approach"
set = ["aircraft.name=b747-approach", "aircraft.airspeed_ft_s=221", "aircraft.altitude_ft=0"]
"#;

#[test]
fn aircraft_known_by_linear_models_alone_are_cases_of_a_contest() {
    let outcome = place(TRANSPORT).held();
    assert_eq!(outcome.summaries.len(), 4);
    for summary in &outcome.summaries {
        assert_eq!((summary.whole.count.of, summary.whole.count.lost), (3, 0), "{summary:?}");
    }
    let wrong = TRANSPORT.replace("aircraft.airspeed_ft_s=774", "aircraft.airspeed_ft_s=700");
    let refused = place(&wrong).refused(&Options::default());
    assert!(refused.contains("774 ft/s, or within 0.5 % of it"), "{refused}");
}
