"""Stores of records: a file is there whole or not at all, errors name what is wrong, and nothing shows
credentials.
"""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

import pytest

from deodar.errors import MissingExtra, OutputError, ParameterError, RecordError
from deodar.model import output
from deodar.recording.record_store import FolderStore, refused
from deodar.recording.store_address import StoreAddress
from tests.deodar.recording.failing_store import FailingFileSystem, register

NAME = "records/0000/00000000-00000001.zarr.zip"


@pytest.fixture(autouse=True)
def failing():
    """Make fsspec know the file system of these tests, empty."""
    register()


@pytest.fixture(params=["folder", "file", "memory", "failing"])
def address(request, tmp_path):
    """Return the address of a store that does not exist yet, of each kind."""
    return StoreAddress.of(
        {
            "folder": tmp_path / "a store",
            "file": (tmp_path / "a store").as_uri(),
            "memory": f"memory://{tmp_path.name}/store",
            "failing": "failing://user:top%20secret@bucket/store/",
        }[request.param]
    )


def test_files_are_stored_listed_read_and_replaced(address):
    store = address.open()
    assert store.get(NAME) is None and store.sizes() == {}
    store.create()
    store.put(NAME, b"first")
    store.put(NAME, b"the second")
    store.put("index.jsonl", b"")
    store_again = address.open()
    assert store_again.get(NAME) == b"the second"
    assert store_again.sizes() == {NAME: 10, "index.jsonl": 0} and store_again.sizes("records") == {NAME: 10}
    with store_again.open(NAME) as file:
        file.seek(4)
        assert file.read(3) == b"sec"
    with pytest.raises(RecordError, match="there is no such file of records"), store_again.open("none"):
        pass
    assert "secret" not in store.shown and store.shown == address.shown


def test_a_store_is_made_where_its_parent_exists(tmp_path):
    for text in (tmp_path / "none" / "store", "failing://elsewhere/store"):
        with pytest.raises(OutputError, match=r"the store of the records is not there. Connect or"):
            StoreAddress.of(text).open().create()
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_gone_is_not_made_again(tmp_path):
    with pytest.raises(OutputError, match="the store of the records is not there"):
        FolderStore(tmp_path / "gone").put(NAME, b"content")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_listed_is_not_taken_for_an_empty_one(tmp_path, monkeypatch):
    store = FolderStore(tmp_path / "store")
    assert store.sizes() == {}, "there is none yet"
    store.create()
    store.put(NAME, b"one")
    listed = os.scandir

    def refuses(path):
        if str(path).endswith("0000"):
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return listed(path)

    monkeypatch.setattr(os, "scandir", refuses)
    for name in ("", "records"):
        with pytest.raises(RecordError, match=r"records/0000: the store of the records cannot be read"):
            store.sizes(name)


@pytest.mark.parametrize("first", [b"", b"an earlier content"])
def test_a_folder_that_is_full_holds_no_part_of_a_file(tmp_path, monkeypatch, first):
    store = FolderStore(tmp_path)
    if first:
        store.put(NAME, first)

    def sync(path):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(output, "sync", sync)
    with pytest.raises(OutputError, match=r"00000001.zarr.zip: the store of the records is full. Make room"):
        store.put(NAME, b"content")
    assert [p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()] == ([first] if first else [])


def test_a_file_system_that_is_full_holds_no_part_of_a_file():
    store = StoreAddress.of("failing://bucket/store").open()
    store.put(NAME, b"content")
    FailingFileSystem.become("full")
    with pytest.raises(OutputError, match="the store of the records is full"):
        store.put(NAME, b"another content")
    assert store.get(NAME) == b"content" and FailingFileSystem.names() == [f"/bucket/store/{NAME}"]


