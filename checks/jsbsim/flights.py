"""What `fspid` makes of JSBSim's flights; called by check.sh with the program and a folder."""

import csv
import json
import math
import os
import resource
import subprocess
import sys
import time
import tomllib

import jsbsim

FSPID, WORK = (os.path.abspath(name) for name in sys.argv[1:3])

SCENARIO = """schema = 1
name = "{aircraft}"
[simulator]
kind = "jsbsim"
aircraft = "{aircraft}"
{speed}
altitude_ft = {altitude}
{more}
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = {period}
duration_s = {duration}
[setpoint]
kind = "step"
at_s = 1.0
amplitude_deg = 2.0
[[controller]]
name = "PID"
kind = "pid"
kp = {kp}
ki = {ki}
kd = 0.1
{behind}
"""

# Trims of JSBSim 1.3.3 with the wheels in, found by hand: angle of attack and elevator, deg, and true airspeed, ft/s.
TRIMS = [
    ("B747", "mach = 0.65", 20000, 1.982, -3.993, 674.0),
    ("B747", "mach = 0.40", 5000, 4.104, -5.998, 438.8),
    ("737", "mach = 0.65", 20000, 1.627, -2.396, 674.0),
    ("A320", "mach = 0.65", 20000, 1.397, -3.133, 674.0),
    ("MD11", "mach = 0.78", 30000, 2.778, -2.217, 776.0),
    ("L17", "calibrated_kt = 104", 1000, 2.967, -2.495, 178.1),
    ("L17", "calibrated_kt = 120", 3000, 1.080, -0.904, 211.6),
    ("c172x", "calibrated_kt = 100", 4000, 0.795, 5.142, 179.0),
    ("c172p", "calibrated_kt = 100", 4000, 0.385, 4.305, 179.0),
]


# Pitch over elevator, rad, trailing edge down positive, found by hand with JSBSim's own linearisation, and how near the
# differences come: propellers that turn steadily are found by them to some parts in a thousand.
LINEAR = [
    ("B747", "mach = 0.65", 20000, [-1.356277, -0.795228, -0.006894], [1, 1.302018, 2.197143, 0.014992, 0.006929], 2e-4),
    ("737", "mach = 0.65", 20000, [-2.549190, -1.615102, -0.014397], [1, 1.724328, 3.460765, 0.028231, 0.012378], 2e-4),
    ("A320", "mach = 0.65", 20000, [-2.907065, -1.812261, -0.007238], [1, 1.131873, 8.740804, 0.060196, 0.038569], 2e-4),
    ("MD11", "mach = 0.78", 30000, [-0.472398, -0.205542, -0.001446], [1, 0.625543, 0.441501, 0.002176, 0.001239], 5e-4),
    ("L17", "calibrated_kt = 104", 1000, [-11.067307, -15.728362, -1.027489], [1, 4.467244, 12.606831, 0.694388, 0.637133], 2e-4),
    ("c172p", "calibrated_kt = 100", 4000, [-27.710317, -76.333709, -5.320297], [1, 8.595319, 49.624334, 3.222192, 2.886770], 6e-3),
]


def write(name, aircraft, speed, altitude, **more):
    values = {"more": "", "behind": "", "period": 0.01, "duration": 10.0, "kp": 1.0, "ki": 0.8, **more}
    path = f"{WORK}/{name}.toml"
    with open(path, "w") as file:
        file.write(SCENARIO.format(aircraft=aircraft, speed=speed, altitude=altitude, **values))
    return path


def fspid(*arguments, codes=(0,)):
    done = subprocess.run([FSPID, *arguments], capture_output=True, text=True, cwd=WORK)
    assert done.returncode in codes, (arguments, done.returncode, done.stdout, done.stderr)
    return done


def rows(name):
    with open(f"{WORK}/{name}") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def trims():
    for aircraft, speed, altitude, alpha, elevator, true_ft_s in TRIMS:
        path = write("trim", aircraft, speed, altitude, duration=3.0)
        fspid("simulate", path, "--trace", "trim.csv", codes=(0, 1))
        first = rows("trim.csv")[0]
        found = (first["alpha_deg"], first["elevator_deg"], first["airspeed_m_s"] / 0.3048)
        for value, wanted, near in zip(found, (alpha, elevator, true_ft_s), (6e-4, 6e-4, 0.06)):
            assert abs(value - wanted) < near, (aircraft, found, (alpha, elevator, true_ft_s))
        assert abs(first["load_factor"] - math.cos(math.radians(alpha))) < 0.01, first
    print(f"trims: {len(TRIMS)} conditions as JSBSim's own")


