"""The file of a figure: its errors, its panels, the size of its page, and the same bytes each time."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.errors import FigureError, ParameterError, RecordError, UnknownName
from deodar.figures import FigureFile, FigurePanel
from tests.deodar.recording.models import record


@pytest.fixture(scope="module")
def recorded() -> xarray.Dataset:
    return record(trials=2)


EVERYTHING = """
record = "run.zarr"
journal = "ieee"
width = "single"
height = 120
font = "DejaVu Serif"
font_size = 6.5
grid = ["aab", "ccc"]
column_widths = [1, 1, 2]
row_heights = [2, 1]
letters = "(A)"

[[panel]]
variable = "u.activation"
record = "other.zarr"
kind = "snapshots"
title = "two \\"times\\" of u, τ"
at = [5, 10]
trial = 1
legend = "none"
value_range = [-8, 8]
labels = { value = "activation", x = "position (deg)" }

[[panel]]
variable = "u.activation"
places = [2.5, 10]
where = { "s.amplitude" = 4 }
time_range = [0, 15]

[[panel]]
variable = "u.activation"
axes = ["x"]
reduce = "integral"
colors = "magma"
"""


def wrong(text: str) -> list[str]:
    """Return the problems of a text, as the error shows them."""
    with pytest.raises(FigureError) as caught:
        FigureFile.parse(text)
    return [str(problem) for problem in caught.value.problems]


def test_every_key_of_a_file_is_read_and_written_again(tmp_path: Path) -> None:
    figure = FigureFile.parse(EVERYTHING, tmp_path)
    assert figure.width == "single" and figure.panels[0].title == 'two "times" of u, τ'
    assert figure.panels[1].where == (("s.amplitude", 4),) and figure.panels[2].reduce == "integral"
    assert FigureFile.parse(figure.text(), tmp_path) == figure
    (tmp_path / "below").mkdir()
    figure.save(tmp_path / "below" / "moved.toml")
    moved = FigureFile.read(tmp_path / "below" / "moved.toml")
    assert moved.record == "../run.zarr" and moved.panels[0].record == "../other.zarr"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("widht = 80", "widht: figure has no such parameter. Did you mean 'width'?"),
        ("width = 5", "width: is 5; expected 10 to 1000 mm"),
        ('width = "singel"', "Did you mean 'single'?"),
        ("font_size = true", "font_size: needs a number, not True"),
        ('font = "No Such Font"', "font: 'No Such Font' is not installed"),
        ('journal = "nature"', 'For example width = "single"'),
        ("letters = 1", "letters: needs text, not 1"),
        ('grid = ["ab", "c"]', "grid: its rows have different numbers of letters"),
        ('[[panel]]\nvariable = "u"\n', None),
        ('grid = ["ab"]\n[[panel]]\nvariable = "u"', "grid: 'b' is not a panel"),
        ('grid = ["."]\n[[panel]]\nvariable = "u"', "grid: panel a has no position"),
        ('grid = ["aa", "a."]\n[[panel]]\nvariable = "u"', "panel a are not a rectangle"),
        (
            'row_heights = [1, 2]\n[[panel]]\nvariable = "u"',
            "row_heights: has 2 numbers, and the figure 1 rows",
        ),
        ("[[panel]]\nkind = 'snapshot'", "panel 1: a panel needs 'variable'"),
        ("[[panel]]\nvariable = 3", "panel 1.variable: needs text, not 3"),
        (
            "[[panel]]\nvariable = 'u'\nat = ['a']",
            "panel 1.at: needs a number, not 'a'",
        ),
        (
            "[[panel]]\nvariable = 'u'\ntime_range = [5, 5]",
            "panel 1.time_range: is [5.0, 5.0]; expected a smaller and a larger",
        ),
        (
            "[[panel]]\nvariable = 'u'\ntrial = -1",
            "panel 1.trial: is -1, below its lower bound 0",
        ),
        (
            "[[panel]]\nvariable = 'u'\nreduce = 'max'",
            "panel 1.reduce: is 'max'; expected one of maximum, integral",
        ),
        ("[[panel]]\nvariable = 'u'\nlabels = ['t']", "panel 1.labels: needs a mapping from names to names"),
        (
            "[[panel]]\nvariable = 'u'\nplace = 3",
            "panel has no such parameter. Did you mean 'places'?",
        ),
        ("[[panel]]\nvariable = 'u'\nplaces = [[3, 'b']]", "panel 1.places: is [[3, 'b']]; expected such as"),
        ("panel = 3", "panel: expected tables, each under a line"),
        ("width = ", "is not TOML"),
        ("width = " + "[" * 5000 + "]" * 5000, "is nested too deeply"),
    ],
)
def test_a_wrong_entry_is_named_with_its_panel_and_key(text: str, says: str | None) -> None:
    if says is None:
        assert FigureFile.parse(text).panels[0].variable == "u"
    else:
        assert any(says in problem for problem in wrong(text)), wrong(text)


def test_all_problems_of_a_file_are_listed_with_its_path(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text("height = 5\nwidht = 3\n[[panel]]\nat = 'x'\n")
    with pytest.raises(FigureError) as caught:
        FigureFile.read(path)
    assert [p.where for p in caught.value.problems] == [
        f"{path}, {place}" for place in ("panel 1", "panel 1.at", "widht", "height")
    ]
    for missing in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(FigureError, match="cannot be read"):
            FigureFile.read(missing)
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(FigureError, match="UTF-8"):
        FigureFile.read(path)
    path.write_bytes(b"#" * (2**20 + 1))
    with pytest.raises(FigureError, match="is larger than 1 MiB"):
        FigureFile.read(path)


@pytest.mark.parametrize(
    ("panel", "error", "says"),
    [
        (FigurePanel("u.actvation"), FigureError, "Did you mean 'u.activation'?"),
        (FigurePanel("u.activation", kind="spacetime"), UnknownName, "Did you mean 'space_time'?"),
        (FigurePanel("u.activation", at=[99]), RecordError, "was not recorded at 99"),
        (FigurePanel("u.activation", time_range=[30, 40]), RecordError, "was not recorded between 30 and 40"),
        (FigurePanel("u.activation", trial=0, colors="viridsi"), RecordError, "Did you mean 'viridis'?"),
    ],
)
def test_an_error_of_a_panel_states_its_number(
    recorded: xarray.Dataset, panel: FigurePanel, error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=re.escape(says)) as caught:
        FigureFile([FigurePanel("n.activation"), panel]).draw(recorded)
    if panel.colors is None:
        assert "panel 2" in str(caught.value)


def test_a_figure_without_panel_or_record_is_an_error(recorded: xarray.Dataset) -> None:
    with pytest.raises(FigureError, match="no variable to draw"):
        FigureFile([]).draw(recorded)
    with pytest.raises(FigureError, match=r'record = "run\.zarr"'):
        FigureFile([FigurePanel("n.activation")]).draw()
    with pytest.raises(ParameterError, match="are 27, too many"):
        FigureFile([FigurePanel("n.activation")] * 27)


def points(path: Path) -> tuple[float, float]:
    """Return width and height of the page of a file, in points of 1/72 inch."""
    text = path.read_bytes().decode("latin-1")
    if path.suffix == ".svg":
        size = re.search(r'<svg [^>]*width="([\d.]+)pt" height="([\d.]+)pt"', text)
    else:
        size = re.search(r"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", text)
    assert size is not None
    return float(size.group(1)), float(size.group(2))


@pytest.mark.parametrize("ending", ["svg", "pdf"])
@pytest.mark.parametrize(
    ("settings", "millimetres"),
    [
        ({"width": 85, "height": 60}, (85, 60)),
        ({"width": "single", "height": 70}, (89, 70)),
        ({"width": "double", "journal": "elsevier", "height": 90}, (190, 90)),
    ],
)
def test_the_page_has_the_size_of_the_file(
    recorded: xarray.Dataset,
    tmp_path: Path,
    ending: str,
    settings: dict[str, Any],
    millimetres: tuple[int, int],
) -> None:
    path = tmp_path / f"figure.{ending}"
    dd.save_figure(FigureFile([FigurePanel("n.activation")], **settings).draw(recorded), path)
    assert points(path) == pytest.approx([mm / 25.4 * 72 for mm in millimetres], abs=1e-5)


def test_panels_that_do_not_fit_are_an_error_and_write_nothing(
    recorded: xarray.Dataset, tmp_path: Path
) -> None:
    small = FigureFile([FigurePanel("n.activation")] * 4, width=20, height=12, font_size=20)
    with pytest.raises(FigureError, match="do not fit into 20 x 12 mm"):
        dd.save_figure(small.draw(recorded), tmp_path / "small.pdf")
    assert not list(tmp_path.iterdir())


def test_type_has_the_size_and_the_font_of_the_file(recorded: xarray.Dataset) -> None:
    panels = [FigurePanel("u.activation", trial=0), FigurePanel("n.activation")]
    figure = FigureFile(panels, font_size=12, font="DejaVu Serif").draw(recorded)
    figure.draw_without_rendering()
    assert figure.axes[0].child_axes
    for ax in [*figure.axes, *figure.axes[0].child_axes]:
        assert {label.get_fontsize() for label in ax.get_yticklabels()} == {12 * 7 / 8}
        assert ax.yaxis.label.get_fontsize() == 12
        fonts = {label.get_fontfamily()[0] for label in [ax.yaxis.label, *ax.get_yticklabels()]}
        assert fonts == {"DejaVu Serif"}


def written(ax: Any) -> set[str]:
    """Return the letters and titles of axes."""
    return {text.get_text() for text in ax.texts} | {ax.get_title()}


def test_panels_have_letters_titles_labels_and_ranges(recorded: xarray.Dataset) -> None:
    figure = FigureFile(
        [
            FigurePanel(
                "n.activation", title="a node", legend="none", time_range=[0, 15], value_range=[-7, 1]
            ),
            FigurePanel(
                "u.activation", trial=0, value_range=[-8, 4], labels={"value": "level", "x": "position"}
            ),
        ],
        letters="(A)",
        columns=2,
    ).draw(recorded)
    one, two = figure.axes
    (bar,) = two.child_axes
    assert written(one) == {"(A)", "a node"} and written(two) == {"(B)", "trial 0"}
    assert (
        one.get_legend() is None and dd.time_course(recorded["n.activation"]).axes[0].get_legend() is not None
    )
    assert one.get_xlim() == (0, 15) and one.get_ylim() == (-7, 1)
    assert two.get_ylabel() == "position" and bar.get_ylabel() == "level" and bar.get_ylim() == (-8, 4)
    assert [ax for ax in FigureFile([FigurePanel("n.activation")]).draw(recorded).axes if ax.texts] == []


def test_panels_with_one_time_share_its_axis(recorded: xarray.Dataset) -> None:
    panels = [
        FigurePanel("u.activation", trial=0),
        FigurePanel("n.activation"),
        FigurePanel("n.activation", at=[5]),
    ]
    figure = FigureFile(panels).draw(recorded)
    above, below, last = figure.axes
    assert above.get_shared_x_axes().joined(above, below) and not above.get_xlabel()
    assert below.get_xlabel() == "time (ms)" and not below.get_shared_x_axes().joined(below, last)
    figure.draw_without_rendering()
    assert above.get_position().x0 == pytest.approx(below.get_position().x0)
    assert above.get_position().x1 == pytest.approx(below.get_position().x1)


def test_a_grid_gives_positions_and_relative_sizes(recorded: xarray.Dataset) -> None:
    panels = [
        FigurePanel("n.activation"),
        FigurePanel("n.activation", at=[5]),
        FigurePanel("n.activation", at=[5]),
    ]
    settings: dict[str, Any] = {"width": 180, "height": 100, "grid": ["aab", "c.b"], "row_heights": [2, 1]}
    figure = FigureFile(panels, **settings).draw(recorded)
    figure.draw_without_rendering()
    a, b, c = (ax.get_position() for ax in figure.axes)
    assert a.y0 > c.y1 and b.x0 > a.x1 > c.x1 and b.height > a.height
    assert a.height > 1.5 * c.height and np.isclose(a.x0, c.x0, atol=0.01)


@pytest.mark.parametrize("ending", ["svg", "pdf"])
def test_the_command_and_python_write_the_same_bytes(
    recorded: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str
) -> None:
    from deodar.cli import main

    monkeypatch.chdir(tmp_path)
    dd.save_record(recorded, "run.zarr")
    select = ["u.activation", "n.activation", "--trial", "1", "--time-range", "0", "15"]
    plot = ["plot", "run.zarr", *select, "--save-as", "figure.toml", "-o"]
    assert main([*plot, f"plotted.{ending}"]) == 0
    assert main(["plot", "figure.toml", "-o", f"command.{ending}"]) == 0
    dd.save_figure(FigureFile.read("figure.toml").draw(), f"python.{ending}")
    dd.save_figure(FigureFile.read("figure.toml").draw(recorded), f"memory.{ending}")
    first = (tmp_path / f"plotted.{ending}").read_bytes()
    for name in ("command", "python", "memory"):
        assert (tmp_path / f"{name}.{ending}").read_bytes() == first, name


def test_a_file_on_the_command_line_replaces_the_options(
    recorded: xarray.Dataset,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    from deodar.cli import main

    monkeypatch.chdir(tmp_path)
    dd.save_record(recorded, "run.zarr")
    (tmp_path / "figure.toml").write_text('[[panel]]\nvariable = "n.activation"\n')
    assert main(["plot", "figure.toml", "run.zarr"]) == 0
    assert "into figure-001.pdf" in capsys.readouterr().out
    for options in (["--kind", "snapshot"], ["run.zarr", "n.activation"]):
        with pytest.raises(SystemExit):
            main(["plot", "figure.toml", *options])
        assert "figure.toml" in capsys.readouterr().err
    assert main(["plot", "run.zarr", "n.activation", "--save-as", "a.txt"]) == 1
    assert "End it in .toml" in capsys.readouterr().err


def test_a_long_course_keeps_its_extreme_values() -> None:
    times = np.arange(100_000) * 0.5
    values = np.sin(times / 5000)
    values[[7, 54_321, 99_990]] = 9.0, -9.0, np.nan
    variable = xarray.DataArray(values, dims="time", coords={"time": times}, name="n.activation")
    (axes,) = dd.time_course(variable).axes
    x, y = axes.get_lines()[0].get_data()
    assert len(x) == 4000 and np.nanmax(y) == 9.0 and np.nanmin(y) == -9.0 and not np.isnan(y).any()
    assert x[np.argmax(y)] == pytest.approx(3.5, abs=50) and np.all(np.diff(x) > 0)
    smooth = np.abs(np.interp(times, x, y) - np.sin(times / 5000))
    assert np.median(smooth) < 0.01


def test_the_mean_of_many_trials_is_that_of_each_time() -> None:
    rng = np.random.default_rng(1)
    values = rng.normal(size=(5, 20_000))
    variable = xarray.DataArray(
        values, dims=("trial", "time"), name="n.activation", coords={"trial": range(5)}
    )
    lines = dd.time_course(variable).axes[0].get_lines()
    mean = np.asarray(lines[-1].get_ydata())
    assert mean.max() == pytest.approx(values.mean(0).max()) and len(lines) == 6
    assert np.asarray(lines[0].get_ydata()).min() == values[0].min()


def test_a_port_with_times_of_its_own_is_drawn_over_them() -> None:
    own = "u.activation.time"
    variable = xarray.DataArray(
        np.arange(6.0).reshape(3, 2),
        dims=(own, "x"),
        coords={own: (own, [0.0, 7.0, 14.0], {"units": "ms"}), "x": ("x", [0.0, 1.0], {"lower": 0.0})},
        name="u.activation",
    )
    (axes,) = dd.time_course(variable, places=[1]).axes
    assert axes.get_xlabel() == "time (ms)" and list(axes.get_lines()[0].get_ydata()) == [1.0, 3.0, 5.0]
    assert dd.space_time(variable).axes[0].get_xlim() == (0.0, 14.0)
    assert dd.snapshot(variable, at=[7]).axes[0].get_title() == "7 ms"


def test_a_figure_reads_only_what_it_shows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Chunks that the figure does not show may be missing."""
    times = np.arange(40.0)
    values = np.random.default_rng(1).normal(size=(40, 5)).astype(np.float32)
    axis = {"lower": 0.0, "upper": 4.0}
    stored = xarray.Dataset(
        {"u.activation": (("time", "x"), values), "n.activation": ("time", values[:, 0])},
        {"time": times, "x": ("x", np.arange(5.0), axis)},
        {"deodar": "{}"},
    )
    stored.to_zarr(
        tmp_path / "run.zarr",
        zarr_format=3,
        consolidated=False,
        encoding={"u.activation": {"chunks": (10, 5)}},
    )
    for chunk in (0, 2, 3):
        (tmp_path / "run.zarr" / "u.activation" / "c" / str(chunk) / "0").write_bytes(b"damaged")
    record = dd.open_record(tmp_path / "run.zarr")
    node = FigurePanel("n.activation")
    FigureFile([node]).draw(record)
    panels = [
        FigurePanel("u.activation", time_range=[10, 19]),
        FigurePanel("u.activation", places=[1, 3], time_range=[12, 18]),
        FigurePanel("u.activation", at=[11, 19]),
        FigurePanel("u.activation", at=[15], kind="snapshot"),
    ]
    map_ = FigureFile([*panels, node]).draw(record).axes[0]
    assert np.array_equal(np.asarray(map_.get_images()[0].get_array()), values[10:20].T)
    lines = [
        np.asarray(line.get_ydata()) for ax in FigureFile(panels[1:2]).draw(record).axes for line in ax.lines
    ]
    assert np.array_equal(lines[0], values[12:19, 1]) and np.array_equal(lines[1], values[12:19, 3])
    with pytest.raises(RecordError, match=r"u\.activation: cannot be read, its file may be damaged"):
        FigureFile([FigurePanel("u.activation")]).draw(record)


