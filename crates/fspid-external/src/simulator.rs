//! Aircraft of other simulators: a process for each flight, in which a small program of Python flies JSBSim.

use std::io::{self, PipeReader, Read as _, Write as _};
use std::net::Shutdown;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt as _;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use fspid_numeric::units::FOOT_M;
use fspid_sim::external_plant::{
    Beginning, Jsbsim, JsbsimLinear, JsbsimSpeed, LongitudinalRates, PlantHost, PlantSample,
    SampleInput, Simulates, StepInput,
};
use fspid_sim::{ControllerLoss, ExternalPlant, PlantLoss, SimError, Simulator};
use rustix::process::{Pid, Signal, kill_process_group};
use tempfile::TempDir;

use crate::fmu_flight::FmuFlight;
use crate::frame::{numbers, read, text};
use crate::pace::Pace;
use crate::process::{ProcessHost, ended, ending};
use crate::shown::{SAMPLE, number_of, sample_of};
use crate::timed::Timed;

/// The program that flies JSBSim.
const JSBSIM: &str = include_str!("jsbsim.py");
/// What starting may take beyond the time for an answer: Python, its package and two aircraft take a fifth of a second on
/// an idle machine.
const START_LIMIT: Duration = Duration::from_secs(30);
/// How long a process has to end once nobody asks any more.
const END_LIMIT: Duration = Duration::from_secs(1);
/// Bytes of what a simulator prints that are kept: the last.
const MOST_KEPT: usize = 4096;
/// Lines of it that are told.
const MOST_TOLD: usize = 12;
/// The number of no sample: the simulator cannot go on.
const CANNOT: u64 = u64::MAX;
/// Numbers of a linear model: twice four rows and a column, and the trim.
const LINEAR: usize = 46;
/// Of a linear model, which flies nowhere.
const NO_FLIGHT: Beginning =
    Beginning { step_s: 0.01, steps: 1, wind_m_s: None, moves_throttle: false };

/// Starts a process of Python for each flight of another simulator.
#[derive(Clone, Debug)]
pub struct SimulatorHost {
    python: PathBuf,
    start_limit: Duration,
    /// Who is told how a flight kept to real time, where it is to.
    real_time: Option<fn(&str)>,
    /// What starts FMUs.
    fmus: Option<ProcessHost>,
}

impl SimulatorHost {
    /// With this Python, whose packages are asked for the simulator.
    #[must_use]
    pub fn new(python: PathBuf) -> Self {
        Self { python, start_limit: START_LIMIT, real_time: None, fmus: None }
    }

    /// The same with another time for a start.
    #[must_use]
    pub fn starting_within(self, start_limit: Duration) -> Self {
        Self { start_limit, ..self }
    }

    /// The same that flies FMUs, too, as this host starts controllers.
    #[must_use]
    pub fn flying_fmus(self, host: ProcessHost) -> Self {
        Self { fmus: Some(host), ..self }
    }

    /// The same whose samples take as long as they are; says of each flight which came late.
    #[must_use]
    pub fn in_real_time(self, tell: fn(&str)) -> Self {
        Self { real_time: Some(tell), ..self }
    }

    fn spawn(&self, arguments: &[String], limit_s: f64) -> io::Result<Process> {
        let (stream, theirs) = UnixStream::pair()?;
        let scratch = tempfile::Builder::new().prefix("fspid-simulator-").tempdir()?;
        let (reader, writer) = io::pipe()?;
        let mut command = Command::new(&self.python);
        command
            .args(["-u", "-c", JSBSIM])
            .args(arguments)
            .arg(format!("parent={}", std::process::id()))
            .arg(format!("scratch={}", scratch.path().display()))
            // Messages are the same everywhere.
            .env("PYTHONIOENCODING", "utf-8")
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            .stdout(Stdio::from(writer.try_clone()?))
            .stderr(Stdio::from(writer))
            // Ctrl-C is for us: a flight that was begun is no crash of its simulator.
            .process_group(0);
        let child = command.spawn()?;
        // Its ends of socket and pipe.
        drop(command);
        Ok(Process {
            child,
            stream,
            said: Said::of(reader),
            sample: 0,
            limit: Duration::from_secs_f64(limit_s),
            is_lost: false,
            start: PlantSample::default(),
            pace: None,
            question: Vec::new(),
            _scratch: scratch,
        })
    }
}

