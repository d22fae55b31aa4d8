"""Flies the shipped designs, or those named, and the PID that was tuned alike, at trims of JSBSim; called by designs.sh.

Everything but the aircraft is that of the design's file: servo, noise, the change of trim, the step of 5 deg, and the same
down, in calm air and in moderate turbulence. Prints the table in Markdown: means over both steps, of the PID's.
"""

import json
import os
import re
import subprocess
import sys

FSPID, ROOT, WORK = sys.argv[1:4]
NAMED = sys.argv[4:]

# The trims of checks/jsbsim/flights.py and some more of the same aircraft.
CONDITIONS = {
    "light": [
        ("L17", "calibrated_kt = 85.0", 1000, "85 kt"),
        ("L17", "calibrated_kt = 104.0", 1000, "104 kt"),
        ("L17", "calibrated_kt = 120.0", 3000, "120 kt"),
        ("c172x", "calibrated_kt = 100.0", 4000, "100 kt"),
        ("c172p", "calibrated_kt = 100.0", 4000, "100 kt"),
    ],
    "transport": [
        ("B747", "mach = 0.4", 5000, "Mach 0.40"),
        ("B747", "mach = 0.65", 10000, "Mach 0.65"),
        ("B747", "mach = 0.65", 20000, "Mach 0.65"),
        ("B747", "mach = 0.8", 35000, "Mach 0.80"),
        ("737", "mach = 0.65", 20000, "Mach 0.65"),
        ("A320", "mach = 0.65", 20000, "Mach 0.65"),
        ("MD11", "mach = 0.78", 30000, "Mach 0.78"),
    ],
}
# Which designs fly them.
DESIGNS = {
    "light": "light",
    "transport": "transport",
    "light-steps": "light",
    "light-network": "light",
    "transport-steps": "transport",
    "transport-damped": "transport",
}
MEASURES = ("iae_deg_s", "elevator_travel_deg", "overshoot_pct")
# Asked for their numbers; the limit of the overshoot is that of the design.
ASKED = "".join(
    f'[[requirement]]\nmeasure = "{measure}"\nmost = {10.0 if measure == "overshoot_pct" else 1e6!r}\n' for measure in MEASURES
)
# Turbulence of ours around JSBSim's aircraft, the same for everybody.
ROUGH = ["--set", "turbulence.intensity=moderate", "--set", "turbulence.seed=5"]
DOWN = ["--set", "setpoint.amplitude_deg=-5", "--set", "disturbance[0].amplitude_deg=-1"]


def scenario(design, aircraft, speed, altitude_ft):
    with open(f"{ROOT}/data/designs/learned/{design}.toml") as file:
        text = file.read()
    flown = f'[simulator]\nkind = "jsbsim"\naircraft = "{aircraft}"\n{speed}\naltitude_ft = {altitude_ft}.0\n\n'
    text, count = re.subn(r"\[aircraft\]\n(?:.+\n)+\n", flown, text[: text.index("[[requirement]]")])
    assert count == 1
    path = f"{WORK}/{design}.toml"
    with open(path, "w") as file:
        file.write(text + ASKED)
    return path


def flown(design, condition, air):
    """Of each controller, measures summed over the step up and the one down, the largest overshoot, and the verdicts."""
    path = scenario(design, *condition[:3])
    all_of = {}
    for more in ([], DOWN):
        done = subprocess.run(
            [FSPID, "simulate", path, "--format", "json", *more, *air], capture_output=True, text=True, env=os.environ
        )
        assert done.returncode < 2, done.stderr
        answer = json.loads(done.stdout)
        for controller in answer["controllers"]:
            of = all_of.setdefault(controller["name"], {"verdicts": set(), **dict.fromkeys(MEASURES, 0.0)})
            of["verdicts"].add(controller["verdict"])
        for requirement in answer["requirements"]:
            of, measure = all_of[requirement["controller"]], requirement["measure"]
            value = requirement.get("value")
            value = float("nan") if value is None else value
            of[measure] = max(of[measure], value) if measure == "overshoot_pct" else of[measure] + value
    return all_of


def ratios(pairs):
    """Of the sums over all flights: IAE and travel, of the PID's."""
    return [sum(of[m] for of, _ in pairs) / sum(pid[m] for _, pid in pairs) for m in MEASURES[:2]]


def words(verdicts):
    short = {"settled": "settled", "not settled within 14 s": "late"}
    return ", ".join(sorted(short.get(verdict, verdict) for verdict in verdicts))


def main():
    for design in NAMED or DESIGNS:
        kind = DESIGNS[design]
        conditions = CONDITIONS[kind]
        print(f"\n| {design}, not tuned on | IAE of the PID, deg s | controller | IAE | travel | overshoot (PID) | verdict (PID) | IAE in turbulence | travel |")
        print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
        sums = {}
        for condition in conditions:
            aircraft, _, altitude_ft, speed = condition
            calm, rough = (flown(design, condition, air) for air in ([], ROUGH))
            for place, name in enumerate(name for name in calm if name != "PID"):
                pairs = [(all_of[name], all_of["PID"]) for all_of in (calm, rough)]
                for air, pair in enumerate(pairs):
                    sums.setdefault((name, air), []).append(pair)
                where = f"{aircraft}, {altitude_ft} ft, {speed}" if place == 0 else ""
                own = f"{0.5 * calm['PID']['iae_deg_s']:.2f}" if place == 0 else ""
                of, pid = pairs[0]
                cells = [f"{value:.3f}" for pair in pairs for value in ratios([pair])]
                over = f"{of['overshoot_pct']:.1f} % ({pid['overshoot_pct']:.1f} %)"
                said = f"{words(of['verdicts'])} ({words(pid['verdicts'])})"
                print(f"| {where} | {own} | {name} | {cells[0]} | {cells[1]} | {over} | {said} | {cells[2]} | {cells[3]} |")
        for name in dict.fromkeys(name for name, _ in sums):
            cells = [f"**{value:.3f}**" for air in (0, 1) for value in ratios(sums[name, air])]
            print(f"| all {len(conditions)} | | {name} | {cells[0]} | {cells[1]} | | | {cells[2]} | {cells[3]} |")


main()
