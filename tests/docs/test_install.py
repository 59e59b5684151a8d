"""The page on installing: its commands lead to its first peak, and tools/install_check.py runs just these."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tests.docs.source import DOCS, ROOT, module

PAGE = (DOCS / "install.md").read_text(encoding="utf-8")
check = module(ROOT / "tools" / "install_check.py")
pages = module(DOCS / "pages.py")

MADE = """
## From an index

```python title="peak.py"
print("a peak")
```

```sh
python3 -m venv --without-pip peak
{command}
```

```text
a {noun}
```

## Other ways
"""


def test_the_commands_of_the_check_are_those_of_the_page() -> None:
    walk = check.walk(PAGE)
    section = PAGE.partition("## From an index\n")[2].partition("\n## ")[0]
    assert "\n".join(walk.commands) == re.findall(r"```sh\n(.*?)\n```", section, re.DOTALL)[0]
    assert walk.commands[1].endswith("install deodar") and walk.file in walk.commands[2]


def test_the_file_of_the_page_prints_the_line_of_the_page(capsys: pytest.CaptureFixture[str]) -> None:
    walk = check.walk(PAGE)
    exec(walk.content, {})
    assert not pages.difference(walk.prints, capsys.readouterr().out)


@pytest.mark.parametrize(
    ("command", "noun", "status", "answer"),
    [
        ("peak/bin/python peak.py", "peak", 0, "min until the last command has ended"),
        ("peak/bin/python peak.py", "field", 1, "not printed: 'a field'; printed:\na peak"),
        ("peak/bin/python absent.py", "peak", 1, "can't open file"),
        ("node --version", "peak", 1, "not found"),
    ],
)
def test_the_check_runs_the_commands_of_the_page_in_an_empty_folder(
    command: str,
    noun: str,
    status: int,
    answer: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    page = tmp_path / "page.md"
    page.write_text(MADE.format(command=command, noun=noun))
    monkeypatch.setattr(check, "PAGE", page)
    (tmp_path / "deodar-1-py3-none-any.whl").touch()
    assert check.main([str(tmp_path), sys.executable]) == status
    printed = capsys.readouterr().out
    assert answer in printed
    assert re.search(r"^ +[\d.]+ s  python3 -m venv --without-pip peak$", printed, re.MULTILINE)


def test_pip_takes_the_wheel_and_finds_nothing_of_the_repository(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "src"))
    wheel = tmp_path / "deodar-1-py3-none-any.whl"
    environment = check.surroundings(tmp_path, Path(sys.executable), wheel)
    assert Path(environment["PIP_CONSTRAINT"]).read_text() == f"deodar @ {wheel.as_uri()}\n"
    assert "PYTHONPATH" not in environment and environment["HOME"].startswith(str(tmp_path))
    assert [path.name for path in Path(environment["PATH"]).iterdir()] == ["python3"]


def test_a_folder_without_one_wheel_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SystemExit):
        check.main([str(tmp_path)])