/// What a flight is told.
fn arguments(jsbsim: &Jsbsim, beginning: &Beginning) -> Vec<String> {
    let Beginning { step_s, steps, wind_m_s, moves_throttle } = beginning;
    let speed = match jsbsim.speed {
        JsbsimSpeed::True(m_s) => format!("true={m_s:?}"),
        JsbsimSpeed::Calibrated(m_s) => format!("calibrated={m_s:?}"),
        JsbsimSpeed::Mach(mach) => format!("mach={mach:?}"),
    };
    let mut all = vec![
        format!("aircraft={}", jsbsim.aircraft),
        format!("version={}", jsbsim.version),
        format!("speed={speed}"),
        format!("altitude_m={:?}", jsbsim.altitude_m),
        format!("climb_rad={:?}", jsbsim.climb_rad),
        format!("heading_rad={:?}", jsbsim.heading_rad),
        format!("gear={}", u8::from(jsbsim.gear_is_down)),
        format!("levels_wings={}", u8::from(jsbsim.levels_wings)),
        format!("seed={}", jsbsim.seed),
        format!("step_s={step_s:?}"),
        format!("steps={steps}"),
        format!("moves_throttle={}", u8::from(*moves_throttle)),
    ];
    all.extend(wind_m_s.map(|[north, east]| format!("wind_m_s={north:?}={east:?}")));
    all.extend(jsbsim.folder.iter().map(|folder| format!("folder={}", folder.display())));
    all.extend(jsbsim.properties.iter().map(|(name, value)| format!("property={name}={value:?}")));
    all
}

impl PlantHost for SimulatorHost {
    fn start(
        &self,
        plant: &ExternalPlant,
        beginning: &Beginning,
    ) -> Result<Box<dyn Simulates>, SimError> {
        let period_s = beginning.step_s * f64::from(beginning.steps);
        if let Simulator::Fmu(fmu) = &plant.simulator {
            let fmus = self.fmus.as_ref();
            let mut flight = FmuFlight::start(fmus, (fmu, plant), beginning.step_s)?;
            flight.pace = self.real_time.map(|tell| Pace::new(period_s, tell));
            return Ok(Box::new(flight));
        }
        let (process, begun) = self.begun(plant, beginning, false)?;
        match begun {
            Begin::Ready => {
                let mut process = process;
                process.pace = self.real_time.map(|tell| Pace::new(period_s, tell));
                Ok(Box::new(process))
            }
            _ => Err(self.no_answer(plant, PlantLoss::NoAnswer, &process)),
        }
    }

    fn linear_model(&self, plant: &ExternalPlant) -> Result<JsbsimLinear, SimError> {
        let (process, begun) = self.begun(plant, &NO_FLIGHT, true)?;
        match begun {
            Begin::Linear(numbers) => Ok(linear(&numbers)),
            _ => Err(self.no_answer(plant, PlantLoss::NoAnswer, &process)),
        }
    }
}

impl SimulatorHost {
    /// A process with its first words, where they are no refusal.
    fn begun(
        &self,
        plant: &ExternalPlant,
        beginning: &Beginning,
        is_linear: bool,
    ) -> Result<(Process, Begin), SimError> {
        let Simulator::Jsbsim(jsbsim) = &plant.simulator else {
            return Err(SimError::OtherSimulator { name: plant.simulator.name() });
        };
        let simulator = plant.simulator.name().to_owned();
        let of_host = |reason: String| SimError::PlantHost { name: simulator.clone(), reason };
        let mut arguments = arguments(jsbsim, beginning);
        arguments.push(format!("linear={}", u8::from(is_linear)));
        let spawned = self.spawn(&arguments, plant.answer_limit_s);
        let mut process = spawned.map_err(|error| of_host(self.unstarted(&error)))?;
        match process.begin(self.start_limit) {
            Ok(Begin::Refused { reason, allowed }) => {
                let reason = reason.replace("{said}", &process.said.told());
                let name = format!("{simulator}, {}", jsbsim.aircraft);
                Err(SimError::PlantNotStarted { name, reason, allowed })
            }
            Ok(Begin::Host { reason }) => Err(of_host(reason)),
            Ok(begun) => Ok((process, begun)),
            Err(loss) => Err(self.no_answer(plant, loss, &process)),
        }
    }

