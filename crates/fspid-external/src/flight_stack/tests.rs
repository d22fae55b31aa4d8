//! Flights with peers that speak the protocols from their documents, and what becomes of everything that goes wrong.
//!
//! The peers share no line with what they talk to: packets are written byte by byte here.

use std::cell::RefCell;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use fspid_sim::core::{Gains, Pid, PidConfig, State};
use fspid_sim::external::{Host, set_host};
use fspid_sim::flight_stack::{ElevatorChannel, Place, SetpointChannel};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Controller, EarlyEnd, ElevatorSign, EndCause, ExternalSource, LinearPlant, NamedExternal,
    Outcome, Scenario, Timing, Trace, fly_commanded, simulate,
};

use super::*;

mod ardupilot_peer;
mod px4_peer;

/// Time from sample to sample, s.
const DT_S: f64 = 0.01;
/// The step of the set-point, rad: a pulse of 1750 µs on a channel whose ends are twice that.
const STEP_RAD: f64 = 0.1;
/// Commands at the ends of the elevator's channel, rad.
const FULL_RAD: f64 = 0.35;

type Peer = Box<dyn FnOnce(SocketAddr) + Send>;

thread_local! {
    /// Who comes to the next flight of this thread, and what is told in it.
    static NEXT: RefCell<Option<Peer>> = const { RefCell::new(None) };
    static TOLD: RefCell<Arc<Mutex<Vec<String>>>> = RefCell::default();
    static PEERS: RefCell<Vec<JoinHandle<()>>> = const { RefCell::new(Vec::new()) };
}

/// Starts the peer of a test where its address is known.
struct WithPeers;

impl Host for WithPeers {
    fn start(&self, external: &External) -> Result<Box<dyn Answers>, SimError> {
        let told = TOLD.with(|told| Arc::clone(&told.borrow()));
        let peer = Mutex::new(NEXT.with(|next| next.borrow_mut().take()));
        let started = Arc::new(Mutex::new(None));
        let joined = Arc::clone(&started);
        let tell = move |words: String| {
            let address = words.strip_prefix("note: waiting for ").and_then(|rest| {
                rest.split_whitespace().nth(2)?.trim_end_matches(',').parse().ok()
            });
            if let (Some(address), Some(peer)) = (address, peer.lock().expect("free").take()) {
                let thread = std::thread::spawn(move || peer(address));
                *joined.lock().expect("free") = Some(thread);
            }
            told.lock().expect("free").push(words);
        };
        let stack = external.source.flight_stack().expect("a flight stack");
        let answers = start(external, stack, None, Arc::new(tell));
        PEERS.with(|peers| peers.borrow_mut().extend(started.lock().expect("free").take()));
        answers
    }
}

fn stack(protocol: Protocol) -> FlightStack {
    FlightStack {
        protocol,
        address: "127.0.0.1:0".parse().expect("an address"),
        connect_limit_s: 30.0,
        lead_in_s: 0.0,
        elevator: ElevatorChannel {
            number: 1,
            command_rad: [-FULL_RAD, FULL_RAD],
            is_reversed: false,
        },
        throttle: None,
        setpoint: Some(SetpointChannel {
            number: 1,
            setpoint_rad: [-2.0 * STEP_RAD, 2.0 * STEP_RAD],
        }),
        place: Place { latitude_rad: 0.8, longitude_rad: 0.1, declination_rad: 0.0 },
        level: Some(LevelFlight { airspeed_m_s: 50.0, altitude_m: 300.0 }),
    }
}

const ARDUPILOT: Protocol = Protocol::ArduPilot { pulses_us: [1000.0, 2000.0] };

