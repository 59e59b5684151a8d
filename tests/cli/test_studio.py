"""`deodar studio` as a person starts it."""

from __future__ import annotations

import http.client
import os
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from deodar.cli import main
from deodar.server import app
from tests.server.page import play, studio


def fetch(address: str) -> tuple[int, bytes]:
    """Status and content of the page at an address."""
    connection = http.client.HTTPConnection("127.0.0.1", urlsplit(address).port, timeout=600)
    try:
        there = urlsplit(address)
        connection.request("GET", "/", headers={"Cookie": f"deodar_token_{there.port}={there.query.removeprefix('token=')}"})
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


def start(folder: Path, *words: str) -> tuple[subprocess.Popen[str], str]:
    """A studio in a process of its own, and the address it prints."""
    environment = os.environ | {"DEODAR_STATE": str(folder / "state")}
    command = [sys.executable, "-m", "deodar", "studio", "--no-browser", "--port", "0", *words]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder, env=environment)
    assert process.stdout is not None
    return process, process.stdout.readline().split()[-1]


def test_it_prints_an_address_answers_there_and_ends_with_ctrl_c(tmp_path: Path) -> None:
    process, address = start(tmp_path)
    try:
        there = urlsplit(address)
        assert there.hostname == "127.0.0.1" and len(there.query.removeprefix("token=")) == 32
        assert b"<title>" in fetch(address)[1]
    finally:
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=600)
    assert process.returncode == 0 and told == ""


def test_a_file_is_opened_by_a_relative_path_and_through_a_link(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    shutil.copy(Path(__file__).parents[2] / "examples" / "node.json", tmp_path / "folder")
    (tmp_path / "link.json").symlink_to(tmp_path / "folder" / "node.json")
    for name in ("folder/node.json", "link.json"):
        process, address = start(tmp_path, name)
        try:
            play(address, lambda p: p.until(lambda: p.document and p.document["file"] == "node.json"))
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=600)


def test_it_may_be_started_without_a_token(tmp_path: Path) -> None:
    process, address = start(tmp_path, "--no-token")
    try:
        assert urlsplit(address).query == "" and b"<title>" in fetch(address)[1]
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=600)


def test_it_opens_the_browser_once_it_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from deodar.server import serve

    opened: list[str] = []
    monkeypatch.setattr(serve.webbrowser, "open", opened.append)

    class Server:
        def __init__(self, ready: Callable[[str], None]) -> None:
            self.ready = ready

        def run(self, sockets: list[socket.socket]) -> None:
            self.ready("http://here/")

    monkeypatch.setattr(serve, "prepare", lambda *given: (Server(given[-1]), None))
    said: list[str] = []
    for browser in (True, False):
        serve.serve(None, tmp_path, "127.0.0.1", 0, browser, False, None, True, said.append)
    assert opened == ["http://here/"] and said == ["http://here/"] * 2


def test_a_taken_port_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert main(["studio", "--no-browser", "--port", str(taken.getsockname()[1])]) == 1
    assert "--port 0" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--port", "70000"], ["--port", "x"], ["gone/x.json"]])
def test_wrong_calls_end_with_2(words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as stopped:
        main(["studio", "--no-browser", *words])
    assert stopped.value.code == 2


def test_a_world_that_is_not_there_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["studio", "--no-browser", "--world", "pictur:x.png"]) == 1
    assert "picture" in capsys.readouterr().err


def test_a_page_that_was_not_built_says_what_to_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(app, "STATIC", tmp_path)
    monkeypatch.setenv("DEODAR_STATE", str(tmp_path))
    with studio(tmp_path) as address:
        status, content = fetch(address)
    assert status == 503 and b"python studio/build.py build" in content
