//! An invented aircraft in JSBSim's format: its loads are those of JSBSim 1.3.3 at random states, which
//! `checks/jsbsim/tables.py` wrote; what is wrong is told, all of it at once.
#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test")]
#![allow(clippy::disallowed_methods, reason = "references may come from the platform's functions")]

use fspid_aircraft::{Air, Controls, Flow, ForceModel, Loads, Vector3};
use fspid_daveml::data;
use fspid_daveml::flight::{Body, Setting, TableForces};
use fspid_daveml::jsbsim::{Assumptions, JsbsimAircraft, is_aircraft, read};
use proptest::prelude::*;

const INVENTED: &str = include_str!("data/jsbsim/invented.xml");
const FLOWN: &str = include_str!("data/jsbsim/invented.csv");
const FOOT_M: f64 = 0.3048;
const POUND_N: f64 = 4.448_221_615_260_5;
const SLUG_KG: f64 = POUND_N / FOOT_M;
const RATE_OF_LIFT: &str = "aero/coefficient/CLadot";

fn plain(text: &str) -> JsbsimAircraft {
    read(text, &Assumptions::default()).unwrap()
}

fn refused(text: &str) -> String {
    read(text, &Assumptions::default()).unwrap_err().to_string()
}

/// The file with one piece in place of another that is in it.
fn with(from: &str, to: &str) -> String {
    assert!(INVENTED.contains(from), "{from}");
    INVENTED.replacen(from, to, 1)
}

/// The file without the lift by the rate of the angle of attack, whose square JSBSim takes too.
fn without_rate_of_lift() -> String {
    let at = INVENTED.find(&format!("<function name=\"{RATE_OF_LIFT}\">")).unwrap();
    let end = at + INVENTED[at..].find("</function>").unwrap() + "</function>".len();
    format!("{}{}", &INVENTED[..at], &INVENTED[end..])
}

fn forces(aircraft: &JsbsimAircraft) -> TableForces {
    aircraft.flies().unwrap().1
}

fn flow(v_ft_s: f64, [alpha, beta]: [f64; 2], rates: [f64; 3], air: Air) -> Flow {
    let ahead = Vector3::new(alpha.cos() * beta.cos(), beta.sin(), alpha.sin() * beta.cos());
    let [p, q, r] = rates;
    Flow::new(v_ft_s * FOOT_M * ahead, Vector3::new(p, q, r), 1000.0, air)
}

fn air(density_slug_ft3: f64, speed_of_sound_ft_s: f64) -> Air {
    Air::with_density(density_slug_ft3 * SLUG_KG / FOOT_M.powi(3), speed_of_sound_ft_s * FOOT_M)
}

/// Loads about the aerodynamic reference point in lbf and ft lbf.
fn answered(aircraft: &JsbsimAircraft, state: &[f64]) -> [f64; 6] {
    let (body, forces) = aircraft.flies().unwrap();
    let flow = flow(
        state[0],
        [state[1], state[2]],
        [state[3], state[4], state[5]],
        air(state[8], state[0] / state[6]),
    );
    let controls = Controls {
        elevator_rad: state[9],
        aileron_rad: state[10],
        rudder_rad: state[11],
        ..Controls::default()
    };
    let moving = forces.loads_per_alpha_rate(&flow).scaled(state[12]);
    let Loads { force_n, moment_n_m } = forces.loads(&flow, &controls).plus(moving);
    let moment_n_m = moment_n_m + body.centre_of_mass_m.cross(force_n);
    let [x, y, z] = force_n.to_array().map(|value| value / POUND_N);
    let [l, m, n] = moment_n_m.to_array().map(|value| value / (POUND_N * FOOT_M));
    [x, y, z, l, m, n]
}