/// A step of pitch, 3 s long.
fn scenario(stack: FlightStack, answer_limit_s: f64) -> Scenario {
    let plant =
        LinearPlant::new(&[1.151, 0.1774], &[1.0, 0.739, 0.921, 0.0], ElevatorSign::NoseUpPositive);
    let timing = Timing::new(DT_S, 3.0).expect("allowed");
    let setpoint = Profile::new(STEP_RAD, Shape::Step { at_s: 0.5 }).expect("allowed");
    let mut scenario = Scenario::new("stack", plant.expect("a plant"), timing, setpoint);
    let source = ExternalSource::FlightStack(Box::new(stack));
    let external =
        External { source, contents: None, answer_limit_s, dt_s: DT_S, renamed: Vec::new() };
    scenario.externals.push(NamedExternal { name: "stack".to_owned(), external });
    scenario
}

/// The flight with a peer, and what was told.
fn flown(scenario: &Scenario, peer: impl FnOnce(SocketAddr) + Send + 'static) -> (Trace, String) {
    set_host(WithPeers);
    NEXT.with(|next| *next.borrow_mut() = Some(Box::new(peer)));
    let mut traces = simulate(scenario).expect("flies").traces;
    for peer in PEERS.with(|peers| std::mem::take(&mut *peers.borrow_mut())) {
        peer.join().expect("the peer is content");
    }
    let told = TOLD.with(|told| std::mem::take(&mut *told.borrow_mut().lock().expect("free")));
    (traces.pop().expect("a flight"), told.join("\n"))
}

fn loss(trace: &Trace) -> (usize, String) {
    match trace.outcome {
        Outcome::EndedEarly(EarlyEnd { cause: EndCause::ControllerLost(loss), .. }) => {
            (trace.rows(), loss.to_string())
        }
        outcome => panic!("{outcome:?}"),
    }
}

/// What flies at both ends.
fn pid() -> Pid<f64> {
    let gains = Gains { kp: 1.2, ki: 0.4, kd: 0.3 };
    Pid::new(gains, PidConfig { rate_gain_s: 0.2, ..PidConfig::sampled_every(DT_S) })
        .expect("allowed")
}

/// The controller at the other end, with its memory.
struct Pilot {
    pid: Controller,
    state: State<f64>,
}

impl Pilot {
    fn new() -> Self {
        Self { pid: Controller::Fixed(pid()), state: State::new() }
    }

    fn command_rad(&mut self, rc_us: u64, measurement_rad: f64, rate_rad_s: f64) -> f64 {
        let setpoint_rad = match rc_us {
            1500 => 0.0,
            1750 => STEP_RAD,
            other => panic!("{other}"),
        };
        let sample = Sample { setpoint_rad, measurement_rad, rate_rad_s };
        self.pid.step(&mut self.state, sample).command_rad
    }
}

/// The pulse of a command: 500 µs are the whole way from the middle.
fn pulse_us(command_rad: f64) -> u16 {
    (1500.0 + 500.0 * command_rad / FULL_RAD).round().clamp(1000.0, 2000.0) as u16
}

/// Pitch, pitch rate, command and elevator, as bits.
fn bits(trace: &Trace) -> Vec<[u64; 4]> {
    let rows = 0..trace.rows();
    rows.map(|k| {
        [trace.theta_rad[k], trace.q_rad_s[k], trace.command_rad[k], trace.elevator_rad[k]]
            .map(f64::to_bits)
    })
    .collect()
}

/// The same controller inside, its command rounded as `rounded` does.
fn inside(scenario: &Scenario, rounded: impl Fn(f64) -> f64) -> Vec<[f64; 4]> {
    let prepared = scenario.prepare().expect("allowed");
    let (mut pilot, mut rows) = (Pilot::new(), Vec::new());
    let commanded =
        |sample: Sample<f64>| rounded(pilot.pid.step(&mut pilot.state, sample).command_rad);
    let outcome = fly_commanded(&prepared, commanded, |instant| {
        rows.push([
            instant.theta_rad,
            instant.q_rad_s,
            instant.step.command_rad,
            instant.elevator_rad,
        ]);
        std::ops::ControlFlow::Continue(())
    });
    assert_eq!(outcome, Ok(Outcome::Completed));
    rows
}
