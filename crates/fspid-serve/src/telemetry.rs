//! Telemetry: lines of JSON, or MAVLink, that come by UDP to this machine, read and passed on. Nothing is ever sent back.
//!
//! The first byte of a packet says which: no line of JSON begins with those of MAVLink.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use fspid_mavlink::{Line, Listener, is_frame};
use serde_json::{Map, Value, json};
use tokio::net::UdpSocket;
use tokio::sync::broadcast::error::{RecvError, TryRecvError};
use tokio::sync::broadcast::{Receiver, Sender, channel};

use crate::jobs::Event;

/// Lines that are kept for a client that reads slowly.
const KEPT: usize = 4096;
/// Lines of one event.
const AT_ONCE: usize = 256;
/// Largest packet of UDP.
const MOST_BYTES: usize = 65_536;
/// Most values of a line.
const MOST_VALUES: usize = 32;
/// Most letters of the name of a value.
const MOST_LETTERS: usize = 64;
/// The value that every line has.
const TIME: &str = "time_s";

/// Address that telemetry is heard at: this machine alone.
pub(crate) fn address(port: u16) -> SocketAddr {
    SocketAddr::from((Ipv4Addr::LOCALHOST, port))
}

/// What came so far.
#[derive(Clone, Debug, Default)]
struct Counts {
    lines: u64,
    bad: u64,
    /// What is wrong with the last bad one.
    last_bad: Option<String>,
    /// What the last packet was.
    form: Option<&'static str>,
    /// What MAVLink has told.
    mavlink: Option<fspid_mavlink::Counts>,
}

/// What is heard on a port.
#[derive(Clone, Debug)]
pub(crate) struct Telemetry {
    port: u16,
    counts: Arc<Mutex<Counts>>,
    lines: Sender<Arc<str>>,
}

impl Telemetry {
    pub(crate) fn new(port: u16) -> Self {
        Self { port, counts: Arc::default(), lines: channel(KEPT).0 }
    }

    /// Hears until it is dropped.
    pub(crate) async fn hear(self, socket: UdpSocket) {
        let (mut packet, mut mavlink) = (vec![0; MOST_BYTES], Listener::default());
        loop {
            // An answer of the system that nobody listens somewhere else is none about this socket.
            let Ok((length, _)) = socket.recv_from(&mut packet).await else { continue };
            let packet = packet.get(..length).unwrap_or_default();
            match is_frame(packet) {
                true => self.take_frames(packet, &mut mavlink),
                false => self.take_lines(packet),
            }
        }
    }

    fn take_lines(&self, packet: &[u8]) {
        self.counts().form = Some("json");
        let lines = packet.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
        lines.filter(|line| !line.is_empty()).for_each(|line| self.take(checked(line)));
    }

    fn take_frames(&self, packet: &[u8], mavlink: &mut Listener) {
        let heard = mavlink.hear(packet);
        {
            let mut counts = self.counts();
            (counts.form, counts.mavlink) = (Some("mavlink"), Some(mavlink.counts()));
        }
        heard.into_iter().for_each(|told| {
            self.take(told.map(|line| as_json(&line)).map_err(|damage| damage.to_string()));
        });
    }

    fn counts(&self) -> MutexGuard<'_, Counts> {
        self.counts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn take(&self, read: Result<Value, String>) {
        let mut counts = self.counts();
        match read {
            Ok(line) => {
                counts.lines += 1;
                // Nobody may be watching.
                let _ = self.lines.send(line.to_string().into());
            }
            Err(reason) => {
                counts.bad += 1;
                counts.last_bad = Some(reason);
                // Whoever watches is told at once.
                let _ = self.lines.send("".into());
            }
        }
    }

    /// What came so far, and where it comes to.
    pub(crate) fn told(&self) -> Value {
        let counts = self.counts().clone();
        json!({
            "port": self.port, "lines": counts.lines, "bad": counts.bad, "last_bad": counts.last_bad,
            "form": counts.form, "mavlink": counts.mavlink.as_ref().map(of_mavlink),
        })
    }

