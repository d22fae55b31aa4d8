//! What a file of JSBSim says twice, clips or puts elsewhere: positions of surfaces are those that JSBSim 1.3.3 shows for
//! commands of -1 and 1, and what it flies otherwise than it stands is refused.
#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test")]
#![allow(clippy::disallowed_methods, reason = "references may come from the platform's functions")]

use fspid_aircraft::{Air, Controls, Flow, ForceModel, Vector3};
use fspid_daveml::data;
use fspid_daveml::jsbsim::{Assumptions, JsbsimAircraft, read};

const INVENTED: &str = include_str!("data/jsbsim/invented.xml");

fn plain(text: &str) -> JsbsimAircraft {
    read(text, &Assumptions::default()).unwrap()
}

/// The only problem of a text, which has a line.
fn refused(text: &str) -> String {
    let told = read(text, &Assumptions::default()).unwrap_err().to_string();
    assert!(told.lines().count() == 1 && told.starts_with(char::is_numeric), "{told}");
    told
}

/// The file with one piece in place of another that is in it.
fn with(from: &str, to: &str) -> String {
    assert!(INVENTED.contains(from), "{from}");
    INVENTED.replacen(from, to, 1)
}

/// The file with other components in the channel of the elevator.
fn with_channel(parts: &str) -> String {
    let channel = |word: &str| INVENTED.find(word).unwrap();
    let (start, end) = (channel("<aerosurface_scale"), channel("</channel>"));
    format!("{}{parts}{}", &INVENTED[..start], &INVENTED[end..])
}

fn ends(name: &str, [min, max]: [f64; 2]) -> String {
    format!("<{name}><min>{min}</min><max>{max}</max></{name}>")
}

fn component(kind: &str, name: &str, input: &str, more: &str) -> String {
    format!("<{kind} name=\"{name}\"><input>{input}</input>{more}</{kind}>")
}

const RAD: &str = "<output>fcs/elevator-pos-rad</output>";
const DEG: &str = "<output>fcs/elevator-pos-deg</output>";
const RANGE: [f64; 2] = [-0.5, 0.4];

/// An elevator that goes from -0.5 to 0.4 rad, with more in it.
fn elevator(more: &str) -> String {
    let more = format!("{}{more}{RAD}", ends("range", RANGE));
    component("aerosurface_scale", "fcs/e", "fcs/elevator-cmd-norm", &more)
}

/// That elevator behind a component that makes what enters it.
fn behind(before: &str, input: &str, more: &str) -> String {
    format!("{before}{}", elevator(more).replace("fcs/elevator-cmd-norm", input))
}

fn assert_stops_rad(parts: &str, [min, max]: [f64; 2]) {
    let (found_min, found_max) = plain(&with_channel(parts)).stops.elevator;
    let (min, max) = (min.to_degrees(), max.to_degrees());
    assert!(
        (found_min - min).abs() < 1e-6 && (found_max - max).abs() < 1e-6,
        "{parts}: {found_min} {found_max}"
    );
}

#[test]
fn stops_of_a_surface_are_what_its_clip_leaves_of_its_range() {
    let clip = |ends_rad| ends("clipto", ends_rad);
    assert_stops_rad(&elevator(""), RANGE);
    assert_stops_rad(&elevator(&clip([-0.1, 0.1])), [-0.1, 0.1]);
    assert_stops_rad(&elevator(&clip([-0.1, 0.6])), [-0.1, 0.4]);
    assert_stops_rad(&elevator(&format!("<gain>-0.5</gain>{}", clip([-0.1, 0.6]))), [-0.1, 0.25]);
    // JSBSim leaves out a clip that has one end, or whose ends are not in order.
    assert_stops_rad(&elevator(&clip([0.1, -0.1])), RANGE);
    assert_stops_rad(&elevator("<clipto><max>0.1</max></clipto>"), RANGE);
}

#[test]
fn stops_of_a_surface_follow_its_domain_and_the_clip_of_what_enters_it() {
    let domain = |ends_nd| ends("domain", ends_nd);
    assert_stops_rad(&elevator(&domain([-2.0, 2.0])), [-0.25, 0.2]);
    assert_stops_rad(&elevator(&domain([-2.0, 0.5])), [-0.25, 0.8]);
    assert_stops_rad(
        &elevator(&(domain([-2.0, 1.0]) + "<zero_centered>0</zero_centered>")),
        [-0.2, 0.4],
    );
    let sum = |ends_nd| {
        component("summer", "Pitch Sum", "fcs/elevator-cmd-norm", &ends("clipto", ends_nd))
    };
    assert_stops_rad(&behind(&sum([-1.0, 1.0]), "fcs/pitch-sum", ""), RANGE);
    assert_stops_rad(&behind(&sum([-0.5, 0.25]), "fcs/pitch-sum", ""), [-0.25, 0.1]);
    assert_stops_rad(&behind(&sum([-0.5, 0.25]), "-fcs/pitch-sum", ""), [-0.125, 0.2]);
    assert_stops_rad(&behind(&sum([-1.1, 1.1]), "fcs/pitch-sum", &domain([-1.1, 1.1])), RANGE);
    let gain = component("pure_gain", "Pitch Sum", "fcs/elevator-cmd-norm", "<gain>-0.5</gain>");
    assert_stops_rad(&behind(&gain, "fcs/pitch-sum", ""), [-0.25, 0.2]);
}

