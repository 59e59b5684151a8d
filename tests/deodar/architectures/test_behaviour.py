"""Elementary behaviours: their nodes start and end them, and the constraints between them hold in every
trial.
"""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.architectures.behaviour import ON, SIGNAL, behaviour, competition, precondition, suppression
from deodar.elements.stimuli import Boost
from deodar.numerics.windows import Window

X = dd.Axis("x", 0, 100, samples=51)


def on(model: dd.Model, names: list[str], duration: float = 1200, trials: int = 20) -> dict[str, np.ndarray]:
    """Return for each node or field whether it is above threshold, (trials, time), every ms."""
    record = dd.simulate(model, duration, record=[f"{name}.activation" for name in names], trials=trials)
    return {
        name: (record[f"{name}.activation"].values > 0).reshape(trials, int(duration) + 1, -1).any(-1)
        for name in names
    }


def tell(model: dd.Model, target: str, amplitude: float, *windows: tuple[float, float]) -> None:
    """Add a timed signal to one node."""
    (
        model.add(Boost(f"to {target}", [], amplitude=amplitude, windows=[Window(*w) for w in windows]))
        >> model[target]
    )


def several(*names: str) -> dd.Model:
    model = dd.Model("several")
    for name in names:
        model.insert(behaviour(), name)
    return model


def test_an_intention_ends_when_satisfied_and_satisfaction_lasts_until_the_task_ends() -> None:
    model = several("a")
    tell(model, "a.task", ON, (100, 1000))
    tell(model, "a.satisfaction", SIGNAL, (600, 660))
    states = on(model, ["a.intention", "a.satisfaction"])
    assert not states["a.intention"][:, :100].any() and states["a.intention"][:, 200:600].all()
    assert not states["a.satisfaction"][:, :600].any() and states["a.satisfaction"][:, 700:1000].all()
    assert not states["a.intention"][:, 700:].any() and not states["a.satisfaction"][:, 1100:].any()


@pytest.mark.parametrize(("task", "signal"), [(True, False), (False, True)])
def test_satisfaction_requires_the_task_and_the_signal(task: bool, signal: bool) -> None:
    model = several("a")
    tell(model, "a.task", ON if task else 0.0, (100, 1200))
    tell(model, "a.satisfaction", SIGNAL if signal else 0.0, (300, 1200))
    assert not on(model, ["a.satisfaction"])["a.satisfaction"].any()


def test_a_signal_without_an_active_intention_does_not_satisfy() -> None:
    """Task and signal are on, and the intention is suppressed."""
    model = several("a")
    tell(model, "a.task", ON, (100, 1200))
    tell(model, "a.intention", -6.0, (0, 1200))
    tell(model, "a.satisfaction", SIGNAL, (300, 1200))
    assert not on(model, ["a.satisfaction"])["a.satisfaction"].any()


def test_the_percept_must_match_the_intention() -> None:
    for place, satisfied in ((30, False), (70, True)):
        model = dd.Model("reach")
        model.insert(behaviour([X]), "reach")
        tell(model, "reach.task", ON, (100, 1200))
        model.add(dd.GaussianStimulus("target", [X], center=70, sigma=4, amplitude=3)) >> model["reach.goal"]
        (
            model.add(
                dd.GaussianStimulus("hand", [X], center=place, sigma=4, amplitude=3, windows=[(500, 1200)])
            )
            >> model["reach.outcome"]
        )
        states = on(model, ["reach.intention", "reach.goal", "reach.outcome", "reach.satisfaction"])
        assert states["reach.goal"][:, 300:500].all() and not states["reach.outcome"][:, :500].any()
        assert (states["reach.satisfaction"][:, -1] == satisfied).all() and (
            states["reach.intention"][:, -1] != satisfied
        ).all()
        assert (states["reach.goal"][:, -1] != satisfied).all()


def test_a_precondition_prevents_the_second_intention_until_the_first_is_satisfied() -> None:
    model = several("first", "then")
    node = precondition(model, "first", "then")
    for name in ("first", "then"):
        tell(model, f"{name}.task", ON, (100, 1200))
    tell(model, "first.satisfaction", SIGNAL, (600, 660))
    states = on(model, ["first.intention", "then.intention", node.path])
    assert not states["then.intention"][:, :601].any() and states[node.path][:, 200:600].all()
    assert states["then.intention"][:, 800:].all() and not states["first.intention"][:, 700:].any()


def test_suppression_interrupts_a_behaviour_which_then_continues() -> None:
    model = several("walk", "avoid")
    suppression(model, "avoid", "walk")
    tell(model, "walk.task", ON, (100, 1200))
    tell(model, "avoid.task", ON, (500, 800))
    states = on(model, ["walk.intention", "avoid.intention"])
    assert states["walk.intention"][:, 200:500].all() and not states["walk.intention"][:, 600:800].any()
    assert states["walk.intention"][:, 950:].all() and states["avoid.intention"][:, 600:800].all()


def test_of_two_competing_behaviours_noise_selects_the_active_one() -> None:
    model = several("left", "right")
    competition(model, "left", "right")
    for name in ("left", "right"):
        tell(model, f"{name}.task", ON, (100, 1200))
    states = on(model, ["left.intention", "right.intention"], trials=100)
    left, right = states["left.intention"], states["right.intention"]
    assert not (left & right).any() and (left | right)[:, 250:].all()
    assert 30 <= left[:, -1].sum() <= 70


def test_of_two_competing_behaviours_the_earlier_one_wins() -> None:
    model = several("left", "right")
    competition(model, "left", "right")
    tell(model, "left.task", ON, (100, 1200))
    tell(model, "right.task", ON, (200, 1200))
    states = on(model, ["left.intention", "right.intention"])
    assert states["left.intention"][:, 200:].all() and not states["right.intention"].any()


def test_all_behaviours_have_one_document_parameter() -> None:
    model = several("a", "b")
    model.set("task to intention", 4.0)
    assert model.get("a.task > intention.factor") == model.get("b.task > intention.factor") == 4.0
