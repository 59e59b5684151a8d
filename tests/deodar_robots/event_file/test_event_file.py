"""The world of a recording of events: readings in time, models, settings, records, and other worlds."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.cli import main
from deodar.errors import WorldError
from deodar.recording.opened import again, named
from deodar.worlds import _capture
from deodar_robots.event_file import aedat2
from deodar_robots.eye.event_camera import EventCamera
from deodar_studio.world.embodiment import Embodiment, preview

HERE = Path(__file__).parent
PIXELS = (dd.Axis("column", 0, 127, 128), dd.Axis("row", 0, 127, 128))
COARSE = dd.EventFile.example_axes("events")


def recording(path: Path, times: list[int], columns: list[int] | None = None) -> Path:
    """Write on events in row 7, at times in microseconds."""
    places = np.array(columns if columns is not None else range(len(times)))
    rows, on = np.full(len(times), 7), np.ones(len(times), bool)
    path.write_bytes(aedat2.encoded(np.array(times), places, rows, on))
    return path


def lit(world: dd.EventFile, time: float) -> list[int]:
    return np.flatnonzero(world.sense("events", PIXELS, time)[:, 7]).tolist()


def test_a_reading_is_the_rate_in_the_period_before_its_time(tmp_path: Path) -> None:
    world = dd.EventFile(recording(tmp_path / "a.aedat", [0, 9_999, 10_000, 25_000]))
    assert [lit(world, t) for t in (0, 10, 20, 30, 40)] == [[], [0, 1], [2], [3], []]
    assert lit(world, 15.0) == [1, 2] and lit(world, 1e12) == []
    reading = world.sense("on", PIXELS, 10.0)
    assert reading[0, 7] == pytest.approx(100) and reading.sum() == pytest.approx(200)
    assert world.sense("off", PIXELS, 10.0).sum() == 0
    # 2 events among 16 pixels in 10 ms
    assert world.sense("events", COARSE, 10.0)[0, 1] == pytest.approx(12.5)
    slow = dd.EventFile(tmp_path / "a.aedat", period=25.0)
    assert slow.sense("on", PIXELS, 25.0).sum() == pytest.approx(120)


def test_a_loop_repeats_the_recording_without_end(tmp_path: Path) -> None:
    # it lasts 14 ms
    world = dd.EventFile(recording(tmp_path / "a.aedat", [0, 9_000, 13_999]), loop=True)
    assert world.duration == 14.0
    events = np.add.outer(14_000 * np.arange(20), [0, 9_000, 13_999]).ravel()
    for time in (0, 10, 20, 30, 140, 150, 155):
        inside = (events >= 1000 * (time - 10)) & (events < 1000 * time)
        assert world.sense("events", PIXELS, time).sum() * 0.01 == pytest.approx(inside.sum())
    slow = dd.EventFile(tmp_path / "a.aedat", loop=True, period=100.0)
    inside = (events >= 100_000) & (events < 200_000)
    assert slow.sense("events", PIXELS, 200.0).sum() * 0.1 == pytest.approx(inside.sum())


def test_a_single_event_repeats_in_a_period_of_a_day(tmp_path: Path) -> None:
    world = dd.EventFile(recording(tmp_path / "a.aedat", [5]), loop=True, period=86_400_000.0)
    assert world.sense("events", PIXELS, 86_400_000.0)[0, 7] == pytest.approx(1e6)


def test_events_of_an_eye_are_the_same_from_a_file(tmp_path: Path) -> None:
    eye = dd.Eye(screen=dd.EyeScreen(endless=False), first=(41.5, 81.5))
    eye.reset(3)
    readings: list[dict[str, np.ndarray]] = []
    parts: list[np.ndarray] = []
    for k in range(12):
        eye.act({"pan": np.array([1000.0 + 10 * k])}, 10.0 * k)
        readings.append({name: eye.sense(name, PIXELS, 0.0)[0] for name in ("on", "off")})
        for name, reading in readings[-1].items():
            counts = np.rint(reading * 0.01).astype(int).ravel()
            pixels = np.repeat(np.arange(128 * 128), counts)
            parts.append(np.stack([np.full(len(pixels), 10_000 * k), pixels, pixels * 0 + (name == "on")]))
    times, pixels, on = np.concatenate(parts, axis=1)
    assert times[0] == 0 and len(times) > 2000
    path = tmp_path / "eye.aedat"
    path.write_bytes(aedat2.encoded(times, pixels // 128, pixels % 128, on > 0))
    world = dd.EventFile(path)
    for k, reading in enumerate(readings):
        for name, values in reading.items():
            np.testing.assert_allclose(world.sense(name, PIXELS, 10.0 * (k + 1)), values, rtol=1e-5)


def test_a_field_follows_a_recording() -> None:
    model = dd.Model("following", dt=5)
    seen = model.add(dd.Sensor("seen", COARSE, sensor="on"))
    field = model.add(dd.Field("u", COARSE, tau=20, resting_level=-2))
    seen >> dd.Gain(0.6) >> field
    record = dd.simulate(model, 400, record="u.activation", every=40, world=dd.EventFile.example())
    peaks = record["u.activation"].max("row").idxmax("column").values
    # 128 columns in 1000 ms
    assert np.abs(np.diff(peaks[3:]) - 5.1).max() < 3 and abs(peaks[-1] - 51) < 6


def test_a_run_of_the_command_line_reads_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    model = dd.Model("watching", dt=10)
    model.add(dd.Sensor("seen", COARSE, sensor="events"))
    dd.save(model, tmp_path / "watching.json")
    file = recording(tmp_path / "hand.aedat", [0, 15_000])
    out = tmp_path / "out.zarr"
    text = f"event-file:{file},loop=yes"
    command = ["run", str(tmp_path / "watching.json"), "--duration", "40", "--out", str(out)]
    assert main([*command, "--record", "seen.output", "--every", "10", "--world", text]) == 0
    record = dd.load_record(out)
    assert (record["seen.output"].sum(("column", "row")).values > 0).tolist() == [
        False,
        True,
        True,
        False,
        True,
    ]
    document = json.loads(record.attrs["deodar"])["world"]
    assert (
        document["world"] == "EventFile"
        and document["file"] == str(file)
        and document["loop"]
        and document["sha256"]
    )
    assert main(["run", str(out)]) == 0
    assert "same bits" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["one.aedat4", "two.aedat4"])
def test_a_record_names_the_file_and_opens_it_again(name: str) -> None:
    stream = 1 if name == "two.aedat4" else 0
    said = dd.EventFile(HERE / name, period=5.0, loop=True, stream=stream).describe()
    assert json.loads(json.dumps(said)) == said
    opened = again(dd.EventFile, said)
    assert isinstance(opened, dd.EventFile)
    assert opened.describe() == said and opened.stream == stream and opened.period == 5.0


def test_a_record_of_a_video_names_the_pixels(tmp_path: Path) -> None:
    camera = EventCamera(threshold=0.3, shot=2.0)
    said = dd.EventFile(_capture.example(), size=(64, 48), camera=camera).describe()
    assert said["format"] == "video"
    opened = again(dd.EventFile, said)
    assert isinstance(opened, dd.EventFile) and opened.camera == camera and opened.describe() == said


def test_a_recording_takes_the_place_of_the_events_of_an_eye() -> None:
    file = dd.EventFile.example()
    world = dd.Combined(dd.Eye(screen=dd.EyeScreen(endless=False)), {"events": file})
    model = dd.Model("watching", dt=10)
    model.add(dd.Sensor("seen", COARSE, sensor="events"))
    model.add(dd.Sensor("pose", dd.Eye.example_axes("pose"), sensor="pose"))
    model.add(dd.Boost("right", amplitude=1200.0)) >> model.add(dd.Motor("pan", motor="pan"))
    record = dd.simulate(model, 200, record=["seen.output", "pose.output"], every=10, world=world)
    for k in (1, 7, 20):
        np.testing.assert_allclose(
            record["seen.output"].values[k], file.sense("events", COARSE, 10.0 * k), rtol=1e-5
        )
    assert record["seen.output"].values[20].max() > 0
    assert record["pose.output"].values[-1, 0] == pytest.approx(1200, abs=1), "the motor is that of the eye"
    text = f"combined:event-file:{file.name};events=eventfile:{HERE / 'one.aedat4'}"
    opened = named(text, "--world")
    assert isinstance(opened, dd.Combined) and opened.sensors["events"].period == 10


def test_the_studio_shows_where_the_events_are() -> None:
    world = dd.EventFile.example()
    shown = preview(world, None)
    assert (shown.width, shown.height, shown.missing) == (128, 128, [])
    assert shown.sensors == ["events", "on", "off"]
    picture = world.preview()
    assert picture[60, :20, 0].max() == 1.0 and picture[60, 110:, 0].min() == 0.0
    assert np.all(picture[10] == 0.5)


def test_the_studio_opens_a_file_with_settings() -> None:
    settings = {"period": 5, "loop": True, "size": [64, 48], "stream": 0.0, "jaer": False}
    file = str(HERE / "one.aedat4")
    world = Embodiment().open("EventFile", file, "one.aedat4", settings)
    assert isinstance(world, dd.EventFile) and world.period == 5.0 and world.loop and world.stream == 0


def test_a_simulated_eye_is_the_default_for_events() -> None:
    model = dd.Model("watching", dt=10)
    model.add(dd.Sensor("seen", COARSE, sensor="events"))
    assert isinstance(Embodiment().world(model.document), dd.Eye)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"period": 0}, "period is 0"),
        ({"period": float("nan")}, "period is nan"),
        ({"stream": -1}, "stream is -1; expected a whole number"),
        ({"stream": 0.5}, "stream is 0.5"),
        ({"stream": True}, "stream is True"),
        ({"size": (128,)}, "expected columns and rows"),
        ({"size": (0, 10)}, "expected columns and rows"),
        ({"size": "large"}, "expected columns and rows"),
        ({"size": (100_000, 100_000)}, "states a sensor of 100000 x 100000 pixels"),
    ],
)
def test_wrong_settings_are_refused(settings, message: str) -> None:
    with pytest.raises(WorldError, match=message):
        dd.EventFile(HERE / "one.aedat4", **settings)


@pytest.mark.parametrize(
    ("argument", "message"),
    [
        ("none.aedat", "none.aedat: there is no such file"),
        ("{}", "there is no such file"),
        ("one.aedat4,peroid=5", "there is no setting 'peroid'. Did you mean 'period'"),
        ("one.aedat4,period=fast", "period is 'fast'; expected a number"),
        ("one.aedat4,size=64", r"size is \[64\.0\]; expected columns and rows"),
        ("one.aedat4,loop=perhaps", "loop is 'perhaps'; expected yes or no"),
        ("one.aedat4,stream=x", "stream is 'x'; expected a number"),
        ("a\0b.aedat", "there is no such file"),
    ],
)
def test_an_argument_that_names_nothing_is_refused(
    argument: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(HERE)
    with pytest.raises(WorldError, match=message):
        dd.EventFile.open(argument.format(tmp_path))


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.aedat")
    with pytest.raises(WorldError, match="is not a regular file"):
        dd.EventFile(tmp_path / "pipe.aedat")
    with pytest.raises(WorldError, match="file is 5; expected the path of a recording"):
        dd.EventFile(5)  # type: ignore[arg-type]


def test_an_argument_states_settings_after_commas(tmp_path: Path) -> None:
    file = recording(tmp_path / "left,right.aedat", [0, 10])
    assert dd.EventFile.open(str(file)).count == 2
    world = dd.EventFile.open(f"{file}, period=5, loop=yes, size=128x200, jaer=no")
    assert (world.period, world.loop, world.size, world.jaer) == (5.0, True, (128, 200), False)


def test_a_reading_needs_two_axes_on_the_sensor() -> None:
    world, far = dd.EventFile(HERE / "two.aedat4", stream=1), dd.Axis("row", 24, 47, 24)
    line = dd.Axis("column", 0, 31, 32)
    assert not list(world.validate_axes("events", (line, dd.Axis("row", 0, 23, 24))))
    assert "lies outside of the sensor, 0 to 23 px" in next(iter(world.validate_axes("on", (line, far)))).what
    assert "has two axes" in next(iter(world.validate_axes("on", (line,)))).what
    with pytest.raises(WorldError, match="on: has two axes, columns and rows; the model gives it 1"):
        world.sense("on", (line,), 0.0)
