"""What counts as a misspelt name: pairs that are proposed, and pairs that are not."""

from __future__ import annotations

import time

import pytest

from deodar.errors import did_you_mean
from deodar.similar import nearest

PROPOSED = [
    ("restng_level", "resting_level"),
    ("RestingLevel", "resting_level"),
    ("spacetime", "space_time"),
    ("tua", "tau"),
    ("sigm", "sigma"),
    ("Feild", "Field"),
    ("kephera", "khepera"),
    ("activaton", "activation"),
    ("u.actvation", "u.activation"),
    ("left.amplitud", "left.amplitude"),
    ("working_memory", "working.memory"),
    ("god.json", "good.json"),
    ("selektion.json", "selection.json"),
    ("obstacle", "obstacles"),
    ("CartPole-v9", "CartPole-v1"),
    ("att", "at"),
    ("hal", "hall"),
    ("normalised", "normalized"),
    ("centre", "center"),
]
NOT_PROPOSED = [
    ("heading", "bearing"),
    ("missing.json", "turtle.json"),
    ("model.json", "turtle.json"),
    ("u", "v"),
    ("u.activation", "v.activation"),
    ("u.activation", "u.output"),
    ("x", "y"),
    ("dt", "t0"),
    ("left", "right"),
    ("pose", "noise"),
    ("camera", "gamma"),
    ("range", "rate"),
    ("speed", "sweep"),
    ("battery", "factory"),
    ("tilt", "tau"),
    ("contact", "content"),
    ("build", "guide"),
    ("", "u"),
    ("...", "u"),
]


@pytest.mark.parametrize(("name", "proposed"), PROPOSED)
def test_slips_of_typing_are_proposed(name: str, proposed: str) -> None:
    assert nearest(name, [proposed, "something else"]) == proposed
    assert did_you_mean(name, [proposed]) == f"Did you mean {proposed!r}?"


@pytest.mark.parametrize(("name", "proposed"), NOT_PROPOSED)
def test_another_word_is_not_proposed(name: str, proposed: str) -> None:
    assert nearest(name, [proposed]) == "" == nearest(proposed, [name])
    assert did_you_mean(name, [proposed]) == f"Valid names: {proposed}"


def test_the_nearest_is_proposed_and_of_equally_near_ones_the_last_by_the_alphabet() -> None:
    assert nearest("sigmaa", ["sigma_a", "sigma"]) == "sigma_a"
    assert nearest("ring-v9", ["ring-v1", "ring-v0"]) == "ring-v1"


def test_without_a_similar_name_at_most_twelve_are_listed() -> None:
    assert did_you_mean("q", [f"number{k}" for k in range(20)]).count("number") == 12
    assert did_you_mean("q", []) == ""


def test_a_misspelt_name_among_many_long_ones_is_found_soon() -> None:
    """Comparisons end where no more slips are allowed, and equal words are compared once."""
    fields = [f"working_memory_of_target_{chr(97 + k % 26) * 12}_{k:04}_number" for k in range(1000)]
    names = [f"{field}.parameter_with_a_long_name_{k:02}" for field in fields for k in range(10)]
    start = time.process_time()
    assert nearest(names[5000].replace("memory", "memroy"), names) == names[5000]
    assert time.process_time() - start < 8


def test_a_name_of_a_damaged_file_is_compared_with_none() -> None:
    began = time.process_time()
    assert nearest("Logistic" * 200_000, ["Logistic", "Logistic" * 200_000]) == ""
    assert nearest("Logistik", ["Logistic" * 200_000, "Logistic"]) == "Logistic"
    assert time.process_time() - began < 0.5
