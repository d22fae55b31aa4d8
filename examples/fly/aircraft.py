"""A toy aircraft flown by `fspid fly`: put any simulator in its place.

    fspid init pitch.toml
    python3 examples/fly/aircraft.py pitch.toml FSPID --fspid target/release/fspid

Only the standard library is used. The conversation is in `Autopilot`, some twenty lines; the
aircraft is a short period of its own making, not one of fspid's.
"""

import argparse
import subprocess
import sys


class Autopilot:
    """A controller of a scenario file, asked line by line."""

    def __init__(self, program, scenario, controller):
        command = [program, "fly", scenario, "--controller", controller]
        # What it tells people goes to our own standard error.
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )

    def ask(self, line):
        """Every line that is asked gets exactly one line back."""
        try:
            self.process.stdin.write(line + "\n")
            self.process.stdin.flush()
            answer = self.process.stdout.readline()
        except BrokenPipeError:
            answer = ""
        if not answer:
            sys.exit(f"the autopilot has ended with code {self.process.wait()}")
        return answer.strip()

    def command_deg(self, setpoint_deg, pitch_deg, dt_s, rate_deg_s):
        """The elevator, nose up positive. `repr` gives every digit of a number."""
        fields = (setpoint_deg, pitch_deg, dt_s, rate_deg_s)
        return float(self.ask(" ".join(map(repr, fields))))

    def reset(self):
        """Starts a new flight."""
        if self.ask("reset") != "ok":
            sys.exit("the autopilot did not start anew")

    def close(self):
        """Ends it and returns its exit code: 0 unless something was wrong."""
        self.process.stdin.close()
        return self.process.wait()


class Aircraft:
    """Short period: pitch acceleration by elevator, weathercock stability and damping."""

    def __init__(self):
        self.pitch_deg = self.rate_deg_s = self.attack_deg = 0.0

    def fly(self, elevator_deg, dt_s):
        """Moves on by dt_s in small steps."""
        for _ in range(10):
            h = dt_s / 10
            acceleration = 3.0 * elevator_deg - 2.0 * self.attack_deg - 1.2 * self.rate_deg_s
            self.attack_deg += h * (self.rate_deg_s - 0.8 * self.attack_deg)
            self.rate_deg_s += h * acceleration
            self.pitch_deg += h * self.rate_deg_s


def flight(autopilot, setpoint_deg, dt_s, samples):
    """One step of the set-point; the pitch at the end."""
    aircraft = Aircraft()
    autopilot.reset()
    for k in range(samples):
        command_deg = autopilot.command_deg(
            setpoint_deg, aircraft.pitch_deg, dt_s, aircraft.rate_deg_s
        )
        if k % (samples // 10) == 0:
            print(f"{k * dt_s:6.2f} {setpoint_deg:8.3f} {aircraft.pitch_deg:8.3f} {command_deg:8.3f}")
        aircraft.fly(command_deg, dt_s)
    return aircraft.pitch_deg


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", help="scenario file with the controller")
    parser.add_argument("controller", help="its name in the file")
    parser.add_argument("--fspid", default="fspid", help="the program")
    parser.add_argument("--dt", type=float, default=0.01, help="sample period of the file, s")
    parser.add_argument("--seconds", type=float, default=20.0, help="length of a flight")
    options = parser.parse_args()

    autopilot = Autopilot(options.fspid, options.scenario, options.controller)
    samples = max(round(options.seconds / options.dt), 10)
    for setpoint_deg in (5.0, -2.0):
        print("  time setpoint    pitch elevator")
        pitch_deg = flight(autopilot, setpoint_deg, options.dt, samples)
        print(f"{setpoint_deg} deg commanded, {pitch_deg:.3f} deg reached")
    return autopilot.close()


if __name__ == "__main__":
    sys.exit(main())
