"""Cameras at an address: their newest picture, and one named error for each way to fail."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.cli._options import world as from_command_line
from deodar.credentials import masked
from deodar.errors import DeodarError, WorldError
from deodar.recording.opened import again
from deodar.worlds import _capture
from deodar.worlds.camera import Camera
from deodar_robots.robot.robot import Robot
from tests.deodar_robots.camera_peer import PeerServer, free_port, silent

AXES = Camera.example_axes("picture")
SECRET = "s3cr3t"


@pytest.fixture
def peer() -> Iterator[PeerServer]:
    server = PeerServer()
    yield server
    server.ended.set()
    server.shutdown()
    server.server_close()


@pytest.fixture
def made() -> Iterator[Callable[..., Camera]]:
    """Return a function that makes a camera, which is closed at the end of the test."""
    cameras: list[Camera] = []

    def make(*args: Any, **settings: Any) -> Camera:
        cameras.append(Camera(*args, **settings))
        return cameras[-1]

    yield make
    for each in cameras:
        each.close()


def wait_until(holds: Callable[[], bool], seconds: float = 20.0) -> None:
    limit = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < limit
        time.sleep(0.01)


def brightness(camera: Camera) -> float:
    return float(camera.picture().mean())


def test_the_newest_picture_of_an_address_is_read(peer: PeerServer, made: Callable[..., Camera]) -> None:
    camera = made(f"http://{peer.place}/stream", open_timeout=30.0, patience=30.0)
    camera.reset(0)
    assert camera.describe() == {
        "world": "Camera",
        "source": f"http://{peer.place}/stream",
        "size": [64, 48],
        "period": 40.0,
    }
    assert camera.sense("picture", AXES, 0.0).shape == (16, 12, 3)
    wait_until(lambda: peer.sent > 20)
    peer.stalled.set()  # the last picture is the newest one, whatever is read meanwhile
    time.sleep(0.1)
    wait_until(lambda: abs(brightness(camera) - peer.sent % 250) < 2.5)


def test_a_closed_camera_ends_its_thread_and_its_connection(
    peer: PeerServer, made: Callable[..., Camera]
) -> None:
    camera = made(f"http://{peer.place}/", open_timeout=30.0)
    camera.reset(0)
    names = [thread.name for thread in threading.enumerate()]
    assert f"camera http://{peer.place}/" in names
    camera.close()
    wait_until(lambda: peer.clients == 0)
    wait_until(lambda: f"camera http://{peer.place}/" not in [t.name for t in threading.enumerate()])
    assert camera.sense("picture", AXES, 0.0).shape == (16, 12, 3), "a reading opens it again"


@pytest.mark.parametrize("how", ["stalled", "ended"])
def test_a_stream_that_stops_is_an_error_and_is_read_again_when_it_comes_back(
    peer: PeerServer, made: Callable[..., Camera], how: str
) -> None:
    camera = made(f"http://{peer.place}/", patience=0.5, open_timeout=30.0)
    camera.reset(0)
    getattr(peer, how).set()
    begun = time.monotonic()
    with pytest.raises(WorldError, match=r"has delivered no picture for 0\.\d s") as caught:
        while time.monotonic() < begun + 20:
            camera.sense("picture", AXES, 0.0)
            time.sleep(0.01)
    assert "then continue" in str(caught.value) and f"camera http://{peer.place}/" in str(caught.value)
    assert ("has ended" in str(caught.value)) == (how == "ended")
    getattr(peer, how).clear()
    assert not camera.running
    assert camera.sense("picture", AXES, 0.0).shape == (16, 12, 3)


def test_pictures_of_another_size_are_errors(peer: PeerServer, made: Callable[..., Camera]) -> None:
    with pytest.raises(WorldError, match=r"has pictures of 64 x 48, and 32 x 24 are stated.*\(64, 48\)"):
        made(f"http://{peer.place}/", size=(32, 24), open_timeout=30.0).reset(0)
    camera = made(f"http://{peer.place}/", size=[64, 48], open_timeout=30.0)
    camera.reset(0)
    peer.size = (32, 24)  # OpenCV scales what follows
    sent = peer.sent
    wait_until(lambda: peer.sent > sent + 10)
    assert camera.picture().shape == (48, 64, 3)


def test_at_most_the_stated_rate_is_kept(peer: PeerServer, made: Callable[..., Camera]) -> None:
    camera = made(f"http://{peer.place}/", rate=0.01, patience=60.0, open_timeout=30.0)
    camera.reset(0)
    first, sent = brightness(camera), peer.sent
    wait_until(lambda: peer.sent > sent + 10)
    assert brightness(camera) == first


def test_a_file_is_played_at_its_own_rate(made: Callable[..., Camera]) -> None:
    camera = made(str(_capture.example()), patience=60.0, open_timeout=30.0)
    begun = time.monotonic()
    camera.reset(0)
    wait_until(lambda: not camera.running)
    assert time.monotonic() - begun > 0.9


@pytest.mark.parametrize("scheme", ["rtsp", "http", "https"])
def test_a_peer_that_refuses_or_is_silent_is_named_in_time(scheme: str) -> None:
    with pytest.raises(WorldError, match=r"127.0.0.1:\d+ refuses the connection.*Check the port"):
        Camera(f"{scheme}://127.0.0.1:{free_port()}/live").reset(0)
    with silent() as waiting:
        begun = time.monotonic()
        says = r"127.0.0.1:\d+ accepts the connection and sends no picture within 0.5 s.*open_timeout"
        with pytest.raises(WorldError, match=says):
            Camera(f"{scheme}://127.0.0.1:{waiting.getsockname()[1]}/live", open_timeout=0.5).reset(0)
        assert time.monotonic() - begun < 5.0
    # no thread stays behind
    wait_until(lambda: not [t for t in threading.enumerate() if t.name.startswith(f"camera {scheme}")])


def test_what_a_peer_answers_is_named(peer: PeerServer, made: Callable[..., Camera]) -> None:
    for path, says in (("none", r"answers 404, Not Found"), ("text", "nothing that OpenCV reads")):
        with pytest.raises(WorldError, match=says):
            made(f"http://{peer.place}/{path}", open_timeout=30.0).reset(0)
    peer.login = f"user:{SECRET}"
    with pytest.raises(WorldError, match=r"asks for a user and password.*machine 127.0.0.1 login USER"):
        made(f"http://{peer.place}/", open_timeout=30.0).reset(0)
    with pytest.raises(WorldError, match="refuses the user and password") as caught:
        made(f"http://user:{SECRET}2@{peer.place}/", open_timeout=30.0).reset(0)
    assert SECRET not in str(caught.value)


def test_a_host_that_does_not_exist_is_named() -> None:
    with pytest.raises(WorldError, match=r"there is no host nowhere.invalid|cannot be reached"):
        Camera("rtsp://nowhere.invalid/live", open_timeout=20.0).reset(0)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        (f"rtsp://user:{SECRET}@host:554/path", "rtsp://***@host:554/path"),
        (f"rtsp://{SECRET}@host/path", "rtsp://***@host/path"),
        (f"rtsp://user:a@{SECRET}@host/path", "rtsp://***@host/path"),
        (f"rtsp://user:a/{SECRET}@host/path", "rtsp://***@host/path"),
        (f"http://host/x?channel=1&token={SECRET}&b=2", "http://host/x?channel=1&token=***&b=2"),
        (f"http://host/x?PassWord={SECRET}", "http://host/x?PassWord=***"),
        (f"http://host/x?api_key={SECRET}/a=b", "http://host/x?api_key=***"),
        (f"rtsp://host/user=a_password={SECRET}_channel=1", "rtsp://host/user=a_password=***"),
        ("http://host/@name/x?size=2", "http://host/@name/x?size=2"),
        (
            f"combined:arena:blocks;camera=http://u:{SECRET}@host/",
            "combined:arena:blocks;camera=http://***@host/",
        ),
    ],
)
def test_credentials_are_masked(text: str, shown: str) -> None:
    assert masked(text) == shown


def test_no_word_of_a_camera_has_its_credentials(
    peer: PeerServer, made: Callable[..., Camera], tmp_path: Path
) -> None:
    peer.login = f"user:{SECRET}"
    address = f"http://user:{SECRET}@{peer.place}/s?token={SECRET}"
    hidden = f"http://***@{peer.place}/s?token=***"
    camera = made(address, open_timeout=30.0)
    camera.reset(0)
    assert camera.describe()["source"] == camera.source == hidden
    seen = [repr(camera), repr(vars(camera)), json.dumps(camera.describe())]
    seen += [repr(vars(vars(camera)["_reader"]))]
    seen += [t.name for t in threading.enumerate()]
    assert SECRET not in "".join(seen)
    camera.close()

    file = tmp_path / "mine.json"
    settings = {"source": address, "open_timeout": 30, "size": [64, 48], "rate": 10}
    file.write_text(json.dumps({"robot": 1, "name": "mine", "kind": "camera", "settings": settings}))
    robot = Robot(file)
    model = dd.Model("looking", dt=10)
    model.add(dd.Sensor("eye", AXES, "picture"))
    session = dd.Session(model, world=robot)
    session.run(40)
    robot.close()
    text = json.dumps(robot.describe())
    assert hidden in text and SECRET not in text
    for wrong in (
        f"camra:{address}",
        f"combined:arena:blocks;{address}",
        f"combined:arena:blocks;a=x:{address}",
    ):
        with pytest.raises(DeodarError) as caught:
            from_command_line(wrong)
        assert SECRET not in str(caught.value)


def test_a_record_names_the_camera_and_netrc_states_the_login(
    peer: PeerServer, made: Callable[..., Camera], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    peer.login = f"us@er:{SECRET}"
    camera = made(f"http://us%40er:{SECRET}@{peer.place}/", open_timeout=30.0)
    description = camera.describe()
    monkeypatch.setenv("NETRC", str(tmp_path / "netrc"))
    opened = again(Camera, description)
    with pytest.raises(WorldError, match=r"states no login for 127.0.0.1.*machine 127.0.0.1 login USER"):
        opened.reset(0)
    (tmp_path / "netrc").write_text(f"machine 127.0.0.1 login us@er password {SECRET}\n")
    opened.reset(0)
    assert isinstance(opened, Camera) and opened.describe() == description
    opened.close()
    (tmp_path / "netrc").write_text(f"machine 127.0.0.1 login {SECRET} passwor\n")
    with pytest.raises(WorldError, match="cannot be read") as caught:
        opened.reset(0)
    assert SECRET not in str(caught.value)
    with pytest.raises(WorldError, match="was stored without its secrets"):
        again(Camera, description | {"source": f"http://{peer.place}/?token=***"}).reset(0)


def test_the_results_of_an_experiment_have_no_login(peer: PeerServer, tmp_path: Path) -> None:
    peer.login = f"user:{SECRET}"
    model = dd.Model("looking", dt=40)
    model.add(dd.Sensor("eye", AXES, "picture"))
    world = f"camera:http://user:{SECRET}@{peer.place}/"
    dd.Experiment("seen", model, dd.TrialPlan(80.0), world=world).run(tmp_path / "results")
    written = b"".join(file.read_bytes() for file in tmp_path.rglob("*") if file.is_file())
    assert f"http://***@{peer.place}/".encode() in written and SECRET.encode() not in written


def test_a_camera_in_a_process_of_its_own_has_its_login(peer: PeerServer) -> None:
    peer.login = f"user:{SECRET}"
    camera = pickle.loads(pickle.dumps(Camera(f"http://user:{SECRET}@{peer.place}/", open_timeout=30.0)))
    camera.reset(0)
    assert camera.sense("picture", AXES, 0.0).shape[-3:] == tuple(axis.samples for axis in AXES)
    camera.close()


def test_a_program_that_ends_while_a_picture_is_read_is_not_aborted() -> None:
    # OpenCV is entered again and again, so that the thread is inside it when the program ends
    program = """
