"""Flies the shipped designs, and the PID that was tuned alike, at trims of JSBSim; called by designs.sh.

Everything but the aircraft is that of the design's file: servo, noise, the change of trim, the step of 5 deg, and the same
down. Prints the table in Markdown. The commands `fspid simulate` gives the numbers: IAE and way of the elevator command's
servo as the simulator shows it.
"""

import json
import os
import re
import subprocess
import sys

FSPID, ROOT, WORK = sys.argv[1:4]

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
MEASURES = ("iae_deg_s", "elevator_travel_deg", "overshoot_pct")
# Asked for their numbers; the limit of the overshoot is that of the design.
ASKED = "".join(
    f'[[requirement]]\nmeasure = "{measure}"\nmost = {10.0 if measure == "overshoot_pct" else 1e6!r}\n' for measure in MEASURES
)
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


def flown(design, condition):
    """Of each controller, measures summed over the step up and the one down, the largest overshoot, and the verdicts."""
    path = scenario(design, *condition[:3])
    all_of = {}
    for more in ([], DOWN):
        done = subprocess.run(
            [FSPID, "simulate", path, "--format", "json", *more], capture_output=True, text=True, env=os.environ
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


def main():
    for design, conditions in CONDITIONS.items():
        print(f"\n| {design} on | IAE PID, deg s | controller | IAE, of the PID's | elevator travel, of the PID's | overshoot (PID) | verdict (PID) |")
        print("| --- | --- | --- | --- | --- | --- | --- |")
        sums = {}
        for condition in conditions:
            aircraft, _, altitude_ft, speed = condition
            all_of = flown(design, condition)
            pid = all_of.pop("PID")
            for place, (name, of) in enumerate(all_of.items()):
                iae, travel = (of[measure] / pid[measure] for measure in MEASURES[:2])
                sums.setdefault(name, []).append((of, pid))
                where = f"{aircraft}, {altitude_ft} ft, {speed}" if place == 0 else ""
                own = f"{0.5 * pid['iae_deg_s']:.2f}" if place == 0 else ""
                words = [", ".join(sorted(it["verdicts"])) for it in (of, pid)]
                overs = [f"{it['overshoot_pct']:.1f} %" for it in (of, pid)]
                print(f"| {where} | {own} | {name} | {iae:.3f} | {travel:.3f} | {overs[0]} ({overs[1]}) | {words[0]} ({words[1]}) |")
        for name, pairs in sums.items():
            means = [sum(of[m] for of, _ in pairs) / sum(pid[m] for _, pid in pairs) for m in MEASURES[:2]]
            ratios = sum(of["iae_deg_s"] / pid["iae_deg_s"] for of, pid in pairs) / len(pairs)
            print(f"| all {len(pairs)} | | {name} | {means[0]:.3f} of the mean, ratios {ratios:.3f} | {means[1]:.3f} of the mean | | |")


main()