#[test]
fn loads_are_those_of_jsbsim_at_random_states() {
    let aircraft = plain(&without_rate_of_lift());
    let rows = FLOWN
        .lines()
        .skip(2)
        .map(|line| line.split(',').map(|word| word.parse().unwrap()).collect::<Vec<f64>>());
    let rows: Vec<_> = rows.collect();
    assert_eq!(rows.len(), 40);
    for row in rows {
        let (state, expected) = row.split_at(13);
        for (found, expected) in answered(&aircraft, state).into_iter().zip(expected) {
            let off = (found - expected).abs();
            assert!(off < 1e-9 * (1.0 + expected.abs()), "{found} is not {expected} at {state:?}");
        }
    }
}

#[test]
fn lift_by_the_rate_of_the_angle_of_attack_is_that_of_its_closed_form() {
    let flow = flow(200.0, [0.1, 0.0], [0.0; 3], air(0.002, 1100.0));
    let [with_lift, without] = [INVENTED.to_owned(), without_rate_of_lift()]
        .map(|text| forces(&plain(&text)).loads_per_alpha_rate(&flow).force_n);
    // 1.7 · c/2V · q̄S along the lift, for each rad/s; the drag's square of lift leaves it out.
    let lift_n = 1.7 * 5.0 / 400.0 * (0.5 * 0.002 * 200.0 * 200.0 * 160.0) * POUND_N;
    let expected = lift_n * Vector3::new(0.1_f64.sin(), 0.0, -(0.1_f64.cos()));
    let off = with_lift + -1.0 * without + -1.0 * expected;
    assert!(off.to_array().iter().all(|part| part.abs() < 1e-9 * lift_n), "{off:?}");
}

#[test]
fn a_body_is_the_sum_of_its_points_about_their_centre() {
    let (Body { mass, centre_of_mass_m }, _) = plain(INVENTED).flies().unwrap();
    let other_lb = 70.0 / 0.453_592_37;
    let pounds = 1500.0 + 180.0 + other_lb + 180.0;
    assert!((mass.mass_kg - pounds * 0.453_592_37).abs() < 1e-9);
    let points = [(1500.0, 41.0, 36.5), (180.0 + other_lb, 36.0, 24.0), (180.0, 56.0, 59.4)];
    let mean = |of: fn(&(f64, f64, f64)) -> f64| {
        points.iter().map(|point| point.0 * of(point)).sum::<f64>() / pounds
    };
    let (aft_in, up_in) = (mean(|point| point.1), mean(|point| point.2));
    assert!((centre_of_mass_m.x - (43.0 - aft_in) * 0.0254).abs() < 1e-12);
    assert!((centre_of_mass_m.z - (59.0 - up_in) * 0.0254).abs() < 1e-12);
    // ixz of the file is the element of the matrix: the negative of the product.
    let zx = |point: &(f64, f64, f64)| point.0 * (point.1 - aft_in) * (point.2 - up_in);
    let points_kg_m2 = points.iter().map(zx).sum::<f64>() * 0.453_592_37 * 0.0254 * 0.0254;
    let own_kg_m2 = -40.0 * SLUG_KG * FOOT_M * FOOT_M;
    assert!((mass.ixz_kg_m2 - own_kg_m2 - points_kg_m2).abs() < 1e-6, "{}", mass.ixz_kg_m2);
}

#[test]
fn products_of_inertia_turn_their_sign_where_the_file_says_so() {
    let turned = with("<mass_balance>", "<mass_balance negated_crossproduct_inertia=\"false\">");
    let [usual, turned] =
        [INVENTED, &turned].map(|text| plain(text).flies().unwrap().0.mass.ixz_kg_m2);
    assert!((turned - usual - 80.0 * SLUG_KG * FOOT_M * FOOT_M).abs() < 1e-6);
}

#[test]
fn what_is_written_reads_back_as_the_same_aircraft() {
    let assumptions = Assumptions { thrust_lbf: Some(500.0), ..Assumptions::default() };
    let aircraft = read(INVENTED, &assumptions).unwrap();
    let propulsion = aircraft.propulsion.clone().unwrap();
    for document in [&aircraft.aerodynamics, &aircraft.inertia, &propulsion] {
        assert_eq!(data::read(&data::write(document)).unwrap().document, *document);
    }
}

