"""Flies one JSBSim aircraft for fspid: settings as arguments, samples over the socket that is standard input.

A fresh executive for each flight, and a process for each: a reset of one does not repeat for several aircraft. All that
JSBSim prints goes to standard error. Frames are in the order of bytes of the machine, as fspid writes them.
"""
import math
import os
import struct
import sys

# Nothing of the folder in which fspid was called is part of this program.
sys.path[:] = [path for path in sys.path if path]
import socket  # noqa: E402
import threading  # noqa: E402

FOOT_M = 0.3048
KNOT_M_S = 1852.0 / 3600.0
READY, REFUSED, HOST, LINEAR = 0, 1, 2, 3
# Of a sample.
SHOWN = (
    "attitude/theta-rad", "velocities/q-rad_sec", "attitude/phi-rad", "velocities/vt-fps", "position/h-sl-ft",
    "position/h-agl-ft", "aero/alpha-rad", "fcs/elevator-pos-rad", "fcs/left-aileron-pos-rad",
    "velocities/u-fps", "velocities/v-fps", "velocities/w-fps",
    "velocities/u-aero-fps", "velocities/v-aero-fps", "velocities/w-aero-fps",
    "forces/fbx-total-lbs", "forces/fby-total-lbs", "forces/fbz-total-lbs", "inertia/weight-lbs", "gear/wow",
    "attitude/psi-rad", "aero/beta-rad", "velocities/p-rad_sec", "velocities/r-rad_sec", "fcs/throttle-pos-norm",
    "velocities/h-dot-fps", "velocities/v-north-fps", "velocities/v-east-fps",
    "position/distance-from-start-lat-mt", "position/distance-from-start-lon-mt",
    "accelerations/udot-ft_sec2", "accelerations/vdot-ft_sec2", "accelerations/wdot-ft_sec2",
)
# And the command of the first throttle.
NUMBERS = len(SHOWN) + 1
# Of the elevator's map: points of the normalised command, and samples until its surface stands.
MAP_POINTS, MAP_RUNS = 200, 4
# Of the law that levels the wings: normalised aileron for a radian of bank, and for a radian a second of roll.
BANK_GAIN, ROLL_RATE_GAIN = 1.0, 0.3


class Refusal(Exception):
    def __init__(self, kind, reason, allowed):
        super().__init__(reason)
        self.kind, self.reason, self.allowed = kind, reason, allowed


def text(words):
    data = words.encode("utf-8", "replace")[:4096]
    return struct.pack("=I", len(data)) + data


def load_jsbsim(asked):
    try:
        import jsbsim
    except ImportError as error:
        raise Refusal(
            HOST,
            f"{sys.executable} has no package jsbsim ({error}); pip install jsbsim=={asked['version']}, or name another "
            "Python in the environment variable FSPID_PYTHON",
            "",
        ) from error
    if jsbsim.__version__ != asked["version"]:
        raise Refusal(
            HOST,
            f"version {jsbsim.__version__} is installed, and the scenario flies version {asked['version']}: another one flies "
            f"another flight; pip install jsbsim=={asked['version']}, or version = \"{jsbsim.__version__}\" in the scenario",
            "",
        )
    return jsbsim


def near(name, names):
    import difflib

    found = difflib.get_close_matches(name.lower(), [known.lower() for known in names], 3, 0.5)
    found = [known for known in names if known.lower() in found]
    return found or sorted(names)[:8]


def loaded(jsbsim, asked):
    """The aircraft in a fresh executive, trimmed."""
    jsbsim.FGJSBBase().debug_lvl = 0
    package = jsbsim.get_default_root_dir()
    root = asked.get("folder", package)
    executive = jsbsim.FGFDMExec(root)
    for part, of in (("engine", executive.set_engine_path), ("systems", executive.set_systems_path)):
        own = os.path.join(root, part)
        of(own if os.path.isdir(own) else os.path.join(package, part))
    # Nothing is written beside the flight: logs of a model's own go where nothing is kept.
    executive.set_output_path(asked["scratch"])
    name = asked["aircraft"]
    folder = os.path.join(root, "aircraft")
    if not os.path.isfile(os.path.join(folder, name, name + ".xml")):
        names = os.listdir(folder) if os.path.isdir(folder) else []
        names = [known for known in names if os.path.isfile(os.path.join(folder, known, known + ".xml"))]
        raise Refusal(REFUSED, f"there is no aircraft {name}", "one of its aircraft, such as " + ", ".join(near(name, names)))
    # Read by L17, and made by nobody.
    executive["fcs/flaps-pos-deg"] = 0.0
    if not executive.load_model(name):
        raise Refusal(REFUSED, f"cannot load {name}: " + "{said}", "an aircraft that JSBSim loads")
    executive.disable_output()
    executive.disable_input()
    executive.set_dt(asked["step_s"])
    executive["simulation/randomseed"] = asked["seed"]
    executive["ic/h-sl-ft"] = asked["altitude_m"] / FOOT_M
    kind, speed = asked["speed"]
    if kind == "mach":
        executive["ic/mach"] = speed
    else:
        executive["ic/vt-kts" if kind == "true" else "ic/vc-kts"] = speed / KNOT_M_S
    executive["ic/gamma-rad"] = asked["climb_rad"]
    executive["ic/psi-true-rad"] = asked["heading_rad"]
    executive["propulsion/set-running"] = -1
    for node in ("gear/gear-cmd-norm", "gear/gear-pos-norm"):
        executive[node] = asked["gear"]
    if not executive.run_ic():
        raise Refusal(REFUSED, f"cannot begin a flight of {name}: " + "{said}", "a speed and an altitude that JSBSim takes")
    try:
        executive.do_trim(1)
    except Exception as error:
        words = f"cannot trim {name} at this condition: " + "{said}"
        raise Refusal(REFUSED, words, "a speed and an altitude at which JSBSim can trim it") from error
    return executive


