"""A session that is changed while it runs: a memory is made, moved by hand, saved and brought back.

    python examples/live_session.py

Look at the places: the peak stays without input, follows an input nearby, and is where it was after
`restore`.
"""

from __future__ import annotations

from pathlib import Path

import deodar as dd


def places(session: dd.Session) -> list[float]:
    """Where the peaks of the field `u` stand now."""
    axes = session.document.by_names()["u",].element.axes  # type: ignore[attr-defined]
    return [round(p.position[0], 1) for p in dd.peaks(session.read("u.activation"), axes)]


def main() -> dict[str, list[float]]:
    """What happens, step by step."""
    session = dd.Session(dd.load(Path(__file__).parent / "working_memory.json"))
    found: dict[str, list[float]] = {}
    session.run(600)
    found["remembered"] = places(session)
    kept = session.snapshot()

    model = dd.load(Path(__file__).parent / "working_memory.json")
    model.set("cue.windows", None)
    session.edit(model.document)  # the cue, now without a window; states stay
    for center in (38, 41, 44):
        session.set("cue.center", center)
        session.run(200)
    found["pulled along"] = places(session)

    session.restore(kept)
    found["restored"] = places(session)
    return found


if __name__ == "__main__":
    for what, where in main().items():
        print(f"{what}: {where}")
