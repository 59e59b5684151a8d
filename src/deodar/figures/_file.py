"""The file of a figure: panels, ranges, labels and sizes, as TOML."""

from __future__ import annotations

import dataclasses as dc
import os
import string
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure

from deodar import codec
from deodar.errors import DeodarError, FigureError, Problem, did_you_mean, show
from deodar.figures import _encode, _journals, _panels, _style, _video
from deodar.figures._moving import Changing
from deodar.figures._view import REDUCTIONS, View
from deodar.model import output
from deodar.progress import telling
from deodar.recording import files
from deodar.recording.provenance import KEY
from deodar.recording.repeat import world_of
from deodar.resources import Resources, use_resources
from deodar.summary import Summarised, Summary, counted

LETTERS = {"none": "", "a": "{}", "(a)": "({})", "a)": "{})", "A": "{}", "(A)": "({})", "A)": "{})"}
"""The letters of panels: how the first one is written."""

LEGENDS = (
    *("none", "best", "upper left", "upper center", "upper right", "center left", "center", "center right"),
    *("lower left", "lower center", "lower right"),
)
"""Places of a legend."""

MOST_PANELS = 26
SMALLEST_TYPE, LARGEST_TYPE = 3.0, 40.0
SMALLEST_VIDEO, LARGEST_VIDEO = 64, 8192
SETTINGS = (
    "at",
    "trial",
    "where",
    "axes",
    "places",
    "reduce",
    "time_range",
    "every",
    "value_range",
    "colors",
    "labels",
)
"""The settings of a panel that are those of a `View`."""


@dc.dataclass(frozen=True)
class FigurePanel:
    """One panel of a figure: a variable, the selected part of it, and its title.

    Attributes:
        variable: path of the variable in the record.
        kind: a kind of figure, such as time_course, space_time or path, or one of a package. None: the one
            that suits the variable.
        record: path of the record, if it is not that of the figure.
        title: title of the panel. None: that of the kind; "" for no title.
        legend: place of the legend, as "upper right", or "none". None: where it hides least.
        at, trial, where, axes, places, reduce: the selected part, as in `View`.
        time_range, every, value_range, colors, labels: times, ranges, colour map and labels, as in `View`.
    """

    variable: str
    kind: str | None = None
    record: str | None = None
    title: str | None = None
    legend: str | None = None
    at: Sequence[float] | None = None
    trial: int | None = None
    where: Mapping[str, float] | None = None
    axes: Sequence[str] | None = None
    places: Sequence[Sequence[float] | float] | None = None
    reduce: str | None = None
    time_range: Sequence[float] | None = None
    every: float | None = None
    value_range: Sequence[float] | None = None
    colors: str | None = None
    labels: Mapping[str, str] | None = None

    def view(self, data: xarray.Dataset) -> View:
        """Return the selected part of the variable.

        Raises:
            FigureError: the record has no such variable.
            RecordError: the selected part was not recorded.
        """
        known = list(map(str, data.data_vars))
        if self.variable not in known:
            raise FigureError(
                f"the record holds no variable {self.variable!r}", fix=did_you_mean(self.variable, known)
            )
        given = {key: value for key in SETTINGS if (value := getattr(self, key)) is not None}
        in_arena = (self.kind or "").replace("-", "_") == "path" and KEY in data.attrs
        return View(data[self.variable], **given, world=world_of(data) if in_arena else None)


