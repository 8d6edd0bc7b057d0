"""How the rings of a Cardan gyro drift while its rotor nutates: a figure of a scene file's run.

    PYTHONPATH=build/python/python python3 examples/python/gyro_drift.py gyro_drift.png
"""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")  # a file, whether or not there is a screen
import matplotlib.pyplot as plt

import kreisel

scenes = pathlib.Path(__file__).resolve().parent.parent / "scenes"
run = kreisel.Scene(scenes / "cardan_gyro_free.toml").solve(tolerance=1e-10)

figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for ring, style, colour in [("outer ring", "-", "#0072b2"), ("inner ring", "--", "#d55e00")]:
    angle = run.coordinates[ring]
    axes.plot(run.times, angle - angle[0], style, color=colour, label=ring)
axes.set(xlabel="t [s]", ylabel="angle since the start [rad]",
         title=f"{run.title}\n{run.report.method}, error {run.report.error_estimate:.1e}")
axes.grid(color="#dddddd")
axes.margins(x=0, y=0.15)
axes.legend(loc="lower left", ncols=2)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "gyro_drift.png", dpi=100)
