"""Loads of aircraft that `fspid aircraft import` makes of JSBSim's files, held against JSBSim itself at random states.

tables.py EXAMPLE [FILE.xml … | --fixture FILE.xml OUT.csv]

EXAMPLE is the program of `cargo build --workspace --example jsbsim`. Without files the aircraft of the package are tried, and a table
is printed of those that convert and why others do not. JSBSim flies a copy of each file without its flight control system,
engines and outside forces, so that surfaces stand where they are put; the state stands still while loads and the rate of
the angle of attack settle. Lift by the rate of the angle of attack is taken out of both where drag goes with the square of
lift: JSBSim squares that lift too, from the frame before.
"""

import os
import random
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import jsbsim

STATES = 40
NEAR = 2e-9
HELD = {"fcs/flap-pos-deg": 0.0, "fcs/flap-pos-norm": 0.0, "gear/gear-pos-norm": 0.0, "fcs/speedbrake-pos-norm": 0.0}
READ = (
    "velocities/vt-fps aero/alpha-rad aero/beta-rad velocities/p-aero-rad_sec velocities/q-aero-rad_sec "
    "velocities/r-aero-rad_sec velocities/mach position/h-sl-ft atmosphere/rho-slugs_ft3 fcs/elevator-pos-rad "
    "fcs/left-aileron-pos-rad fcs/rudder-pos-rad aero/alphadot-rad_sec"
).split()
LOADS = [f"forces/fb{axis}-aero-lbs" for axis in "xyz"] + [f"moments/{axis}-aero-lbsft" for axis in "lmn"]
MASS = ["mass-slugs"] + [f"{name}-slugs_ft2" for name in ("ixx", "iyy", "izz", "ixz")] + ["cg-x-in", "cg-z-in"]


def stripped(path, without_rate_of_lift):
    """The file as far as its aerodynamics need it."""
    tree = ElementTree.parse(path)
    root = tree.getroot()
    scales = [it for it in root.iter("aerosurface_scale") if (it.findtext("input") or "").strip() in READ]
    for part in list(root):
        if part.tag not in ("metrics", "mass_balance", "aerodynamics"):
            root.remove(part)
    if scales:
        system = ElementTree.SubElement(root, "flight_control", name="scales")
        ElementTree.SubElement(system, "channel", name="scales").extend(scales)
    if without_rate_of_lift:
        for axis in root.iter("axis"):
            if axis.get("name") == "LIFT":
                for function in list(axis):
                    if any((it.text or "").strip() == "aero/alphadot-rad_sec" for it in function.iter()):
                        axis.remove(function)
    root.append(ElementTree.Element("ground_reactions"))
    return ElementTree.tostring(root, encoding="unicode")


def flown(text, full, held, seed):
    """States and loads of JSBSim, and the mass of the whole file."""
    folder = tempfile.mkdtemp()
    os.makedirs(f"{folder}/aircraft/flown")
    with open(f"{folder}/aircraft/flown/flown.xml", "w") as file:
        file.write(text)
    executive = jsbsim.FGFDMExec(folder)
    for name, value in held.items():
        executive[name] = value
    if not executive.load_model("flown"):
        raise RuntimeError("JSBSim does not load it")
    draw = random.Random(seed)
    rows = []
    for _ in range(STATES):
        executive["ic/h-sl-ft"] = draw.uniform(3000.0, 20000.0)
        executive["ic/vt-fps"] = draw.uniform(150.0, 700.0)
        executive["ic/alpha-deg"] = draw.uniform(-4.0, 14.0)
        executive["ic/beta-deg"] = draw.uniform(-8.0, 8.0)
        for axis in "pqr":
            executive[f"ic/{axis}-rad_sec"] = draw.uniform(-0.3, 0.3)
        executive.run_ic()
        for name, value in {**HELD, **held}.items():
            executive[name] = value
        for surface in ("elevator", "left-aileron", "rudder"):
            executive[f"fcs/{surface}-pos-rad"] = draw.uniform(-0.3, 0.3)
        executive["fcs/right-aileron-pos-rad"] = -executive["fcs/left-aileron-pos-rad"]
        executive.suspend_integration()
        for _ in range(12):
            executive.run()
        rows.append(([executive[name] for name in READ], [executive[name] for name in LOADS]))
        executive.resume_integration()
    return rows, [executive[f"inertia/{name}"] for name in ("cg-x-in", "cg-y-in", "cg-z-in")]


def about_reference(loads, centre_ft):
    """Moments about the aerodynamic reference point, of those about a centre of mass forward, right and down of it."""
    (x, y, z), (fx, fy, fz) = centre_ft, loads[:3]
    turned = (y * fz - z * fy, z * fx - x * fz, x * fy - y * fx)
    return loads[:3] + [moment + arm for moment, arm in zip(loads[3:], turned)]


