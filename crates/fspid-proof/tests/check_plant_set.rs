//! All plants of a box lie between the sampled plants that stand for it, and nothing else passes for such a set.

use fspid_numeric::scalar::Interval;
use fspid_proof::check::{
    ActuatorLag, ContinuousPlant, LagOf, NotProved, PlantSet, PrintedPlant, Sloped,
};
use fspid_sim::ElevatorSign;
use fspid_sim::loop_model::SampledPlant;

const DT_S: f64 = 0.05;
/// Middles of effect, damping and stiffness.
const MIDDLES: [f64; 3] = [1.5, 0.75, 4.0];

/// $e / (s^2 + d s + k)$.
fn plant(at: &[Sloped], lag: LagOf<Sloped>) -> ContinuousPlant<Sloped> {
    let [effect, damping, stiffness] = *at else { panic!("three numbers") };
    let one = Sloped::fixed(Interval::ONE);
    let denominator = [one, damping, stiffness];
    ContinuousPlant::of_transfer_function(
        &[effect],
        &denominator,
        ElevatorSign::NoseUpPositive,
        lag,
    )
}

fn ends(reach: [f64; 3]) -> Vec<Interval> {
    let around = MIDDLES.into_iter().zip(reach);
    around.map(|(middle, reach)| Interval::between(middle - reach, middle + reach)).collect()
}

fn without_lag(reach: [f64; 3]) -> PlantSet {
    let make = |at: &[Sloped]| -> Result<_, NotProved> { Ok(plant(at, LagOf::None)) };
    PlantSet::of(&ends(reach), &make).expect("a plant")
}

fn lagging(reach: [f64; 3]) -> PlantSet {
    let lag = || LagOf::First(Sloped::fixed(Interval::point(8.0)));
    let make = move |at: &[Sloped]| -> Result<_, NotProved> { Ok(plant(at, lag())) };
    PlantSet::of(&ends(reach), &make).expect("a plant")
}

/// One plant of the box, sampled by itself.
fn one(numbers: [f64; 3], lag: ActuatorLag) -> SampledPlant<Interval> {
    let [effect, damping, stiffness] = numbers;
    let denominator = &[1.0, damping, stiffness];
    let elevator_sign = ElevatorSign::NoseUpPositive;
    let plant = PrintedPlant { numerator: &[effect], denominator, elevator_sign, lag, dt_s: DT_S };
    plant.sampled().expect("a plant")
}

/// Where each number lies, from −1 to 1.
const PLACES: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, -1.0],
    [0.3, -0.7, 1.0],
    [1.0, -1.0, -0.2],
    [-0.5, -1.0, 0.9],
];

#[test]
fn every_plant_of_a_box_lies_between_its_corners_and_corners_lie_near_their_plants() {
    let reach = [0.15, 0.04, 0.4];
    let first = ActuatorLag::First { time_constant_s: 0.125 };
    for (set, lag) in [(without_lag(reach), ActuatorLag::None), (lagging(reach), first)] {
        let corners = set.sampled(DT_S).expect("small");
        assert_eq!(corners.len(), 8);
        for place in PLACES {
            let numbers = [0, 1, 2].map(|at| MIDDLES[at] + place[at] * reach[at]);
            let own = one(numbers, lag);
            // As much of each corner as lies on its side.
            let share = |corner: usize| -> f64 {
                let along = place.iter().enumerate();
                let sides =
                    along.map(
                        |(at, place)| if corner >> at & 1 == 1 { 1.0 + place } else { 1.0 - place },
                    );
                sides.map(|side| 0.5 * side).product()
            };
            for (entry, own) in own.rows.iter().enumerate() {
                let mixed = corners.iter().enumerate().fold(Interval::ZERO, |sum, (corner, it)| {
                    sum + Interval::point(share(corner)) * it.rows[entry]
                });
                // Rounding of the shares, and decimals that a printed number stands for.
                let near = 1e-13;
                assert!(
                    mixed.lower() <= own.lower() + near && mixed.upper() >= own.upper() - near,
                    "{entry} {mixed:?} {own:?}"
                );
            }
            for corner in &corners {
                assert_eq!(corner.states, own.states);
                assert!(
                    corner.rate.iter().zip(&own.rate).all(|(corner, own)| corner.encloses(*own))
                );
            }
        }
        for (corner, sampled) in corners.iter().enumerate() {
            let side = |at: usize| if corner >> at & 1 == 1 { reach[at] } else { -reach[at] };
            let own = one([0, 1, 2].map(|at| MIDDLES[at] + side(at)), lag);
            for (entry, own) in sampled.rows.iter().zip(&own.rows) {
                // Of second order: shares of a tenth in what a sample of 50 ms adds.
                assert!(
                    (entry.midpoint() - own.midpoint()).abs() < 5e-5,
                    "{corner} {entry:?} {own:?}"
                );
                assert!(entry.radius() < 2e-4, "{corner} {entry:?}");
            }
        }
    }
}

