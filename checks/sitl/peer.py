"""A fake ArduPilot: flies the elevator of `fspid simulate` over ArduPilot's JSON interface with a PI controller and pitch rate.

It speaks the protocol from ArduPilot's `libraries/SITL/examples/JSON/readme.md` and needs nothing but Python:

    python3 checks/sitl/peer.py &
    fspid simulate checks/sitl/pitch.toml

`--lose N` loses every N-th answer, `--late N` sends an old packet behind every N-th, `--nonsense N` sends something else as the N-th.
"""
import argparse
import json
import math
import socket
import struct
import time

MAGIC, PERIOD_S, FULL_DEG = 18458, 0.01, 20.0


def packet(count, pulse):
    pulses = [1500] * 16
    pulses[1] = pulse
    return struct.pack("<HHI16H", MAGIC, round(1 / PERIOD_S), count, *pulses)


class Pilot:
    """PI controller and pitch rate: 1.2 (r - y) + 0.4 ∫(r - y) dt - 0.3 q."""

    def __init__(self):
        self.integral = 0.0

    def pulse(self, line):
        setpoint = math.radians((line["rc"]["rc_2"] - 1500) / 500 * FULL_DEG)
        error = setpoint - line["attitude"][1]
        self.integral += 0.4 * error * PERIOD_S
        command = 1.2 * error + self.integral - 0.3 * line["imu"]["gyro"][1]
        return round(min(max(1500 + 500 * math.degrees(command) / FULL_DEG, 1000), 2000))


def answer(link, count, pulse, lose):
    """Sends a packet until its answer comes; ArduPilot waits 10 s before it sends one again."""
    while True:
        link.send(packet(count, pulse))
        try:
            line = json.loads(link.recv(65536))
        except TimeoutError:
            continue
        except ConnectionRefusedError:
            # Nobody is there yet, which is known at once.
            time.sleep(0.1)
            continue
        if lose and count % lose == 0:
            lose = 0
            continue
        return line


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--at", default="127.0.0.1:9002", help="where fspid waits")
    for name in ("lose", "late", "nonsense"):
        parser.add_argument(f"--{name}", type=int, default=0, metavar="N")
    arguments = parser.parse_args()
    host, port = arguments.at.rsplit(":", 1)
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.connect((host, int(port)))
    link.settimeout(0.5)
    pilot, count, pulse, last_s = Pilot(), 1, 1500, 0.0
    while True:
        line = answer(link, count, pulse, arguments.lose)
        if line["timestamp"] < last_s:
            pilot = Pilot()
        last_s, pulse, count = line["timestamp"], pilot.pulse(line), count + 1
        if count == arguments.nonsense:
            link.send(b"what is this?")
            return
        if arguments.late and count % arguments.late == 0 and count > 3:
            link.send(packet(count - 2, 1000))


try:
    main()
except KeyboardInterrupt:
    pass
