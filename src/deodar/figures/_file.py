"""The file of a figure: panels, ranges, labels and sizes, as TOML."""

from __future__ import annotations

import dataclasses as dc
import os
import string
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import xarray
from matplotlib.figure import Figure

from deodar import codec, regular_file
from deodar.errors import DeodarError, FigureError, Problem, did_you_mean, show
from deodar.figures import _encode, _panels, _style, _video
from deodar.figures._moving import Changing
from deodar.figures._view import REDUCTIONS, View
from deodar.model import output
from deodar.parameters import Part, PerAxis, Recompile, parameters, real
from deodar.part_data import part_of
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
LARGEST_FILE = 2**20
SMALLEST_TYPE, LARGEST_TYPE = 3.0, 40.0
SMALLEST_VIDEO, LARGEST_VIDEO = 64, 8192
Shares = Annotated[PerAxis | None, Recompile(lower=1e-3, upper=1e3)]
"""Relative sizes of columns or rows."""

SETTINGS = ("trial", "axes", "reduce", "every", "colors")
LISTED = ("at", "places", "time_range", "value_range")
NAMED = ("where", "labels")
"""The settings of a panel that are those of a `View`: single values, lists of numbers, and tables."""


@dc.dataclass(frozen=True)
class FigurePanel(Part):
    """One panel of a figure: a variable, the selected part of it, and its title.

    From `at` on, None has the meaning that it has in `View`.

    Attributes:
        variable: path of the variable in the record.
        kind: a kind of figure, such as time_course, space_time or path, or one of a package. None: the one
            that suits the variable.
        record: path of the record, if it is not that of the figure.
        title: title of the panel. None: that of the kind; "" for no title.
        legend: place of the legend, as "upper right", or "none". None: where it hides least.
        at: times, in the record's unit.
        places: for time courses of fields: positions, one number for each axis.
        trial: number of the trial.
        where: for each sweep path the selected value.
        axes: names of the axes to keep in a projection.
        reduce: contraction over the other axes in a projection.
        time_range: first and last time to show.
        every: time between two shown samples.
        value_range: smallest and largest value of the scale.
        colors: name of a colour map of matplotlib.
        labels: labels by name of an axis, `time` or `value`.
    """

    variable: str
    kind: str | None = None
    record: str | None = None
    title: str | None = None
    legend: Annotated[str | None, Recompile(choices=LEGENDS)] = None
    at: PerAxis | None = None
    places: object | None = None
    trial: Annotated[int | None, Recompile(lower=0)] = None
    where: Mapping[str, float] | None = None
    axes: Sequence[str] | None = None
    reduce: Annotated[str | None, Recompile(choices=REDUCTIONS)] = None
    time_range: PerAxis | None = None
    every: float | None = None
    value_range: PerAxis | None = None
    colors: str | None = None
    labels: Mapping[str, str] | None = None

    def validate(self) -> Iterator[tuple[str, str]]:
        for key in ("time_range", "value_range"):
            ends = _listed(getattr(self, key))
            if ends and not (len(ends) == 2 and ends[0] < ends[1]):
                yield key, f"is {show(list(ends))}; expected a smaller and a larger number, such as [0, 500]"
        places = _listed(self.places)
        if any(real(n) is None for place in places for n in _listed(place)):
            yield "places", f"is {show(self.places)}; expected such as [35, 70] or [[30, 5], [60, 5]]"

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
        values: dict[str, Any] = {key: getattr(self, key) for key in (*SETTINGS, *LISTED, *NAMED)}
        given = {key: value for key, value in values.items() if value is not None}
        given |= {key: _listed(given[key]) for key in LISTED if key in given}
        given |= {key: dict(given[key]) for key in NAMED if key in given}
        in_arena = (self.kind or "").replace("-", "_") == "path" and KEY in data.attrs
        return View(data[self.variable], **given, world=world_of(data) if in_arena else None)