#[test]
fn numbers_without_width_make_no_corners() {
    let only = without_lag([0.1, 0.0, 0.0]).sampled(DT_S).expect("small");
    assert_eq!(only.len(), 2);
    let point = without_lag([0.0; 3]).sampled(DT_S).expect("small");
    assert_eq!(point.len(), 1);
    // Without a lag the deflection is the command, whatever the plant is.
    for plant in only.iter().chain(&point) {
        let last = &plant.rows[plant.rows.len() - plant.states - 1..];
        assert_eq!(last, [0.0, 0.0, 0.0, 1.0].map(Interval::point));
    }
    for dt_s in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let found = without_lag([0.1; 3]).sampled(dt_s);
        assert!(matches!(found, Err(NotProved::Number { .. })), "{dt_s}");
    }
}

fn shorter<T>(list: &mut Vec<T>) {
    list.truncate(list.len() - 1);
}

#[test]
fn a_set_fits_where_all_its_parts_do() {
    let good = lagging([0.1; 3]);
    assert!(good.fits(3) && !good.fits(2) && !good.fits(4));
    let with = |change: &dyn Fn(&mut PlantSet)| {
        let mut set = good.clone();
        change(&mut set);
        set
    };
    let broken: [&dyn Fn(&mut PlantSet); 11] = [
        &|set| shorter(&mut set.middle),
        &|set| shorter(&mut set.middle[1]),
        &|set| shorter(&mut set.all),
        &|set| shorter(&mut set.all[0]),
        &|set| shorter(&mut set.slopes),
        &|set| shorter(&mut set.slopes[2]),
        &|set| shorter(&mut set.slopes[2][1]),
        &|set| shorter(&mut set.reach),
        &|set| set.reach[1] = f64::NAN,
        &|set| set.reach[1] = f64::INFINITY,
        &|set| set.reach[1] = -0.1,
    ];
    for (number, change) in broken.into_iter().enumerate() {
        assert!(!with(change).fits(3), "{number}");
    }
    assert!(!with(&|set| shorter(&mut set.pitch_rate)).fits(3));
    assert!(with(&|set| set.reach[1] = 0.0).fits(3));
    // Of one state nothing is left once the command is one.
    let single = |rows: &mut Vec<Vec<Interval>>| *rows = vec![vec![Interval::ONE; 2]];
    let small = with(&|set| {
        single(&mut set.middle);
        single(&mut set.all);
        set.slopes.iter_mut().for_each(single);
        set.pitch_rate.truncate(1);
    });
    assert!(!small.fits(3));
}

#[test]
fn a_set_encloses_narrower_boxes_and_nothing_that_differs_in_one_part() {
    let good = lagging([0.125, 0.0625, 0.25]);
    assert!(good.encloses(&good));
    // Their middles are the same to the bit.
    assert!(good.encloses(&lagging([0.0625, 0.03125, 0.125])));
    assert!(!lagging([0.0625, 0.03125, 0.125]).encloses(&good));
    assert!(!good.encloses(&without_lag([0.125, 0.0625, 0.25])));
    let two = Interval::point(2e3);
    let changes: [&dyn Fn(&mut PlantSet); 12] = [
        &|set| set.middle[2][1] = two,
        &|set| shorter(&mut set.middle),
        &|set| shorter(&mut set.middle[2]),
        &|set| set.all[0][2] = two,
        &|set| shorter(&mut set.all),
        &|set| set.slopes[1][0][1] = two,
        &|set| shorter(&mut set.slopes),
        &|set| shorter(&mut set.slopes[0][0]),
        &|set| set.reach[2] = 0.26,
        &|set| set.pitch_rate[0] = two,
        &|set| shorter(&mut set.pitch_rate),
        &|set| set.without_lag = true,
    ];
    for (number, change) in changes.into_iter().enumerate() {
        let mut other = good.clone();
        change(&mut other);
        assert!(!good.encloses(&other), "{number}");
    }
}