/// The line of thrust goes through the centre of mass: no moment at any throttle.
#[test]
fn the_engine_that_was_asked_for_pulls_through_the_centre_of_mass() {
    let assumptions = Assumptions { thrust_lbf: Some(500.0), ..Assumptions::default() };
    let forces = forces(&read(INVENTED, &assumptions).unwrap());
    let flow = flow(200.0, [0.05, 0.0], [0.0; 3], air(0.002, 1100.0));
    let at = |throttle: f64| forces.loads(&flow, &Controls { throttle, ..Controls::default() });
    let added = at(0.5).plus(at(0.0).scaled(-1.0));
    assert!((added.force_n.x / POUND_N - 250.0).abs() < 1e-9);
    assert!(added.moment_n_m.to_array().iter().all(|moment| moment.abs() < 1e-9));
    assert!(forces.has_engine() && !self::forces(&plain(INVENTED)).has_engine());
}

#[test]
fn a_property_is_held_where_it_is_asked_for_and_nowhere_else() {
    let held = |name: &str, value: f64| Assumptions {
        held: vec![(name.to_owned(), value)],
        thrust_lbf: None,
    };
    let flow = flow(200.0, [0.05, 0.0], [0.0; 3], air(0.002, 1100.0));
    let lift = |assumptions: &Assumptions| {
        let forces = forces(&read(INVENTED, assumptions).unwrap());
        -forces.loads(&flow, &Controls::default()).force_n.z
    };
    let (far, near) = (lift(&Assumptions::default()), lift(&held("aero/h_b-mac-ft", 0.0)));
    assert!(near > 1.15 * far && near < 1.25 * far, "{near} {far}");
    let told = |assumptions: &Assumptions| read(INVENTED, assumptions).unwrap_err().to_string();
    assert!(told(&held("fcs/flap-pos-deg", 10.0)).contains("no function of the aerodynamics asks"));
    assert!(told(&held("aero/alpha-rad", 0.0)).contains("this is flown, and cannot be held"));
    let unknown = with("fcs/mag-elevator-pos-rad", "fcs/lef-pos-rad");
    assert!(refused(&unknown).contains("`fcs/lef-pos-rad`: a flight here has no such property"));
    assert!(read(&unknown, &held("fcs/lef-pos-rad", 0.1)).is_ok());
}

/// The height over the ground is held beyond its table, and no flight moves it.
#[test]
fn what_is_held_beyond_its_table_ends_no_flight() {
    let forces = forces(&plain(INVENTED));
    let flow = flow(200.0, [0.05, 0.0], [0.0; 3], air(0.002, 1100.0));
    assert_eq!(forces.departure(&flow, &Controls::default()), None);
    let watched = format!("{:?}", forces.table_inputs());
    assert!(!watched.contains("h_b-mac-ft"), "{watched}");
}

#[test]
fn a_position_that_the_file_scales_is_made_of_the_angle_of_its_surface() {
    let scale = "<aerosurface_scale><input>fcs/elevator-pos-rad</input><domain><min>-0.5</min><max>0.4</max></domain>\
                 <range><min>-1</min><max>1</max></range><output>fcs/elevator-pos-norm</output></aerosurface_scale></channel>";
    let text = with("</channel>", scale).replace(
        "<property>fcs/mag-elevator-pos-rad</property>",
        "<abs><property>fcs/elevator-pos-norm</property></abs>",
    );
    let flow = flow(200.0, [0.0, 0.0], [0.0; 3], air(0.002, 1100.0));
    let drag = |text: &str, elevator_rad: f64| {
        let controls = Controls { elevator_rad, ..Controls::default() };
        forces(&plain(text)).loads(&flow, &controls).force_n.x
    };
    let scale_n = 0.06 * 0.5 * 0.002 * 200.0 * 200.0 * 160.0 * POUND_N;
    for (angle, norm) in [(0.2, 0.5), (-0.2, 0.4)] {
        let apart = drag(INVENTED, angle) - drag(&text, angle);
        assert!((apart - scale_n * (norm - 0.2)).abs() < 1e-6, "{angle}: {apart}");
    }
}