    fn no_answer(&self, plant: &ExternalPlant, loss: PlantLoss, process: &Process) -> SimError {
        let (python, said) = (self.python.display(), process.said.told());
        let reason = format!("{python} {loss} before its flight, and said: {said}");
        SimError::PlantHost { name: plant.simulator.name().to_owned(), reason }
    }
}

/// The model of numbers in the order of the bridge, in feet.
fn linear(numbers: &[f64; LINEAR]) -> JsbsimLinear {
    let of = |place: usize| numbers.get(place).copied().unwrap_or(f64::NAN);
    // Of a state and of a rate, in feet a second, how many metres a second they are.
    let rates = |from: usize, sizes: [f64; 4]| LongitudinalRates {
        by_states: std::array::from_fn(|row| {
            std::array::from_fn(|column| of(from + 4 * row + column) * sizes[row] / sizes[column])
        }),
        by_elevator: std::array::from_fn(|row| of(from + 16 + row) * sizes[row]),
    };
    JsbsimLinear {
        by_differences: rates(0, [FOOT_M, FOOT_M, 1.0, 1.0]),
        own: rates(20, [FOOT_M, 1.0, 1.0, 1.0]),
        airspeed_m_s: of(40) * FOOT_M,
        alpha_rad: of(41),
        elevator_rad: of(42),
        theta_rad: of(43),
        mach: of(44),
        span_m: of(45) * FOOT_M,
    }
}

impl SimulatorHost {
    fn unstarted(&self, error: &io::Error) -> String {
        let python = self.python.display();
        match error.kind() {
            io::ErrorKind::NotFound => format!(
                "there is no Python at {python}; install one, or name one in the environment variable FSPID_PYTHON"
            ),
            _ => format!("{python} cannot be started: {error}"),
        }
    }
}

/// The first words of a simulator's process.
enum Begin {
    Ready,
    Refused { reason: String, allowed: String },
    Host { reason: String },
    Linear(Box<[f64; LINEAR]>),
}

/// The last of what a simulator prints.
#[derive(Debug)]
struct Said {
    bytes: Arc<Mutex<Vec<u8>>>,
    ended: Receiver<()>,
}

impl Said {
    fn of(mut reader: PipeReader) -> Self {
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let (tell, ended) = channel();
        let kept = Arc::clone(&bytes);
        std::thread::spawn(move || {
            let mut some = [0; 1024];
            while let Ok(read @ 1..) = reader.read(&mut some) {
                let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                kept.extend(some.get(..read).unwrap_or_default());
                let before = kept.len().saturating_sub(MOST_KEPT);
                kept.drain(..before);
            }
            let _ = tell.send(());
        });
        Self { bytes, ended }
    }

    /// Its last lines as one, once all is printed.
    fn told(&self) -> String {
        let _ = self.ended.recv_timeout(END_LIMIT);
        let kept = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        let text = String::from_utf8_lossy(&kept);
        let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
        let has_words = |line: &String| line.chars().any(char::is_alphanumeric);
        let lines: Vec<String> = text.lines().map(words).filter(has_words).collect();
        let last = lines.get(lines.len().saturating_sub(MOST_TOLD)..).unwrap_or_default();
        if last.is_empty() { "nothing".to_owned() } else { last.join(" / ") }
    }
}

/// A simulator in flight.
#[derive(Debug)]
struct Process {
    child: Child,
    stream: UnixStream,
    said: Said,
    /// Number of the last sample.
    sample: u64,
    limit: Duration,
    /// True once there is nothing more to wait for.
    is_lost: bool,
    start: PlantSample,
    pace: Option<Pace>,
    /// Bytes of the last question.
    question: Vec<u8>,
    /// Where files of its own go, removed behind it.
    _scratch: TempDir,
}

