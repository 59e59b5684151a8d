"""A child reads for its parent: what passes, what ends it, and who has it."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import psutil
import pytest

from deodar.errors import MEDIA, DocumentError, MissingExtra, WorldError
from deodar.guarded.child import AHEAD, TAKEN
from deodar.guarded.children import MOST_IDLE, children
from deodar.guarded.guarded_file import GuardedFile
from tests.deodar.guarded import foreign

GUARD = GuardedFile(WorldError, "file.xml")
SMALL = GuardedFile(DocumentError, "file.xml", memory=2**28, seconds=0.5)
LINUX = sys.platform == "linux"


def test_plain_data_pass_as_they_are() -> None:
    plain = {"": [None, True, 2**70, 0.1, "ä\udc80\0"], "bytes": [b"", b"\n{}"], "inside": {"bytes": 0}}
    assert GUARD.call(foreign.same, plain) == plain
    assert math.isnan(GUARD.call(foreign.same, math.nan))
    assert GUARD.call(foreign.same, (1, (2,))) == [1, [2]]
    for array in (
        np.arange(6, dtype=">i2").reshape(2, 3).T,
        np.array(["text"]),
        np.zeros((0, 2)),
        np.zeros(2, bool),
    ):
        passed = GUARD.call(foreign.same, array)
        assert passed.dtype == array.dtype and passed.shape == array.shape and np.array_equal(passed, array)
    GUARD.call(foreign.same, np.zeros(2))[0] = 1
    assert GUARD.call(foreign.same, {"number": np.int64(2**60)}) == {"number": 2**60}


def test_a_relative_path_is_that_of_the_parent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for place in (Path.cwd(), tmp_path):
        monkeypatch.chdir(place)
        assert GUARD.call(foreign.folder) == str(place)


def test_what_a_library_prints_is_no_message() -> None:
    assert GUARD.call(foreign.printed) == 1
    with pytest.raises(WorldError, match=r"file\.xml: cannot be read: TypeError: object is no plain data"):
        GUARD.call(foreign.unplain)
    with pytest.raises(TypeError, match="object is no plain data"):
        GUARD.call(foreign.same, object())


@pytest.mark.parametrize(
    ("function", "end"),
    [
        (foreign.crash, "its reader ended by SIGSEGV"),
        (foreign.leave, "its reader ended with status 3"),
        (foreign.never, "it takes longer than 0.5 s"),
        (foreign.fail, "ValueError: no such"),
    ],
)
def test_an_error_says_what_ended_the_reader(function: Callable[[], object], end: str) -> None:
    before = {GUARD.call(foreign.process) for _ in range(2)}
    with pytest.raises(DocumentError) as caught:
        SMALL.call(function)
    problem = caught.value.problems[0]
    assert (problem.where, problem.what) == ("file.xml", f"cannot be read: {end}") and problem.fix
    assert GUARD.call(foreign.process) not in before, "the next file has another reader"


@pytest.mark.skipif(not LINUX, reason="only Linux limits the memory")
def test_memory_is_limited_for_each_call() -> None:
    with pytest.raises(
        DocumentError, match=r"file\.xml: cannot be read: it needs more than 0\.25 GiB of mem"
    ):
        SMALL.call(foreign.take, 2**29)
    assert GUARD.call(foreign.take, 2**29) == 2**29


def test_an_error_of_deodar_passes_with_its_class_and_problems() -> None:
    with pytest.raises(WorldError) as caught:
        GUARD.call(foreign.refuse)
    first, second = caught.value.problems
    assert type(caught.value) is WorldError
    assert (first.where, first.what, second.what, second.severity) == (
        "here",
        "is wrong",
        "and this",
        "warning",
    )
    assert [first.fix_at(medium) for medium in MEDIA] == ["Type: a", "Type: b", "Choose c"]
    with pytest.raises(MissingExtra, match=r"reading needs the package package.*deodar\[extra\]"):
        GUARD.call(foreign.lack)


def test_a_function_is_called_in_the_parent() -> None:
    def answer(text: str) -> bytes:
        if text == "b" and refuses:
            raise DocumentError("leads out of the folder", where=text)
        return f"{text} {os.getpid()}".encode()

    refuses = False
    assert GUARD.call(foreign.ask, answer) == [f"{text} {os.getpid()}".encode() for text in "ab"]
    refuses = True
    with pytest.raises(DocumentError, match="b: leads out of the folder"):
        GUARD.call(foreign.ask, answer)
    with pytest.raises(ZeroDivisionError):
        GUARD.call(foreign.ask, lambda text: 1 // 0)
    assert GUARD.call(foreign.same, 1) == 1


def test_items_come_one_by_one_and_those_before_a_crash_count() -> None:
    assert list(GUARD.items(foreign.count, 5)) == [0, 1, 2, 3, 4]
    items = GUARD.items(foreign.count, 10**9)
    assert next(items) == 0 and next(items) == 1
    assert GUARD.call(foreign.process) != os.getpid(), "another file meanwhile"
    items.close()
    taken: list[int] = []
    with pytest.raises(WorldError, match="its reader ended by SIGSEGV"):
        taken.extend(GUARD.items(foreign.count_and_crash, 3))
    assert taken == [0, 1, 2]


@pytest.mark.parametrize("count", [0, 1, AHEAD - 1, AHEAD, AHEAD + 1, AHEAD + TAKEN, 5 * AHEAD + 1])
def test_all_items_come_also_where_the_child_waits_for_them_to_be_taken(count: int) -> None:
    assert list(GUARD.items(foreign.count, count)) == list(range(count))
    assert GUARD.call(foreign.same, count) == count, "the child has no word left"


def test_a_child_is_kept_and_one_thread_uses_it_at_a_time() -> None:
    assert GUARD.call(foreign.process) == GUARD.call(foreign.process)
    used: list[int] = []
    threads = [threading.Thread(target=lambda: used.append(GUARD.call(foreign.busy, 0.2))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(used)) == 4
    readers = {GUARD.call(foreign.process) for _ in range(3)}
    assert len(readers) == 1 and len([pid for pid in used if psutil.pid_exists(pid)]) <= MOST_IDLE
    assert children() is children()


ENDS = """
import os, sys
from deodar.errors import WorldError
from deodar.guarded.guarded_file import GuardedFile
from tests.deodar.guarded import foreign
guard = GuardedFile(WorldError, "file")
own = guard.call(foreign.process)
if not os.fork():
    other = guard.call(foreign.process)
    print(own, other, flush=True)
    sys.exit()
