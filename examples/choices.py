"""How often a field selects the stronger of two inputs: trials and a sweep as one batch.

    python examples/choices.py

Look at the numbers: with equal inputs half of the trials go each way; the share of the stronger one grows
with its advantage.
"""

from __future__ import annotations

from pathlib import Path

import deodar as dd

ADVANTAGES = (0.0, 0.05, 0.1, 0.2)


def shares(trials: int = 200) -> list[float]:
    """For each advantage of the left input, the share of trials in which it wins."""
    model = dd.load(Path(__file__).parent / "selection.json")
    strength = model.get("left.amplitude")
    data = dd.simulate(
        model, 600, trials=trials, sweep={"left.amplitude": [strength + a for a in ADVANTAGES]}
    )
    u = data["u.activation"].isel(time=-1)
    return [float(s) for s in (u.sel(x=30) > u.sel(x=70)).mean("trial")]


if __name__ == "__main__":
    for advantage, share in zip(ADVANTAGES, shares(), strict=True):
        print(f"left stronger by {advantage:4.2f}: wins in {100 * share:3.0f} % of the trials")
