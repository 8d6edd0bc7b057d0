#!/usr/bin/env python3
"""Runs the code of a notebook in one namespace: notebook.py NOTEBOOK

Cells with the tag "picture" need matplotlib and are skipped without it. A notebook that contains outputs
fails: they are not kept in the repository.
"""

import importlib.util
import json
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    cells = [cell for cell in json.load(file)["cells"] if cell["cell_type"] == "code"]
has_matplotlib = importlib.util.find_spec("matplotlib") is not None
if has_matplotlib:
    import matplotlib
    matplotlib.use("Agg")
namespace = {}
for number, cell in enumerate(cells, 1):
    if cell["outputs"]:
        sys.exit(f"code cell {number} contains outputs: clear them")
    if has_matplotlib or "picture" not in cell["metadata"].get("tags", []):
        exec(compile("".join(cell["source"]), f"cell {number}", "exec"), namespace)
