"""Claims on the scenes: on each cue, and on all untuned photographs together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from deodar.analysis.claims import Claim, ClaimKind
from deodar.codec import JsonObject
from deodar_papers.saliency.scenes import NEAR, Cue, Found, Outcome

SOURCE = "Sandamirskaya (2014), Front. Neurosci. 7:276, figure 2"

LEAST_RIGHT = 10
"""Required number of selections for the twelve cues whose colour is present in an untuned photograph (a
choice of deodar).
"""

CONVERGES = "the motor variable converges to the peak"

FOUND_HERE = "parameters that were found on this photograph"


def claims(found: Found) -> list[Claim]:
    """Return one claim for the time without a cue, and for each cue of a marked picture one for the fields
    and one for the motor variable.

    Each is reported, and undecided where the scene was not run. On the photographs on which the parameters
    were tuned none of them is evidence; `totals` states the requirements on the others.
    """
    scene = found.scene
    assumed: dict[str, Any] = (
        {"assumes": FOUND_HERE, "inferred": True} if scene.tuned and any(c.expect for c in scene.cues) else {}
    )
    marks: dict[str, Any] = {"kind": "reported", "source": SOURCE, "origin": "ours", **assumed}
    level = None if found.quiet is None else round(found.quiet, 3)
    text = f"{scene.name}, no cue: the colour-space field stays below threshold"
    out = [Claim(text, level, "< 0", None if found.quiet is None else found.quiet < 0, **marks)]
    for cue, outcome in zip(scene.cues, found.outcomes or [None] * len(scene.cues), strict=True):
        out += _of_a_cue(scene.name, cue, outcome, marks)
    return out


def _of_a_cue(name: str, cue: Cue, o: Outcome | None, marks: dict[str, Any]) -> list[Claim]:
    value: JsonObject | None = o and {
        "peaks": len(o.places),
        "spatial peaks": len(o.spatial_places),
        "places": [[round(v) for v in p] for p in o.places],
        "motor variable": [round(v) for v in o.motor],
    }
    if not cue.expect:
        text = f"{name}, cue {cue.hue:g} deg"
        return [Claim(text, value, "not marked", None, kind="reported", origin="none")]
    text = f"{name}, cue {cue.name} ({cue.hue:g} deg)"
    right = None if o is None else o.right
    if cue.expect == "present":
        says = f"exactly one peak, on {cue.object}; the spatial field follows", CONVERGES
        selected = "one peak in the marked region, one spatial peak there too"
        targets = selected, f"at most {NEAR:g} from the spatial peak"
        distance = None if o is None else o.gap
    else:
        says = "no such colour in the picture, no peak", "the motor variable stays"
        targets = "no peak in either field", f"at most {NEAR / 10:g} from its start"
        distance = None if o is None else o.moved
    held = None if o is None else (o.gap is not None) == (cue.expect == "present") and o.converged
    distance = None if distance is None else round(distance, 2)
    return [
        Claim(f"{text}: {says[0]}", value, targets[0], right, **marks),
        Claim(f"{text}: {says[1]}", distance, targets[1], held, **marks),
    ]


def totals(results: Sequence[Found]) -> list[Claim]:
    """Return the required claims on all untuned photographs, and in how many the motor variable arrives in
    time.

    The targets are choices of deodar. They are undecided until all of these photographs were run.
    """
    untuned = [r for r in results if not r.scene.tuned]
    if not untuned:
        return []
    of = [sum(c.expect == e for r in untuned for c in r.scene.cues) for e in ("present", "absent")]
    whole = all(r.outcomes for r in untuned)
    asked = [o for r in untuned for o in r.outcomes]
    present, absent = ([o for o in asked if o.cue.expect == e] for e in ("present", "absent"))
    right, silent = sum(o.right for o in present), sum(o.right for o in absent)
    arrived = sum(o.gap is not None and o.converged for o in present)
    enough, all_of = f"at least {LEAST_RIGHT} of {of[0]}", [f"all of {n}" for n in of]
    rows: list[tuple[str, int, str, bool, ClaimKind, int]] = [
        ("a present colour is selected", right, enough, right >= LEAST_RIGHT, "required", len(present)),
        ("an absent colour selects nothing", silent, all_of[1], silent == of[1], "required", len(absent)),
        (CONVERGES, arrived, all_of[0], arrived == of[0], "reported", len(present)),
    ]
    return [
        Claim(f"untuned: {what}", *(given if whole else (None, target, None)), kind, n=n, origin="ours")
        for what, value, target, holds, kind, n in rows
        for given in [(value, target, holds)]
    ]


def sentence(results: Sequence[Found]) -> str:
    """Return the outcome in one line of plain words."""
    asked = [o for r in results for o in r.outcomes if o.cue.expect]
    quiet = sum(r.quiet is not None and r.quiet < 0 for r in results)
    if asked:
        present, absent = ([o.right for o in asked if o.cue.expect == e] for e in ("present", "absent"))
        return (
            f"{len(results)} photographs: silent without a cue in {quiet}; {sum(present)} of {len(present)}"
            f" cued colours selected on the right object; {sum(absent)} of {len(absent)} cues of absent"
            " colours selected nothing."
        )
    found = [f"{o.cue.hue:g} deg: {_where(o)}" for r in results for o in r.outcomes if o.places or o.spatial]
    return (
        f"Selected: {'; '.join(found)}. Other cues selected nothing."
        if found
        else "No cue selected anything."
    )


def _where(outcome: Outcome) -> str:
    """Return the positions of the peaks of the spatial field, or of the colour-space field if the spatial
    field has none.
    """
    places = outcome.spatial_places or outcome.places
    text = " and ".join(f"column {x:.0f}, row {y:.0f}" for x, y in places)
    return text if outcome.spatial else f"{text} (without a peak of the spatial field)"
