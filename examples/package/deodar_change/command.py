"""`deodar change`: the response of the detector to a step."""

from __future__ import annotations

import argparse

HELP = "print how the detector of change answers a step of its input"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("--tau", type=float, default=100.0, help="time constant in ms (default 100)")


def run(args: argparse.Namespace) -> int:
    """Print the output every 100 ms."""
    import deodar as dd
    from deodar_change.change import Change

    model = dd.Model("step")
    model.add(dd.Boost("step", amplitude=1.0)) >> model.add(Change("change", tau=args.tau))
    output = dd.simulate(model, 500, record=["change.output"], every=100)["change.output"]
    print("\n".join(f"{float(t):g} ms: {float(y):.3f}" for t, y in zip(output.time, output, strict=True)))
    return 0
