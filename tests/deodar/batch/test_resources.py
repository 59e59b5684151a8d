"""What a computation may use: checked once, and refused where it cannot be used."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import CoresError, ParameterError

PLACE = Path("nowhere.zarr")


def model() -> dd.Model:
    model = dd.Model("m")
    model.add(dd.Field("u", [dd.Axis("x", 0, 10, samples=11)]))
    return model


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (
            {"workers": 0},
            "workers is 0; expected a number of processes, at least 1. One for each core is best",
        ),
        ({"batch": True}, "batch is True; expected a number of copies that run at once, at least 1"),
        (
            {"workers": 2, "cluster": "local:2"},
            "workers and cluster exclude each other. Leave one of them out",
        ),
        ({"devices": 2, "cluster": "local:2"}, "devices and cluster exclude each other"),
        ({"cluster": "nowhere"}, "is not the address of a cluster"),
    ],
)
def test_what_is_no_resource_is_refused_where_it_is_written(wrong: dict[str, object], says: str) -> None:
    with pytest.raises(ParameterError) as caught:
        dd.Resources(**wrong)  # type: ignore[arg-type]
    assert says in str(caught.value)


CALLS: dict[str, tuple[Callable[[], object], str]] = {
    "session": (lambda: dd.Session(model(), on=dd.Resources(workers=2)), "workers"),
    "session, progress": (lambda: dd.Session(model(), on=dd.Resources(progress=True)), "progress"),
    "experiment": (
        lambda: dd.Experiment("e", model(), dd.TrialPlan(5), 1).run(on=dd.Resources(device="gpu")),
        "device",
    ),
    "regimes": (lambda: dd.regimes(model(), "u", on=dd.Resources(workers=2)), "workers"),
    "map": (lambda: dd.regime_map(model(), {}, on=dd.Resources(cluster="local:2")), "cluster"),
    "tune": (lambda: dd.tune(model(), [], [], on=dd.Resources(devices=2)), "devices"),
    "resume": (lambda: dd.resume(PLACE, on=dd.Resources(batch=2)), "batch"),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_function_refuses_what_it_cannot_use(name: str) -> None:
    call, field = CALLS[name]
    with pytest.raises(ParameterError, match=f"on: .* cannot use {field}. Leave it out; .* uses .*cores"):
        call()


def test_the_number_of_cores_is_that_of_the_process() -> None:
    dd.simulate(model(), 5)
    with pytest.raises(CoresError, match="JAX has already started"):
        dd.simulate(model(), 5, on=dd.Resources(cores=99))
