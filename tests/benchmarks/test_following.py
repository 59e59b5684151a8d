"""The loop of a head and a ball over a link with delays: stable below its margin, lost beyond it."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import following


@pytest.fixture(scope="module")
def session() -> dd.Session:
    return dd.Session(following.following(), world=following.LossyLink())


@pytest.mark.parametrize(
    ("delay", "loss", "stays"), [(0.0, 0.0, True), (160.0, 0.3, True), (500.0, 0.0, False)]
)
def test_the_head_follows_the_ball_where_its_margin_allows_it(
    session: dd.Session, delay: float, loss: float, stays: bool
) -> None:
    link = session.world
    link.delay, link.loss = delay, loss
    margin = following.GAIN * (delay / 1000 + following.LAG)
    assert (margin <= following.ALLOWED) is stays
    session.reset(1)
    session.run(10_000)
    errors = np.abs(np.degrees(link.errors[250:]))
    assert bool(errors.max() < 10) is stays and bool(errors.max() > 28) is not stays


def test_a_link_that_loses_everything_stops_the_head(session: dd.Session) -> None:
    link = session.world
    link.delay, link.loss = 0.0, 0.0
    session.reset(0)
    session.run(2000)
    link.loss = 1.0
    session.run(300)
    before = float(np.ravel(link.head.sense("pan", (), 0.0))[0])
    session.run(1000)
    assert float(np.ravel(link.head.sense("pan", (), 0.0))[0]) == pytest.approx(before, abs=1e-3)