@dc.dataclass(frozen=True, repr=False)
class FigureFile(Summarised):
    """A figure as data: panels, ranges, labels and sizes, in a file that a person can edit.

    `FigureFile.read("figure.toml").draw()` and `deodar plot figure.toml` draw the same figure:
    `dd.save_figure` writes the same bytes as the command, as SVG and as PDF. The page is as wide and as high
    as the file says.

    Args:
        panels: the panels, in the order of their letters.
        record: path of the record, relative to the folder of the file.
        journal: nature, elsevier or ieee; gives the widths of columns.
        width: width of the page in mm, or of a column: "single" or "double". None: that of the kinds.
        height: height of the page in mm. None: it suits the kinds.
        font: font of all text. None: DejaVu Sans, which matplotlib brings.
        font_size: size of type in points; numbers at ticks and legends are 7/8 of it.
        columns: number of columns, which the panels fill row by row.
        grid: positions of the panels in place of `columns`: one text for each row, in it a letter for each
            column, a for the first panel, `.` for none; `["aab", "ccb"]`.
        column_widths, row_heights: relative sizes. None: they suit the kinds.
        letters: how the first panel is lettered: a, (a), a), A, (A), A) or none. None: a, where there are
            several panels.
        folder: the folder in which paths of records begin.

    Raises:
        FigureError: a value is invalid; the message lists every problem.
    """

    panels: Sequence[FigurePanel]
    record: str | None = None
    journal: str | None = None
    width: float | str | None = None
    height: float | None = None
    font: str | None = None
    font_size: float | None = None
    columns: int | None = None
    grid: Sequence[str] | None = None
    column_widths: Sequence[float] | None = None
    row_heights: Sequence[float] | None = None
    letters: str | None = None
    folder: str | Path = ""

    def __post_init__(self) -> None:
        problems = list(_faults(self))
        if problems:
            raise FigureError(problems)

    # -------------------------------------------------------------------------------------------------- files

    @classmethod
    def read(cls, path: str | Path) -> FigureFile:
        """Read the file of a figure.

        Raises:
            FigureError: the file cannot be read, or is invalid; the message lists every problem.
        """
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            raise FigureError("is not a text file in UTF-8", where=str(path)) from None
        except OSError as error:
            raise FigureError(f"cannot be read: {error.strerror or error}", where=str(path)) from None
        try:
            return cls.parse(text, path.parent)
        except FigureError as error:
            raise FigureError(error.inside(path, ",")) from None

    @classmethod
    def parse(cls, text: str, folder: str | Path = "") -> FigureFile:
        """Return the figure that a text in TOML describes; paths of records begin in `folder`."""
        try:
            data = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise FigureError(f"is not TOML: {error}") from None
        problems: list[Problem] = []
        given = _checked(data, FIGURE_KEYS, "", problems)
        panels = given.pop("panel", [])
        made = [_checked(panel, PANEL_KEYS, f"panel {n}", problems) for n, panel in enumerate(panels, 1)]
        for n, panel in enumerate(made, 1):
            if "variable" not in panel and not any(p.where.startswith(f"panel {n}") for p in problems):
                problems.append(
                    Problem(f"panel {n}", "states no variable", 'For example: variable = "u.activation"')
                )
        if problems:
            raise FigureError(problems)
        return cls([FigurePanel(**panel) for panel in made], **given, folder=Path(folder))

    def text(self) -> str:
        """Return the figure in TOML; `parse` gives the same figure."""
        own = {
            key: value for key in FIGURE_KEYS if key != "panel" and (value := getattr(self, key)) is not None
        }
        lines = [f"{key} = {_toml(value)}" for key, value in own.items()]
        for panel in self.panels:
            lines += ["", "[[panel]]"]
            lines += [
                f"{key} = {_toml(value)}" for key in PANEL_KEYS if (value := getattr(panel, key)) is not None
            ]
        return "\n".join(lines).lstrip("\n") + "\n"

    def save(self, path: str | Path, force: bool = False) -> Path:
        """Write the file; paths of records are written relative to its folder.

        Raises:
            OutputExists: the file exists, and `force` is not given.
            OutputError: it cannot be written.
        """
        path = output.claim(path, force)

        def moved(record: str | None) -> str | None:
            return None if record is None else _relative(Path(self.folder) / record, path.parent)

        panels = [dc.replace(panel, record=moved(panel.record)) for panel in self.panels]
        written = dc.replace(self, panels=panels, record=moved(self.record), folder=path.parent)
        output.write(path, written.text().encode())
        return path

    # --------------------------------------------------------------------------------------------- the figure

    def draw(self, record: xarray.Dataset | str | Path | None = None) -> Figure:
        """Draw the figure; `record` in place of that of the file, for panels without one of their own.

        Raises:
            FigureError: the figure has no panel, or a panel no record.
            RecordError: a record cannot be read, or a panel cannot be drawn from it.
        """
        if not self.panels:
            raise FigureError("there is no variable to draw", fix='A panel begins with the line "[[panel]]"')
        with _style.style(self.font_size, self.font):
            cells = self._cells(record)
            return _panels.draw(cells, self._sized(cells))

    def animate(
        self,
        path: str | Path,
        record: xarray.Dataset | str | Path | None = None,
        every: float | None = None,
        speed: float | None = None,
        width: int = _video.WIDTH,
        force: bool = False,
        on: Resources = Resources(),
    ) -> Path:
        """Write a video of the figure.

        Panels over time get a line that moves; snapshots, projections and paths show each time; a panel with
        `at` does not change. Scales are those of all frames. Records are read frame by frame.

        Args:
            path: the video: .gif, .mp4 (extra `video`), or a folder of PNG files if the name has no ending.
            record: the record in place of that of the file.
            every: time between two frames, in the record's unit. None: each recorded time, or evenly spaced
                ones if there are more than 600.
            speed: time of the record by time of the video. None: 25 frames in a second.
            width: width in pixels.
            force: whether to replace an existing video.
            on: its `progress` counts the frames that are drawn.

        Raises:
            FigureError: nothing changes over time, or the speed needs too many frames in a second.
            MissingExtra: the extra `video` is not installed.
            OutputExists: the video exists, and `force` is not given.
        """
        progress = use_resources(on, "animate", "progress").progress
        path = output.location(path)
        format = _encode.format_of(path)
        _encode.claim(path, format, force)
        if not SMALLEST_VIDEO <= width <= LARGEST_VIDEO:
            raise FigureError(f"the width is {width}; it has {SMALLEST_VIDEO} to {LARGEST_VIDEO} pixels")
        with _style.style(self.font_size, self.font):
            cells = self._cells(record)
            views = [cell.view for cell in cells]
            shown = _video.times(views, every).tolist()
            rate = _video.rate(views, np.asarray(shown), speed, format)
            changing: list[Changing] = []
            figure = _panels.draw(cells, self._sized(cells), shown, changing)
            if not changing:
                raise FigureError("nothing in the figure changes over time")
            with telling(progress, "drawing", "frames") as tell:
                _encode.write(_video.frames(figure, changing, shown, width, tell), path, format, rate, force)
        return path

    def records(self, record: xarray.Dataset | str | Path | None = None) -> list[xarray.Dataset]:
        """Return the records of the panels, opened without reading their values."""
        opened: dict[str, xarray.Dataset] = {}
        used = [self._data(panel, record, opened) for panel in self.panels]
        return list({id(data): data for data in used}.values())

    def kinds(self, record: xarray.Dataset | str | Path | None = None) -> list[str]:
        """Return the kind of each panel."""
        return [cell.kind.__name__.rpartition(".")[2] for cell in self._cells(record)]

    def _cells(self, record: xarray.Dataset | str | Path | None) -> list[_panels.Cell]:
        opened: dict[str, xarray.Dataset] = {}
        cells: list[_panels.Cell] = []
        for n, (panel, (rows, columns)) in enumerate(zip(self.panels, self._places(), strict=True), 1):
            try:
                view = panel.view(self._data(panel, record, opened))
                kind = _panels.kind(view, panel.kind)
                cells.append(
                    _panels.Cell(view, kind, rows, columns, panel.title, self._letter(n - 1), panel.legend)
                )
            except DeodarError as error:
                if len(self.panels) == 1:
                    raise
                raise type(error)(error.inside(f"panel {n}", ",")) from None
        return cells

    def _data(
        self,
        panel: FigurePanel,
        record: xarray.Dataset | str | Path | None,
        opened: dict[str, xarray.Dataset],
    ) -> xarray.Dataset:
        if panel.record is not None:
            name = panel.record
        elif isinstance(record, xarray.Dataset):
            return record
        else:
            name = self.record if record is None else str(Path(record).resolve())
        if name is None:
            raise FigureError(
                "no record is given",
                fix='Name one: record = "run.zarr" in the file, or deodar plot FILE RECORD',
            )
        if name not in opened:
            opened[name] = files.open_record(Path(self.folder) / name)
        return opened[name]

    def _letter(self, k: int) -> str:
        style = self.letters or ("a" if len(self.panels) > 1 else "none")
        letters = string.ascii_uppercase if "A" in style else string.ascii_lowercase
        return LETTERS[style].format(letters[k])

    def _places(self) -> list[tuple[tuple[int, int], tuple[int, int]]]:
        """Return the first row and the one after the last, and the columns likewise, of each panel."""
        if self.grid is None:
            across = self.columns or 1
            return [
                ((k // across, k // across + 1), (k % across, k % across + 1))
                for k in range(len(self.panels))
            ]
        return [_span(self.grid, letter) for letter in string.ascii_lowercase[: len(self.panels)]]

    def _sized(self, cells: Sequence[_panels.Cell]) -> _panels.Tracks:
        """Return the sizes of the grid in inches."""
        width = self.width
        if isinstance(width, str):
            width = _journals.width(width, self.journal)
        grid = _panels.natural(cells, None if width is None else width / _journals.INCH)
        if width is None:
            width = _tenths(grid.widths)
        height = self.height if self.height is not None else _tenths(grid.heights)
        return _panels.Tracks(
            _shared(width / _journals.INCH, self.column_widths or grid.widths),
            _shared(height / _journals.INCH, self.row_heights or grid.heights),
        )

    def _summary(self) -> Summary:
        rows = [(panel.variable, panel.kind or "the kind that suits") for panel in self.panels]
        return Summary(f"FigureFile of {counted(len(rows), 'panel')}", rows)


# ----------------------------------------------------------------------------------------------------- checks

Check = Callable[[Any], Any]
"""Returns the value of a key; raises a ValueError that says what it expects."""


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError('a text in quotes, "like this"')
    return value


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < float("inf"):
        raise ValueError("a number")
    return value


def _whole(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise ValueError("a whole number, 0 or above")
    return value


def _list(of: Check, example: str) -> Check:
    def check(value: Any) -> list[Any]:
        if not isinstance(value, list):
            raise ValueError(f"a list such as {example}")
        try:
            return [of(v) for v in value]
        except ValueError:
            raise ValueError(f"a list such as {example}") from None

    return check


def _or(number: Check, listed: Check) -> Check:
    """Accept a single value in place of a list of one."""
    return lambda value: listed(value) if isinstance(value, list) else [number(value)]


def _place(value: Any) -> Any:
    return [_number(v) for v in value] if isinstance(value, list) else _number(value)


def _range(value: Any) -> list[float]:
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError("two numbers, for example [0, 500]")
    low, high = map(_number, value)
    if not low < high:
        raise ValueError("a smaller and a larger number, for example [0, 500]")
    return [low, high]


def _table(of: Check, example: str) -> Check:
    def check(value: Any) -> dict[str, Any]:
        if not isinstance(value, dict):
            raise ValueError(f"a table such as {example}")
        try:
            return {k: of(v) for k, v in value.items()}
        except ValueError:
            raise ValueError(f"a table such as {example}") from None

    return check


def _choice(known: Sequence[str]) -> Check:
    def check(value: Any) -> str:
        if value not in known:
            hint = f". {did_you_mean(value, known)}" if isinstance(value, str) else ""
            raise ValueError(f"one of {', '.join(map(repr, known))}{hint}")
        return value

    return check


def _between(low: float, high: float, unit: str) -> Check:
    def check(value: Any) -> float:
        if not low <= _number(value) <= high:
            raise ValueError(f"{low:g} to {high:g} {unit}")
        return value

    return check


def _width(value: Any) -> float | str:
    if isinstance(value, str):
        return _choice(list(_journals.COLUMNS[_journals.DEFAULT]))(value)
    return _between(_journals.SMALLEST, _journals.LARGEST, "mm")(value)


def _panel_list(value: Any) -> list[dict[str, Any]]:
    if not isinstance(value, list) or not all(isinstance(v, dict) for v in value):
        raise ValueError('tables, each under a line "[[panel]]"')
    return value


FIGURE_KEYS: dict[str, Check] = {
    "record": _text,
    "journal": _choice(list(_journals.COLUMNS)),
    "width": _width,
    "height": _between(_journals.SMALLEST, _journals.LARGEST, "mm"),
    "font": _text,
    "font_size": _between(SMALLEST_TYPE, LARGEST_TYPE, "points"),
    "columns": _between(1, MOST_PANELS, "columns"),
    "grid": _list(_text, '["aab", "ccb"]'),
    "column_widths": _list(_between(1e-3, 1e3, ""), "[2, 1]"),
    "row_heights": _list(_between(1e-3, 1e3, ""), "[2, 1]"),
    "letters": _choice(list(LETTERS)),
    "panel": _panel_list,
}
"""The keys of the file, in the order in which they are written, and what each one holds."""

PANEL_KEYS: dict[str, Check] = {
    "variable": _text,
    "record": _text,
    "kind": _text,
    "title": _text,
    "legend": _choice(LEGENDS),
    "at": _or(_number, _list(_number, "[50, 250]")),
    "places": _or(_number, _list(_place, "[35, 70] or [[30, 5], [60, 5]]")),
    "trial": _whole,
    "where": _table(_number, '{ "s.amplitude" = 4 }'),
    "axes": _list(_text, '["x", "y"]'),
    "reduce": _choice(REDUCTIONS),
    "time_range": _range,
    "every": _number,
    "value_range": _range,
    "colors": _text,
    "labels": _table(_text, '{ time = "time (ms)", value = "activation" }'),
}
"""The keys of a panel."""


def _checked(
    data: Mapping[str, Any], keys: Mapping[str, Check], where: str, problems: list[Problem]
) -> dict[str, Any]:
    """Return the valid entries of a table; add a problem for each of the others."""
    found: dict[str, Any] = {}
    for key, value in data.items():
        if key not in keys:
            problems.append(Problem(where, f"unknown key {key!r}", did_you_mean(key, keys)))
            continue
        try:
            found[key] = keys[key](value)
        except ValueError as error:
            problems.append(
                Problem(f"{where}, {key}" if where else key, f"expected {error}, got {show(value)}")
            )
    return found


def _faults(figure: FigureFile) -> Iterator[Problem]:
    """Yield what is wrong with the values of a figure together."""
    n = len(figure.panels)
    if n > MOST_PANELS:
        yield Problem("", f"{n} panels are too many for one figure", f"Name at most {MOST_PANELS}")
    for key in FIGURE_KEYS:
        value = getattr(figure, key, None)
        if value is not None:
            try:
                FIGURE_KEYS[key](list(value) if isinstance(value, tuple) else value)
            except ValueError as error:
                yield Problem(key, f"expected {error}, got {show(value)}")
    if figure.journal is not None and not isinstance(figure.width, str):
        yield Problem(
            "journal", "gives the width of a column, and width names none", 'For example width = "single"'
        )
    if figure.font is not None and not _style.installed(figure.font):
        yield Problem("font", f"{figure.font!r} is not installed", "Leave it out for DejaVu Sans")
    if figure.grid is not None:
        yield from _grid_faults(figure.grid, n)
        if figure.columns is not None:
            yield Problem("columns", "is given beside grid", "Leave out one of them")
    shape = figure.grid and (len(figure.grid), max(map(len, figure.grid)))
    across = figure.columns or 1
    rows, columns = shape or (-(-n // across), across)
    for key, count, what in (("column_widths", columns, "columns"), ("row_heights", rows, "rows")):
        given = getattr(figure, key)
        if given is not None and len(given) != count:
            yield Problem(key, f"has {len(given)} numbers, and the figure {count} {what}")


def _grid_faults(grid: Sequence[str], panels: int) -> Iterator[Problem]:
    known = string.ascii_lowercase[:panels]
    if len(set(map(len, grid))) != 1 or not grid[0]:
        yield Problem("grid", "its rows have different numbers of letters", "Write . where no panel is")
        return
    for letter in dict.fromkeys("".join(grid)):
        if letter != "." and letter not in known:
            yield Problem("grid", f"{letter!r} is not a panel; there are {panels}", "a is the first panel")
    for letter in known:
        if letter not in "".join(grid):
            yield Problem("grid", f"panel {letter} has no position")
            continue
        (top, below), (left, right) = _span(grid, letter)
        if any(set(row[left:right]) != {letter} for row in grid[top:below]):
            yield Problem("grid", f"the positions of panel {letter} are not a rectangle")


def _span(grid: Sequence[str], letter: str) -> tuple[tuple[int, int], tuple[int, int]]:
    rows = [k for k, row in enumerate(grid) if letter in row]
    columns = [k for row in grid for k, found in enumerate(row) if found == letter]
    return (rows[0], rows[-1] + 1), (min(columns), max(columns) + 1)


def _shared(whole: float, parts: Sequence[float]) -> list[float]:
    """Divide a length in proportion."""
    return [whole * part / sum(parts) for part in parts]


def _tenths(inches: Sequence[float]) -> float:
    """Return the sum of lengths in mm, rounded as it is written into a file."""
    return round(_journals.INCH * sum(inches), 1)


def _relative(path: Path, folder: Path) -> str:
    """Return a path as seen from a folder, with slashes; on another drive of Windows, the whole path."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return path.resolve().as_posix()


def _toml(value: Any) -> str:
    """Return a value in TOML, in one line."""
    if isinstance(value, str):
        return codec.line(value).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_toml_key(str(k))} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return f"{value:g}" if float(f"{value:g}") == value else repr(value)


def _toml_key(key: str) -> str:
    plain = key and set(key) <= set(string.ascii_letters + string.digits + "-_")
    return key if plain else _toml(key)