def reference_ft(path, centre_in):
    """A place of the structural frame from the aerodynamic reference point."""
    metrics = ElementTree.parse(path).getroot().find("metrics")
    place = next(it for it in metrics.iter("location") if (it.get("name") or "").upper() == "AERORP")
    unit = {"IN": 1 / 12, "FT": 1.0, "M": 1 / 0.3048}[place.get("unit", "IN").upper()]
    aft, right, up = (float(place.find(axis).text) * unit for axis in "xyz")
    x, y, z = (value / 12 for value in centre_in)
    return (-(x - aft), y - right, -(z - up))


def answered(example, text, states, held):
    """What the example says of a file at states: mass and loads, or its problems."""
    with tempfile.NamedTemporaryFile("w", suffix=".xml", delete=False) as file:
        file.write(text)
    words = [f"{name}={value}" for name, value in held.items()]
    lines = "".join(" ".join(repr(value) for value in state) + "\n" for state in states)
    done = subprocess.run([example, file.name, *words], input=lines, capture_output=True, text=True)
    if done.returncode != 0:
        return None, None, done.stderr.strip()
    mass, *loads = ([float(word) for word in line.split()] for line in done.stdout.splitlines())
    return mass, loads, ""


def compared(example, path, held, seed=1):
    """Largest difference of loads, as a part of the largest load of its kind; or why there is none."""
    with open(path, encoding="utf-8") as file:
        whole = file.read()
    mass, _, problems = answered(example, whole, [], held)
    if problems:
        return None, problems
    squares = "aero/cl-squared" in whole
    text = stripped(path, squares)
    states, centre_in = flown(text, path, held, seed)
    _, loads, problems = answered(example, text, [state for state, _ in states], held)
    if problems:
        return None, problems
    own_mass, _, _ = answered(example, text, [], held)
    theirs = [about_reference(load, reference_ft(path, centre_in)) for _, load in states]
    ours = [about_reference(load, (own_mass[5], 0.0, own_mass[6])) for load in loads]
    force = max(abs(value) for load in theirs for value in load[:3]) or 1.0
    moment = max(abs(value) for load in theirs for value in load[3:]) or 1.0
    scales = [force] * 3 + [moment] * 3
    worst = max(abs(a - b) / scale for one, two in zip(ours, theirs) for a, b, scale in zip(one, two, scales))
    return worst, mass


def whole_mass(name):
    """Mass, inertia and centre of mass of an aircraft of the package, tanks as its file has them."""
    executive = jsbsim.FGFDMExec(jsbsim.get_default_root_dir())
    if name == "L17":
        executive["fcs/flaps-pos-deg"] = 0.0  # It reads it, and nobody makes it.
    if not executive.load_model(name):
        return None
    executive.disable_output()
    executive["ic/h-sl-ft"] = 5000.0
    executive.run_ic()
    return [executive[f"inertia/{it}"] for it in MASS]


def masses(name, path, found):
    """Largest difference of mass and moments as parts of theirs, and of the product as a part of the largest moment."""
    theirs = whole_mass(name)
    if theirs is None:
        return float("nan")
    x, _, z = reference_ft(path, (theirs[5], 0.0, theirs[6]))
    off = [abs(a / b - 1.0) for a, b in zip(found[:4], theirs[:4])]
    # JSBSim shows the element of the matrix, which is the negative of the product.
    off.append(abs(found[4] + theirs[4]) / max(theirs[1:4]))
    off += [abs(found[5] - x), abs(found[6] - z)]
    return max(off)


def fixture(example, path, out):
    """Writes states and loads of an aircraft, for a test that has no JSBSim."""
    text = stripped(path, True)
    rows, centre_in = flown(text, path, {}, 7)
    centre = reference_ft(path, centre_in)
    with open(out, "w") as file:
        file.write("# " + jsbsim.__version__ + ", checks/jsbsim/tables.py; loads about the aerodynamic reference point, lbf and ft lbf\n")
        file.write(",".join(READ + LOADS) + "\n")
        for state, loads in rows:
            numbers = state + about_reference(loads, centre)
            file.write(",".join(repr(value) for value in numbers) + "\n")
    print(f"{len(rows)} states of JSBSim {jsbsim.__version__} in {out}")


def main():
    jsbsim.FGJSBBase().debug_lvl = 0
    example, *names = sys.argv[1:]
    if names[:1] == ["--fixture"]:
        return fixture(example, *names[1:])
    root = os.path.join(jsbsim.get_default_root_dir(), "aircraft")
    shipped = [f"{root}/{name}/{name}.xml" for name in sorted(os.listdir(root))]
    failed = 0
    for path in names or [path for path in shipped if os.path.exists(path)]:
        name = os.path.basename(path)[: -len(".xml")]
        try:
            worst, found = compared(example, path, {})
        except Exception as error:
            worst, found = None, f"JSBSim: {error}"
        if worst is None:
            print(f"{name}: no: " + " | ".join(found.splitlines()))
            continue
        try:
            off = masses(name, path, found) if not names else float("nan")
        except Exception as error:
            off = float("nan")
            print(f"{name}: JSBSim does not fly the whole: {error}")
        failed += not worst < NEAR or off > 1e-6
        print(f"{name}: yes: loads within {worst:.1e}, body within {off:.1e}")
    sys.exit(1 if failed else 0)


main()
