//! Who flies tunings and contests, where it is not this machine: workers of Ray or Dask, behind a process of the Python
//! package that carries orders there and answers back. The search itself stays here.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use clap::{Args, ValueEnum};
use fspid_campaign::local;
use fspid_tune::{Crew, Engine as Others, Order, Source, TuneError};
use serde_json::{Value, json};

use super::interrupt;
use crate::argument::is_standard;
use crate::exit::Failure;

/// How often somebody looks whether Ctrl-C was pressed while others fly.
const PERIOD: Duration = Duration::from_millis(50);

/// Who flies. Slurm is none of them: each generation waits for the one before it, which needs somebody who goes on with
/// the answers, and not a list of jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// This machine, on its threads.
    Local,
    /// Ray: candidates and blocks of their flights as tasks, flown again where a worker goes away.
    Ray,
    /// Dask's scheduler, the same way.
    Dask,
}

/// What engines are asked.
#[derive(Debug, Args)]
pub(crate) struct Cluster {
    /// Who flies. The result is the same.
    #[arg(long, value_enum, default_value_t = Engine::Local)]
    engine: Engine,
    /// Where the cluster is: HOST:PORT, ray://HOST:PORT or auto of Ray; tcp://HOST:PORT of Dask. Without it Ray begins
    /// here.
    #[arg(long, value_name = "ADDRESS")]
    address: Option<String>,
    /// The Python that has the package fspid, for Ray and Dask.
    #[arg(long, value_name = "PROGRAM", default_value = "python3")]
    python: String,
}

impl Cluster {
    /// Somebody who carries flights to the cluster; none where this machine flies.
    pub(crate) fn carrier(&self, source: &Source) -> Result<Option<Carrier>, Failure> {
        let engine = match self.engine {
            Engine::Local => return Ok(None),
            Engine::Ray => "ray",
            Engine::Dask => "dask",
        };
        if is_standard(&source.path) {
            return Err(Failure::input(format_args!(
                "--engine {engine} reads the scenario itself, and standard input is read once; give it as a file"
            )));
        }
        check_package(&self.python, engine)?;
        let mut command = Command::new(&self.python);
        command.args(["-m", "fspid.engines", engine, "--flights"]).arg(&source.path);
        if let Some(address) = &self.address {
            command.args(["--address", address]);
        }
        for change in &source.overrides {
            command.arg(format!("--set={change}"));
        }
        Carrier::begun(command).map(Some)
    }
}

/// Refuses a Python that has no package fspid.
pub(super) fn check_package(python: &str, engine: &str) -> Result<(), Failure> {
    let mut asked = Command::new(python);
    match asked.args(["-c", "import fspid.engines"]).stderr(Stdio::null()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(Failure::input(format_args!(
            "{python} has no package fspid: no registry has it yet; build its wheel as the guide says and install it with what `{engine}` needs (`pip install 'target/wheels/FILE.whl[{engine}]'`), or name a Python that has it with --python"
        ))),
        Err(error) => Err(Failure::input(format_args!("--python {python}: {error}"))),
    }
}

/// Does work with whoever flies: the carrier, or so many threads of this machine until Ctrl-C is pressed.
pub(crate) fn with_crew<T: Send>(
    carrier: Option<&Carrier>,
    threads: usize,
    work: impl FnOnce(Crew<'_>) -> T + Send,
) -> Result<T, Failure> {
    match carrier {
        Some(carrier) => Ok(work(Crew::Others(carrier))),
        None => local::in_threads(threads, || work(Crew::Here(&interrupt::asked)))
            .map_err(Failure::input),
    }
}

/// A process that carries flights to a cluster: an order is a line of JSON, and so are its answers.
pub(crate) struct Carrier {
    process: Child,
    orders: Option<ChildStdin>,
    answers: Receiver<String>,
}

impl Carrier {
    fn begun(mut command: Command) -> Result<Self, Failure> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut process = command.spawn().map_err(Failure::input)?;
        let (orders, told) = (process.stdin.take(), process.stdout.take());
        let (answer, answers) = mpsc::channel();
        thread::spawn(move || {
            let lines = told.into_iter().flat_map(|told| BufReader::new(told).lines());
            // Nobody may listen any more.
            lines.map_while(Result::ok).map_while(|line| answer.send(line).ok()).count()
        });
        let carrier = Self { process, orders, answers };
        match carrier.answer() {
            Ok(_) => Ok(carrier),
            Err(TuneError::Stopped) => Err(Failure::interrupted("interrupted")),
            Err(error) => Err(Failure::input(error)),
        }
    }

    /// What it says next.
    fn answer(&self) -> Result<Value, TuneError> {
        let gone =
            || TuneError::Engine { reason: "who carries flights to the engine is gone".into() };
        let line = loop {
            match self.answers.recv_timeout(PERIOD) {
                Ok(line) => break line,
                Err(_) if interrupt::asked() => return Err(TuneError::Stopped),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(gone()),
            }
        };
        let mut told: Value = serde_json::from_str(&line).map_err(|_| gone())?;
        match told.get("error").and_then(Value::as_str) {
            Some(reason) => Err(TuneError::Engine { reason: reason.to_owned() }),
            None => Ok(told["answers"].take()),
        }
    }
}

impl Others for Carrier {
    fn fly(&self, order: &Order) -> Result<Vec<String>, TuneError> {
        let asked = json!({
            "order": order.text(), "flights": order.flights(), "at_once": order.at_once(),
        });
        // One that is gone is seen by its answer.
        let _ = self.orders.as_ref().map(|mut orders| writeln!(orders, "{asked}"));
        let answers = match self.answer()? {
            Value::Array(answers) => answers,
            _ => Vec::new(),
        };
        let text = |answer| match answer {
            Value::String(text) => text,
            other => other.to_string(),
        };
        Ok(answers.into_iter().map(text).collect())
    }
}

impl Drop for Carrier {
    /// It ends once it hears no more; who pressed Ctrl-C does not wait for that.
    fn drop(&mut self) {
        self.orders = None;
        if !interrupt::asked() {
            let _ = self.process.wait();
        }
    }
}
