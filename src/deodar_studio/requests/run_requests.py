"""Handlers of requests about the run: its clock, its moments, its costs, and injected inputs."""

from __future__ import annotations

import math

import numpy as np

from deodar.errors import DocumentError, ParameterError
from deodar.numerics.axes import Axes
from deodar_studio.live.engine import Injection
from deodar_studio.messages import to_server
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles


@handles(to_server.Play)
async def _play(hub: Hub, page: Page, m: to_server.Play) -> None:
    hub.project.require_run()
    page.seek(None)
    await hub.in_engine(lambda: hub.engine.play(True))


@handles(to_server.Pause)
async def _pause(hub: Hub, page: Page, m: to_server.Pause) -> None:
    await hub.in_engine(lambda: hub.engine.play(False))


@handles(to_server.Advance)
async def _step(hub: Hub, page: Page, m: to_server.Advance) -> None:
    hub.project.require_run()
    page.seek(None)
    await hub.in_engine(lambda: hub.engine.step(m.n))


@handles(to_server.ResetRun)
async def _reset(hub: Hub, page: Page, m: to_server.ResetRun) -> None:
    page.seek(None)
    await hub.in_engine(lambda: hub.engine.reset(m.seed))


@handles(to_server.Speed)
async def _speed(hub: Hub, page: Page, m: to_server.Speed) -> None:
    await hub.in_engine(lambda: hub.engine.pace.go(m.factor))


@handles(to_server.Lengthen)
async def _lengthen(hub: Hub, page: Page, m: to_server.Lengthen) -> None:
    hub.project.require_run()
    await hub.in_engine(lambda: hub.engine.lengthen(m.longest))


@handles(to_server.RunFrom)
async def _run_from(hub: Hub, page: Page, m: to_server.RunFrom) -> None:
    await hub.project.run_from(m.time)
    page.seek(None)


@handles(to_server.Seek)
async def _seek(hub: Hub, page: Page, m: to_server.Seek) -> None:
    page.seek(m.time)


@handles(to_server.SeekFrames)
async def _seek_frames(hub: Hub, page: Page, m: to_server.SeekFrames) -> None:
    page.seek_further(m.frames)


@handles(to_server.MeasureCosts)
async def _measure_costs(hub: Hub, page: Page, m: to_server.MeasureCosts) -> None:
    hub.project.require_run()
    await hub.in_engine(hub.engine.measure)


@handles(to_server.PushInput)
async def _push(hub: Hub, page: Page, m: to_server.PushInput) -> None:
    engine = hub.engine
    session = engine.session
    entry = None if session is None else session.document.by_id().get(m.element)
    if session is None or entry is None:
        raise DocumentError("the running model has no such element", where=m.element)
    session.require_injection(m.element)
    injection = Injection(
        m.element, _blob(session.program.axes(session.program.port(m.element, entry.element.ports()[0])), m)
    )
    page.pushes = True
    await hub.in_engine(lambda: engine.inject(injection))


@handles(to_server.Release)
async def _release(hub: Hub, page: Page, m: to_server.Release) -> None:
    page.pushes = False
    await hub.in_engine(lambda: hub.engine.inject(None))


def _blob(axes: Axes, m: to_server.PushInput) -> np.ndarray:
    """Sample the input of a push over axes: a Gaussian, or a constant."""
    if not math.isfinite(m.amplitude):
        raise ParameterError("needs a finite number", where="amplitude")
    out = np.asarray(m.amplitude, float)
    for i, axis in enumerate(axes):
        bump = np.ones(axis.samples)
        if m.center is not None and i < len(m.center):
            sigma = m.sigma[i] if m.sigma is not None and i < len(m.sigma) else 0.05 * axis.range
            distance = axis.points - m.center[i]
            distance = distance - axis.range * np.round(distance / axis.range) if axis.periodic else distance
            bump = np.exp(-0.5 * (distance / max(abs(sigma), 1e-9)) ** 2)
        out = out[..., None] * bump
    return out
