//! The answer of `analyse` for people.

use fspid_core::Gains;
use fspid_diagnostics::digits::to_six_decimals;
use fspid_lti::{Complex, Mode, modulus};

use super::answer::{Margins, NO_CROSSOVER, NO_LOWER_LIMIT, NO_UPPER_LIMIT};

use super::{
    AnalysedLoop, Analysis, Equilibrium, Flights, Frozen, FrozenMap, FrozenReach, PlantLoop,
    RestLoop, Stability, held_in_words,
};
use crate::metrics::Absent;

impl Analysis {
    /// The answer of `analyse --format text`: verdict first, then the margins with their frequencies.
    #[must_use]
    pub fn text(&self) -> String {
        let point = self.question.point.name();
        let mut out = format!("{}: sampled loop, broken at the {point}\n", self.scenario);
        let externals = self.externals.iter().map(|found| found.name.chars().count());
        let names = self.loops.iter().map(|found| found.name.chars().count()).chain(externals);
        let width = names.max().unwrap_or(0).max(10);
        for found in &self.loops {
            out.push_str(&format!("\n{:width$}  {}\n", found.name, verdict(found)));
            push_loop(&mut out, found);
        }
        for external in &self.externals {
            out.push_str(&external.text(width));
        }
        if !self.left_out.is_empty() {
            out.push_str("\nNot in these numbers:\n");
            for sentence in &self.left_out {
                out.push_str(&format!("  {sentence}\n"));
            }
        }
        out
    }
}

fn verdict(found: &AnalysedLoop) -> String {
    let gains = match &found.equilibrium {
        Equilibrium::Fixed(gains) => format!("with {}", triple(*gains)),
        Equilibrium::AtRest(gains) => format!("at rest, with {}", triple(*gains)),
        Equilibrium::Drifts { .. } => String::new(),
    };
    if let Some(reason) = found.absent {
        return format!("no margins: {reason}");
    }
    let held = found.worst().map(held_where_worst).unwrap_or_default();
    let stability = found.stability();
    let (growing, modes) = (found.growing_modes(), found.modes.len());
    if growing > 0 {
        return format!("UNSTABLE with the outer loops of {growing} of {modes} modes {gains}");
    }
    let bad = found.plants.iter().filter(|it| it.stability() == stability).count();
    let plants = |bad| match found.plants.len() {
        1 => String::new(),
        all => format!(" for {bad} of {all} plants"),
    };
    if let (Stability::Undecided, 0, Some(doubt)) = (stability, bad, found.doubt) {
        return format!("UNDECIDED {gains}: {doubt}");
    }
    if stability != Stability::Stable {
        // Gains that move add at a rest what is asked of the pitch loop by itself.
        let is_fixed = matches!(found.equilibrium, Equilibrium::Fixed(_));
        let modes_hold = is_fixed && found.around() == Stability::Stable;
        let (alone, with_modes) = match (modes, modes_hold && stability == Stability::Unstable) {
            (1.., true) => (" by itself", "; stable with the outer loops of each mode"),
            _ => ("", ""),
        };
        let word = stability.word().to_uppercase();
        return format!("{word}{alone}{} {gains}{held}{with_modes}", plants(bad));
    }
    let unproved = found.plants.iter().filter(|plant| plant.margins.is_err()).count();
    if unproved > 0 {
        return format!("stable {gains}; NO MARGINS PROVED{}{held}", plants(unproved));
    }
    let poor = found.poor_margins_in_words().map_or(String::new(), |poor| format!("; {poor}"));
    format!("stable {gains}{poor}{held}")
}

/// Where the loop at rest is worst, if it differs from set-point to set-point.
pub(crate) fn held_where_worst(plant: &PlantLoop) -> String {
    if plant.others.is_empty() {
        return String::new();
    }
    format!("; worst {}", held_in_words(plant.worst.at))
}

fn push_loop(out: &mut String, found: &AnalysedLoop) {
    for plant in &found.plants {
        if found.plants.len() > 1 {
            out.push_str(&format!("  plant from {} s on\n", to_six_decimals(plant.from_s)));
        }
        push_plant(out, plant);
        match &plant.frozen {
            Some(Frozen::OfInputs(map)) => push_map(out, map),
            Some(Frozen::WithinReach(reach)) => push_reach(out, reach),
            None => {}
        }
        push_unseen(out, plant);
    }
    for mode in &found.modes {
        out.push_str(&format!("  mode {}\n", mode.in_words()));
    }
    for (label, sentence) in found.flights.iter().flat_map(Flights::lines) {
        out.push_str(&format!("  {label:17}  {sentence}\n"));
    }
}