def same_bits():
    path = write("same", "c172x", "calibrated_kt = 100", 4000)
    for name in ("one.csv", "two.csv"):
        fspid("simulate", path, "--trace", name)
    one, two = (open(f"{WORK}/{name}", "rb").read() for name in ("one.csv", "two.csv"))
    assert one == two
    behind = """[[dispersion]]
path = "simulator.calibrated_kt"
distribution = "uniform"
lower = 0.8
upper = 1.2
"""
    path = write("campaign", "B747", "calibrated_kt = 300", 20000, behind=behind, duration=5.0)
    for threads in ("1", "2"):
        fspid("campaign", "run", path, "--runs", "6", "--quiet", "--threads", threads, "--out", threads)
    one, two = (open(f"{WORK}/{threads}/campaign.parquet", "rb").read() for threads in "12")
    assert one == two
    print("the same bits: a flight twice, a campaign of 6 flights on 1 and 2 threads")


def linear_models():
    for aircraft, speed, altitude, numerator, denominator, near in LINEAR:
        path = write("imported", aircraft, speed, altitude)
        found = json.loads(fspid("aircraft", "import", path, "--out", "linear.toml", "--format", "json").stdout)
        theta = found["theta_over_elevator"]
        pairs = list(zip(theta["numerator"][-3:] + theta["denominator"], numerator + denominator))
        worst = max(abs(value / wanted - 1.0) for value, wanted in pairs)
        assert worst < near, (aircraft, worst, theta)
        # Flown as an aircraft of a linear model, where it can be asked what JSBSim cannot.
        text = open(path).read()
        begin, end = text.index("[simulator]"), text.index("[actuator]")
        condition = found["condition"]
        flown = f'[aircraft]\nfile = "linear.toml"\nairspeed_m_s = {condition["airspeed_m_s"]!r}\naltitude_m = {condition["altitude_m"]!r}\n'
        with open(f"{WORK}/asked.toml", "w") as file:
            file.write(text[:begin] + flown + text[end:])
        fspid("analyse", "asked.toml", "--map", "0", codes=(0, 1))
    print(f"linear models: {len(LINEAR)} as JSBSim's own")


def turbulence():
    """Turbulence shakes, and its seed is what it depends on."""
    more = """seed = {seed}
[[simulator.property]]
name = "atmosphere/turb-type"
value = 4
[[simulator.property]]
name = "atmosphere/turbulence/milspec/windspeed_at_20ft_AGL-fps"
value = 50.0
[[simulator.property]]
name = "atmosphere/turbulence/milspec/severity"
value = 4
"""
    texts = []
    for seed in (1, 1, 2):
        path = write("rough", "c172x", "calibrated_kt = 100", 4000, more=more.format(seed=seed), duration=20.0)
        fspid("simulate", path, "--trace", "rough.csv", codes=(0, 1))
        texts.append(open(f"{WORK}/rough.csv").read())
    assert texts[0] == texts[1] and texts[0] != texts[2]
    felt = [row["load_factor"] for row in rows("rough.csv")]
    bank = [abs(row["bank_deg"]) for row in rows("rough.csv")]
    assert max(felt) - min(felt) > 0.05 and max(bank) < 20.0, (max(felt), min(felt), max(bank))
    print(f"turbulence: load factor {min(felt):.2f} to {max(felt):.2f}, bank up to {max(bank):.1f} deg")