def elevator_map(executive):
    """Where the elevator stands for each normalised command, with the trim as it is: rad, by the command."""
    cmd, pos = "fcs/elevator-cmd-norm", "fcs/elevator-pos-rad"
    trim = executive["fcs/pitch-trim-cmd-norm"] if known(executive, "fcs/pitch-trim-cmd-norm") else 0.0
    rest = executive[cmd]
    points = {-1.0 + 2.0 * k / MAP_POINTS for k in range(MAP_POINTS + 1)} | {rest}
    # Ranges up and down are unequal, and meet where command and trim are zero together.
    points |= {-trim} if abs(trim) < 1.0 else set()
    executive.suspend_integration()
    executive.set_trim_status(True)
    rows = []
    for command in sorted(points):
        executive[cmd] = command
        for _ in range(MAP_RUNS):
            executive.run()
        rows.append((executive[pos], command))
    for (before, _), (after, command) in zip(rows, rows[1:]):
        if after < before - 1e-6:
            words = f"the elevator turns back where its command is {command:.2f}, so that no command stands for a deflection"
            raise Refusal(REFUSED, words, "an aircraft whose elevator follows its command")
    if rows[-1][0] - rows[0][0] < 1e-3:
        raise Refusal(REFUSED, "the elevator does not follow fcs/elevator-cmd-norm", "an aircraft whose elevator does")
    return rows


def carried(executive, wind_m_s):
    """Lets the wind blow in which the trimmed aircraft begins, and the aircraft move with it: JSBSim trims in still air
    alone. Nothing else of the trim moves, engines and flight control system neither."""
    north, east = (speed / FOOT_M for speed in wind_m_s)
    rest = {
        axis: executive[name]
        for axis, name in (
            ("ic/phi-rad", "attitude/phi-rad"), ("ic/theta-rad", "attitude/theta-rad"),
            ("ic/psi-true-rad", "attitude/psi-rad"), ("ic/vn-fps", "velocities/v-north-fps"),
            ("ic/ve-fps", "velocities/v-east-fps"), ("ic/vd-fps", "velocities/v-down-fps"),
        )
    }
    executive["ic/vw-mag-fps"] = math.hypot(north, east)
    executive["ic/vw-dir-deg"] = math.degrees(math.atan2(east, north))
    rest["ic/vn-fps"] += north
    rest["ic/ve-fps"] += east
    # Angles first: JSBSim keeps the velocity over the ground where they are set.
    for name, value in rest.items():
        executive[name] = value
    executive.run_ic()


def nothing():
    """Of what an aircraft has not."""
    return 0.0


def throttles(executive, asked):
    """The commands of all engines, and where the trim has them."""
    engines = executive.get_propulsion().get_num_engines()
    names = ["fcs/throttle-cmd-norm" + ("" if k == 0 else f"[{k}]") for k in range(engines)]
    manager = executive.get_property_manager()
    nodes = [manager.get_node(name) for name in names]
    nodes = [node for node in nodes if node is not None]
    if asked["moves_throttle"] and not nodes:
        words = f"{asked['aircraft']} has no engine, and an outer loop moves its throttle"
        raise Refusal(REFUSED, words, "an aircraft with an engine, or loops that move pitch alone")
    return nodes


def known(executive, name):
    try:
        executive[name]
    except KeyError:
        return False
    return True