/// As of the X-15 that comes with JSBSim.
#[test]
fn a_surface_that_lags_behind_a_clip_has_its_ends() {
    let sum = component("summer", "Positioning", "fcs/gain", &ends("clipto", [-0.26, 0.61]));
    let lag = |more: &str| {
        component("lag_filter", "Filter", "fcs/positioning", &format!("<c1>600</c1>{more}{RAD}"))
    };
    assert_stops_rad(&format!("{sum}{}", lag("")), [-0.26, 0.61]);
    assert_stops_rad(&format!("{sum}{}", lag(&ends("clipto", [-0.1, 1.0]))), [-0.1, 0.61]);
}

#[test]
fn a_surface_whose_ends_nobody_can_tell_is_refused_with_its_line() {
    let second = component(
        "aerosurface_scale",
        "fcs/e2",
        "fcs/elevator-cmd-norm",
        &(ends("range", [-0.1, 0.1]) + RAD),
    );
    let in_degrees = second.replace(RAD, DEG);
    let domain = ends("domain", [-2.0, 2.0]);
    let wrong: [(String, &str); 7] = [
        (elevator("") + &second, "a second component of the flight control system makes it"),
        (elevator("") + &in_degrees, "a second component of the flight control system makes it"),
        (elevator(DEG), "or makes it in other units"),
        (
            elevator(&domain).replace("fcs/elevator-cmd-norm", "fcs/x"),
            "the <domain> of its <aerosurface_scale> is -2 to 2",
        ),
        (elevator(&ends("domain", [0.0, 2.0])), "no numbers that can be used"),
        (elevator(&ends("clipto", [0.6, 0.7])), "it stays at 34.3774"),
        (
            elevator("<clipto><min>fcs/lower</min><max>0.1</max></clipto>"),
            "the ends of its <clipto> are no numbers",
        ),
    ];
    for (parts, words) in wrong {
        let told = refused(&with_channel(&parts));
        assert!(told.contains("`fcs/elevator-pos-rad`") && told.contains(words), "{words}: {told}");
    }
}

#[test]
fn components_that_feed_each_other_come_to_an_end() {
    let one = component("lag_filter", "One", "fcs/two", "");
    let two = component("lag_filter", "Two", "fcs/one", "");
    let parts = behind(&(one + &two), "fcs/one", "");
    assert_stops_rad(&parts, RANGE);
}

#[test]
fn a_second_axis_of_one_name_is_refused_with_its_line() {
    let told = refused(&with("</aerodynamics>", "<axis name=\"pitch\"/></aerodynamics>"));
    assert!(told.contains("`PITCH`: a second axis of this name"), "{told}");
}

#[test]
fn a_place_that_is_written_twice_is_refused_with_its_line() {
    for (part, name) in [("metrics", "AERORP"), ("mass_balance", "CG")] {
        let place = format!("<location name=\"{name}\" unit=\"IN\"><x>20</x></location></{part}>");
        let told = refused(&with(&format!("</{part}>"), &place));
        assert!(told.contains(&format!("`{name}`: a second place of this name")), "{told}");
    }
}

#[test]
fn fuel_and_masses_that_jsbsim_has_elsewhere_or_not_at_all_are_refused() {
    let tank = |part: &str| with("<capacity", &format!("{part}<capacity"));
    let weight = "<weight unit=\"LBS\"> 180 </weight>";
    let place = "<location unit=\"IN\"> <x> 36 </x> <y> -14 </y> <z> 24 </z> </location>";
    let wrong = [
        (
            tank("<drain_location unit=\"IN\"><x>90</x></drain_location>"),
            "<drain_location> inside of <tank>",
        ),
        (tank("<grain_config type=\"CYLINDRICAL\"/>"), "<grain_config> inside of <tank>"),
        (tank("<inertia_factor>2</inertia_factor>"), "<inertia_factor> inside of <tank>"),
        (
            with("> 90 <", "> 131 <"),
            "its contents of 131.00 lb are more than its capacity of 130.00 lb",
        ),
        (with("<capacity unit=\"LBS\"> 130 </capacity>", ""), "more than its capacity of 0.00 lb"),
        (with(place, ""), "`pointmass`: no <location>"),
        (with(weight, ""), "`pointmass`: no <weight>"),
    ];
    for (text, words) in wrong {
        let told = refused(&text);
        assert!(told.contains(words), "{words}: {told}");
    }
    // A full tank, and one that is full in other units.
    assert!(read(&with("> 90 <", "> 130 <"), &Assumptions::default()).is_ok());
    let full = with("<capacity unit=\"LBS\"> 130 <", "<capacity unit=\"KG\"> 40.823313 <");
    assert!(read(&full, &Assumptions::default()).is_ok());
}