def gusts():
    """A small gust on the aircraft with its stick held, beside what the linear model of the same condition says of it:
    rates of u, w, q and pitch by the states less the air, without the gust's rate of pitch, by Runge and Kutta."""
    gust = """[[gust]]
kind = "full-cycle"
up_m_s = {up}
gradient_m = {gradient}
at_s = 1.0
"""
    for aircraft, speed, altitude, gradient in (
        ("c172p", "calibrated_kt = 100", 4000, 60.0),
        ("L17", "calibrated_kt = 104", 1000, 60.0),
        ("737", "mach = 0.65", 20000, 250.0),
        ("B747", "mach = 0.65", 20000, 250.0),
    ):
        held = {"kp": 1e-9, "ki": 0.0, "duration": 6.0}
        thetas = []
        for up in (0.0, 0.3):
            behind = gust.format(up=up, gradient=gradient) if up else ""
            path = write("gust", aircraft, speed, altitude, behind=behind, **held)
            fspid("simulate", path, "--trace", "gust.csv", "--set", "controller[0].kd=0.0", codes=(0, 1))
            thetas.append([row["theta_deg"] for row in rows("gust.csv")])
        found = [math.radians(one - still) for still, one in zip(*thetas)]
        fspid("aircraft", "import", path, "--out", "linear.toml", "--format", "json")
        with open(f"{WORK}/linear.toml", "rb") as file:
            model = tomllib.load(file)
        a = [row["by_states"] for row in model["equations"]]
        speed_m_s = model["condition"]["airspeed_m_s"]

        def rate(state, time_s):
            way = (time_s - 1.0) * speed_m_s
            down = -0.5 * 0.3 * (1.0 - math.cos(math.pi * way / gradient)) if 0.0 <= way <= 2.0 * gradient else 0.0
            relative = [state[0], state[1] - down, state[2], state[3]]
            return [sum(entry * x for entry, x in zip(row, relative)) for row in a]

        def moved(state, by, more):
            return [x + more * y for x, y in zip(state, by)]

        state, wanted, step = [0.0] * 4, [], 0.01
        for k in range(len(found)):
            wanted.append(state[3])
            time_s = k * step
            k1 = rate(state, time_s)
            k2 = rate(moved(state, k1, 0.5 * step), time_s + 0.5 * step)
            k3 = rate(moved(state, k2, 0.5 * step), time_s + 0.5 * step)
            k4 = rate(moved(state, k3, step), time_s + step)
            state = [x + step / 6.0 * (p + 2.0 * q + 2.0 * r + s) for x, p, q, r, s in zip(state, k1, k2, k3, k4)]
        largest = max(abs(value) for value in wanted)
        apart = max(abs(one - other) for one, other in zip(found, wanted)) / largest
        print(f"gust on {aircraft}: pitch up to {math.degrees(largest):.4f} deg, {100.0 * apart:.1f} % of it apart from the linear model")
        assert apart < 0.02, (aircraft, apart)


AROUND = """[[outer_loop]]
name = "altitude"
kind = "pid"
holds = "altitude"
moves = "vertical speed"
kp = 0.1
least = -2.54
most = 2.54
most_per_s = 1.0
[[outer_loop]]
name = "vertical speed"
kind = "pid"
holds = "vertical-speed"
moves = "pitch"
kp = {path}
ki = {path}
least = -10.0
most = 10.0
most_per_s = 2.0
[[outer_loop]]
name = "autothrottle"
kind = "pid"
holds = "airspeed"
moves = "throttle"
kp = 0.1
ki = 0.01
[[mode]]
name = "level"
engage = ["altitude", "vertical speed", "autothrottle"]
[[mode]]
name = "capture"
at_s = 5.0
engage = ["altitude", "vertical speed", "autothrottle"]
target = {{ altitude_ft = {altitude} }}
[[requirement]]
measure = "altitude_overshoot_ft"
target_ft = {altitude}
most = 20.0
[[requirement]]
measure = "altitude_deviation_ft"
from_s = 80.0
target_ft = {altitude}
most = 10.0
[[requirement]]
measure = "airspeed_deviation_kt"
most = 5.0
[[requirement]]
measure = "largest_alpha_deg"
most = 8.0
[[requirement]]
measure = "largest_load_factor_g"
most = 1.5
"""


def autopilots():
    """An altitude is captured, with an autothrottle, and a mode that never begins fails its flight."""
    for aircraft, speed, altitude, gain in (("c172p", "calibrated_kt = 100", 4000, 0.5), ("737", "mach = 0.65", 20000, 0.1)):
        around = AROUND.format(path=gain, altitude=altitude + 200.0)
        path = write("around", aircraft, speed, altitude, behind=around, period=0.02, duration=120.0)
        asked = ["simulate", path, "--trace", "around.csv", "--set", "setpoint.amplitude_deg=0.0", "--format", "json"]
        answer = json.loads(fspid(*asked, codes=(0, 1)).stdout)
        missed = [it for it in answer["requirements"] if not it["met"]]
        last = rows("around.csv")[-1]
        assert all(it["measure"] == "altitude_overshoot_ft" and "not reached" in json.dumps(it) for it in missed), missed
        assert abs(last["throttle"] - last["throttle_command"]) < 0.02, (last["throttle"], last["throttle_command"])
        print(
            f"autopilot on {aircraft}: {last['altitude_m'] / 0.3048:.1f} ft, "
            f"{last['airspeed_m_s']:.2f} m/s, throttle {last['throttle']:.3f}"
        )
    never = around + '[[mode]]\nname = "high"\nwhen = { altitude_above_ft = 30000.0 }\n'
    path = write("never", aircraft, speed, altitude, behind=never, period=0.02, duration=20.0)
    outcome = json.loads(fspid("simulate", path, "--format", "json", codes=(1,)).stdout)["controllers"][0]["outcome"]
    assert outcome["kind"] == "mode never began", outcome


