//! The paper's rules as a constant: a firmware needs no file for them.
//!
//! Source: Beygi, Beigy and Siahi, *Design of fuzzy self-tuning PID controller for pitch control system of
//! aircraft autopilot*, arXiv 1510.02588, Table 3.

use fspid_fuzzy::Label::{self, NB, NM, NS, PB, PM, PS, ZO};
use fspid_fuzzy::{Grid, LABEL_COUNT, RuleTable};

type Rows = [[Label; LABEL_COUNT]; LABEL_COUNT];

/// Rows: error from NB to PB; columns: change of error from NB to PB.
const DELTA_KP: Rows = [
    [PB, PB, PM, PM, PS, PS, ZO],
    [PB, PB, PM, PS, PS, ZO, NS],
    [PM, PM, PM, PS, ZO, NS, NM],
    [PM, PM, PS, ZO, NS, NM, NM],
    [PS, PS, ZO, NS, NS, NM, NM],
    [ZO, ZO, NS, NM, NM, NM, NB],
    [ZO, NS, NM, NM, NM, NB, NB],
];
const DELTA_KI: Rows = [
    [NB, NB, NB, NM, NS, ZO, ZO],
    [NB, NB, NM, NS, NS, ZO, ZO],
    [NB, NM, NS, NS, ZO, PS, PS],
    [NM, NS, NS, ZO, PS, PM, PM],
    [NS, NS, ZO, PS, PS, PM, PB],
    [ZO, ZO, PS, PS, PM, PB, PB],
    [ZO, ZO, PS, PM, PB, PB, PB],
];
const DELTA_KD: Rows = [
    [PS, NM, NB, NB, NB, NM, PS],
    [PS, NS, NB, NM, NM, NS, PS],
    [ZO, NS, NM, NM, NS, NS, ZO],
    [ZO, NS, NS, NS, NS, NS, ZO],
    [ZO, NS, ZO, ZO, ZO, ZO, PS],
    [PB, NS, PS, PS, PS, PS, PB],
    [PB, PM, PM, PM, PS, PS, PB],
];

/// Table 3 as printed. It answers a fall otherwise than a rise; [`RuleTable::mirrored`] answers both alike.
#[must_use]
pub const fn rules() -> RuleTable {
    RuleTable::new([Grid::new(DELTA_KP), Grid::new(DELTA_KI), Grid::new(DELTA_KD)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constant_is_what_the_shipped_files_say() {
        let file = |text: &str| {
            let parts: std::vec::Vec<&str> = text.split("\"\"\"").collect();
            RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
        };
        let text = |name| {
            let known = fspid_data::RULE_TABLES.into_iter().find(|(known, _)| *known == name);
            known.expect("a shipped table").1
        };
        let printed = file(text("printed"));
        let mirrored = file(text("mirrored"));
        assert_eq!((rules(), rules().mirrored()), (printed, mirrored));
    }
}