import sys
from deodar.worlds import _capture
from deodar.worlds._camera_reader import CameraReader, CameraSource, CameraTimes, _Stream
def watch(self, opened):
    cv2 = _capture.opencv("a camera")
    self.newest = opened.read()[1]
    self.ready.set()
    while not self.closing.is_set():
        cv2.blur(self.newest, (99, 99))
_Stream._watch = watch
reader = CameraReader(CameraSource("file", "film", sys.argv[1]), CameraTimes(60.0, 60.0))
print(reader.running)
"""
    done = subprocess.run(
        [sys.executable, "-c", program, str(_capture.example())], capture_output=True, text=True, timeout=300
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "True\n", "")


def test_a_robot_file_names_an_address_and_nothing_outside_its_folder(
    tmp_path: Path, made: Callable[..., Camera]
) -> None:
    file = tmp_path / "folder" / "mine.json"
    file.parent.mkdir()
    (tmp_path / "outside.avi").write_bytes(b"x")

    def robot(source: Any) -> Robot:
        settings = {"source": source, "open_timeout": 0.5}
        file.write_text(json.dumps({"robot": 1, "name": "mine", "kind": "camera", "settings": settings}))
        return Robot(file)

    for address in ("rtsp://127.0.0.1:1/live", "HTTP://127.0.0.1:1/../x", "https://127.0.0.1:1/"):
        with pytest.raises(WorldError, match="refuses the connection"):
            robot(address).reset(0)
    outside = str(tmp_path / "outside.avi")
    for wrong in (outside, "../outside.avi", f"file://{outside}", f"file:{outside}", "file:///../../../x"):
        with pytest.raises(
            WorldError, match=r"outside the folder|no such device or file|not an address"
        ) as caught:
            robot(wrong).reset(0)
        assert "cannot be read" not in str(caught.value), "it was opened"
    for protocol in (f"concat:{outside}", f"file://{outside}", "tcp://127.0.0.1:1", "pipe:0", "ftp://h/x"):
        with pytest.raises(WorldError, match=r"no such device or file|not an address"):
            made(protocol).reset(0)


def test_wrong_settings_are_named(peer: PeerServer) -> None:
    for settings, says in (
        ({"open_timeout": 0}, "open_timeout is 0"),
        ({"rate": -1}, "rate is -1"),
        ({"size": [640]}, r"size is \[640\]"),
        ({"size": (640.0, 480)}, "expected a width and a height"),
    ):
        with pytest.raises(WorldError, match=says):
            Camera(0, **settings)  # type: ignore[arg-type]
    for wrong in ("http://", "rtsp://ho st/x", "http://host:99999/", "http://h/\x01"):
        with pytest.raises(WorldError, match="no host, or characters"):
            Camera(wrong).reset(0)


def test_a_camera_stands_in_for_a_sensor_on_the_command_line(peer: PeerServer) -> None:
    world = from_command_line(f"combined:arena:blocks;camera=http://{peer.place}/?a=1;above=camera:0")
    assert isinstance(world, dd.Combined) and isinstance(world.others["camera"], Camera)
    assert world.others["camera"].source == f"http://{peer.place}/?a=1"
    reading = world.sense("camera", AXES, 0.0)
    assert np.isfinite(reading).all() and peer.asked[0] == "/?a=1"
    world.close()
    assert isinstance(from_command_line("rtsp://host/live"), Camera)


SCRIPT = """
import sys, time
import deodar as dd
from deodar.errors import WorldError
for source in sys.argv[2:]:
    camera = dd.Camera(source, patience=0.5, open_timeout=float(sys.argv[1]))
    try:
        camera.reset(0)
        while True:
            camera.picture()
            time.sleep(0.01)
    except WorldError as error:
        print(error)
    camera.close()
"""


def test_opencv_and_ffmpeg_write_nothing_to_the_terminal(
    peer: PeerServer, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    damaged = tmp_path / "damaged.avi"
    whole = _capture.example().read_bytes()
    damaged.write_bytes(whole[:1000] + bytes(len(whole) - 1000))
    (tmp_path / "text.mp4").write_text("no video")
    with silent() as waiting:
        port = waiting.getsockname()[1]
        sources = [f"{scheme}://127.0.0.1:{port}/" for scheme in ("http", "rtsp")]
        sources += [f"rtsp://127.0.0.1:{free_port()}/", f"http://{peer.place}/text", str(damaged)]
        sources += [f"http://{peer.place}/none", str(tmp_path / "text.mp4"), f"http://{peer.place}/"]
        run = subprocess.Popen([sys.executable, "-c", SCRIPT, "2", *sources])
        wait_until(lambda: ("/" in peer.asked and peer.sent > 20) or run.poll() is not None, 120.0)
        peer.stalled.set()
        assert run.wait(60) == 0
    printed = capfd.readouterr()
    assert printed.err == ""
    assert len(printed.out.splitlines()) == len(sources), printed.out