/// The aircraft whose drag goes with a position that the file scales to, as `fcs/elevator-pos-norm`.
fn with_scale(parts: &str) -> String {
    with("</channel>", &format!("{parts}</channel>")).replace(
        "<property>fcs/mag-elevator-pos-rad</property>",
        "<property>fcs/elevator-pos-norm</property>",
    )
}

fn scale(ends: [f64; 4], more: &str) -> String {
    let [down, up, min, max] = ends;
    format!(
        "<aerosurface_scale name=\"norm\"><input>fcs/elevator-pos-rad</input>\
         <domain><min>{down}</min><max>{up}</max></domain><range><min>{min}</min><max>{max}</max></range>{more}\
         <output>fcs/elevator-pos-norm</output></aerosurface_scale>"
    )
}

#[test]
fn a_scale_whose_ends_are_turned_round_turns_the_sign_of_its_surface() {
    let flow = flow(200.0, [0.0, 0.0], [0.0; 3], air(0.002, 1100.0));
    let drag = |text: &str, elevator_rad: f64| {
        let controls = Controls { elevator_rad, ..Controls::default() };
        forces(&plain(text)).loads(&flow, &controls).force_n.x
    };
    let scale_n = 0.06 * 0.5 * 0.002 * 200.0 * 200.0 * 160.0 * POUND_N;
    let cases = [
        ([-0.5, 0.4, -1.0, 1.0], [0.5, -0.4]),
        ([-0.5, 0.4, 1.0, -1.0], [-0.5, 0.4]),
        ([0.5, -0.4, -1.0, 1.0], [-0.5, 0.4]),
        ([-0.5, 0.4, -200.0, 200.0], [100.0, -80.0]),
    ];
    for (ends, positions) in cases {
        let text = with_scale(&scale(ends, "<zero_centered>true</zero_centered>"));
        for (elevator_rad, position) in [0.2, -0.2].into_iter().zip(positions) {
            let apart = drag(INVENTED, elevator_rad) - drag(&text, elevator_rad);
            assert!(
                (apart / scale_n + 0.2 - position).abs() < 1e-6,
                "{ends:?} {elevator_rad}: {apart}"
            );
        }
    }
}

#[test]
fn a_scale_that_does_more_than_is_known_is_refused_by_name() {
    let usual = [-0.5, 0.4, -1.0, 1.0];
    let clip = "<clipto><min>-0.5</min><max>0.5</max></clipto>";
    let gain =
        "<pure_gain name=\"Elevator Pos Norm\"><input>fcs/elevator-cmd-norm</input></pure_gain>";
    let twice = scale(usual, "") + &scale([-0.5, 0.4, -2.0, 2.0], "");
    let centred = |word: &str| scale(usual, &format!("<zero_centered>{word}</zero_centered>"));
    let wrong: [(String, &str); 7] = [
        (scale(usual, clip), "has <clipto>"),
        (scale(usual, "<gain>2</gain>"), "has <gain>"),
        (twice, "2 components of the flight control system make it"),
        (scale(usual, "") + gain, "2 components of the flight control system make it"),
        (centred("0"), "<zero_centered> of its <aerosurface_scale> is 0"),
        (centred("false"), "<zero_centered> of its <aerosurface_scale> is false"),
        (scale([0.0, 0.4, -1.0, 1.0], ""), "no numbers that can be used"),
    ];
    for (parts, words) in wrong {
        let told = refused(&with_scale(&parts));
        assert!(
            told.contains("`fcs/elevator-pos-norm`") && told.contains(words),
            "{words}: {told}"
        );
    }
    let held = Assumptions {
        held: vec![("fcs/elevator-pos-norm".to_owned(), 0.1)],
        ..Assumptions::default()
    };
    assert!(read(&with_scale(&scale(usual, clip)), &held).is_ok());
}

