"""The lock of a record that is being written, and what others learn from it."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from collections.abc import Generator
from pathlib import Path

import pytest

from deodar.errors import RecordError
from deodar.recording import writer_lock
from deodar.recording.writer_lock import WriterWatch

pytestmark = pytest.mark.skipif(os.name != "posix", reason="other systems do not lock folders")

HOLD = """
import sys
from pathlib import Path
from deodar.recording import writer_lock
held = writer_lock.lock(Path(sys.argv[1]))
print("locked", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def holder(tmp_path: Path) -> Generator[subprocess.Popen[str]]:
    """Return a process that writes the record `tmp_path`."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(tmp_path)], text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    with process:
        assert process.stdout is not None and process.stdout.readline() == "locked\n"
        yield process
        process.kill()


def test_the_lock_of_a_killed_process_is_released(tmp_path: Path, holder: subprocess.Popen[str]) -> None:
    assert writer_lock.is_written(tmp_path) is True
    with pytest.raises(RecordError, match="is being written by another process"):
        writer_lock.lock(tmp_path)
    holder.kill()
    holder.wait()
    assert writer_lock.is_written(tmp_path) is False
    handle = writer_lock.lock(tmp_path)
    assert handle is not None and writer_lock.is_written(tmp_path) is True
    os.close(handle)


def test_a_writer_waits_for_a_process_that_only_asks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asking = writer_lock.lock(tmp_path)
    assert asking is not None
    monkeypatch.setattr(writer_lock.time, "sleep", lambda _: os.close(asking))
    handle = writer_lock.lock(tmp_path)
    assert handle is not None
    os.close(handle)


def test_two_processes_that_ask_do_not_take_each_other_for_a_writer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asking = writer_lock.lock(tmp_path)
    assert asking is not None
    monkeypatch.setattr(writer_lock.time, "sleep", lambda _: os.close(asking))
    assert writer_lock.is_written(tmp_path) is False


def test_a_writer_has_ended_after_two_observations_without_a_lock_and_without_growth(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = iter(range(100))
    monkeypatch.setattr(writer_lock.time, "monotonic", lambda: next(clock))
    commit = tmp_path / "zarr.json"
    commit.write_text("1")
    watch = WriterWatch(tmp_path)
    handle = writer_lock.lock(tmp_path)
    assert handle is not None and not watch.ended() and not watch.ended()
    os.close(handle)
    assert not watch.ended(), "the first observation"
    commit.write_text("12")
    assert not watch.ended(), "the record grew: another machine writes it"
    assert watch.ended()


def test_a_file_system_without_locks_tells_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import fcntl

    def refuse(*_: object) -> None:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF))

    monkeypatch.setattr(fcntl, "flock", refuse)
    assert writer_lock.lock(tmp_path) is None and writer_lock.is_written(tmp_path) is None
    watch = WriterWatch(tmp_path)
    monkeypatch.setattr(writer_lock, "CERTAIN_SECONDS", 0)
    assert not watch.ended()


def test_another_system_locks_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as windows:
        windows.setattr(writer_lock.os, "name", "nt")
        states = writer_lock.lock(tmp_path), writer_lock.is_written(tmp_path)
    assert states == (None, None)