impl Process {
    fn begin(&mut self, start_limit: Duration) -> Result<Begin, PlantLoss> {
        let limit = start_limit + self.limit;
        let first = first(&mut Timed::new(&self.stream, limit));
        let (begin, start) = first.map_err(|error| self.lost(&error, limit))?;
        if let Some(start) = start {
            self.start = sample_of(&start).ok_or(PlantLoss::NotFinite)?;
        } else {
            self.is_lost = true;
        }
        Ok(begin)
    }

    /// What an error of the conversation means.
    fn lost(&mut self, error: &io::Error, limit: Duration) -> PlantLoss {
        use io::ErrorKind::{BrokenPipe, ConnectionReset, TimedOut, UnexpectedEof, WouldBlock};
        self.is_lost = true;
        let silent = ControllerLoss::Silent { limit_s: limit.as_secs_f64() };
        let loss = match error.kind() {
            WouldBlock | TimedOut => ending(&self.child).unwrap_or(silent),
            UnexpectedEof | BrokenPipe | ConnectionReset => {
                ended(&self.child).unwrap_or(ControllerLoss::NoAnswer)
            }
            _ => ControllerLoss::NoAnswer,
        };
        loss.into()
    }

    fn asked(&mut self, held: &SampleInput, steps: &[StepInput]) -> io::Result<[u8; SAMPLE]> {
        let mut timed = Timed::new(&self.stream, self.limit);
        self.question.clear();
        self.question.extend(held.throttle.to_ne_bytes());
        for StepInput { elevator_rad, air_m_s: [north, east, down] } in steps {
            let numbers = [*elevator_rad, *north, *east, *down];
            self.question.extend(numbers.into_iter().flat_map(f64::to_ne_bytes));
        }
        timed.write_all(&self.question)?;
        read(&mut timed)
    }
}

/// What a process begins with: a kind, and the version and the first sample, or what is wrong.
fn first(from: &mut impl io::Read) -> io::Result<(Begin, Option<[u8; SAMPLE]>)> {
    Ok(match read::<1>(from)? {
        [0] => {
            text(from)?;
            (Begin::Ready, Some(read(from)?))
        }
        [1] => (Begin::Refused { reason: text(from)?, allowed: text(from)? }, None),
        [2] => {
            let reason = text(from)?;
            text(from)?;
            (Begin::Host { reason }, None)
        }
        [3] => {
            let count = u32::from_ne_bytes(read(from)?);
            let numbers = numbers::<LINEAR>(&read::<{ 8 * LINEAR }>(from)?);
            let is_model = count as usize == LINEAR && numbers.iter().all(|it| it.is_finite());
            if !is_model {
                return Err(io::ErrorKind::InvalidData.into());
            }
            (Begin::Linear(Box::new(numbers)), None)
        }
        _ => return Err(io::ErrorKind::InvalidData.into()),
    })
}

impl Simulates for Process {
    fn start(&self) -> PlantSample {
        self.start
    }

    fn advance(
        &mut self,
        held: &SampleInput,
        steps: &[StepInput],
    ) -> Result<PlantSample, PlantLoss> {
        let asked = self.asked(held, steps);
        let frame = asked.map_err(|error| self.lost(&error, self.limit))?;
        self.sample += 1;
        let found = match number_of(&frame) {
            CANNOT => Err(PlantLoss::Refused),
            number if number != self.sample => Err(PlantLoss::NoAnswer),
            _ => sample_of(&frame).ok_or(PlantLoss::NotFinite),
        };
        self.is_lost = found.is_err();
        if let Some(pace) = &mut self.pace {
            pace.wait(self.sample);
        }
        found
    }
}

impl Drop for Process {
    /// Lets it end; one that does not is ended, and so is what it left behind in its group.
    fn drop(&mut self) {
        let _ = self.stream.shutdown(Shutdown::Write);
        if !self.is_lost {
            let _ = io::copy(&mut Timed::new(&self.stream, END_LIMIT), &mut io::sink());
        }
        // Before it is waited for, while nobody else can have its number.
        if ending(&self.child) != Some(ControllerLoss::Gone) {
            let _ = kill_process_group(Pid::from_child(&self.child), Signal::KILL);
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
