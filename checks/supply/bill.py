"""The bill of materials of what is handed out, and the policy of dependencies, from what cargo and npm wrote down.

    python3 checks/supply/bill.py --out fspid.cdx.json     a bill of materials (CycloneDX 1.6), made without a network
    python3 checks/supply/bill.py --policy                 1 if a dependency breaks the policy, with what and where

A bill holds what is built into the program and its page, each with version, licence, source and, from the lock files, its digest. It
has no time and no random number: the same lock files give the same bytes.
"""

import argparse
import base64
import csv
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tomllib
import uuid

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = "fspid-cli"
# Every licence that a dependency may have, alone or as a choice.
ALLOWED = {
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
}


def metadata():
    asked = ["cargo", "metadata", "--format-version", "1", "--locked"]
    return json.loads(subprocess.run(asked, cwd=ROOT, check=True, capture_output=True).stdout)


class Tree:
    """What depends on what."""

    def __init__(self, found):
        self.packages = {package["id"]: package for package in found["packages"]}
        self.nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
        self.own = set(found["workspace_members"])

    def own_named(self, name):
        return next(key for key in self.own if self.packages[key]["name"] == name)

    def needs(self, key, kinds):
        """Packages that a package names, by kinds of dependency."""
        deps = self.nodes[key]["deps"]
        return {dep["pkg"] for dep in deps if any(kind["kind"] in kinds for kind in dep["dep_kinds"])}

    def below(self, key, kinds):
        """All packages that a package brings."""
        found, waiting = set(), [key]
        while waiting:
            more = self.needs(waiting.pop(), kinds) - found
            found |= more
            waiting.extend(more)
        return found

    def foreign(self):
        return sorted(set(self.packages) - self.own, key=self.order)

    def order(self, key):
        return (self.packages[key]["name"], self.packages[key]["version"])


def licence(package):
    """A licence as an SPDX expression; a slash is how some wrote `OR`."""
    return re.sub(r"\s*/\s*", " OR ", package["license"] or "")


def is_allowed(expression):
    """Whether a choice of allowed licences fulfils an expression of AND, OR and brackets."""
    words = re.findall(r"\(|\)|AND|OR|[^\s()]+(?:\s+WITH\s+[^\s()]+)?", expression)

    def choice(place):
        held, place = both(place)
        while place < len(words) and words[place] == "OR":
            other, place = both(place + 1)
            held = held or other
        return held, place

    def both(place):
        held, place = single(place)
        while place < len(words) and words[place] == "AND":
            other, place = single(place + 1)
            held = held and other
        return held, place

    def single(place):
        if words[place] == "(":
            held, place = choice(place + 1)
            return held, place + 1
        return " ".join(words[place].split()) in ALLOWED, place + 1

    held, place = choice(0) if words else (False, 0)
    return held and place == len(words)


def checksums():
    lock = tomllib.loads((ROOT / "Cargo.lock").read_text())
    return {(it["name"], it["version"]): it.get("checksum") for it in lock["package"]}


def component(package, checksum, is_own):
    name, version = package["name"], package["version"]
    found = {
        "type": "library",
        "bom-ref": f"pkg:cargo/{name}@{version}",
        "name": name,
        "version": version,
        "licenses": [{"expression": licence(package)}],
        "purl": f"pkg:cargo/{name}@{version}",
    }
    if checksum:
        found["hashes"] = [{"alg": "SHA-256", "content": checksum}]
    if package.get("repository") and not is_own:
        found["externalReferences"] = [{"type": "vcs", "url": package["repository"]}]
    return found


# What is built into the page of the cockpit; everything else there builds or tests it.
PAGE = ["clsx", "esm-env", "svelte", "uplot"]


def of_page():
    """What the page of the cockpit carries."""
    lock = json.loads((ROOT / "web" / "package-lock.json").read_text())["packages"]
    for name in PAGE:
        package = lock[f"node_modules/{name}"]
        purl = f"pkg:npm/{name}@{package['version']}"
        digest = base64.b64decode(package["integrity"].removeprefix("sha512-")).hex()
        yield {
            "type": "library",
            "bom-ref": purl,
            "name": name,
            "version": package["version"],
            "licenses": [{"expression": package["license"]}],
            "purl": purl,
            "hashes": [{"alg": "SHA-512", "content": digest}],
        }


