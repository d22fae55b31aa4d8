//! `fspid serve`: the cockpit, in a browser of this machine.

#[cfg(not(feature = "web"))]
pub(crate) use absent::{Arguments, run};
#[cfg(feature = "web")]
pub(crate) use present::{Arguments, run};

#[cfg(feature = "web")]
mod present {
    use std::net::{IpAddr, Ipv4Addr};
    use std::path::Path;
    use std::process::{Command, Stdio};
    use std::thread;
    use std::time::Duration;

    use clap::Args;
    use fspid_scenario::file::read_text;
    use fspid_serve::{Opened, Page, Server, Settings, StartError, leave_a_core};
    use fspid_study::output;
    use serde_json::json;

    use super::super::{Format, interrupt};
    use crate::argument::{Folder, NamedFile, OutFile, written};
    use crate::exit::{self, Failure, note, wrote};

    /// How often somebody looks whether Ctrl-C was pressed.
    const PERIOD: Duration = Duration::from_millis(50);
    /// What shows a page to a person.
    const OPENER: &str = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };

    /// Serve the cockpit: a page in which a scenario, its flight, its margins and its proofs move together.
    ///
    /// Standard output is its address, with a token behind it that nobody else knows; open it in a browser of this machine.
    /// The server opens and saves the scenarios in and below a folder, or one scenario alone, runs tunings, campaigns,
    /// contests and certificates, and shows telemetry. It listens on this machine alone, begins no connection of its own,
    /// and starts no program that a scenario names. Ctrl-C ends it, and its jobs with it; that is its good end, with code 0.
    #[derive(Debug, Args)]
    #[command(
        after_help = "Examples:\n  fspid serve                                # the scenarios in and below this folder\n  fspid serve pitch.toml --port 0            # one scenario, on any port that is free\n  fspid serve --telemetry udp:14600          # with telemetry, JSON or MAVLink\n  fspid serve pitch.toml --export page.html  # the page with a scenario, in one file that needs no server"
    )]
    pub(crate) struct Arguments {
        /// A scenario, or a folder with some; this folder if left out.
        #[arg(value_name = "SCENARIO")]
        opened: Option<NamedFile>,
        /// The port; 0 for any that is free.
        #[arg(long, value_name = "N", default_value_t = 8318)]
        port: u16,
        /// An address of this machine that others reach, in place of loopback. Nothing is encrypted: in the network whoever
        /// reads along has the token.
        #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
        host: IpAddr,
        /// Hear telemetry on this port of this machine: MAVLink, or lines of JSON by UDP such as {"time_s": 0.1, "measurement_deg": 1.2}.
        #[arg(long, value_name = "udp:PORT", value_parser = udp)]
        telemetry: Option<Udp>,
        /// Keep in this folder what jobs write, so that they go on with another server; without it, it goes with this one.
        #[arg(long, value_name = "DIR")]
        out: Option<Folder>,
        /// Open the page in a browser.
        #[arg(long)]
        open: bool,
        /// Serve nothing: write the page as one file that works from disk, with the scenario in it if one is named.
        #[arg(value_parser = written(&["html", "htm"]), long, value_name = "FILE.html", conflicts_with_all = ["port", "host", "telemetry", "out", "open"])]
        export: Option<OutFile>,
        /// How the address is written.
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    }

    /// A port of UDP, as in `udp:14600`.
    #[derive(Clone, Copy, Debug)]
    struct Udp(u16);

    fn udp(text: &str) -> Result<Udp, String> {
        let port = text.strip_prefix("udp:").and_then(|port| port.parse().ok());
        port.map(Udp).ok_or_else(|| "allowed is udp:PORT, such as udp:14600".to_owned())
    }

    pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
        if let Some(path) = &arguments.export {
            return export(path, arguments.opened.as_deref(), arguments.format);
        }
        let page = Page::built();
        if !page.is_built() {
            note(
                "warning: this fspid was built without the page: run web/build.sh, then build it again",
            );
        }
        if !arguments.host.is_loopback() {
            let host = arguments.host;
            note(format_args!(
                "warning: {host} is not this machine alone: others reach the server, and nothing is encrypted, so that whoever reads along in the network has the token"
            ));
        }
        leave_a_core();
        let server = Server::start(settings(arguments, page)).map_err(failure)?;
        interrupt::watch();
        tell(&server, arguments.format)?;
        // The file is needed until the browser has read it, and nobody knows when that is.
        let _door = if arguments.open { open(&server) } else { None };
        while !interrupt::asked() {
            thread::sleep(PERIOD);
        }
        server.stop();
        // Ctrl-C is its good end, and nothing else is.
        exit::reason().map_or(Ok(()), |_| Err(Failure::interrupted("the server has ended")))
    }

    fn settings(arguments: &Arguments, page: Page) -> Settings {
        let opened = match &arguments.opened {
            Some(path) if path.is_dir() => Opened::Folder(path.to_path_buf()),
            Some(path) => Opened::Scenario(path.to_path_buf()),
            None => Opened::Folder(".".into()),
        };
        Settings {
            host: arguments.host,
            port: arguments.port,
            telemetry_port: arguments.telemetry.map(|Udp(port)| port),
            kept: arguments.out.as_ref().map(|out| out.to_path_buf()),
            page,
            ..Settings::new(opened)
        }
    }

    fn failure(error: StartError) -> Failure {
        match error {
            StartError::Folder { .. } => Failure::output(error),
            error => Failure::input(error),
        }
    }

    /// Tells where it is; the port of telemetry, too, which may be any.
    fn tell(server: &Server, format: Format) -> Result<(), Failure> {
        let (url, address, telemetry) = (server.url(), server.address(), server.telemetry_port());
        let json = || {
            json!({
                "schema": 1, "url": url, "host": address.ip().to_string(), "port": address.port(),
                "token": server.token(), "telemetry_port": telemetry,
            })
        };
        format.print(|| format!("{url}\n"), json)?;
        if let Some(port) = telemetry {
            note(format_args!("telemetry is heard at udp:127.0.0.1:{port}"));
        }
        note("Ctrl-C ends it");
        Ok(())
    }

    /// Shows the page. The address is not in the command, which every user of the machine can see, but in a file that only
    /// this one can read.
    fn open(server: &Server) -> Option<impl Sized + use<>> {
        let door = match server.door() {
            Ok(door) => door,
            Err(reason) => {
                note(format_args!("warning: no file for the browser: {reason}"));
                return None;
            }
        };
        let silent = [Stdio::null(), Stdio::null(), Stdio::null()];
        let [stdin, stdout, stderr] = silent;
        let mut opener = Command::new(OPENER);
        opener.arg(door.path()).stdin(stdin).stdout(stdout).stderr(stderr);
        if let Err(reason) = opener.spawn() {
            note(format_args!("warning: {OPENER}: {reason}; open the address yourself"));
        }
        Some(door)
    }

    fn export(path: &Path, scenario: Option<&Path>, format: Format) -> Result<(), Failure> {
        let page = Page::built();
        let whole = match scenario {
            None => page.whole().map(<[u8]>::to_vec),
            Some(scenario) => {
                let text = read_text(scenario).map_err(Failure::load)?;
                let name = scenario.file_name().unwrap_or_default().to_string_lossy();
                page.whole_with(&name, &text)
            }
        };
        let Some(whole) = whole else {
            return Err(Failure::input(
                "this fspid was built without the page: run web/build.sh, then build it again",
            ));
        };
        output::write(path, whole)?;
        wrote(path);
        let file = path.display().to_string();
        match format {
            Format::Text => Ok(()),
            Format::Json => format.print(String::new, || json!({ "schema": 1, "file": file })),
        }
    }
}

#[cfg(not(feature = "web"))]
mod absent {
    use clap::Args;

    use super::super::Format;
    use crate::exit::Failure;

    /// Serve the cockpit; this fspid was built without it, and says how it is built with it.
    #[derive(Debug, Args)]
    pub(crate) struct Arguments {
        /// Whatever is asked.
        #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
        rest: Vec<String>,
        /// How the answer is written.
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    }

    pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
        // Of no use here, and read so that the same lines are taken.
        let (_, _) = (&arguments.rest, arguments.format);
        Err(Failure::input(
            "this fspid was built without the server: build it with the feature `web`, as `cargo build --release` does",
        ))
    }
}
