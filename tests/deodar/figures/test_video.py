"""Videos of figures: each frame shows its time, in every format and of every kind."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from PIL import Image

import deodar as dd
from deodar.errors import FigureError, MissingExtra, OutputError, OutputExists, RecordError
from deodar.figures import FigureFile, FigurePanel, _encode, _panels, _video
from deodar.worlds.arena.arena import Arena
from tests.deodar.recording.models import record


@pytest.fixture(scope="module")
def recorded() -> xarray.Dataset:
    return record(trials=2)


def frames(path: Path) -> list[np.ndarray]:
    """Return the frames of a GIF, or of a folder of PNG files."""
    if path.is_dir():
        return [np.asarray(Image.open(p).convert("RGB")) for p in sorted(path.iterdir())]
    with Image.open(path) as video:
        images: list[np.ndarray] = []
        for k in range(getattr(video, "n_frames", 1)):
            video.seek(k)
            images.append(np.asarray(video.convert("RGB")))
    return images


def milliseconds(path: Path) -> list[int]:
    with Image.open(path) as video:
        out: list[int] = []
        for k in range(getattr(video, "n_frames", 1)):
            video.seek(k)
            out.append(video.info["duration"])
    return out


def drawn(view: dict[str, Any], kind: str, times: list[float], recorded: xarray.Dataset) -> list[Any]:
    """Return what a kind shows at each time: the arrays of its maps and lines."""
    figure = FigureFile([FigurePanel("u.activation", kind=kind, **view)])
    changing: list[Any] = []
    cells = figure._cells(recorded)
    animation = _panels.draw(cells, figure._sized(cells), times, changing)
    out = []
    for time in times:
        for part in changing:
            part.show(time)
        (ax,) = animation.axes
        lines = [np.array(line.get_data()) for line in ax.get_lines()]
        out.append((ax.get_title(), [np.asarray(i.get_array()) for i in ax.get_images()], lines))
    return out


def test_a_snapshot_shows_trials_and_their_mean_at_each_time(recorded: xarray.Dataset) -> None:
    u = recorded["u.activation"].values
    for k, (title, _, lines) in enumerate(drawn({}, "snapshot", [5.0, 12.0, 20.0], recorded)):
        step = (1, 2, 4)[k]
        curves = [y for _, y in lines if len(y) == 11]
        assert title == f"{(5, 10, 20)[k]} ms" and len(curves) == 3
        assert np.array_equal(curves[0], u[0, step]) and np.array_equal(curves[1], u[1, step])
        assert np.allclose(curves[2], u[:, step].mean(0))


def test_a_line_moves_over_time(recorded: xarray.Dataset) -> None:
    for kind in ("space_time", "time_course"):
        picture = drawn({"trial": 1}, kind, [0.0, 15.0], recorded)
        for time, (_, _, lines) in zip((0.0, 15.0), picture, strict=True):
            assert any(x.tolist() == [time, time] for x, _ in lines)


def test_maps_and_projections_change_their_values() -> None:
    x, y = dd.Axis("x", 0, 20, samples=11), dd.Axis("y", 0, 10, samples=6)
    model = dd.Model("plane")
    model.add(dd.Field("u", [x, y], noise=0.5))
    record = dd.simulate(model, 20, record="u.activation", every=5)
    u = record["u.activation"].values
    for k, (title, maps, _) in enumerate(drawn({}, "snapshot", [0.0, 20.0], record)):
        assert np.array_equal(maps[0], u[(0, 4)[k]].T) and title == ("0 ms", "20 ms")[k]
    for k, (title, _, lines) in enumerate(drawn({"axes": ["x"]}, "projection", [5.0, 20.0], record)):
        assert np.allclose(lines[0][1], u[(1, 4)[k]].max(1)) and title == ("5 ms", "20 ms")[k]
    for k, (_, maps, _) in enumerate(drawn({"axes": ["x", "y"]}, "projection", [5.0, 20.0], record)):
        assert np.allclose(maps[0], u[(1, 4)[k]].T)


def test_a_path_grows_in_its_arena() -> None:
    driven = np.stack([0.2 + 0.1 * np.arange(5), np.full(5, 0.3), np.full(5, np.pi / 2)], -1)
    variable = xarray.DataArray(
        driven[None],
        dims=("trial", "time", "of"),
        coords={
            "time": ("time", np.arange(5) * 64.0, {"units": "ms"}),
            "of": ("of", [0, 1, 2], {"lower": 0}),
        },
        name="pose.output",
    )
    from matplotlib.figure import Figure

    from deodar.figures import path

    ax = Figure().subplots()
    part = path.moving(ax, dd.figures.View(variable, world=Arena("blocks")), [0.0, 256.0])
    part.show(128.0)
    lines = [np.array(line.get_data()) for line in ax.get_lines()]
    assert any(np.allclose(line, driven[:3, :2].T) for line in lines) and ax.get_title() == "128 ms"
    (vehicle,) = (
        p
        for p in ax.patches
        if hasattr(p, "get_center")
        and np.ndim(getattr(p, "radius", None)) == 0
        and type(p).__name__ == "Circle"
    )
    assert np.allclose(vehicle.get_center(), driven[2, :2])
    assert any(np.allclose(line[0], 0.4) and line[1][1] > 0.3 for line in lines if line.shape == (2, 2))


@pytest.mark.parametrize("ending", ["", ".gif"])
def test_each_frame_is_the_figure_of_its_time(recorded: xarray.Dataset, tmp_path: Path, ending: str) -> None:
    """Only what changes is drawn again; the frames are those of complete figures."""
    panels = [FigurePanel("u.activation", trial=0), FigurePanel("u.activation", trial=0, kind="snapshot")]
    figure = FigureFile(panels, columns=2, width=120, height=45)
    path = figure.animate(tmp_path / f"video{ending}", recorded, width=360)
    shots = frames(path)
    assert len(shots) == 5 and all(frame.shape == (135, 360, 3) for frame in shots)
    changing: list[Any] = []
    cells = figure._cells(recorded)
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    with dd.figures._style.style():
        whole = _panels.draw(cells, figure._sized(cells), [0.0, 20.0], changing)
    for part in changing:
        part.show(15.0)
    whole.set_dpi(360 / whole.get_size_inches()[0])
    canvas = FigureCanvasAgg(whole)
    canvas.draw()
    expected = np.asarray(canvas.buffer_rgba())[..., :3].astype(float)
    assert np.abs(shots[3] - expected).mean() < (0.6 if ending else 0.2)
    assert np.abs(shots[3] - shots[0].astype(float)).mean() > 1.0


def test_the_interval_and_the_speed_set_the_frames(recorded: xarray.Dataset, tmp_path: Path) -> None:
    figure = FigureFile([FigurePanel("u.activation", trial=0)], width=60, height=40)
    done: list[tuple[int, int]] = []
    figure.animate(
        tmp_path / "a.gif",
        recorded,
        every=10,
        speed=0.05,
        width=200,
        on=dd.Resources(progress=lambda n: done.append((int(n), n.of))),
    )
    assert milliseconds(tmp_path / "a.gif") == [200, 200, 200] and done == [(1, 3), (2, 3), (3, 3)]
    figure.animate(tmp_path / "b.gif", recorded, width=200)
    assert milliseconds(tmp_path / "b.gif") == [40] * 5
    with pytest.raises(
        FigureError,
        match=r"needs 200 frames in a second; gif has 50 at most\. One frame every N ms or more: every=20",
    ):
        figure.animate(tmp_path / "c.gif", recorded, speed=1, width=200)
    with pytest.raises(OutputExists):
        figure.animate(tmp_path / "a.gif", recorded)
    figure.animate(tmp_path / "a.gif", recorded, width=200, force=True)
    long = [dd.figures.View(xarray.DataArray(np.zeros(1501), dims="time", name="n"))]
    assert len(_video.times(long, None)) == 501


def test_a_frame_without_a_change_lengthens_the_one_before(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    first = rng.integers(0, 8, (20, 31, 3), dtype=np.uint8) * 30
    second = first.copy()
    second[5:9, 3:20] = 255
    _encode.write([first, first, second, second, second, first], tmp_path / "a.gif", "gif", 10)
    assert milliseconds(tmp_path / "a.gif") == [200, 300, 100]
    for picture, frame in zip(frames(tmp_path / "a.gif"), (first, second, first), strict=True):
        assert np.abs(picture - frame.astype(float)).max() <= 30


def test_frames_of_one_palette_have_its_colours_and_keep_invisible_differences(
    tmp_path: Path,
) -> None:
    black, grey, red = [0, 0, 0], [100, 100, 100], [200, 0, 0]
    palette = _encode.VideoPalette(np.array([black, grey, [104, 101, 100], red], np.uint8), tolerance=6)
    first = np.full((20, 31, 3), 99, np.uint8)
    second = first.copy()
    second[5:9, 3:20] = 104, 102, 100  # nearest to a colour that differs by 5 from the grey
    second[12:14, 2:4] = 190, 10, 0
    _encode.write([first, second, second, first], tmp_path / "a.gif", "gif", 10, palette=palette)
    assert milliseconds(tmp_path / "a.gif") == [100, 200, 100]
    expected = np.full((20, 31, 3), 100)
    between = expected.copy()
    between[12:14, 2:4] = red
    for picture, frame in zip(frames(tmp_path / "a.gif"), (expected, between, expected), strict=True):
        assert (picture == frame).all()
    file = (tmp_path / "a.gif").read_bytes()
    assert file[10] & 0x80 and file.count(bytes([*black, *grey])) == 1, "one table, of the whole file"


def test_a_palette_has_the_fixed_colours_and_counts_a_rare_colour_as_much_as_a_frequent_one() -> None:
    sample = np.full((100, 100, 3), 250, np.uint8)
    sample[0, 0] = 10, 200, 10
    colours = _encode.of_samples([sample], np.array([[1.2, 2.0, 3.0], [1.0, 2.0, 3.0]]))
    assert len(colours) <= 255 and [1, 2, 3] in colours.tolist()
    assert np.abs(colours.astype(int) - [10, 200, 10]).sum(1).min() == 0


def test_an_mp4_has_every_frame(recorded: xarray.Dataset, tmp_path: Path) -> None:
    figure = FigureFile([FigurePanel("u.activation", trial=0)], width=60, height=41)
    path = figure.animate(tmp_path / "video.mp4", recorded, width=201)
    assert path.read_bytes()[4:8] == b"ftyp"
    raw = [
        _encode.ffmpeg(),
        "-loglevel",
        "error",
        "-i",
        str(path),
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-",
    ]
    pixels = subprocess.run(raw, capture_output=True, check=True).stdout
    assert len(pixels) == 5 * 202 * 138 * 3
    decoded = np.frombuffer(pixels, np.uint8).reshape(5, 138, 202, 3).astype(float)
    figure.animate(tmp_path / "frames", recorded, width=201)
    for frame, same in zip(frames(tmp_path / "frames"), decoded, strict=True):
        assert np.abs(frame - same[: frame.shape[0], :201]).mean() < 8


def test_ffmpeg_that_fails_or_is_missing_is_one_error(
    recorded: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    frame = np.zeros((20, 20, 3), np.uint8)
    program = tmp_path / "ffmpeg"
    program.write_text(f"#!{sys.executable}\nimport sys\nsys.exit('no such codec')\n")
    program.chmod(0o755)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setattr(_encode.shutil, "which", lambda name: str(program))
    with pytest.raises(OutputError, match="ffmpeg failed: no such codec"):
        _encode.write([frame] * 100, tmp_path / "a.mp4", "mp4", 25)
    monkeypatch.setattr(_encode.shutil, "which", lambda name: None)
    with pytest.raises(MissingExtra, match=r"pip install 'deodar\[video\]'"):
        FigureFile([FigurePanel("n.activation")]).animate(tmp_path / "a.mp4", recorded)
    assert [p.name for p in tmp_path.iterdir()] == ["ffmpeg"]


def test_a_figure_that_cannot_change_is_refused(recorded: xarray.Dataset, tmp_path: Path) -> None:
    for panel in (
        FigurePanel("u.activation", at=[5], kind="snapshot"),
        FigurePanel("u.activation", trial=0, kind="snapshots"),
    ):
        with pytest.raises(FigureError, match="nothing in the figure changes over time"):
            FigureFile([panel]).animate(tmp_path / "a.gif", recorded)
    with pytest.raises(RecordError, match="names no format of videos"):
        FigureFile([FigurePanel("n.activation")]).animate(tmp_path / "a.avi", recorded)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.txt").write_text("x")
    with pytest.raises(OutputError, match="other files than PNG"):
        FigureFile([FigurePanel("n.activation")]).animate(tmp_path / "full", recorded, force=True)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["full"]


def test_a_kind_of_a_package_is_drawn_again_for_each_time(recorded: xarray.Dataset, tmp_path: Path) -> None:
    from types import ModuleType

    kind = ModuleType("deodar_change.histogram")

    def fill(place: Any, view: dd.figures.View) -> None:
        ax = place.subplots()
        ax.set_title(view.time_label(view.times[view.instant()]))

    kind.ACROSS, kind.size, kind.fill = False, lambda view: (2.0, 2.0), fill  # type: ignore[attr-defined]
    view = dd.figures.View(recorded["u.activation"], trial=0)
    changing: list[Any] = []
    cell = _panels.Cell(view, kind, (0, 1), (0, 1))
    figure = _panels.draw([cell], _panels.natural([cell]), [0.0, 20.0], changing)
    titles = []
    for _ in _video.frames(figure, changing, [5.0, 20.0], 100):
        titles.append(figure.subfigs[0].axes[0].get_title())
    assert titles == ["5 ms", "20 ms"]
