"""Requests about the run: its clock, its moments, its costs, and injected inputs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated

import msgspec
import numpy as np

from deodar.errors import DocumentError, ParameterError
from deodar.numerics.axes import Axes
from deodar_studio.live.engine import Injection
from deodar_studio.messages.message import Id
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import asks, changes

Seed = Annotated[int, msgspec.Meta(ge=0, le=2**32 - 1)]


@asks()
async def play(hub: Hub, page: Page) -> None:
    """Start or continue the run."""
    hub.project.require_run()
    page.seek(None)
    await hub.in_engine(lambda: hub.engine.play(True))


@asks()
async def pause(hub: Hub, page: Page) -> None:
    """Pause the run."""
    await hub.in_engine(lambda: hub.engine.play(False))


@asks(tag="step")
async def advance(hub: Hub, page: Page, *, n: Annotated[int, msgspec.Meta(ge=1, le=1_000_000)] = 1) -> None:
    """Advance by `n` Euler steps, then pause."""
    hub.project.require_run()
    page.seek(None)
    await hub.in_engine(lambda: hub.engine.step(n))


@asks(tag="reset")
async def reset_run(hub: Hub, page: Page, *, seed: Seed | None = None) -> None:
    """Reset state, time and noise to the start, with another seed if one is given. Parameters stay."""
    page.seek(None)
    await hub.in_engine(lambda: hub.engine.reset(seed))


@asks()
async def speed(hub: Hub, page: Page, *, factor: Annotated[float, msgspec.Meta(gt=0, le=1e6)] | None) -> None:
    """Set the ratio of document time to wall time: 1 is real time, None as fast as possible."""
    await hub.in_engine(lambda: hub.engine.pace.go(factor))


@asks()
async def lengthen(hub: Hub, page: Page, *, longest: Annotated[float, msgspec.Meta(gt=0)] | None) -> None:
    """Let the step grow up to `longest` (document time) if the machine is too slow.

    None: the step is constant, and the run falls behind.
    """
    hub.project.require_run()
    await hub.in_engine(lambda: hub.engine.lengthen(longest))


@asks()
async def seek(hub: Hub, page: Page, *, time: float | None) -> None:
    """Show the last frame up to a document time; None: the present. Other pages are not affected."""
    page.seek(time)


@asks()
async def seek_frames(
    hub: Hub, page: Page, *, frames: Annotated[int, msgspec.Meta(ge=-(2**31), le=2**31 - 1)]
) -> None:
    """Show the frame that is `frames` later than the one shown; a negative number goes back."""
    page.seek_further(frames)


@changes()
async def run_from(hub: Hub, page: Page, *, time: float) -> None:
    """Continue the run from the last frame up to a document time, with the parameters of that moment.

    The change of parameters is one step of undo.
    """
    await hub.project.run_from(time)
    page.seek(None)


@asks()
async def measure_costs(hub: Hub, page: Page) -> None:
    """Measure the cost of each element during the run; a `costs` message follows at start and end."""
    hub.project.require_run()
    await hub.in_engine(hub.engine.measure)


@asks(tag="push")
async def push_input(
    hub: Hub,
    page: Page,
    *,
    element: Id,
    amplitude: float,
    center: Sequence[float] | None = None,
    sigma: Sequence[float] | None = None,
) -> None:
    """Add an input to an element until `release`.

    The input is a Gaussian around `center` (axis units), or constant over the axes if that is None.
    """
    engine = hub.engine
    session = engine.session
    entry = None if session is None else session.document.by_id().get(element)
    if session is None or entry is None:
        raise DocumentError("the running model has no such element", where=element)
    session.require_injection(element)
    axes = session.program.axes(session.program.port(element, entry.element.ports()[0]))
    injection = Injection(element, _blob(axes, amplitude, center, sigma))
    page.pushes = True
    await hub.in_engine(lambda: engine.inject(injection))


@asks()
async def release(hub: Hub, page: Page) -> None:
    """End the input of `push`."""
    page.pushes = False
    await hub.in_engine(lambda: hub.engine.inject(None))


def _blob(
    axes: Axes, amplitude: float, center: Sequence[float] | None, sigma: Sequence[float] | None
) -> np.ndarray:
    """Sample the input of a push over axes: a Gaussian, or a constant."""
    if not math.isfinite(amplitude):
        raise ParameterError("needs a finite number", where="amplitude")
    out = np.asarray(amplitude, float)
    for i, axis in enumerate(axes):
        bump = np.ones(axis.samples)
        if center is not None and i < len(center):
            width = sigma[i] if sigma is not None and i < len(sigma) else 0.05 * axis.range
            distance = axis.points - center[i]
            distance = distance - axis.range * np.round(distance / axis.range) if axis.periodic else distance
            bump = np.exp(-0.5 * (distance / max(abs(width), 1e-9)) ** 2)
        out = out[..., None] * bump
    return out