def same_air():
    """What JSBSim shows of the air is what an aircraft of ours meets at the same speed and height, with the same seed."""
    rough = '[turbulence]\nintensity = "moderate"\nseed = 3\n'
    path = write("theirs", "c172p", "calibrated_kt = 100", 4000, behind=rough)
    fspid("simulate", path, "--trace", "theirs.csv", codes=(0, 1))
    theirs = rows("theirs.csv")
    with open(path) as file:
        text = file.read()
    own = f'[aircraft]\nname = "navion"\nairspeed_m_s = {theirs[0]["airspeed_m_s"]!r}\naltitude_ft = 4000.0\nvalidity = "warn"\n'
    text = text[: text.index("[simulator]")] + own + text[text.index("[actuator]") :]
    with open(f"{WORK}/ours.toml", "w") as file:
        file.write(text)
    fspid("simulate", "ours.toml", "--trace", "ours.csv", codes=(0, 1))
    pairs = list(zip(theirs, rows("ours.csv")))[1:]
    apart = {
        axis: max(abs(one[axis] - other[axis]) for one, other in pairs)
        for axis in ("air_forward_m_s", "air_right_m_s", "air_down_m_s")
    }
    largest = max(abs(one["air_down_m_s"]) for one, _ in pairs)
    assert len(pairs) == 1000 and largest > 2.0 and max(apart.values()) < 0.02, (len(pairs), largest, apart)
    print(f"air: {largest:.2f} m/s of turbulence, in JSBSim and around an aircraft of ours at most {max(apart.values()):.4f} m/s apart")


def told():
    wrong = [
        (("c172y", "calibrated_kt = 100", 4000), {}, "there is no aircraft c172y; allowed is one of its aircraft, such as c172"),
        (("B747", "calibrated_kt = 60", 40000), {}, "cannot trim B747 at this condition"),
        (("B747", "calibrated_kt = 60", 40000), {}, "wdot"),
        (("B747", "mach = 0.65", 20000), {"more": 'version = "1.2.1"'}, "version 1.3.3 is installed, and the scenario flies version 1.2.1"),
        (("B747", "mach = 0.65", 20000), {"more": '[[simulator.property]]\nname = "no/such"\nvalue = 1'}, "B747 has no property no/such"),
    ]
    for condition, more, words in wrong:
        done = fspid("simulate", write("wrong", *condition, **more), codes=(2,))
        assert words in done.stderr, done.stderr
    print(f"errors: {len(wrong)} by name")


# JSBSim alone, as fast as its Python package flies the same aircraft for 300 s, asked nothing meanwhile.
BARE = """
import jsbsim
jsbsim.FGJSBBase().debug_lvl = 0
executive = jsbsim.FGFDMExec(jsbsim.get_default_root_dir())
executive.set_output_path({folder!r})
executive.load_model("c172x")
executive.disable_output()
executive.set_dt(0.01)
executive["ic/h-sl-ft"], executive["ic/vc-kts"] = 4000, 100
executive["propulsion/set-running"] = -1
executive.run_ic()
executive.do_trim(1)
for _ in range(30000):
    executive.run()
"""


def spent(call):
    """By the clock, and of processors by everything that was started."""

    def now():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return time.perf_counter(), used.ru_utime + used.ru_stime

    begun = now()
    call()
    return [ended - began for began, ended in zip(begun, now())]


def speed():
    """Whole programs, starting included; the faster of two, taken in turns. On a busy machine the clock says little: who
    runs in two processes gets twice the share."""

    def alone():
        program = BARE.format(folder=WORK)
        subprocess.run([sys.executable, "-c", program], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def flown(period):
        path = write("long", "c172x", "calibrated_kt = 100", 4000, period=period, duration=300.0, kp=0.5, ki=0.4)
        fspid("simulate", path, "--format", "json", codes=(0, 1))

    turns = [(spent(alone), spent(lambda: flown(0.01)), spent(lambda: flown(0.05))) for _ in range(2)]
    bare, *times = ([min(kind) for kind in zip(*each)] for each in zip(*turns))
    for period, (clock, processors) in zip((0.01, 0.05), times):
        print(
            f"speed: 300 s of flight, a sample each {period} s: {clock:.2f} s, bare JSBSim {bare[0]:.2f} s, ratio "
            f"{bare[0] / clock:.2f}; of processors {processors:.2f} s and {bare[1]:.2f} s, ratio {bare[1] / processors:.2f}"
        )


def main():
    jsbsim.FGJSBBase().debug_lvl = 0
    for part in (trims, linear_models, same_bits, turbulence, same_air, gusts, autopilots, told, speed):
        part()
    print("c172x:", json.loads(fspid("simulate", "same.toml", "--format", "json", codes=(0, 1)).stdout)["controllers"][0]["verdict"])


main()
