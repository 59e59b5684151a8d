"""Two sequences are taught to one chain, each with a cue of its own; the cue says which one is produced."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import deodar as dd
from deodar.architectures.color_search import color_search
from deodar.architectures.serial_order import CLEAR, SEEN, SHOWN, START, WIDTH, action_axis, serial_order
from deodar.errors import ParameterError
from deodar.model import document_files
from tests.deodar.experiments.calls import run_alone

FIRST, SECOND = (40.0, 12.0, 40.0), (12.0, 52.0)
ITEMS = 3


class Chain:
    """A chain with two cues that was taught both sequences, the longer one first."""

    def __init__(self) -> None:
        model = serial_order(ITEMS, cues=2)
        self.meanings = [model[f"item {k}.meaning"].id for k in range(1, ITEMS + 1)]
        model.set("start.windows", None)
        model.set("start.amplitude", 0.0)
        for name, target in (("shown", "action"), ("seen", "satisfaction")):
            stimulus = dd.GaussianStimulus(name, [action_axis()], center=0.0, sigma=WIDTH, amplitude=0.0)
            model.add(stimulus) >> model[target]
        self.session = dd.Session(model)
        self.mode(teaching=True)
        for cue, sequence in enumerate((FIRST, SECOND), 1):
            self.session.set("cue", float(cue))
            self.restart()
            for place in sequence:
                self.session.set({"shown.center": place, "seen.center": place})
                self.during(400.0, {"shown.amplitude": SHOWN})
                self.during(200.0, {"shown.amplitude": SHOWN, "seen.amplitude": SEEN})
                self.session.run(300.0)
        self.taught = self.session.snapshot()

    def mode(self, teaching: bool) -> None:
        self.session.set({"learning.amplitude": float(teaching), "producing.amplitude": float(not teaching)})

    def during(self, duration: float, amplitudes: dict[str, float]) -> None:
        """Run with amplitudes that are 0 before and after."""
        self.session.set(amplitudes)
        self.session.run(duration)
        self.session.set(dict.fromkeys(amplitudes, 0.0))

    def restart(self) -> None:
        """Clear all activation, and start the first node."""
        self.during(200.0, {"clear.amplitude": CLEAR})
        self.session.run(100.0)
        self.during(100.0, {"start.amplitude": START})
        self.session.run(200.0)

    def begin(self, cue: float) -> None:
        """Return to the end of both lessons, and begin production."""
        self.session.restore(self.taught)
        self.mode(teaching=False)
        self.session.set("cue", cue)
        self.restart()

    def perceive(self, place: float) -> None:
        self.session.set("seen.center", place)
        self.during(200.0, {"seen.amplitude": SEEN})
        self.session.run(300.0)

    def action(self) -> float | None:
        """Return the place of the action, None without one."""
        u = self.session.read("action.activation")
        return float(np.flatnonzero(u > 0).mean()) if u.max() > 0 else None

    def node(self) -> int | None:
        """Return the number of the active node, from 1."""
        on = [k for k in range(1, ITEMS + 1) if self.session.read(f"item {k}.node.activation") > 0]
        assert len(on) <= 1
        return on[0] if on else None

    def weights(self) -> np.ndarray:
        """Return the weights of all nodes, (nodes, cues, actions)."""
        states = self.session.snapshot().states
        return np.stack([np.asarray(states[ident][0]["weights"]) for ident in self.meanings])


def elements(model: dd.Model) -> dict[str, object]:
    return {entry.path: entry.element for entry in model.document.entries}


@pytest.fixture(scope="module")
def chain() -> Chain:
    return Chain()


def test_each_cue_has_the_weights_of_its_own_sequence(chain: Chain) -> None:
    weights = chain.weights()
    assert weights.shape == (ITEMS, 2, 60)
    for cue, sequence in enumerate((FIRST, SECOND)):
        for k, place in enumerate(sequence):
            active = np.flatnonzero(weights[k, cue] > 0.5)
            assert weights[k, cue].max() > 0.95 and abs(active.mean() - place) < 2
    assert weights[2, 1].max() < 0.01  # the second sequence has no third action


@pytest.mark.parametrize(("cue", "sequence"), [(1.0, FIRST), (2.0, SECOND)])
def test_the_sequence_of_the_cue_is_produced(chain: Chain, cue: float, sequence: Sequence[float]) -> None:
    chain.begin(cue)
    for k, place in enumerate(sequence, 1):
        assert chain.node() == k and chain.action() == pytest.approx(place, abs=2)
        for silent in {*FIRST, *SECOND} - {place}:
            chain.perceive(silent)
            assert chain.node() == k  # it waits for its own outcome
        chain.perceive(place)
    assert chain.action() is None


def test_a_new_cue_changes_the_action_and_leaves_the_order(chain: Chain) -> None:
    chain.begin(1.0)
    chain.perceive(FIRST[0])
    assert chain.node() == 2 and chain.action() == pytest.approx(FIRST[1], abs=2)
    chain.session.set("cue", 2.0)
    for _ in range(20):
        chain.session.run(10.0)
        assert chain.node() == 2  # at no moment is the node switched off
    assert chain.action() == pytest.approx(SECOND[1], abs=2)
    chain.perceive(FIRST[1])
    assert chain.node() == 2
    chain.session.set("cue", 1.0)
    chain.session.run(200.0)
    assert chain.action() == pytest.approx(FIRST[1], abs=2)
    chain.perceive(FIRST[1])
    assert chain.node() == 3 and chain.action() == pytest.approx(FIRST[2], abs=2)


@pytest.mark.parametrize("cue", [0.0, 1.5])
def test_without_a_cue_no_action_is_recalled(chain: Chain, cue: float) -> None:
    chain.begin(cue)
    assert chain.node() == 1 and chain.action() is None
    assert chain.session.read("cue nodes.activation").max() < 0


def test_weights_of_another_cue_do_not_change_a_bit(chain: Chain) -> None:
    chain.begin(1.0)
    before = chain.weights()
    chain.mode(teaching=True)
    chain.session.run(200.0)
    later = chain.weights()
    assert np.array_equal(later[:, 1], before[:, 1]) and np.array_equal(later[1:], before[1:])
    assert later[0, 0].max() < 0.1 < before[0, 0].max()  # nothing is shown, so the node forgets


def test_a_chain_of_one_cue_is_that_without_cues_and_more_cues_add_only_their_parts() -> None:
    """Rows of earlier runs stay valid: their documents are the same, and their elements in larger ones."""
    cued = color_search(3, cues=2)
    single, same, two_cues = (elements(model) for model in (color_search(3), color_search(3, cues=1), cued))
    assert single == same
    assert {path for path in two_cues if path not in single} == {
        "cue input",
        "cue nodes",
        "cue number",
        "taught cue",
        *(f"item {k}.cued" for k in (1, 2, 3)),
    }
    assert {path: two_cues[path] for path in single} == single
    assert document_files.dumps(color_search(3).document) == document_files.dumps(
        color_search(3, cues=1).document
    )
    assert "cue" not in document_files.dumps(color_search(3).document)[0]


@pytest.mark.parametrize("cues", [0, 51, 2.0, True])
def test_a_chain_of_fewer_than_1_or_more_than_50_cues_is_refused(cues: object) -> None:
    with pytest.raises(ParameterError, match="a chain has 1 to 50 cues"):
        color_search(2, cues=cues)  # type: ignore[arg-type]


def test_a_chain_with_cues_has_no_problem() -> None:
    assert color_search(3, cues=2).check() == [] == serial_order(3, cues=3).check()


def test_a_new_cue_starts_the_chain_again_only_while_a_sequence_is_taught() -> None:
    arena = dd.Arena(
        {"unit": "mm", "arena": {"x": [-300, 300], "y": [-300, 300]}},
        (0, 0, 0),
        unit="mm",
        vehicle="khepera",
        physics=dd.ArenaPhysics(period=20, camera_every=4),
    )
    changes = [dd.Set(800.0, "cue", 2.0), dd.Set(1600.0, "mode", 1.0), dd.Set(2400.0, "cue", 1.0)]
    watch = ["item 1.node.activation", "cue nodes.activation"]
    trial = run_alone(color_search(1, cues=2), 2800.0, arena, watch=watch, actions=changes, every=20.0)
    on = trial.values[watch[0]] > 0
    at = {t: bool(on[np.searchsorted(trial.times, t)]) for t in (780.0, 900.0, 1580.0, 1700.0, 2380.0)}
    assert at == {780.0: True, 900.0: False, 1580.0: True, 1700.0: False, 2380.0: True}
    assert on[trial.times > 2380].all()
    cued = trial.values[watch[1]] > 0
    for t, cue in ((780.0, 1), (1580.0, 2), (2380.0, 2), (2780.0, 1)):
        assert cued[np.searchsorted(trial.times, t)].tolist() == [cue == 1, cue == 2]