#[test]
fn a_difference_of_one_operand_is_that_operand() {
    let flow = flow(200.0, [0.05, 0.0], [0.0; 3], air(0.002, 1100.0));
    let drag = |text: &str| forces(&plain(text)).loads(&flow, &Controls::default()).force_n.x;
    let text = with("<v>0.03</v>", "<difference><v>0.03</v></difference>");
    assert!((drag(&text) - drag(INVENTED)).abs() < 1e-9);
}

#[test]
fn everything_outside_of_the_subset_is_told_at_once_with_its_line() {
    let text = with("fcs/mag-elevator-pos-rad", "propulsion/engine/thrust-lbs")
        .replace("<sin>", "<random>")
        .replace("</sin>", "</random>")
        .replacen("velocities/mach", "fcs/lef-pos-rad", 1);
    let told = refused(&text);
    for words in [
        "`propulsion/engine/thrust-lbs`: a flight here has no such property",
        "`random`: <random> inside of <function> is not supported",
        "`fcs/lef-pos-rad`: a flight here has no such property",
    ] {
        let line = told.lines().find(|line| line.contains(words));
        assert!(line.is_some_and(|line| line.starts_with(char::is_numeric)), "{words}: {told}");
    }
    assert_eq!(told.lines().count(), 3, "{told}");
}

#[test]
fn bad_files_are_told_what_is_wrong_with_them() {
    let wrong: [(String, &str); 22] = [
        ("<DAVEfunc/>".into(), "this is not an aircraft file of JSBSim"),
        ("<fdm_config>".into(), "not well-formed"),
        ("<fdm_config/>".into(), "no <aerodynamics>"),
        (with("<aerodynamics>", "<aerodynamics file=\"aero.xml\">"), "in a file of their own"),
        (with("0.7 0.001", "-0.7 0.001"), "do not rise"),
        (with("0.7 0.001", "nan 0.001"), "not a number that can be used"),
        (with("0.7 0.001", "1e300 0.001"), "not a number that can be used"),
        (with("0.7 0.001", "0.7"), "the number of numbers is 5"),
        (with("0.22  1.4     1.0", "0.22  1.4"), "the line of 0.22 has 1 values"),
        (with("20    5.0  3.5", "21    5.0  3.5"), "differ from those of the first <tableData>"),
        (with("breakPoint=\"0.5\"", "breakPoint=\"0.1\""), "do not rise"),
        (with("lookup=\"column\"", "lookup=\"depth\""), "no axis of a table"),
        (
            with("<axis name=\"YAW\">", "<axis name=\"YAW\" unit=\"N*M\">"),
            "this unit is not known here",
        ),
        (
            with("<axis name=\"SIDE\">", "<axis name=\"X\">"),
            "forces along the flow and along the body",
        ),
        (with("<axis name=\"SIDE\">", "<axis name=\"NORMAL\">"), "this axis is not supported"),
        (with("unit=\"FT2\"> 160", "unit=\"ACRE\"> 160"), "this unit is not known here"),
        (with("> 160 <", "> 0 <"), "<wingarea> is 0"),
        (with("> 1500 <", "> -1500 <"), "the weight of the empty aircraft"),
        (with("> 1350 <", "> -9350 <"), "moment"),
        (
            with("<p>aero/function/pressure_times_area</p>", "<p>metrics/Sw-sqft</p>"),
            "this load is not proportional to the dynamic pressure",
        ),
        (
            with("<property>aero/cl-squared</property>", "<property>aero/qbar-psf</property>"),
            "the dynamic pressure is a factor twice",
        ),
        (
            with("<p>aero/function/pressure_times_area</p>", "<p>aero/coefficient/CD0</p>"),
            "this function asks for itself",
        ),
    ];
    for (text, words) in wrong {
        let told = refused(&text);
        assert!(told.contains(words), "expected `{words}`: {told}");
    }
    let thrust = Assumptions { thrust_lbf: Some(-1.0), ..Assumptions::default() };
    assert!(read(INVENTED, &thrust).unwrap_err().to_string().contains("a thrust of -1 lbf"));
    assert!(is_aircraft(INVENTED) && !is_aircraft("<DAVEfunc/>"));
}

