"""Pushes as boosts in the model, so that a push with a time of its own needs no intervention while the trial
runs.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.elements.boost import Boost
from deodar.experiments.actions import Action, Push
from deodar.model import edit, find
from deodar.model.model import Model


def with_pushes(model: Model, actions: Sequence[Action]) -> tuple[Model, dict[Push, str]]:
    """Return the model with a boost for each push, and the paths of those whose time is not the same in all
    trials; without pushes the model itself.
    """
    wanted = list(dict.fromkeys(a for a in actions if isinstance(a, Push)))
    if not wanted:
        return model, {}
    doc, waiting, number = model.document, dict[Push, str](), 0
    for push in wanted:
        target = find.element(doc, push.element)
        while (f"push{number}",) in doc.by_names():
            number += 1
        own = bool(push.when) or isinstance(push.at, Sequence)
        windows = () if own else ((push.times[0], push.times[0] + push.lasting),)
        boost = Boost(f"push{number}", amplitude=0.0 if own else push.amount, windows=windows)  # pyright: ignore[reportArgumentType]
        doc, entry = edit.add(doc, boost)
        doc = edit.connect(doc, entry, "", target, "")
        if own:
            waiting[push] = entry.path
    staged = Model(document=doc, trusted=model.trusted)
    staged.programs = model.programs  # so that the next trial uses the programs that this one compiles
    return staged, waiting