@dc.dataclass(frozen=True, repr=False)
class FigureFile(Summarised, Part):
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
        ParameterError: a value is invalid; the message lists every problem.
    """

    panels: Sequence[FigurePanel]
    record: str | None = None
    journal: Annotated[str | None, Recompile(choices=tuple(_style.COLUMNS))] = None
    width: float | str | None = None
    height: Annotated[
        float | None, Recompile("mm", lower=_style.SMALLEST_PAGE, upper=_style.LARGEST_PAGE)
    ] = None
    font: str | None = None
    font_size: Annotated[float | None, Recompile("points", lower=SMALLEST_TYPE, upper=LARGEST_TYPE)] = None
    columns: Annotated[int | None, Recompile(lower=1, upper=MOST_PANELS)] = None
    grid: Sequence[str] | None = None
    column_widths: Shares = None
    row_heights: Shares = None
    letters: Annotated[str | None, Recompile(choices=tuple(LETTERS))] = None
    folder: str | Path = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "folder", str(self.folder))
        super().__post_init__()

    def validate(self) -> Iterator[tuple[str, str]]:
        n = len(self.panels)
        if n > MOST_PANELS:
            yield "panels", f"are {n}, too many for one figure; name at most {MOST_PANELS}"
        yield from self._width_faults()
        if self.font is not None and not _style.installed(self.font):
            yield "font", f"{self.font!r} is not installed; leave it out for DejaVu Sans"
        if self.grid is not None:
            yield from (("grid", fault) for fault in _grid_faults(self.grid, n))
            if self.columns is not None:
                yield "columns", "is given beside grid; leave out one of them"
        shape = self.grid and (len(self.grid), max(map(len, self.grid)))
        across = self.columns or 1
        rows, columns = shape or (-(-n // across), across)
        for key, count, what in (("column_widths", columns, "columns"), ("row_heights", rows, "rows")):
            shares = _listed(getattr(self, key))
            if shares and len(shares) != count:
                yield key, f"has {len(shares)} numbers, and the figure {count} {what}"

    def _width_faults(self) -> Iterator[tuple[str, str]]:
        if isinstance(self.width, str):
            known = _style.COLUMNS[self.journal or _style.DEFAULT_JOURNAL]
            if self.width not in known:
                yield "width", f"there is no column {self.width!r}. {did_you_mean(self.width, known)}"
            return
        number = None if self.width is None else real(self.width)
        low, high = _style.SMALLEST_PAGE, _style.LARGEST_PAGE
        if self.width is not None and (number is None or not low <= number <= high):
            yield "width", f"is {show(self.width)}; expected {low:g} to {high:g} mm, or a column"
        if self.journal is not None:
            yield "journal", 'gives the width of a column, and width names none. For example width = "single"'

    # -------------------------------------------------------------------------------------------------- files

    @classmethod
    def read(cls, path: str | Path) -> FigureFile:
        """Read the file of a figure.

        Raises:
            FigureError: the file cannot be read, or is invalid; the message lists every problem.
        """
        path = Path(path)
        try:
            if path.stat().st_size > LARGEST_FILE:
                raise FigureError(f"is larger than {LARGEST_FILE // 2**20} MiB", where=str(path))
            text = regular_file.read_text(path)
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
        except RecursionError:
            raise FigureError("is nested too deeply") from None
        problems: list[Problem] = []
        tables: Any = data.pop("panel", [])
        if not isinstance(tables, list):
            problems.append(Problem("panel", 'expected tables, each under a line "[[panel]]"'))
            tables = []
        panels = [
            part_of(FigurePanel, table, f"panel {n}", {}, problems, "panel")
            for n, table in enumerate(tables, 1)
        ]
        # with a panel in place of each wrong one, the other problems of the figure are stated too
        preset = {"panels": [panel or FigurePanel("") for panel in panels], "folder": folder}
        figure = part_of(cls, data, "", preset, problems, "figure")
        if problems:
            raise FigureError(problems)
        return figure

    def text(self) -> str:
        """Return the figure in TOML; `parse` gives the same figure."""
        lines = _toml_lines(self, ("panels", "folder"))
        for panel in self.panels:
            lines += ["", "[[panel]]", *_toml_lines(panel)]
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
            width = _style.column_width(width, self.journal)
        grid = _panels.natural(cells, None if width is None else width / _style.INCH)
        if width is None:
            width = _tenths(grid.widths)
        height = self.height if self.height is not None else _tenths(grid.heights)
        return _panels.Tracks(
            _shared(width / _style.INCH, _listed(self.column_widths) or grid.widths),
            _shared(height / _style.INCH, _listed(self.row_heights) or grid.heights),
        )

    def _summary(self) -> Summary:
        rows = [(panel.variable, panel.kind or "the kind that suits") for panel in self.panels]
        return Summary(f"FigureFile of {counted(len(rows), 'panel')}", rows)


def _listed(values: Any) -> tuple[Any, ...]:
    """Return values of a list, of a single value in place of a list of one, or of None: none."""
    return () if values is None else tuple(values) if isinstance(values, list | tuple) else (values,)


def _grid_faults(grid: Sequence[str], panels: int) -> Iterator[str]:
    known = string.ascii_lowercase[:panels]
    if len(set(map(len, grid))) != 1 or not grid[0]:
        yield "its rows have different numbers of letters; write . where no panel is"
        return
    for letter in dict.fromkeys("".join(grid)):
        if letter != "." and letter not in known:
            yield f"{letter!r} is not a panel; there are {panels}, and a is the first"
    for letter in known:
        if letter not in "".join(grid):
            yield f"panel {letter} has no position"
            continue
        (top, below), (left, right) = _span(grid, letter)
        if any(set(row[left:right]) != {letter} for row in grid[top:below]):
            yield f"the positions of panel {letter} are not a rectangle"


def _span(grid: Sequence[str], letter: str) -> tuple[tuple[int, int], tuple[int, int]]:
    rows = [k for k, row in enumerate(grid) if letter in row]
    columns = [k for row in grid for k, found in enumerate(row) if found == letter]
    return (rows[0], rows[-1] + 1), (min(columns), max(columns) + 1)


def _shared(whole: float, parts: Sequence[float]) -> list[float]:
    """Divide a length in proportion."""
    return [whole * part / sum(parts) for part in parts]


def _tenths(inches: Sequence[float]) -> float:
    """Return the sum of lengths in mm, rounded as it is written into a file."""
    return round(_style.INCH * sum(inches), 1)


def _relative(path: Path, folder: Path) -> str:
    """Return a path as seen from a folder, with slashes; on another drive of Windows, the whole path."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return path.resolve().as_posix()


def _toml_lines(part: Part, without: Sequence[str] = ()) -> list[str]:
    """Return a line for each parameter that has a value."""
    values = {p.name: getattr(part, p.name) for p in parameters(type(part)) if p.name not in without}
    tables = {key: dict(values[key]) for key in NAMED if values.get(key) is not None}
    return [f"{key} = {_toml(value)}" for key, value in (values | tables).items() if value is not None]


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