    /// What comes from now on.
    pub(crate) fn follow(&self) -> Following {
        Following { telemetry: self.clone(), lines: self.lines.subscribe() }
    }
}

/// Telemetry as one client sees it.
#[derive(Debug)]
pub(crate) struct Following {
    telemetry: Telemetry,
    lines: Receiver<Arc<str>>,
}

impl Following {
    pub(crate) fn told(&self) -> Value {
        self.telemetry.told()
    }

    /// The lines that came since the last call, at least one, a bad one or one that was lost; none at the end.
    pub(crate) async fn next(&mut self) -> Option<Event> {
        let (mut lines, mut lost) = (Vec::new(), 0);
        match self.lines.recv().await {
            Ok(line) => lines.push(line),
            Err(RecvError::Lagged(missed)) => lost = missed,
            Err(RecvError::Closed) => return None,
        }
        while lines.len() < AT_ONCE {
            match self.lines.try_recv() {
                Ok(line) => lines.push(line),
                Err(TryRecvError::Lagged(missed)) => lost += missed,
                Err(TryRecvError::Empty | TryRecvError::Closed) => break,
            }
        }
        let mut told = self.told();
        // They were read once already; a bad one stands there as an empty text.
        let read = |line: &Arc<str>| serde_json::from_str::<Value>(line).ok();
        told["lines"] = lines.iter().filter_map(read).collect::<Vec<_>>().into();
        told["lost"] = lost.into();
        Some(Event::new("telemetry", &told))
    }
}

/// `{frames, unused, others, system, component}`: who is followed, if somebody is.
fn of_mavlink(counts: &fspid_mavlink::Counts) -> Value {
    let followed = counts.followed;
    json!({
        "frames": counts.frames, "unused": counts.unused, "others": counts.others,
        "system": followed.map(|it| it.system), "component": followed.map(|it| it.component),
    })
}

fn as_json(line: &Line) -> Value {
    line.iter()
        .map(|(name, value)| ((*name).to_owned(), json!(value)))
        .collect::<Map<_, _>>()
        .into()
}

/// A line as it is passed on, or what is wrong with it.
fn checked(line: &[u8]) -> Result<Value, String> {
    let value: Value = serde_json::from_slice(line).map_err(|error| error.to_string())?;
    let Value::Object(values) = value else { return Err("it is no object".to_owned()) };
    if values.len() > MOST_VALUES {
        return Err(format!("it has {} values; the most is {MOST_VALUES}", values.len()));
    }
    if !values.contains_key(TIME) {
        return Err(format!("it has no `{TIME}`"));
    }
    let wrong = |(name, value): (&String, &Value)| match value {
        _ if name.len() > MOST_LETTERS => Some(format!("a name is longer than {MOST_LETTERS}")),
        Value::Number(_) => None,
        _ => Some(format!("`{name}` is no number")),
    };
    match values.iter().find_map(wrong) {
        Some(wrong) => Err(wrong),
        None => Ok(Value::Object(Map::from_iter(values))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_numbers_with_names_and_a_time_and_else_is_told_why_not() {
        let told = |line: &str| checked(line.as_bytes()).map(|it| it.to_string());
        let good = r#"{"time_s":0.01,"setpoint_deg":1.0,"measurement_deg":-2e-3}"#;
        assert_eq!(told(good), Ok(good.replace("-2e-3", "-0.002")));
        for (bad, why) in [
            ("[1]", "no object"),
            ("{}", "no `time_s`"),
            (r#"{"time_s":null}"#, "`time_s` is no number"),
            (r#"{"time_s":1e999}"#, "out of range"),
            (r#"{"time_s":1,"a":"<script>"}"#, "`a` is no number"),
            ("nonsense", "expected"),
            ("{\"time_s\":1", "EOF"),
        ] {
            let reason = told(bad).expect_err(bad);
            assert!(reason.contains(why), "{bad}: {reason}");
        }
        assert!(checked(b"\xff").is_err());
    }
}