fn push_plant(out: &mut String, plant: &PlantLoop) {
    match &plant.margins {
        Ok(margins) => {
            push_margins(out, margins);
            push_turning(out, plant);
        }
        Err(reason) => {
            if plant.stability() == Stability::Unstable {
                push_unstable_poles(out, plant);
            }
            out.push_str(&format!("  no margins         {reason}\n"));
        }
    }
    if !plant.others.is_empty() {
        let Gains { kp, .. } = plant.worst.gains;
        let held = held_in_words(plant.worst.at);
        out.push_str(&format!(
            "  gain on the error  {kp:.4} {held}: kp, and what the held command changes by as kp moves\n"
        ));
    }
    let oscillating = plant.worst.closed_poles.iter().filter(|pole| pole.im > 0.0);
    let modes = oscillating.map(|pole| mode(*pole, plant.worst.open.dt_s()));
    let least = modes.min_by(|one, other| one.damping_ratio.total_cmp(&other.damping_ratio));
    if let Some(mode) = least {
        out.push_str(&format!(
            "  least damped mode  damping {:.3} at {:.3} rad/s\n",
            mode.damping_ratio, mode.natural_frequency_rad_s
        ));
    }
}

/// A pole of the sampled loop as the mode that it samples.
pub(super) fn mode(pole: Complex, dt_s: f64) -> Mode {
    // A pole at the origin is gone after one sample, faster than any frequency.
    let gone = Mode { natural_frequency_rad_s: f64::INFINITY, damping_ratio: 1.0 };
    // One at 1 stays where it is: a mode of no frequency, of which no damping can be told.
    let stays = Mode { natural_frequency_rad_s: 0.0, damping_ratio: 0.0 };
    let none = if modulus(pole) < 0.5 { gone } else { stays };
    Mode::of_sampled_pole(pole, dt_s).unwrap_or(none)
}

fn push_unstable_poles(out: &mut String, plant: &PlantLoop) {
    for pole in
        plant.worst.closed_poles.iter().filter(|pole| modulus(**pole) >= 1.0 && pole.im >= 0.0)
    {
        let sign = if pole.im > 0.0 { format!(" ± {:.6}j", pole.im) } else { String::new() };
        let mode = mode(*pole, plant.worst.open.dt_s());
        out.push_str(&format!(
            "  unstable pole      z = {:.6}{sign}, modulus {:.6}: {:.3} rad/s, damping {:.3}\n",
            pole.re,
            modulus(*pole),
            mode.natural_frequency_rad_s,
            mode.damping_ratio
        ));
    }
}

fn push_margins(out: &mut String, margins: &Margins) {
    let [low, high] = margins.gain_margin_db;
    let [low_at, high_at] = margins.phase_crossover_rad_s;
    out.push_str(&format!(
        "  gain margin        {}; {}\n",
        end(low, low_at, NO_LOWER_LIMIT),
        end(high, high_at, NO_UPPER_LIMIT)
    ));
    match margins.gain_crossover_rad_s {
        Some(omega) => out.push_str(&format!(
            "  phase margin       {:.2} deg at {omega:.3} rad/s; delay margin {:.4} s\n",
            margins.phase_margin_deg, margins.delay_margin_s
        )),
        None => out.push_str(&format!("  phase margin       without end: {NO_CROSSOVER}\n")),
    }
    if margins.gain_crossover_rad_s.is_none() && margins.delay_margin_s.is_finite() {
        out.push_str(&format!("  delay margin       {:.4} s\n", margins.delay_margin_s));
    }
    let [disk_low, disk_high] = margins.disk_gain_db;
    out.push_str(&format!(
        "  disk margin        {:.4} at {:.3} rad/s: gain {disk_low:+.2} to {disk_high:+.2} dB, phase {:.2} deg\n",
        margins.disk_margin, margins.disk_rad_s, margins.disk_phase_deg
    ));
    out.push_str(&format!(
        "  sensitivity        peak {:.4} at {:.3} rad/s; complementary peak {:.4}\n",
        margins.sensitivity_peak, margins.sensitivity_peak_rad_s, margins.complementary_peak
    ));
    for (name, bracket) in margins.open_brackets() {
        out.push_str(&format!(
            "  proved only        {} between {:.4} and {:.4}; the worse end stands above\n",
            name.replace('_', " "),
            bracket.at_least,
            bracket.at_most
        ));
    }
}

