//! Cases that are told as mirror images of others.

use fspid_tune::contest::Options;

use super::{marked, place};

/// Three shipped contests told a step of 5 deg as the mirror image of one of -1 deg.
#[test]
fn a_case_that_is_no_mirror_image_of_the_one_it_names_is_refused_with_what_differs() {
    let told = |set: &str| {
        let text = marked().replace("setpoint.amplitude_deg=-2.0", set);
        place(&text).refused(&Options::default())
    };
    let unlike = told("setpoint.amplitude_deg=-1.0");
    let wanted = "case \"-2 deg\" is no mirror image of \"2 deg\": `setpoint.amplitude_deg` is -1.0, its mirror image is -2.0; leave out mirror_of";
    assert!(unlike.contains(wanted), "{unlike}");
    let same = told("setpoint.amplitude_deg=2.0");
    assert!(same.contains("`setpoint.amplitude_deg` is 2.0, its mirror image is -2.0"), "{same}");
    let other = told("setpoint={kind='step', amplitude_deg=-2.0, at_s=3.0}");
    assert!(other.contains("`setpoint.at_s` is 3.0 here and"), "{other}");
}
