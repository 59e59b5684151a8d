"""`deodar studio`, started as by a user."""

from __future__ import annotations

import http.client
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

import deodar as dd
from deodar.cli import COMMANDS, _options, main
from deodar.importers import examples
from deodar_studio.web import app, serve
from deodar_studio.web.service import Service
from tests.deodar_studio.page import Page, play, studio


def fetch(address: str) -> tuple[int, bytes]:
    """Return status and content of the page at an address."""
    connection = http.client.HTTPConnection("127.0.0.1", urlsplit(address).port, timeout=600)
    try:
        parts = urlsplit(address)
        connection.request(
            "GET", "/", headers={"Cookie": f"deodar_token_{parts.port}={parts.query.removeprefix('token=')}"}
        )
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


def start(folder: Path, *words: str) -> tuple[subprocess.Popen[str], str]:
    """Start a studio in a process of its own; return it and the address that it prints."""
    environment = os.environ | {"DEODAR_STATE": str(folder / "state")}
    command = [sys.executable, "-m", "deodar", "studio", "--no-browser", "--port", "0", *words]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder, env=environment
    )
    assert process.stdout is not None
    return process, process.stdout.readline().split()[-1]


def test_the_studio_prints_its_address_responds_and_ends_with_ctrl_c(tmp_path: Path) -> None:
    process, address = start(tmp_path)
    try:
        parts = urlsplit(address)
        assert parts.hostname == "127.0.0.1" and len(parts.query.removeprefix("token=")) == 32
        assert b"<title>" in fetch(address)[1]
    finally:
        process.send_signal(signal.SIGINT)
        _, printed = process.communicate(timeout=600)
    assert process.returncode == 0 and printed == ""


def test_a_studio_in_the_background_of_a_script_ends_with_sigterm_and_says_so(tmp_path: Path) -> None:
    """A shell without job control makes what it starts with `&` ignore SIGINT."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        process, address = start(tmp_path)
    finally:
        signal.signal(signal.SIGINT, before)
    try:
        assert b"<title>" in fetch(address)[1]
    finally:
        process.terminate()
        _, printed = process.communicate(timeout=600)
    assert process.returncode == 128 + signal.SIGTERM
    assert printed == "deodar studio: SIGTERM has ended the studio\n"


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


def test_no_token_starts_the_studio_without_a_token(tmp_path: Path) -> None:
    process, address = start(tmp_path, "--no-token")
    try:
        assert urlsplit(address).query == "" and b"<title>" in fetch(address)[1]
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=600)


class FakeServer:
    """A server that answers at an address and ends."""

    def __init__(self, address: str, ready: Callable[[str], None], ended: Callable[[], None]) -> None:
        self.address, self.ready, self.ended = address, ready, ended

    def run(self, sockets: list[socket.socket]) -> None:
        self.ready(self.address)
        self.ended()

    def working(self) -> bool:
        return False


def opened_at(
    address: str, browser: bool, folder: Path, monkeypatch: pytest.MonkeyPatch, opens: Callable[[str], None]
) -> list[str]:
    """Start a studio that answers at an address; return the addresses that it prints."""
    said: list[str] = []
    monkeypatch.setattr(serve.webbrowser, "open", opens)
    monkeypatch.setattr(serve, "prepare", lambda *arguments: (FakeServer(address, *arguments[-2:]), None))
    serve.serve(Service(folder, port=0), browser, said.append)
    return said


def test_the_browser_is_opened_when_the_studio_responds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    for browser in (True, False):
        assert opened_at("http://here/", browser, tmp_path, monkeypatch, opened.append) == ["http://here/"]
    assert opened == ["http://here/"]


def test_the_token_is_not_in_the_command_line_of_the_browser(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Other users of the machine can read it there."""
    files: list[Path] = []

    def opens(address: str) -> None:
        assert "secret" not in address
        file = Path(url2pathname(urlsplit(address).path))
        assert file.stat().st_mode & 0o777 == 0o600 and file.parent.stat().st_mode & 0o777 == 0o700
        assert 'content="0; url=http://here/?token=secret&amp;x=&quot;"' in file.read_text()
        files.append(file)

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    address = 'http://here/?token=secret&x="'
    assert opened_at(address, True, tmp_path, monkeypatch, opens) == [address]
    assert len(files) == 1 and list(tmp_path.iterdir()) == []


def test_without_space_for_a_temporary_file_no_browser_is_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    assert opened_at("http://here/?token=secret", True, tmp_path, monkeypatch, opened.append) == [
        "http://here/?token=secret"
    ]
    assert opened == [] and "the browser is not opened" in caplog.text


