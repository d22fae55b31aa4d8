"""Packets of MAVLink, made by pymavlink, and the lines that a pitch loop makes of them.

The frames are those of pymavlink's generated dialect; the lines are written down here from the definitions of the messages,
without a look at the Rust code. `packets.jsonl` has a sequence in each line: packets in hexadecimal digits, which one listener
hears one after the other, the lines that come of them, and how many damages are told.
"""
import json
import math
import os
from pathlib import Path

os.environ["MAVLINK20"] = "1"
from pymavlink.dialects.v20 import common  # noqa: E402
import struct  # noqa: E402

PATH = Path(__file__).resolve().parent.parent / "crates/fspid-mavlink/tests/data/packets.jsonl"


def single(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


class Sender:
    def __init__(self, system=1, component=1, v1=False):
        self.mav = common.MAVLink(None, srcSystem=system, srcComponent=component)
        self.v1 = v1

    def pack(self, message):
        return message.pack(self.mav, force_mavlink1=self.v1)

    def attitude(self, time_ms, roll=0.0, pitch=0.0, rate=0.0):
        return self.pack(common.MAVLink_attitude_message(time_ms, roll, pitch, 0.3, 0.01, rate, -0.02))

    def target(self, quaternion, mask=0):
        return self.pack(common.MAVLink_attitude_target_message(0, mask, quaternion, 0, 0, 0, 0.5))

    def desired(self, pitch_deg):
        return self.pack(common.MAVLink_nav_controller_output_message(1.5, pitch_deg, 10, 20, 30, 0, 0, 0))

    def flight(self, airspeed, altitude, climb, throttle):
        return self.pack(common.MAVLink_vfr_hud_message(airspeed, airspeed + 1, 90, throttle, altitude, climb))

    def servos(self, pulses, port=0):
        return self.pack(common.MAVLink_servo_output_raw_message(123456, port, *pulses))

    def heartbeat(self):
        return self.pack(common.MAVLink_heartbeat_message(1, 12, 81, 0, 4, 3))


def quaternion(roll, pitch, yaw):
    """Of a rotation by yaw, then pitch, then roll, north, east, down."""
    cr, sr, cp, sp = math.cos(roll / 2), math.sin(roll / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy]


def line(time_ms, roll=0.0, pitch=0.0, rate=0.0, **held):
    told = {"time_s": time_ms / 1000, "measurement_deg": math.degrees(single(pitch)), "rate_deg_s": math.degrees(single(rate)), "roll_deg": math.degrees(single(roll))}
    return told | held


def sequences():
    for v1 in (False, True):
        a = Sender(v1=v1)
        name = "version 1" if v1 else "version 2"
        yield f"{name}: an attitude", [a.attitude(2000, 0.1, 0.125, 0.5)], [line(2000, 0.1, 0.125, 0.5)], 0
        yield f"{name}: an attitude of zeros", [a.attitude(0)], [line(0)], 0
        yield (
            f"{name}: set-points, speeds and servos beside attitudes, in packets of several frames",
            [
                a.heartbeat() + a.attitude(100, 0, 0.01, 0),
                a.target(quaternion(0.2, 0.0872664626, 1.0)) + a.attitude(110, 0, 0.02, 0.1) + a.attitude(120, 0, 0.03, 0.1),
                a.flight(21.5, 120.25, -0.5, 55) + a.servos([1500, 0, 1100, 65535, 0, 0, 0, 1900]),
                a.servos([1, 2, 3, 4, 5, 6, 7, 8], port=1),
                a.attitude(130, 0, 0.04, 0.1),
                a.target(quaternion(-0.5, -0.4, -2.0)) + a.attitude(140),
            ],
            [
                line(100, 0, 0.01, 0),
                line(110, 0, 0.02, 0.1, setpoint_deg=5.0),
                line(120, 0, 0.03, 0.1, setpoint_deg=5.0),
                line(130, 0, 0.04, 0.1, setpoint_deg=5.0, airspeed_m_s=21.5, altitude_m=120.25, climb_m_s=-0.5, throttle_pct=55, servo_1_us=1500, servo_3_us=1100, servo_8_us=1900),
                line(140, setpoint_deg=math.degrees(-0.4), airspeed_m_s=21.5, altitude_m=120.25, climb_m_s=-0.5, throttle_pct=55, servo_1_us=1500, servo_3_us=1100, servo_8_us=1900),
            ],
            0,
        )
    a, b = Sender(), Sender(system=2)
    signed = Sender()
    signed.mav.signing.secret_key = bytes(range(32))
    signed.mav.signing.sign_outgoing = True
    signed.mav.signing.link_id, signed.mav.signing.timestamp = 1, 1000
    yield "signed frames are read", [signed.attitude(5, 0, 0.1, 0) + signed.attitude(6, 0, 0.2, 0)], [line(5, 0, 0.1), line(6, 0, 0.2)], 0
    yield (
        "a desired pitch counts until a target is told",
        [a.attitude(1) + a.desired(3.5) + a.attitude(2) + a.target(quaternion(0, 0.1, 0)) + a.desired(9) + a.attitude(3)],
        [line(1), line(2, setpoint_deg=3.5), line(3, setpoint_deg=math.degrees(0.1))],
        0,
    )
    yield (
        "a target that ignores the attitude is none",
        [a.attitude(1) + a.target(quaternion(0, 0.1, 0)) + a.attitude(2) + a.target(quaternion(0, 0.1, 0), mask=128) + a.attitude(3)],
        [line(1), line(2, setpoint_deg=math.degrees(0.1)), line(3)],
        0,
    )
    yield (
        "what an autopilot said before it began anew is forgotten",
        [a.attitude(90_000) + a.desired(3.5) + a.attitude(90_010) + a.attitude(90_005) + a.attitude(1)],
        [line(90_000), line(90_010, setpoint_deg=3.5), line(90_005, setpoint_deg=3.5), line(1)],
        0,
    )
    yield "another system is not joined", [a.attitude(1) + b.desired(7) + b.attitude(2, 0, 0.5, 0) + a.attitude(3)], [line(1), line(3)], 0
    gimbal = Sender(component=154)
    yield "an autopilot is preferred to a gimbal", [gimbal.attitude(1) + a.attitude(2) + gimbal.attitude(3) + a.attitude(4)], [line(1), line(2), line(4)], 0
    yield (
        "who is not heard any more is not followed",
        [a.attitude(1)] + [b.attitude(k) for k in range(2, 104)],
        [line(1), line(102), line(103)],
        0,
    )
    nan, infinity = float("nan"), float("inf")
    yield (
        "what is no number is told and not passed on",
        [a.attitude(1) + a.attitude(2, 0, nan, 0) + a.attitude(3, 0, 0, infinity), a.desired(nan) + a.flight(nan, 1, 1, 1) + a.target([nan, 0, 0, 0]) + a.target([0, 0, 0, 0]) + a.target([2, 0, 0, 0]) + a.attitude(4)],
        [line(1), line(4)],
        7,
    )
    whole = a.attitude(2, 0, 0.25, 0)
    yield "a wrong checksum is told, and what follows is read", [whole[:-1] + bytes([whole[-1] ^ 1]) + a.attitude(3)], [line(3)], 1
    beat = a.heartbeat()
    yield "a wrong checksum of what is not read is told too", [beat[:-1] + bytes([beat[-1] ^ 1]) + a.attitude(3)], [line(3)], 1
    yield "a frame that is cut off is told", [a.attitude(1) + whole[:-3], whole[:1], whole[:9]], [line(1)], 3
    yield "what is no frame is told", [a.attitude(1) + b"{}" + whole], [line(1)], 1
    unknown = bytes([0xFD, 3, 0, 0, 0, 1, 1, 0x39, 0x30, 0, 1, 2, 3, 0xAB, 0xCD])
    yield "an unknown message is passed over", [unknown + a.attitude(1)], [line(1)], 0
    flags = bytes([whole[0], whole[1], 2]) + whole[3:]
    yield "a flag that nobody knows is told", [flags + a.attitude(1)], [], 1


def main():
    rows = [{"name": name, "packets": [packet.hex() for packet in packets], "lines": lines, "damages": damages} for name, packets, lines, damages in sequences()]
    PATH.write_text("".join(json.dumps(row) + "\n" for row in rows), newline="\n")
    print(f"fspid-mavlink/packets.jsonl: {len(rows)} sequences, {PATH.stat().st_size} bytes")


main()