def test_every_selects_evenly_spaced_samples_and_reads_no_others(tmp_path: Path) -> None:
    values = np.arange(80, dtype=np.float32).reshape(40, 2)
    stored = xarray.Dataset(
        {"u.activation": (("time", "x"), values)},
        {"time": np.arange(40) * 0.5, "x": ("x", [0.0, 1.0], {"lower": 0.0})},
        {"deodar": "{}"},
    )
    stored.to_zarr(
        tmp_path / "run.zarr",
        zarr_format=3,
        consolidated=False,
        encoding={"u.activation": {"chunks": (5, 2)}},
    )
    for chunk in (1, 3, 5, 7):
        (tmp_path / "run.zarr" / "u.activation" / "c" / str(chunk) / "0").write_bytes(b"damaged")
    variable = dd.open_record(tmp_path / "run.zarr")["u.activation"]
    (line, *_) = dd.time_course(variable, places=[1], every=5).axes[0].get_lines()
    assert list(line.get_xdata()) == [0, 5, 10, 15] and list(line.get_ydata()) == [1, 21, 41, 61]
    (line, *_) = dd.time_course(variable, places=[0], every=5, time_range=[5, 10]).axes[0].get_lines()
    assert list(line.get_ydata()) == [20, 40]
    with pytest.raises(RecordError, match="above 0"):
        dd.time_course(variable, every=0)
