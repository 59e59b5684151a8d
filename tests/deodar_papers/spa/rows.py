"""Constructed rows with the results that the paper reports."""

from __future__ import annotations

from deodar_papers.spa import cases

PATH = [[-45.0, 55 + 0.36 * k] for k in range(110)] + [[-50 - 0.15 * k, 95.0] for k in range(200)]
"""North, then west through the passage beside the partial obstacle."""


def row(c, trial, **options):
    """Return a row of a run that goes straight to its goal."""
    fields = {
        "key": c.key(trial),
        "condition": c.name,
        "trial": trial,
        "success": True,
        "steps": 700,
        "arrival": 660,
        "length": 120.0,
        "shortest": 100.0,
        "divergence": 1.1 + 0.001 * (trial % 7),
        "touching": 0,
        "touches_at_end": False,
        "clearance": 8.0,
        "shortest_clearance": 5.0,
        "goal": [0.0, 0.0],
        "path": PATH,
    }
    if c.method == "planner":
        fields |= {
            "plan": 150 + 60 * (trial % 3),
            "moved": 225,
            "opposed": 0.002,
            "behaviours": ["north", "west", "south", "east"],
            "shortest": 100.0 + 20 * (trial % 3),
        }
    if not c.many_starts:
        fields |= {"route": "north", "wave": 150, "plan": 212, "west_ends": 500, "east_begins": 550}
    if c.obstacle:
        onset, duration = (int(v) for v in cases.windows(c.obstacle)[trial])
        fields |= {"onset": onset, "duration": duration, "on_robot": trial == 3, "still": 0}
        fields["route"] = expected(c.obstacle, onset, duration)
        if fields["route"] == "switch":
            fields |= {"still": 150, "arrival": 1230}
    return fields | options


def expected(obstacle, onset, duration):
    """Return the route that the paper reports."""
    if onset < 180:
        return "south" if obstacle == "partial" or duration > 75 else "north"
    return "switch" if obstacle != "partial" and onset < 480 and duration > 130 else "north"


def all_rows(quick, change=lambda c, trial: {}):
    """Return all rows of the design by their keys."""
    found = [row(c, k, **change(c, k)) for c in cases.conditions(quick).values() for k in c.trials]
    return {r["key"]: r for r in found}
