"""An FMU of a fuzzy system in FMPy: validated, asked for all its vectors by two instances side by side, and back in time.

    python fmu_system.py FMU VECTORS single|double

Exits with 1 on any finding.
"""

import csv
import shutil
import sys
from pathlib import Path

import fmpy
import numpy

import fmu
from fmu import Flown, bits, expect, findings


def ask(it, rows, inputs, outputs, first):
    """How many rows have other bits; steps are of any length."""
    different = 0
    for number, row in enumerate(rows, first):
        for name in inputs:
            it.set(name, row[name])
        it.fmu.doStep(currentCommunicationPoint=it.time, communicationStepSize=0.5 + number % 3)
        it.time += 0.5 + number % 3
        for name in outputs:
            whole = name == "faults" or name.endswith("_source")
            found = it.whole(name) if whole else it.get(name)
            different += found != row[name] if whole else bits(found) != bits(row[name])
    return different


class Asked(Flown):
    time = 0.0

    def whole(self, name):
        return (self.fmu.getInteger if self.two else self.fmu.getInt32)([self.references[name]])[0]


def main(path, vectors, numbers):
    folder = fmpy.extract(str(path))
    description = fmu.described(path, folder)
    kind = numpy.float32 if numbers == "single" else float
    with open(vectors, newline="") as file:
        rows = [{name: float(kind(value)) for name, value in row.items()} for row in csv.DictReader(file)]
    inputs = [v.name for v in description.modelVariables if v.causality == "input"]
    outputs = [name for name in rows[0] if name not in inputs]
    described = [v.name for v in description.modelVariables if v.causality == "output"]
    expect(described == outputs, f"outputs are {described}, those of the vectors {outputs}")
    first, second = (Asked(description, folder, name) for name in ("first", "second"))
    different, part = 0, max(len(rows) // 4, 1)
    for begin in range(0, len(rows), part):
        for it in (first, second):
            different += ask(it, rows[begin : begin + part], inputs, outputs, begin)
    expect(different == 0, f"{different} answers of two instances side by side have other bits")
    state, then = first.state(), first.time
    few = rows[:500]
    once = ask(first, few, inputs, outputs, 0)
    first.go_back(state)
    first.time = then
    expect(once == ask(first, few, inputs, outputs, 0), "after a step back the answers differ")
    taken = second.from_bytes(first.as_bytes(state))
    second.go_back(taken)
    first.free_state(state)
    second.free_state(taken)
    first.end()
    second.end()
    shutil.rmtree(folder, ignore_errors=True)
    print(
        f"FMI {description.fmiVersion}, {Path(path).stat().st_size} bytes: "
        f"2 x {len(rows)} answers side by side, {different} different; {len(findings)} findings"
    )
    for finding in findings:
        print(f"  {finding}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]))