def test_the_redirect_file_is_removed_when_the_studio_is_terminated(tmp_path: Path) -> None:
    """A script replaces the browser: it writes its argument and the content of the file."""
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/told\ncat "${{1#file://}}" > {tmp_path}/page\n')
    browser.chmod(0o700)
    (tmp_path / "tmp").mkdir()
    environment = os.environ | {
        "DEODAR_STATE": str(tmp_path / "state"),
        "TMPDIR": str(tmp_path / "tmp"),
        "BROWSER": str(browser),
    }
    command = [sys.executable, "-m", "deodar", "studio", "--port", "0"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, cwd=tmp_path, env=environment
    ) as process:
        assert process.stdout is not None
        address = process.stdout.readline().split()[-1]
        assert b"<title>" in fetch(address)[1]  # the browser is opened before the first request is answered
        process.send_signal(signal.SIGTERM)
        process.wait(600)
    assert address in (tmp_path / "page").read_text()
    assert urlsplit(address).query not in (tmp_path / "told").read_text()
    assert list((tmp_path / "tmp").glob("deodar-studio-*")) == []


def test_a_port_in_use_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert main(["studio", "--no-browser", "--port", str(taken.getsockname()[1])]) == 1
    assert "--port 0" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--port", "70000"], ["--port", "x"], ["gone/x.json"]])
def test_invalid_calls_end_with_status_2(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as stopped:
        main(["studio", "--no-browser", *words])
    assert stopped.value.code == 2


def test_an_unknown_world_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["studio", "--no-browser", "--world", "pictur:x.png"]) == 1
    assert "picture" in capsys.readouterr().err


def test_a_missing_page_is_an_error_that_states_what_to_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app, "STATIC", tmp_path)
    monkeypatch.setenv("DEODAR_STATE", str(tmp_path))
    with studio(tmp_path) as address:
        status, content = fetch(address)
    assert status == 503 and b"python studio/build.py build" in content


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_studio_opens_a_package_and_saves_it(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DEODAR_STATE", str(workspace / "state"))
    assert main(["pack", "example:node"]) == 0

    async def scene(p: Page) -> None:
        await p.runs()
        await p.ask("list_folder", path="")
        assert (await p.until(lambda: p.said.get("folder")))["files"] == ["node.deodar"]
        await p.do("set", element=p.element("u"), parameter="tau", value=33.0)
        await p.do("save")

    with studio(workspace, workspace / "node.deodar") as address:
        play(address, scene)
    assert dd.load("node.deodar").get("u.tau") == 33.0
    assert sorted(p.name for p in workspace.iterdir()) == ["node.deodar", "state"]


def test_the_studio_opens_an_example_as_a_copy_without_a_file(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The studio writes below the working folder, never into the folder of the examples."""
    monkeypatch.setenv("DEODAR_STATE", str(workspace / "state"))
    served: list[Any] = []
    monkeypatch.setattr("deodar_studio.web.serve.serve", lambda *args: served.extend(args) or 0)
    assert main(["studio", "example:node", "--no-browser"]) == 0
    service = served[0]
    assert service.root == workspace

    async def scene(p: Page) -> None:
        await p.runs()
        assert p.document["title"] == "node" and p.document["file"] == ""

    with studio(service.root, service.file) as address:
        play(address, scene)


def test_a_missing_document_is_reported_before_a_port_is_opened(workspace: Path) -> None:
    command = [sys.executable, "-m", "deodar", "studio", "nope.json", "--no-browser", "--port", "0"]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        cwd=workspace,
        env=os.environ | {"DEODAR_STATE": str(workspace)},
        timeout=600,
    )
    assert done.returncode == 1 and not done.stdout and "nope.json: there is no such file" in done.stderr


def test_an_example_is_opened_by_the_command_that_opens_documents(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    served: list[Any] = []
    monkeypatch.setattr("deodar_studio.web.serve.serve", lambda *args: served.extend(args) or 0)
    assert main(["examples", "open", "node"]) == 0
    assert served[0].root == workspace and served[0].file == examples.file("node")


@pytest.mark.parametrize(
    ("name", "says"),
    [("nope.json", "nope.json: there is no such file"), ("selection", "Did you mean 'example:selection'?")],
)
def test_an_unknown_example_is_an_error_that_states_what_to_type(
    name: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["studio", name, "--no-browser"]) == 1
    assert says in " ".join(capsys.readouterr().err.split())


def test_the_command_takes_names_of_examples_as_other_commands_do() -> None:
    parser = _options.CommandParser()
    COMMANDS["studio"].arguments(parser)
    assert next(a for a in parser._actions if a.dest == "file").type is _options.document