fn moment_n_m(text: &str, held: &[(&str, f64)], [alpha_rad, beta_rad]: [f64; 2]) -> [f64; 3] {
    let held = held.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let (_, forces) = read(text, &Assumptions { held, thrust_lbf: None }).unwrap().flies().unwrap();
    let speed_m_s = 60.0;
    let ahead = Vector3::new(
        alpha_rad.cos() * beta_rad.cos(),
        beta_rad.sin(),
        alpha_rad.sin() * beta_rad.cos(),
    );
    let air = Air::with_density(1.0, 340.0);
    let flow = Flow::new(speed_m_s * ahead, Vector3::default(), 1000.0, air);
    forces.loads(&flow, &Controls::default()).moment_n_m.to_array()
}

#[test]
fn an_angle_that_is_held_is_held_in_tables_too() {
    let text = with("<property>aero/beta-deg</property>", "<value>0</value>");
    // Both angles by the table alone.
    let by_sideslip = "<property>aero/qbar-psf</property> <property>aero/beta-rad</property>";
    assert!(text.contains(by_sideslip));
    let text = text.replacen(by_sideslip, "<property>aero/qbar-psf</property>", 1);
    let function = |word: &str| text.find(word).unwrap();
    let start = function("<function name=\"aero/coefficient/Cn-in-space\">");
    let end = start + text[start..].find("</function>").unwrap() + "</function>".len();
    let without = format!("{}{}", &text[..start], &text[end..]);
    // What the table of both angles in degrees adds to the yaw.
    let table = |held: &[(&str, f64)], angles| {
        moment_n_m(&text, held, angles)[2] - moment_n_m(&without, &[], angles)[2]
    };
    let (alpha, beta) = (("aero/alpha-deg", 20.0), ("aero/beta-deg", 10.0));
    let at = |alpha_deg: f64, beta_deg: f64| [alpha_deg.to_radians(), beta_deg.to_radians()];
    let same = |one: f64, other: f64| (one - other).abs() < 1e-6 * other.abs();
    for angles in [at(0.0, 0.0), at(5.0, -3.0), at(10.0, 7.0)] {
        let [own_alpha, own_beta] = angles;
        let [held_alpha, held_beta] = at(20.0, 10.0);
        assert!(same(table(&[alpha, beta], angles), table(&[], [held_alpha, held_beta])));
        assert!(same(table(&[alpha], angles), table(&[], [held_alpha, own_beta])));
        assert!(same(table(&[beta], angles), table(&[], [own_alpha, held_beta])));
        assert!(!same(table(&[], angles), table(&[], [held_alpha, held_beta])));
    }
}

#[test]
fn a_function_may_have_the_name_of_a_coefficient_or_of_a_sum() {
    let loads = |text: &str| moment_n_m(text, &[], [0.1, 0.05]);
    let expected = loads(INVENTED);
    for (from, to) in [
        ("aero/coefficient/Cm\"", "Cm\""),
        ("aero/coefficient/Cl\"", "Cl\""),
        ("aero/coefficient/CLq-and-de\"", "axis/LIFT\""),
        ("aero/coefficient/CYb\"", "CX\""),
    ] {
        let text = with(from, to);
        assert_eq!(loads(&text).map(f64::to_bits), expected.map(f64::to_bits), "{to}");
        let aircraft = plain(&text);
        let written = data::write(&aircraft.aerodynamics);
        assert_eq!(data::read(&written).unwrap().document, aircraft.aerodynamics);
    }
    let both = with("aero/coefficient/Cm\"", "Cm\"").replace("aero/coefficient/Cn\"", "Cm_\"");
    assert_eq!(loads(&both).map(f64::to_bits), expected.map(f64::to_bits));
    let told = refused(&with("aero/coefficient/CD0\"", "axis/LIFT-at-rest\""));
    assert!(told.contains("this name cannot be that of a function"), "{told}");
}
