"""Ctrl-C: it acts at the end of the chunk, is never lost, and the old handler is restored."""

from __future__ import annotations

import os
import signal
import threading

import pytest

import deodar as dd
from deodar.session.interrupt import stoppable
from deodar.session.run import PROBE_STEPS, Run


def test_an_interrupt_acts_between_chunks_and_the_handler_is_restored(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", []))
    before, chunk, calls = signal.getsignal(signal.SIGINT), Run._chunk, []

    def pressed(self: Run, *args: object) -> object:
        calls.append(1)
        if len(calls) == 3:
            os.kill(os.getpid(), signal.SIGINT)  # in the middle of a chunk
        return chunk(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Run, "_chunk", pressed)
    with pytest.raises(dd.errors.Interrupted) as caught:
        dd.simulate(model, 10_000_000, record=["u.activation"], every=1000)
    assert len(calls) == 3 and caught.value.data.sizes["time"] >= 1
    assert signal.getsignal(signal.SIGINT) is before


def test_a_new_program_starts_with_a_short_chunk(monkeypatch: pytest.MonkeyPatch) -> None:
    model = dd.Model("m")
    session = dd.Session(model)
    chunk, sizes = Run._chunk, list[int]()

    def counted(self: Run, program: object, counts: dict[str, int], used: int) -> object:
        sizes.append(used)
        return chunk(self, program, counts, used)  # type: ignore[arg-type]

    monkeypatch.setattr(Run, "_chunk", counted)
    session.step(20_000)
    assert max(sizes) > 1000, "steps of an empty document take no time"
    model.add(dd.Field("u", []))
    session.edit(model.document)
    sizes.clear()
    session.step(20_000)
    assert sizes[0] == PROBE_STEPS


def test_a_second_interrupt_stops_at_once() -> None:
    before = signal.getsignal(signal.SIGINT)  # a shell that starts the tests behind it ignores the signal
    with pytest.raises(KeyboardInterrupt), stoppable():
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)
        pytest.fail("it was not stopped")
    assert signal.getsignal(signal.SIGINT) is before


def test_other_threads_do_not_change_signal_handlers() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", []))
    done: list[int] = []
    thread = threading.Thread(target=lambda: done.append(dd.simulate(model, 10).sizes["time"]))
    thread.start()
    thread.join(600)
    assert done == [1]
