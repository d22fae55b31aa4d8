"""An FMU in FMPy: validated, flown against its vectors, two side by side, back in time, with other parameters.

    python fmu.py FMU VECTORS single|double

Exits with 1 on any finding.
"""

import csv
import shutil
import struct
import sys
import tempfile
from pathlib import Path

import fmpy
import fmpy.build
import numpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from lxml import etree

findings = []


def expect(truth, what):
    if not truth:
        findings.append(what)


def bits(value):
    return struct.pack("<d", value)


class Flown:
    """An instance, the same for both versions."""

    def __init__(self, description, folder, name):
        self.two = description.fmiVersion == "2.0"
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        kind = FMU2Slave if self.two else FMU3Slave
        self.fmu = kind(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate(loggingOn=False)
        if self.two:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def set(self, name, value):
        (self.fmu.setReal if self.two else self.fmu.setFloat64)([self.references[name]], [value])

    def get(self, name):
        reference = [self.references[name]]
        if name == "saturated":
            return int(self.fmu.getBoolean(reference)[0])
        if name == "faults":
            return (self.fmu.getInteger if self.two else self.fmu.getInt32)(reference)[0]
        return (self.fmu.getReal if self.two else self.fmu.getFloat64)(reference)[0]

    def step(self, sample, period):
        self.fmu.doStep(currentCommunicationPoint=sample * period, communicationStepSize=period)

    def state(self):
        return self.fmu.getFMUstate() if self.two else self.fmu.getFMUState()

    def go_back(self, state):
        (self.fmu.setFMUstate if self.two else self.fmu.setFMUState)(state)

    def as_bytes(self, state):
        return (self.fmu.serializeFMUstate if self.two else self.fmu.serializeFMUState)(state)

    def from_bytes(self, written):
        return (self.fmu.deSerializeFMUstate if self.two else self.fmu.deserializeFMUState)(written)

    def free_state(self, state):
        (self.fmu.freeFMUstate if self.two else self.fmu.freeFMUState)(state)

    def end(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


def fly(it, rows, inputs, outputs, period, first):
    """How many of these samples have other bits."""
    different = 0
    for sample, row in enumerate(rows, first):
        for name in inputs:
            it.set(name, row[name])
        it.step(sample, period)
        different += any(
            (it.get(name) != row[name]) if name in ("saturated", "faults") else (bits(it.get(name)) != bits(row[name]))
            for name in outputs
        )
    return different


def described(path, folder):
    findings.extend(validate_fmu(str(path)))
    schema = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3BuildDescription.xsd"
    build = etree.parse(str(Path(folder) / "sources" / "buildDescription.xml"))
    rules = etree.XMLSchema(etree.parse(str(schema)))
    if not rules.validate(build):
        findings.extend(str(error) for error in rules.error_log)
    return fmpy.read_model_description(str(path), validate=True)


def back_in_time(description, folder, rows, inputs, outputs, period):
    half = len(rows) // 2
    it, other = (Flown(description, folder, name) for name in ("back", "takes over"))
    expect(fly(it, rows[:half], inputs, outputs, period, 0) == 0, "the first half differs")
    state = it.state()
    expect(fly(it, rows[half:], inputs, outputs, period, half) == 0, "the second half differs")
    it.go_back(state)
    expect(fly(it, rows[half:], inputs, outputs, period, half) == 0, "after a step back the second half differs")
    taken = other.from_bytes(it.as_bytes(state))
    other.go_back(taken)
    expect(fly(other, rows[half:], inputs, outputs, period, half) == 0, "from bytes the second half differs")
    it.free_state(state)
    other.free_state(taken)
    it.end()
    other.end()


def refused(description, folder):
    """Each parameter refuses what is no number, and can be set to what it starts from."""
    it = Flown(description, folder, "refuses")
    parameters = [v for v in description.modelVariables if v.causality == "parameter"]
    expect(len(parameters) >= 5, "few parameters")
    for variable in parameters:
        expect(bits(it.get(variable.name)) == bits(float(variable.start)), f"{variable.name} does not start as described")
        it.set(variable.name, float(variable.start))
        try:
            it.set(variable.name, float("nan"))
            findings.append(f"{variable.name} takes NaN")
        except FMICallException as refusal:
            expect(refusal.status == 2, f"{variable.name} is refused with status {refusal.status}")
    it.end()
    return len(parameters)


def simulated(path, description, folder, period):
    """FMPy's own simulation of a step against an instance that is asked by hand."""
    time = numpy.arange(400) * period
    inputs = [v.name for v in description.modelVariables if v.causality == "input"]
    signal = numpy.zeros(len(time), dtype=[("time", float)] + [(name, float) for name in inputs])
    signal["time"] = time
    signal[inputs[0]] = numpy.where(time >= 100 * period, 0.1, 0.0)
    result = fmpy.simulate_fmu(
        str(path), stop_time=399 * period, step_size=period, output_interval=period, input=signal, output=[command_of(description)]
    )
    it = Flown(description, folder, "by hand")
    different = 0
    for sample in range(399):
        it.set(inputs[0], 0.1 if sample >= 100 else 0.0)
        it.step(sample, period)
        different += bits(it.get(command_of(description))) != bits(float(result[command_of(description)][sample + 1]))
    it.end()
    expect(different == 0, f"FMPy's own simulation differs in {different} of 399 samples")


def command_of(description):
    return next(v.name for v in description.modelVariables if v.name.startswith("command_"))


def main(path, vectors, numbers):
    folder = fmpy.extract(str(path))
    description = described(path, folder)
    period = float(description.defaultExperiment.stepSize)
    # The digits of a number of 32 bits are those that name it among its like.
    kind = numpy.float32 if numbers == "single" else float
    with open(vectors, newline="") as file:
        rows = [{name: float(kind(value)) for name, value in row.items()} for row in csv.DictReader(file)]
    inputs = [v.name for v in description.modelVariables if v.causality == "input"]
    outputs = [name for name in rows[0] if name not in inputs]
    first, second = (Flown(description, folder, name) for name in ("first", "second"))
    different, part = 0, len(rows) // 4
    for begin in range(0, len(rows), part):
        for it in (first, second):
            different += fly(it, rows[begin : begin + part], inputs, outputs, period, begin)
    first.end()
    second.end()
    expect(different == 0, f"{different} samples of two instances side by side have other bits")
    few = rows[:2000]
    back_in_time(description, folder, few, inputs, outputs, period)
    parameters = refused(description, folder)
    simulated(path, description, folder, period)
    shutil.rmtree(folder, ignore_errors=True)
    built_from_sources(path, rows, inputs, outputs, period)
    print(
        f"FMI {description.fmiVersion}, {Path(path).stat().st_size} bytes, {parameters} parameters: "
        f"2 x {len(rows)} samples side by side, {different} different; {len(findings)} findings"
    )
    for finding in findings:
        print(f"  {finding}")
    return 1 if findings else 0


def built_from_sources(path, rows, inputs, outputs, period):
    """The FMU without its library, built by FMPy with the headers of the standard."""
    with tempfile.TemporaryDirectory() as place:
        copy = Path(place) / Path(path).name
        shutil.copy(path, copy)
        folder = fmpy.extract(str(copy))
        shutil.rmtree(Path(folder) / "binaries")
        fmpy.build.build_platform_binary(folder)
        description = fmpy.read_model_description(folder)
        it = Flown(description, folder, "from sources")
        different = fly(it, rows, inputs, outputs, period, 0)
        it.end()
        shutil.rmtree(folder, ignore_errors=True)
    expect(different == 0, f"built from its sources, {different} samples have other bits")


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]))