/// A delay margin that no crossover tells.
fn push_turning(out: &mut String, plant: &PlantLoop) {
    let at_nyquist = |rest: &RestLoop| rest.open.gain(rest.open.nyquist_rad_s());
    let gain = plant.rests().map(at_nyquist).fold(0.0, f64::max);
    // Written so that NaN is told, too.
    if !(gain < 1.0) {
        out.push_str(&format!(
            "  half sample rate   the gain is {gain:.3} there, where a sample of delay turns the sign: the loop bears less than one sample\n"
        ));
    }
}

fn end(db: f64, omega_rad_s: Option<f64>, reason: &str) -> String {
    match omega_rad_s {
        Some(omega) => format!("{db:+.2} dB at {omega:.3} rad/s"),
        None => reason.to_owned(),
    }
}

fn push_map(out: &mut String, map: &FrozenMap) {
    let worst = &map.worst;
    let at = format!(
        "error {:+.3}, change {:+.3} (supervisor units): {}",
        worst.input[0],
        worst.input[1],
        triple(worst.gains)
    );
    let all = match &worst.margins {
        Ok(_) => format!("all {} hold", all_of(map)),
        Err(_) => not_holding(map),
    };
    push_frozen(out, &all, &worst.margins, &at);
}

/// Where a set-point that is held makes a loop unstable whose frozen gains all hold: why the two lines differ.
fn push_unseen(out: &mut String, plant: &PlantLoop) {
    let frozen = plant.frozen.as_ref().map(|frozen| match frozen {
        Frozen::OfInputs(map) => map.stability(),
        Frozen::WithinReach(reach) => reach.stability(),
    });
    let differs = plant.stability() != Stability::Stable && frozen == Some(Stability::Stable);
    if differs && !plant.others.is_empty() {
        out.push_str("                     what the motion of the gains adds at a held set-point is not among gains that stand still\n");
    }
}

/// What is found of frozen gains, and where it is worst.
fn push_frozen(out: &mut String, all: &str, worst: &Result<Margins, Absent>, at: &str) {
    let worst = match worst {
        Ok(margins) => format!(
            "disk margin {:.4}, gain {:.2} dB, phase {:.2} deg",
            margins.disk_margin,
            margins.smaller_gain_margin_db(),
            margins.phase_margin_deg
        ),
        Err(reason) => reason.to_string(),
    };
    out.push_str(&format!(
        "  frozen gains       {all}; the worst: {worst}\n                     at {at}\n"
    ));
}

fn push_reach(out: &mut String, reach: &FrozenReach) {
    let stability = reach.stability();
    let (points, bad) = (reach.points.len(), reach.count(stability));
    let of = "looked at within the law's reach";
    let all = match (stability, bad) {
        (Stability::Stable, _) => format!("all {points} {of} hold"),
        (_, 0) => format!("all {points} {of} hold, and some between them do not or are undecided"),
        (Stability::Unstable, _) => format!("{bad} of {points} {of} would NOT HOLD"),
        (Stability::Undecided, _) => format!("{bad} of {points} {of} are UNDECIDED"),
    };
    push_frozen(out, &all, &reach.worst.margins, &triple(reach.worst.gains));
}

/// "81 on the map and 49 cells".
fn all_of(map: &FrozenMap) -> String {
    match (map.points.len(), map.nodes.len()) {
        (points, 0) => format!("{points} on the map"),
        (points, cells) => format!("{points} on the map and {cells} cells"),
    }
}

/// "3 of 81 on the map and 1 of 49 cells DO NOT HOLD"; where none of them is meant, the search found one.
fn not_holding(map: &FrozenMap) -> String {
    let stability = map.stability();
    let [one, several] = match stability {
        Stability::Stable => return format!("all {} hold", all_of(map)),
        Stability::Unstable => ["DOES NOT HOLD", "DO NOT HOLD"],
        Stability::Undecided => ["IS UNDECIDED", "ARE UNDECIDED"],
    };
    let (points, cells) = (map.points.len(), map.nodes.len());
    match (FrozenMap::count(&map.points, stability), FrozenMap::count(&map.nodes, stability)) {
        (0, 0) => format!("all {} hold, and one between them {one}", all_of(map)),
        (0, 1) => format!("1 of {cells} cells {one}"),
        (0, bad) => format!("{bad} of {cells} cells {several}"),
        (bad, _) if cells == 0 => format!("{bad} of {points} on the map {several}"),
        (bad, of_cells) => {
            format!("{bad} of {points} on the map and {of_cells} of {cells} cells {several}")
        }
    }
}

/// Gains for people.
pub(super) fn triple(gains: Gains<f64>) -> String {
    format!("kp {:.4}, ki {:.4}, kd {:.4}", gains.kp, gains.ki, gains.kd)
}
