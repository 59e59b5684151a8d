"""Plots of the studio from packages: the message to the page, and the files that the server serves."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from deodar.cli import main
from deodar_studio.catalogue import plots
from tests.deodar_studio.page import Page, play, studio
from tests.deodar_studio.test_guard import get
from tests.plugins.conftest import EXAMPLE, Install

PLOT = "TITLE = 'Odd'\nFILE = 'odd.js'\nAXES = 2\n"


def _install(install: Install, text: str, name: str = "odd") -> Path:
    """Put a package with a plot on the path; return its folder."""
    folder = install("odd", {"odd": text}, {"deodar.plots": {name: "odd"}}).parent
    (folder / "odd.js").write_text("export function draw() {}\n", encoding="utf-8")
    return folder


@pytest.mark.usefixtures("example")
def test_the_page_is_sent_the_plot_of_the_package_and_the_server_serves_its_module(tmp_path: Path) -> None:
    seen: list[object] = []

    async def scene(p: Page) -> None:
        seen.extend(p.said["welcome"]["plots"])

    with studio(tmp_path) as address:
        play(address, scene)
        status, body, headers = get(address, "/plots/polar.js")
        assert (status, headers["content-type"]) == (200, "text/javascript; charset=utf-8")
        assert body == (EXAMPLE / "deodar_change" / "polar.js").read_text(encoding="utf-8")
        assert headers["cache-control"] == "no-cache" and headers["x-content-type-options"] == "nosniff"
        assert "default-src 'self'" in headers["content-security-policy"]
        assert get(address, "/plots/polar.js", token=False)[0] == 401
        assert get(address, "/plots/polar.js", Origin="http://evil.example")[0] == 403
        for other in ("polar", "polar.py", "change.js", "heat.js", ".js", "..%2fpolar.js", "polar.js%00"):
            assert get(address, f"/plots/{other}")[0] == 404, other
    assert seen == [
        {
            "name": "polar",
            "title": "Polar plot",
            "package": "deodar-change 0.1.0",
            "axes": 1,
            "periodic": True,
            "module": "plots/polar.js",
        }
    ]


@pytest.mark.usefixtures("example")
def test_a_plot_is_not_imported_before_the_studio_starts() -> None:
    assert [p.name for p in plots.PLOTS.packaged()] == ["polar"]
    assert "deodar_change.polar" not in sys.modules
    assert [view.title for view in plots.views()] == ["Polar plot"]
    assert "deodar_change.polar" in sys.modules and "deodar_change.change" not in sys.modules


@pytest.mark.parametrize(
    ("text", "name", "problem"),
    [
        ("FILE = 'odd.js'", "odd", "has no TITLE, AXES"),
        (PLOT + "TITLE = ''", "odd", "has the TITLE '', which is not a text"),
        (PLOT + "AXES = 4", "odd", "has AXES = 4, which is not 1, 2 or 3"),
        (PLOT + "PERIODIC = 1", "odd", "has PERIODIC = 1, which is not True or False"),
        (PLOT + "FILE = '../odd.js'", "odd", "has the FILE '../odd.js', which is not the name of a file"),
        (PLOT + "FILE = 'even.js'", "odd", "has the FILE 'even.js', which is not in its folder"),
        (PLOT, "odd,even", "has a name with other characters than letters, digits, _ and -"),
        (PLOT, "heat", "takes the name 'heat', which deodar has"),
    ],
    ids=["parts", "title", "axes", "periodic", "a path", "no file", "a comma", "a name of deodar"],
)
def test_an_invalid_plot_is_a_line_of_doctor_and_not_sent_to_the_page(
    text: str, name: str, problem: str, install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    _install(install, text, name)
    assert plots.views() == [] and plots.file(name) is None
    assert main(["doctor"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("plug-in")]
    assert lines == [f"plug-in    odd 0.1.0: PROBLEM: {name} {problem}"]


def test_an_object_that_is_not_a_module_is_refused_as_a_plot(install: Install) -> None:
    install("odd", {"odd": "Plot = 3"}, {"deodar.plots": {"odd": "odd:Plot"}})
    assert [plots.PLOTS.problem(p) for p in plots.PLOTS.packaged()] == [
        "names odd:Plot as 'odd', which is not a module"
    ]


def test_a_plot_that_fits_is_sent_beside_a_broken_one(install: Install) -> None:
    install("broken", {"broken": "raise RuntimeError"}, {"deodar.plots": {"broken": "broken"}})
    folder = _install(install, PLOT)
    assert [(view.name, view.axes, view.periodic) for view in plots.views()] == [("odd", 2, False)]
    assert plots.file("odd") == folder / "odd.js" and plots.file("broken") is None
