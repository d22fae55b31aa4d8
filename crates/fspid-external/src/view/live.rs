//! A flight that is shown while it is flown, at its own pace.

use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant as Clock};

use fspid_sim::{Instant, Timing};

use super::poses::{Moment, Way};
use super::{LATE, Shown, Start, Viewer, sent, socket_for};

/// A flight that is being shown: each sample waits for its time, and what it shows is sent.
#[derive(Debug)]
pub struct Live {
    way: Way,
    timing: Timing,
    sockets: Vec<(Viewer, SocketAddr, UdpSocket)>,
    /// So many times as fast as it flies.
    speed: f64,
    /// The shortest time between two poses, s.
    apart_s: f64,
    begun: Option<Clock>,
    next_s: f64,
    shown: Shown,
}

impl Live {
    /// Before the first sample.
    ///
    /// # Errors
    /// A socket that cannot be made.
    pub fn new(
        start: Start,
        timing: Timing,
        viewers: &[(Viewer, SocketAddr)],
        [speed, most_hz]: [f64; 2],
    ) -> io::Result<Self> {
        let socket = |(viewer, address): &(Viewer, SocketAddr)| {
            Ok((*viewer, *address, socket_for(address)?))
        };
        Ok(Self {
            way: Way::new(start),
            timing,
            sockets: viewers.iter().map(socket).collect::<io::Result<_>>()?,
            speed,
            apart_s: 1.0 / most_hz,
            begun: None,
            next_s: 0.0,
            shown: Shown::default(),
        })
    }

    /// Waits for the time of a sample and shows it, if it is time for a pose.
    ///
    /// # Errors
    /// An address to which the system sends nothing.
    pub fn show(&mut self, instant: &Instant) -> io::Result<()> {
        let begun = *self.begun.get_or_insert_with(Clock::now);
        let moment = moment(instant, self.timing);
        let pose = self.way.pose(&moment);
        let at_s = moment.time_s / self.speed;
        let at = Duration::from_secs_f64(at_s);
        std::thread::sleep(at.saturating_sub(begun.elapsed()));
        self.shown.flight_s = moment.time_s;
        if at_s < self.next_s {
            return Ok(());
        }
        self.next_s = (at_s + self.apart_s).max(self.next_s);
        let late = begun.elapsed().saturating_sub(at);
        for (viewer, address, socket) in &self.sockets {
            sent(socket.send_to(&viewer.packet(&pose), address))?;
        }
        self.shown.sent += 1;
        self.shown.late += usize::from(late > LATE);
        self.shown.latest_s = self.shown.latest_s.max(late.as_secs_f64());
        Ok(())
    }

    /// How it was shown so far.
    #[must_use]
    pub fn shown(&self) -> Shown {
        self.shown
    }
}

fn moment(instant: &Instant, timing: Timing) -> Moment {
    let pitch = Moment {
        time_s: timing.time_s(instant.k),
        theta_deg: instant.theta_rad.to_degrees(),
        elevator_deg: instant.elevator_rad.to_degrees(),
        ..Moment::default()
    };
    let Some(aircraft) = &instant.aircraft else { return pitch };
    Moment {
        airspeed_m_s: Some(aircraft.airspeed_m_s),
        altitude_m: Some(aircraft.altitude_m),
        alpha_deg: Some(aircraft.alpha_rad.to_degrees()),
        bank_deg: Some(aircraft.bank_rad.to_degrees()),
        aileron_deg: Some(aircraft.aileron_rad.to_degrees()),
        place_m: Some(aircraft.position_m),
        heading_deg: Some(aircraft.heading_rad.to_degrees()),
        attitude_deg: Some(aircraft.attitude_rad.to_degrees()),
        ..pitch
    }
}