os.wait()
assert guard.call(foreign.process) == own
os.kill(os.getpid(), 9)
"""


OPEN = """
from deodar.errors import WorldError
from deodar.guarded.guarded_file import GuardedFile
from tests.deodar.guarded import foreign
items = GuardedFile(WorldError, "file").items(foreign.count, 9)
assert next(items) == 0
"""


def test_a_process_ends_inside_a_generator() -> None:
    root = Path(__file__).parents[3]
    command = [sys.executable, "-c", OPEN]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, timeout=120)
    assert done.returncode == 0 and not done.stderr


@pytest.mark.skipif(not LINUX, reason="forks")
def test_a_fork_has_another_child_and_both_end_with_their_parents() -> None:
    root = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", ENDS], capture_output=True, text=True, cwd=root)
    assert done.returncode == -9 and not done.stderr
    first, second = map(int, done.stdout.split())
    assert first != second
    until = time.monotonic() + 60
    while any(_runs(pid) for pid in (first, second)) and time.monotonic() < until:
        time.sleep(0.01)
    assert not _runs(first) and not _runs(second)


def _runs(pid: int) -> bool:
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


IN_A_PROCESS = """
import os, sys
sys.path.insert(0, "")
import deodar.worlds.picture
from PIL import Image
Image.new("RGB", (4, 3)).save(sys.argv[1] + "/picture.png")
os.chdir(sys.argv[2])
if sys.argv[2].endswith("removed"):
    os.rmdir(sys.argv[2])
print(deodar.worlds.picture.Picture(sys.argv[1] + "/picture.png").pixels.shape)
"""


@pytest.mark.parametrize("folder", ["hiding", "removed"])
def test_the_working_folder_hides_no_module_and_may_be_gone(tmp_path: Path, folder: str) -> None:
    (tmp_path / folder).mkdir()
    if folder == "hiding":
        (tmp_path / folder / "random.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w').close()")
        (tmp_path / folder / "resource.py").write_text("raise SystemError")
    command = [sys.executable, "-c", IN_A_PROCESS, str(tmp_path), str(tmp_path / folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout == "(3, 4, 3)\n", done.stderr
    assert not (tmp_path / "ran").exists()


def test_what_python_prints_at_its_start_is_no_message(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text('print("hello")')
    (tmp_path / "folder").mkdir()
    command = [sys.executable, "-c", IN_A_PROCESS, str(tmp_path), str(tmp_path / "folder")]
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert done.stdout.endswith("(3, 4, 3)\n"), done.stderr


BROUGHT_BACK = """
import gc, sys
from deodar.errors import WorldError
from deodar.guarded import children
from deodar.guarded.guarded_file import GuardedFile
from tests.deodar.guarded import foreign

guard = GuardedFile(WorldError, "file")
lines = [0]


def collect(frame, event, argument):
    # as the garbage collector may, at each line of the module
    if frame.f_code.co_filename == children.__file__ and event == "line" and held:
        lines[0] += 1
        held.pop().close()
    return collect


for line in range(60):
    items = guard.items(foreign.count, 3)
    next(items)
    held = []
    sys.settrace(collect)
    gate = line

    class Later(list):
        def __bool__(self):
            global gate
            gate -= 1
            return gate < 0 and len(self) > 0

    held = Later([items])
    assert guard.call(foreign.same, line) == line
    sys.settrace(None)
    items.close()
assert lines[0] > 5
print("ended", len(children.children()._waiting) <= children.MOST_IDLE)
"""


def test_a_reader_that_the_garbage_collector_brings_back_stops_no_other() -> None:
    root = Path(__file__).parents[3]
    command = [sys.executable, "-c", BROUGHT_BACK]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, timeout=120, check=False)
    assert done.stdout == "ended True\n", done.stderr


FORKED = """
import os, sys
import numpy as np
import deodar as dd
from deodar.errors import WorldError
from deodar.guarded.guarded_file import GuardedFile
from deodar.worlds import _capture
from tests.deodar.guarded import foreign

expected = dd.Video(_capture.example())
pictures = [expected.picture(40.0 * k).copy() for k in range(25)]
video = dd.Video(_capture.example())
assert np.array_equal(video.picture(120.0), pictures[3])
items = GuardedFile(WorldError, "file").items(foreign.count, 100)
assert [next(items) for _ in range(3)] == [0, 1, 2]
forked = not os.fork()
assert all(np.array_equal(video.picture(40.0 * k), pictures[k]) for k in range(3, 25))
if forked:
    try:
        next(items)
    except WorldError as error:
        assert str(error).startswith("file: cannot be read: the process was forked after it was"), error
        os._exit(7)
    os._exit(1)
assert os.waitstatus_to_exitcode(os.wait()[1]) == 7
assert list(items) == list(range(3, 100))
print("read")
"""


def test_a_fork_reads_from_no_child_of_its_parent() -> None:
    root = Path(__file__).parents[3]
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", FORKED]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, timeout=120, check=False)
    assert done.stdout == "read\n", done.stderr
