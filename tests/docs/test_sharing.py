"""*One file for a colleague*: another account of the machine does what the page says, word for word."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.docs.source import DOCS, module

pages = module(DOCS / "pages.py")
PAGE = DOCS / "sharing.md"
COLLEAGUE = re.compile(r'^```console title="colleague"\n(.*?)^```$', re.MULTILINE | re.DOTALL)


NUMBER = 65534
"""Of the account and the group without rights."""

ACCOUNT = [f"--reuid={NUMBER}", f"--regid={NUMBER}", "--clear-groups"]
READING = ["--inh-caps=-all,+dac_read_search", "--ambient-caps=-all,+dac_read_search"]
"""What another account has in common with the author: it may read where deodar is installed."""


@pytest.fixture
def colleague() -> Iterator[tuple[Path, list[str]]]:
    """A folder, and the words before a command by which another account runs it there.

    Where the tests may not change the account, it is the same one with another home.
    """
    folder = Path(tempfile.mkdtemp(prefix="colleague-"))
    home = ["env", "-i", f"PATH={os.environ['PATH']}", f"HOME={folder}", f"TMPDIR={folder}"]
    if os.name == "posix" and os.getuid() == 0 and shutil.which("setpriv"):
        os.chown(folder, NUMBER, NUMBER)
        home = ["setpriv", *ACCOUNT, *READING, *home]
    yield folder, home
    shutil.rmtree(folder)


def test_a_colleague_repeats_what_was_packed(tmp_path: Path, colleague: tuple[Path, list[str]]) -> None:
    with pages.quiet():
        pages.run(PAGE, tmp_path)
    folder, before = colleague
    for name in ("lamp.deodar", "results.deodar", "light.deodar"):
        shutil.copy(tmp_path / name, folder / name)
        (folder / name).chmod(0o644)
    [block] = COLLEAGUE.findall(PAGE.read_text(encoding="utf-8"))
    commands = list(pages._commands(PAGE, 0, block))
    assert len(commands) == 5
    for command in commands:
        done = subprocess.run(
            [*before, sys.executable, "-m", *shlex.split(command.text)],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=600,
        )
        assert not pages.difference(command.prints, done.stdout), (command.text, done.stdout)
    assert (folder / "lamp" / "code" / "lamp.py").is_file() and (folder / "light-001.pdf").is_file()