#[test]
fn a_lift_whose_square_depends_on_itself_is_a_circle() {
    let text =
        with("<property>aero/function/ground</property>", "<property>aero/cl-squared</property>");
    assert!(refused(&text).contains("variables that need each other"), "{}", refused(&text));
}

#[test]
fn thousands_of_functions_or_levels_come_to_an_end() {
    let many: String = (0..5000)
        .map(|index| {
            format!("<function name=\"f{index}\"><property>f{}</property></function>", index + 1)
        })
        .collect();
    let told = refused(&with("<axis name=\"DRAG\">", &format!("{many}<axis name=\"DRAG\">")));
    assert!(told.contains("functions; expected at most 1024"), "{told}");
    let deep = format!("{}<value>1</value>{}", "<abs>".repeat(1000), "</abs>".repeat(1000));
    assert!(refused(&with("<v>0.03</v>", &deep)).contains("nested too deeply"));
    let long: String = (0..900)
        .map(|index| {
            format!("<function name=\"f{index}\"><property>f{}</property></function>", index + 1)
        })
        .collect();
    let text = with(
        "<axis name=\"DRAG\">",
        &format!("{long}<function name=\"f900\"><value>1</value></function><axis name=\"DRAG\">"),
    );
    let text = text.replacen("<v>0.03</v>", "<v>0.03</v><p>f0</p>", 1);
    let _ = plain(&text);
}

#[test]
fn models_of_tables_without_the_rate_have_no_loads_by_it() {
    let text = without_rate_of_lift().replace("aero/alphadot-rad_sec", "aero/alpha-rad");
    let flow = flow(200.0, [0.05, 0.0], [0.0; 3], air(0.002, 1100.0));
    assert_eq!(forces(&plain(&text)).loads_per_alpha_rate(&flow), Loads::default());
}

#[test]
fn the_setting_of_a_flight_moves_loads_by_the_rate_to_the_centre_of_mass_too() {
    let aircraft = plain(INVENTED);
    let model = |document| fspid_daveml::Model::new(document).unwrap();
    let setting = |x: f64| Setting {
        centre_of_mass_m: Vector3::new(x, 0.0, 0.0),
        gearing: fspid_aircraft::Gearing::Proportional,
        travel: fspid_aircraft::Travel::UNLIMITED,
    };
    let flow = flow(200.0, [0.05, 0.0], [0.0; 3], air(0.002, 1100.0));
    let [here, ahead] = [0.0, 0.5].map(|x| {
        let forces = TableForces::new(model(&aircraft.aerodynamics), None, setting(x)).unwrap();
        forces.loads_per_alpha_rate(&flow)
    });
    let arm = ahead.moment_n_m.y - here.moment_n_m.y;
    assert!((arm - 0.5 * here.force_n.z).abs() < 1e-9 * here.force_n.z.abs() && arm.abs() > 1.0);
}

proptest! {
    #[test]
    fn garbage_never_panics(text in "\\PC{0,200}") {
        let _ = read(&format!("<fdm_config>{text}</fdm_config>"), &Assumptions::default());
    }

    #[test]
    fn an_aircraft_with_a_piece_cut_out_or_doubled_never_panics(start in 0_usize..13_000, length in 0_usize..400, twice: bool) {
        let mut text = INVENTED.to_owned();
        let end = (start + length).min(text.len());
        let start = start.min(end);
        prop_assume!(text.is_char_boundary(start) && text.is_char_boundary(end));
        let piece = if twice { text[start..end].repeat(2) } else { String::new() };
        text.replace_range(start..end, &piece);
        let _ = read(&text, &Assumptions::default());
    }
}