def knots(rows, rest):
    """The map without what is flat, so that each deflection has one command; the command at rest is kept."""
    kept = [rows[0]]
    for row in rows[1:]:
        if row[0] > kept[-1][0] + 1e-9:
            kept.append(row)
        elif abs(row[1] - rest) < abs(kept[-1][1] - rest):
            kept[-1] = (kept[-1][0], row[1])
    return [row[0] for row in kept], [row[1] for row in kept]


def linearised(jsbsim, asked, wire):
    """The longitudinal motion around the trim by central differences: what moves, by u, w, q, theta and the elevator; beside
    it what JSBSim's own linearisation says of the same. Engines and propellers turn steadily at each point, as there."""
    executive = loaded(jsbsim, asked)
    outs = (
        "accelerations/udot-ft_sec2", "accelerations/wdot-ft_sec2", "accelerations/qdot-rad_sec2",
        "velocities/thetadot-rad_sec",
    )
    rest = {
        axis: executive[name]
        for axis, name in (
            ("ic/phi-rad", "attitude/phi-rad"), ("ic/theta-rad", "attitude/theta-rad"),
            ("ic/psi-true-rad", "attitude/psi-rad"), ("ic/u-fps", "velocities/u-fps"),
            ("ic/v-fps", "velocities/v-fps"), ("ic/w-fps", "velocities/w-fps"),
            ("ic/p-rad_sec", "velocities/p-rad_sec"), ("ic/q-rad_sec", "velocities/q-rad_sec"),
            ("ic/r-rad_sec", "velocities/r-rad_sec"),
        )
    }
    speed, alpha = executive["velocities/vt-fps"], executive["aero/alpha-rad"]
    elevator, theta = executive["fcs/elevator-pos-rad"], executive["attitude/theta-rad"]
    mach, span = executive["velocities/mach"], executive["metrics/bw-ft"]
    command = executive["fcs/elevator-cmd-norm"]

    def rates(axis=None, by=0.0, more=0.0):
        executive["fcs/elevator-cmd-norm"] = command + more
        # Angles first: JSBSim keeps the velocity over the ground where they are set.
        for name, value in rest.items():
            executive[name] = value + (by if name == axis else 0.0)
        # Where it is trimmed, lags of its flight control system let through what they get.
        executive.set_trim_status(more != 0.0)
        executive.run_ic()
        executive.get_propulsion().get_steady_state()
        executive.suspend_integration()
        for _ in range(10):
            executive.run()
        executive.resume_integration()
        executive.set_trim_status(False)
        return [executive[name] for name in outs], executive["fcs/elevator-pos-rad"]

    columns = []
    steps = (("ic/u-fps", 1e-3 * speed), ("ic/w-fps", 1e-3 * speed), ("ic/q-rad_sec", 1e-3), ("ic/theta-rad", 1e-3))
    for axis, half in steps:
        (more, _), (less, _) = rates(axis, half), rates(axis, -half)
        columns.append([(a - b) / (2.0 * half) for a, b in zip(more, less)])
    (more, down), (less, up) = rates(more=0.02), rates(more=-0.02)
    if abs(down - up) < 1e-6:
        raise Refusal(REFUSED, "the elevator does not follow fcs/elevator-cmd-norm", "an aircraft whose elevator does")
    by_elevator = [(a - b) / (down - up) for a, b in zip(more, less)]
    del executive
    fresh = loaded(jsbsim, asked)
    own = jsbsim.FGLinearization(fresh)
    names, inputs = list(own.x_names), list(own.u_names)
    places = [names.index(name) for name in ("Vt", "Alpha", "Q", "Theta")]
    check = [float(own.system_matrix[row][column]) for row in places for column in places]
    slope = (down - up) / 0.04
    check += [float(own.input_matrix[row][inputs.index("DeCmd")]) / slope for row in places]
    numbers = [columns[column][row] for row in range(4) for column in range(4)] + by_elevator + check
    numbers += [speed, alpha, elevator, theta, mach, span]
    wire.sendall(struct.pack("=B", LINEAR) + struct.pack(f"=I{len(numbers)}d", len(numbers), *numbers))