def test_an_object_is_put_again_where_a_rename_replaces_nothing(monkeypatch):
    """As on a server of SMB, after a caller was killed between an object and its rows."""
    rename = FailingFileSystem.mv

    def refuses(self, old, new):
        if self.exists(new):
            raise FileExistsError(new)
        rename(self, old, new)

    monkeypatch.setattr(FailingFileSystem, "mv", refuses)
    store = StoreAddress.of("failing://bucket/store").open()
    for _ in range(2):
        store.put(NAME, b"the same object")
    assert store.sizes() == {NAME: 15}
    with pytest.raises(OutputError, match=r"took no file .FileExistsError"):
        store.put(NAME, b"another object")
    assert store.get(NAME) == b"the same object" and store.sizes() == {NAME: 15}


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (OSError(errno.EDQUOT, "Disk quota exceeded"), "is full. Make room there"),
        (OSError(errno.EROFS, "Read-only file system"), r"written \(Read-only file system\). Permit it"),
        (PermissionError("403"), r"cannot be written \(403\). Permit it there"),
        (NotImplementedError(), "cannot be written .no message.. Permit it there"),
        (OSError(errno.ESTALE, "Stale file handle"), "is not there. Connect or create it"),
        (FileNotFoundError("The specified bucket does not exist"), "is not there"),
        (ConnectionError("refused"), r"took no file \(ConnectionError: refused\)"),
        (RuntimeError("of a package"), "took no file .RuntimeError: of a package"),
    ],
)
def test_errors_say_what_is_wrong_and_that_the_call_resumes(error, says):
    text = str(refused("there", error))
    assert text.startswith("there: the store of the records ")
    assert text.endswith("Rows that exist are kept, and the same call resumes")
    with pytest.raises(OutputError, match=says):
        raise refused("there", error)


def test_addresses_that_cannot_be_used_are_refused(monkeypatch):
    monkeypatch.setitem(sys.modules, "s3fs", None)
    with pytest.raises(ParameterError, match=r"s3://b/n: the address of the store needs.*Install s3fs"):
        StoreAddress.of("s3://b/n").open()
    with pytest.raises(ParameterError, match=r"is not the address of a store.*such as s3://BUCKET/NAME"):
        StoreAddress.of("nonsense://a/b").open()
    with pytest.raises(ParameterError, match="a chain of addresses"):
        StoreAddress.of("simplecache::s3://a/b")
    for nothing in ("", "  ", None, 3):
        with pytest.raises(ParameterError, match="names no store of records"):
            StoreAddress.of(nothing)
    with pytest.raises(ParameterError, match=r"was written without its credentials. Name it again"):
        StoreAddress.of("ftp://***@host/store")
    for nowhere in ("s3://", "memory:///"):
        with pytest.raises(ParameterError, match=rf"{nowhere}: the address names no place below its scheme"):
            StoreAddress.of(nowhere)
    for short in ("file://", "file://data/records"):
        with pytest.raises(ParameterError, match=r"has three slashes.*file:///data/records, or data/records"):
            StoreAddress.of(short)
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    with pytest.raises(MissingExtra, match=r"needs the package fsspec.*pip install 'deodar\[store\]'"):
        StoreAddress.of("memory://a").open()


def test_addresses_of_folders_are_their_paths(tmp_path):
    for address in (tmp_path, str(tmp_path), tmp_path.as_uri(), f"file://localhost{tmp_path.as_posix()}"):
        assert StoreAddress.of(address).shown == str(tmp_path)
    assert isinstance(StoreAddress.of("C://data/records").open(), FolderStore)


def test_credentials_are_hidden():
    address = StoreAddress.of("ftp://user:top%20secret@host/store?token=abcdef/")
    assert address.shown == "ftp://***@host/store?token=***" and "secret" not in repr(address)
    for text in ("user:top secret", "login top%20secret", "ftp://user:top%20secret@host/x", "top secret"):
        assert "secret" not in address.hidden(text)
    assert address.hidden("no token abcdef of user:top secret") == "no token *** of ***"
    slash = StoreAddress.of("ftp://user:to/p@host/store")
    assert slash.shown == "ftp://***@host/store" and slash.hidden("bad login user:to/p") == "bad login ***"
    assert StoreAddress.of("ftp://us[er:secret@host/x").hidden("of us[er:secret") == "of ***"


def test_an_address_is_no_path():
    with pytest.raises(ParameterError, match=r'has no //.*as text: "s3://BUCKET/NAME"'):
        StoreAddress.of(Path("s3://bucket/name"))


@pytest.mark.parametrize("mode", ["silent", "forbidden"])
def test_errors_of_packages_show_no_credentials(mode):
    store = StoreAddress.of("failing://user:top%20secret@bucket/store").open()
    FailingFileSystem.become(mode)
    with pytest.raises(OutputError) as caught:
        store.put(NAME, b"")
    assert "secret" not in str(caught.value) and "***" in str(caught.value)
