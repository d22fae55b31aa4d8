"""Runs the notebooks, and writes them with their answers as pages of the guide.

    python checks/python/notebooks.py            # run all; the pages must be as they are
    python checks/python/notebooks.py --write    # write the pages

Notebooks are kept without answers. A page has what an answer says as text and its first drawing as SVG, which have the same bytes
on every machine.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "examples" / "notebooks"
PAGES = ROOT / "docs" / "guide"
FIGURES = ROOT / "docs" / "figures"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write the pages")
    asked = parser.parse_args()
    wrong = []
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        notebook = nbformat.read(path, as_version=4)
        wrong += [f"{path.name}: kept with answers" for cell in notebook.cells if cell.get("outputs")]
        with tempfile.TemporaryDirectory() as folder:
            NotebookClient(notebook, timeout=120, resources={"metadata": {"path": folder}}).execute()
        for place, text in page(path.stem, notebook):
            if asked.write:
                place.write_text(text, encoding="utf-8")
            elif not place.exists() or place.read_text(encoding="utf-8") != text:
                wrong.append(f"{place.relative_to(ROOT)} is not what {path.name} answers")
        print(f"{path.name}: run", flush=True)
    for each in wrong:
        print(each, file=sys.stderr)
    return 1 if wrong else 0


def page(name, notebook):
    """The page and its figures, each a place and a text."""
    words, figures = [], []
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            words.append(cell.source)
            continue
        words.append(f"```python\n{cell.source}\n```")
        for output in cell.outputs:
            text, drawing = shown(output)
            if drawing:
                place = FIGURES / f"notebook-{name}-{len(figures) + 1}.svg"
                figures.append((place, drawing + "\n"))
                title = re.search(r"<title[^>]*>(.*?)</title>", drawing, re.DOTALL)
                words.append(f"![{title.group(1) if title else name}](../figures/{place.name})")
            if text:
                # `text` is what commands of the guide print, which another test runs.
                words.append(f"```out\n{text}\n```")
    words.insert(1, f"*A notebook: [`{name}.ipynb`](../../examples/notebooks/{name}.ipynb).*")
    return [(PAGES / f"notebook-{name}.md", "\n\n".join(words) + "\n"), *figures]


def shown(output):
    """What an answer says, and its first drawing."""
    if output.output_type == "stream":
        return output.text.rstrip(), None
    data = output.get("data", {})
    markup = data.get("text/html", "") or data.get("image/svg+xml", "")
    drawing = re.search(r"<svg.*?</svg>", markup, re.DOTALL)
    # An object that is nothing but a drawing says only where it lies in memory.
    text = "" if "image/svg+xml" in data else data.get("text/plain", "")
    return "\n".join(line.rstrip() for line in text.splitlines()).strip("\n"), drawing and drawing.group(0)


if __name__ == "__main__":
    # Frozen modules only make the debugger of the kernel talk.
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
    sys.exit(main())
