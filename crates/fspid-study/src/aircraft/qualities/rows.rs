//! The values of flying qualities, and the reasons of those that do not exist.

use fspid_aircraft::qualities::{Absent, Phugoid, Qualities};

use crate::aircraft::facts::Facts;
use fspid_scenario::aircraft::units::Kind;

/// Every value that exists.
pub(super) fn facts(qualities: &Qualities) -> Facts {
    let facts = short_period(Facts::default(), qualities);
    let facts = divergence(phugoid(facts, qualities), qualities);
    let facts = bandwidth(facts, qualities);
    rest(facts, qualities)
}

fn short_period(facts: Facts, qualities: &Qualities) -> Facts {
    let name = "short period, damping";
    let Ok(found) = &qualities.short_period else {
        return match &qualities.short_period_damping {
            Ok(found) => facts.number(name, "short_period_damping", Kind::Plain, found.value),
            Err(_) => facts,
        };
    };
    let mode = &found.mode;
    facts
        .number(
            "short period, frequency",
            "short_period_frequency",
            Kind::Frequency,
            mode.natural_frequency_rad_s,
        )
        .number(name, "short_period_damping", Kind::Plain, mode.damping_ratio)
        .number("lift lag, Ttheta2", "lift_lag", Kind::Time, found.lift_lag_s)
        .number(
            "load by angle of attack",
            "n_alpha",
            Kind::LoadPerAngle,
            found.load_per_alpha_g_rad,
        )
        .number("control anticipation parameter", "cap", Kind::CapUnit, found.cap)
}

fn phugoid(facts: Facts, qualities: &Qualities) -> Facts {
    match &qualities.phugoid {
        Ok(Phugoid::Oscillation { mode, .. }) => {
            let frequency = mode.natural_frequency_rad_s;
            facts
                .number("phugoid, frequency", "phugoid_frequency", Kind::Frequency, frequency)
                .number("phugoid, damping", "phugoid_damping", Kind::Plain, mode.damping_ratio)
        }
        Ok(Phugoid::Creep { real_rad_s, .. }) => {
            facts.number("phugoid, slowest pole", "phugoid_pole", Kind::Frequency, *real_rad_s)
        }
        Err(_) => facts,
    }
}

fn divergence(facts: Facts, qualities: &Qualities) -> Facts {
    let Some(found) = &qualities.divergence else { return facts };
    let name = "fastest divergence, pole";
    facts.number(name, "divergence_pole", Kind::Frequency, found.real_rad_s).number(
        "fastest divergence, time to double",
        "divergence_time_to_double",
        Kind::Time,
        found.doubles_s,
    )
}

fn bandwidth(facts: Facts, qualities: &Qualities) -> Facts {
    let Ok(found) = &qualities.bandwidth else { return facts };
    let row = |facts: Facts, name, key, value| facts.number(name, key, Kind::Frequency, value);
    let facts = row(facts, "phase of -180 deg at", "neutral", found.neutral_rad_s);
    let facts = row(facts, "bandwidth by phase", "bandwidth_by_phase", found.by_phase_rad_s);
    let facts = row(facts, "bandwidth by gain", "bandwidth_by_gain", found.by_gain_rad_s);
    row(facts, "bandwidth", "bandwidth", found.bandwidth_rad_s).number(
        "phase delay",
        "phase_delay",
        Kind::Time,
        found.phase_delay_s,
    )
}

fn rest(facts: Facts, qualities: &Qualities) -> Facts {
    let facts = match &qualities.equivalent_delay {
        Ok(found) => {
            facts.number("equivalent delay", "equivalent_delay", Kind::Time, found.delay_s)
        }
        Err(_) => facts,
    };
    let Ok(found) = &qualities.dropback else { return facts };
    let overshoot = found.pitch_rate_overshoot;
    facts.number("dropback", "dropback", Kind::Time, found.dropback_s).number(
        "pitch rate, highest over steady",
        "pitch_rate_overshoot",
        Kind::Plain,
        overshoot,
    )
}

/// Why values and levels are missing.
pub(super) fn reasons(qualities: &Qualities) -> Vec<String> {
    let level = qualities.bandwidth.as_ref().ok().and_then(|found| found.level.err());
    let missing: [(&str, Option<Absent>); 6] = [
        ("short period", qualities.short_period.as_ref().err().copied()),
        ("phugoid", qualities.phugoid.as_ref().err().copied()),
        ("bandwidth", qualities.bandwidth.as_ref().err().copied()),
        ("level of the bandwidth", level),
        ("equivalent delay", qualities.equivalent_delay.as_ref().err().copied()),
        ("dropback", qualities.dropback.as_ref().err().copied()),
    ];
    let told = missing.into_iter().filter_map(|(name, reason)| Some((name, reason?)));
    told.map(|(name, reason)| format!("{name}: {reason}")).collect()
}