def bill(tree):
    known = checksums()
    program = tree.own_named(PROGRAM)
    # What is built into the program, and what builds it.
    parts = tree.below(program, (None, "build"))
    components, edges = [], []
    for key in sorted(parts | {program}, key=tree.order):
        package = tree.packages[key]
        checksum = known.get((package["name"], package["version"]))
        row = component(package, checksum, key in tree.own)
        needs = sorted(tree.needs(key, (None, "build")) & parts, key=tree.order)
        below = [f"pkg:cargo/{tree.packages[it]['name']}@{tree.packages[it]['version']}" for it in needs]
        edges.append({"ref": row["bom-ref"], "dependsOn": sorted(set(below))})
        if key == program:
            subject = {**row, "type": "application", "name": "fspid"}
        else:
            components.append(row)
    components += of_page()
    content = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": subject},
        "components": components,
        "dependencies": edges,
    }
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).digest()
    number = uuid.UUID(bytes=digest[:16], version=5)
    return {"bomFormat": "CycloneDX", "specVersion": "1.6", "serialNumber": f"urn:uuid:{number}", **content}


def rows(name):
    with open(HERE / name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def problems(tree):
    """Everything that breaks the policy."""
    for key in tree.foreign():
        package = tree.packages[key]
        named = f"{package['name']} {package['version']}"
        if not is_allowed(licence(package)):
            yield f"{named}: its licence is {package['license']!r}; allowed are {', '.join(sorted(ALLOWED))}"
        if package["source"] != "registry+https://github.com/rust-lang/crates.io-index":
            yield f"{named}: it comes from {package['source']}; allowed is the registry of Rust"
    yield from what_runs_while_building(tree)
    yield from budgets(tree)


def what_runs_while_building(tree):
    """Build scripts and macros run on the machine that builds: each has a line that says why."""
    told = {row["package"]: row["why"] for row in rows("runs-while-building.csv")}
    there = set()
    for key in tree.packages:
        package = tree.packages[key]
        kinds = {kind for target in package["targets"] for kind in target["kind"]}
        if kinds & {"custom-build", "proc-macro"}:
            there.add(package["name"])
    for name in sorted(there - set(told)):
        yield f"{name}: it runs while building, and runs-while-building.csv has no line that says why"
    for name in sorted(set(told) - there):
        yield f"{name}: runs-while-building.csv has a line for it, and it does not run while building"
    yield from (f"{name}: runs-while-building.csv gives no reason" for name in sorted(told) if not told[name].strip())


def budgets(tree):
    """A crate brings no more packages of others than it may."""
    allowed = {row["crate"]: int(row["most"]) for row in rows("budget.csv")}
    for key in sorted(tree.own, key=tree.order):
        name = tree.packages[key]["name"]
        count = len(tree.below(key, (None, "build")) - tree.own)
        if name not in allowed:
            yield f"{name}: budget.csv has no line for it; today it brings {count}"
        elif count > allowed[name]:
            yield f"{name}: it brings {count} packages of others, allowed are {allowed[name]}"
        elif count < allowed[name]:
            yield f"{name}: it brings {count} packages of others, and its budget of {allowed[name]} can be lowered to that"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=pathlib.Path, help="where the bill of materials goes")
    parser.add_argument("--policy", action="store_true", help="whether every dependency keeps the policy")
    asked = parser.parse_args()
    tree = Tree(metadata())
    if asked.out:
        text = json.dumps(bill(tree), indent=2, ensure_ascii=False)
        asked.out.write_text(text + "\n", encoding="utf-8")
        print(f"{asked.out}: {len(json.loads(text)['components'])} components")
    if asked.policy:
        broken = list(problems(tree))
        for problem in broken:
            print(problem, file=sys.stderr)
        print(f"{len(tree.foreign())} packages of others, {len(broken)} problems")
        sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