def flight(asked, wire):
    jsbsim = load_jsbsim(asked)
    if asked["linear"]:
        linearised(jsbsim, asked, wire)
        return
    # Measured in an executive of its own: nothing of it is left in the flight's.
    measured = loaded(jsbsim, asked)
    rows = elevator_map(measured)
    positions, commands = knots(rows, measured["fcs/elevator-cmd-norm"])
    del measured
    executive = loaded(jsbsim, asked)
    if asked["wind_m_s"] is not None:
        carried(executive, asked["wind_m_s"])
    for name, value in asked["properties"]:
        if not known(executive, name):
            raise Refusal(REFUSED, f"{asked['aircraft']} has no property {name}", "a property that JSBSim lists for it")
        executive[name] = value
    manager = executive.get_property_manager()

    def node(name):
        return manager.get_node(name) if known(executive, name) else None

    engines = throttles(executive, asked)
    gusts = [manager.get_node(f"atmosphere/gust-{axis}-fps") for axis in ("north", "east", "down")]
    # As JSBSim counts them, in feet: what is made of them is made once they are across, since a call here costs a tenth
    # of a step of JSBSim.
    shown = [node(name) for name in SHOWN] + engines[:1]
    gets = [nothing if it is None else it.get_double_value for it in shown]
    gets += [nothing] * (NUMBERS - len(gets))
    bank, roll = node("attitude/phi-rad"), node("velocities/p-rad_sec")
    elevator, aileron = (manager.get_node(f"fcs/{name}-cmd-norm") for name in ("elevator", "aileron"))
    level = aileron.get_double_value() if asked["levels_wings"] else None
    frame = struct.Struct(f"=Q{NUMBERS}d")
    # The throttle, and of each step its elevator and the air to the north, to the east and down.
    ask = struct.Struct(f"={1 + 4 * asked['steps']}d")
    wire.sendall(struct.pack("=B", READY) + text(jsbsim.__version__) + frame.pack(0, *[get() for get in gets]))
    from bisect import bisect_right

    least, most, last = positions[0], positions[-1], len(positions) - 2
    buffer = bytearray(ask.size)
    view = memoryview(buffer)
    run, receive, send, pack = executive.run, wire.recv_into, wire.sendall, frame.pack
    get_bank, get_roll, set_aileron = bank.get_double_value, roll.get_double_value, aileron.set_double_value
    set_elevator = elevator.set_double_value
    air_moves = asked["wind_m_s"] is not None
    number = 1
    while True:
        got = 0
        while got < ask.size:
            more = receive(view[got:])
            if more == 0:
                return
            got += more
        values = ask.unpack(buffer)
        if asked["moves_throttle"]:
            for engine in engines:
                engine.set_double_value(values[0])
        for place in range(1, len(values), 4):
            wanted = values[place]
            if air_moves:
                for gust, m_s in zip(gusts, values[place + 1 : place + 4]):
                    gust.set_double_value(m_s / FOOT_M)
            if wanted <= least:
                set_elevator(commands[0])
            elif wanted >= most:
                set_elevator(commands[-1])
            else:
                k = min(bisect_right(positions, wanted) - 1, last)
                share = (wanted - positions[k]) / (positions[k + 1] - positions[k])
                set_elevator(commands[k] + share * (commands[k + 1] - commands[k]))
            if level is not None:
                turned = level - (BANK_GAIN * get_bank() + ROLL_RATE_GAIN * get_roll())
                set_aileron(-1.0 if turned < -1.0 else 1.0 if turned > 1.0 else turned)
            if not run():
                # No number of a sample: it says that it cannot go on.
                send(frame.pack(0xFFFF_FFFF_FFFF_FFFF, *([0.0] * NUMBERS)))
                return
        send(pack(number, *[get() for get in gets]))
        number += 1


def end_with(parent):
    """Ends this process once nobody asks any more, of whatever the one died that did."""
    while os.getppid() == parent:
        threading.Event().wait(0.1)
    os._exit(0)


def settings(arguments):
    asked = {"properties": [], "wind_m_s": None}
    for argument in arguments:
        key, _, value = argument.partition("=")
        if key == "property":
            name, _, number = value.partition("=")
            asked["properties"].append((name, float(number)))
        elif key == "speed":
            kind, _, number = value.partition("=")
            asked["speed"] = (kind, float(number))
        elif key == "wind_m_s":
            asked["wind_m_s"] = [float(number) for number in value.split("=")]
        elif key in ("steps", "moves_throttle", "seed", "levels_wings", "linear", "parent"):
            asked[key] = int(value)
        elif key in ("aircraft", "folder", "version", "scratch"):
            asked[key] = value
        else:
            asked[key] = float(value)
    return asked


def main():
    asked = settings(sys.argv[1:])
    threading.Thread(target=end_with, args=(asked["parent"],), daemon=True).start()
    wire = socket.socket(fileno=os.dup(0))
    try:
        flight(asked, wire)
    except Refusal as refusal:
        sys.stdout.flush()
        wire.sendall(struct.pack("=B", refusal.kind) + text(refusal.reason) + text(refusal.allowed))
    except (BrokenPipeError, ConnectionResetError):
        pass
    wire.close()
    sys.stdout.flush()
    # Nothing of the simulator is left to be taken down.
    os._exit(0)


main()
