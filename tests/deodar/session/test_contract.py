"""The calls of scripts, as the manual prints them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

CODE = """
import deodar as dd

x = dd.Axis("x", 0, 100, samples=101, unit="deg")
model = dd.Model("selection")
u = model.add(dd.Field("u", [x], tau=20, resting_level=-5, sigmoid=dd.Logistic(beta=4),
                       kernel=[dd.Gaussian(amplitude=1.2, sigma=5)], global_inhibition=0.4, noise=0.1))
#   dd.Gaussian(amplitude=15, sigma=5, normalized=True): the amplitude is the kernel's integral,
#   not its value at the centre
left = model.add(dd.GaussianStimulus("left", [x], center=30, sigma=5, amplitude=6))
model.connect(left, u)                       # or: left >> u ; couplings: left >> dd.Gain(2.0) >> u

data = dd.simulate(model, duration=500, dt=1, seed=0, record=["u.activation"], every=5)
# xarray.Dataset; every 5 ms
runs = dd.simulate(model, duration=500, trials=100, sweep={"left.amplitude": [4, 6, 8]})
# batched in one program

s = dd.Session(model, dt=1, seed=0)          # live: the same model, stepped by hand, by a clock, or by
                                             # the studio
s.run(200); s.step(5)                        # document time; Euler steps
s.set("left.amplitude", 8); s.read("u.activation"); s.reset()
dd.simulate(model, duration=500, precision="float64")        # also dd.Session(model, precision="float64")
dd.save(model, "selection.json"); model = dd.load("selection.json")
"""

CHECKS = """
import numpy as np
assert data["u.activation"].dims == ("time", "x")
assert list(data["time"].values[:3]) == [0, 5, 10] and data["time"].values[-1] == 500
assert (data["u.activation"].values[0] == -5).all()
assert runs["u.activation"].dims == ("left.amplitude", "trial", "time", "x")
assert runs.sizes == {"left.amplitude": 3, "trial": 100, "time": 1, "x": 101}
assert runs["time"].values == [500]
assert isinstance(s.read("u.activation"), np.ndarray) and s.read("u.activation").shape == (101,)
assert s.time == 0 and s.get("left.amplitude") == 8 and (s.read("u.activation") == -5).all()
assert model["u"].element == u.element
"""


def test_the_printed_code_runs_from_an_empty_folder(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", CODE + CHECKS],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["selection.json"]


def test_root_imports_nothing_heavy() -> None:
    code = (
        "import sys, deodar; assert not {'jax', 'numpy', 'xarray', 'matplotlib'} & set(sys.modules),"
        " sorted(sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=600).returncode == 0
