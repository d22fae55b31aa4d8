use super::*;

fn plant() -> ExternalPlant {
    let jsbsim = Jsbsim {
        aircraft: "glider".to_owned(),
        folder: None,
        version: "1.3.3".to_owned(),
        speed: JsbsimSpeed::True(50.0),
        altitude_m: 1000.0,
        climb_rad: 0.0,
        heading_rad: 0.0,
        gear_is_down: false,
        levels_wings: true,
        seed: 0,
        properties: Vec::new(),
    };
    ExternalPlant { simulator: Simulator::Jsbsim(jsbsim), answer_limit_s: 1.0 }
}

#[test]
fn without_a_host_an_external_plant_is_refused_and_says_why() {
    let beginning = Beginning { step_s: 0.01, steps: 1, wind_m_s: None, moves_throttle: false };
    let refused = plant().start(&beginning).expect_err("nobody starts it").to_string();
    assert!(refused.contains("starts no other simulators; allowed"), "{refused}");
}

#[test]
fn a_sample_with_a_number_that_is_not_finite_is_none() {
    let mut numbers = [1.0; PLANT_SAMPLE_NUMBERS];
    assert!(PlantSample::of(&numbers).is_some_and(|sample| sample.is_on_ground));
    for place in 0..PLANT_SAMPLE_NUMBERS {
        numbers[place] = f64::NAN;
        assert_eq!(PlantSample::of(&numbers), None);
        numbers[place] = 1.0;
    }
}
