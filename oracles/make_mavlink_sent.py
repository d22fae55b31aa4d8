"""Frames of MAVLink 2 that fspid sends, made by pymavlink.

A line of `sent.jsonl` has the numbers of a message as its definition in `common.xml` has them (in the units of the wire, where
those are not ours they are turned here), and the frame in hexadecimal digits. Frames are numbered from 0 on, of system 42 and
component 1. What the Rust code encodes must be these bytes.
"""
import json
import math
import os
from pathlib import Path

os.environ["MAVLINK20"] = "1"
from pymavlink.dialects.v20 import common  # noqa: E402

PATH = Path(__file__).resolve().parent.parent / "crates/fspid-mavlink/tests/data/sent.jsonl"
NONE = 32767
IGNORED = 65535


def messages():
    yield "heartbeat", {}, common.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3)
    yield (
        "sensors",
        {"time_us": 4000, "felt_m_s2": [0.5, -0.25, -9.75], "rates_rad_s": [0.125, 0.1, -0.01], "field_gauss": [0.21, 0.0, 0.45], "pressure_pa": 89874.5, "dynamic_pressure_pa": 1389.5, "pressure_altitude_m": 1000.0, "temperature_k": 281.65},
        common.MAVLink_hil_sensor_message(4000, 0.5, -0.25, -9.75, 0.125, 0.1, -0.01, 0.21, 0.0, 0.45, 89874.5 / 100, 1389.5 / 100, 1000.0, 281.65 - 273.15, 0x1FFF),
    )
    place = {"time_us": 2**40 + 5, "latitude_deg": 47.3977418, "longitude_deg": -122.375, "altitude_m": 488.125, "velocity_m_s": [-12.34, 5.0, 0.5]}
    speed, course = math.hypot(-12.34, 5.0), math.degrees(math.atan2(5.0, -12.34))
    yield (
        "gps",
        place,
        common.MAVLink_hil_gps_message(2**40 + 5, 3, 473977418, -1223750000, 488125, 100, 100, round(speed * 100), -1234, 500, 50, round(course * 100), 10),
    )
    west = dict(place, velocity_m_s=[0.0, -20.0, 0.0])
    yield "gps", west, common.MAVLink_hil_gps_message(2**40 + 5, 3, 473977418, -1223750000, 488125, 100, 100, 2000, 0, -2000, 0, 27000, 10)
    yield (
        "state",
        dict(place, quaternion=[0.9238795, 0.0, 0.3826834, 0.0], rates_rad_s=[0.0, 0.25, 0.0], airspeed_m_s=21.5, indicated_m_s=20.25, felt_g=[0.5, 0.0, -1.25]),
        common.MAVLink_hil_state_quaternion_message(2**40 + 5, [0.9238795, 0.0, 0.3826834, 0.0], 0.0, 0.25, 0.0, 473977418, -1223750000, 488125, -1234, 500, 50, 2025, 2150, 500, 0, -1250),
    )
    pulses = [1500, 1750, 1000, 1500, 2000, 1500, 1500, 1500, 1500, 1500, 1500, 1100]
    yield "remote", {"time_us": 77, "pulses_us": pulses}, common.MAVLink_hil_rc_inputs_raw_message(77, *pulses, 255)
    q = [math.cos(0.05), 0.0, math.sin(0.05), 0.0]
    yield "target", {"to": [1, 1], "time_ms": 1234, "quaternion": q, "thrust": 0.6}, common.MAVLink_set_attitude_target_message(1234, 1, 1, 7, q, 0, 0, 0, 0.6)
    yield "target", {"to": [3, 0], "time_ms": 0, "quaternion": q, "thrust": None}, common.MAVLink_set_attitude_target_message(0, 3, 0, 71, q, 0, 0, 0, 0)
    for channel, pulse in ((1, 1623), (7, 0), (0, 1000)):
        channels = [pulse if place == channel else IGNORED for place in range(8)]
        yield "override", {"to": [1, 1], "channel": channel, "pulse_us": pulse}, common.MAVLink_rc_channels_override_message(1, 1, *channels)
    yield "manual", {"to": [1, 1], "forward": -250}, common.MAVLink_manual_control_message(1, -250, NONE, NONE, NONE, 0)
    yield "ask", {"to": [1, 1], "interval_us": 10000.0}, common.MAVLink_command_long_message(1, 1, 511, 0, 30, 10000, 0, 0, 0, 0, 0)


def main():
    mav = common.MAVLink(None, srcSystem=42, srcComponent=1)
    rows = []
    for kind, values, message in messages():
        rows.append({"kind": kind, "values": values, "frame": message.pack(mav).hex()})
        mav.seq = (mav.seq + 1) % 256
    rows += controls()
    PATH.write_text("".join(json.dumps(row) + "\n" for row in rows), newline="\n")
    print(f"fspid-mavlink/sent.jsonl: {len(rows)} frames, {PATH.stat().st_size} bytes")


def controls():
    """What PX4 sends: it is decoded."""
    mav = common.MAVLink(None, srcSystem=1, srcComponent=1)
    for time_us, mode, flags, values in ((4000, 129, 1, [0.5, -0.25, 0.75] + [0.0] * 13), (2**50, 0, 0, [0.0] * 15 + [1.0]), (8000, 128, 1, [0.0] * 16)):
        message = common.MAVLink_hil_actuator_controls_message(time_us, values, mode, flags)
        told = {"time_us": time_us, "controls": values, "is_armed": bool(mode & 128), "is_lockstep": bool(flags & 1)}
        yield {"kind": "controls", "values": told, "frame": message.pack(mav).hex()}


main()
