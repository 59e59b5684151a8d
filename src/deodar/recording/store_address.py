"""The address of a store of records, whose credentials no message and no file shows."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

from deodar.credentials import HIDDEN, masked, secrets
from deodar.errors import ParameterError
from deodar.model import output
from deodar.recording.record_store import FolderStore, RecordStore
from deodar.recording.remote_store import RemoteStore

_URL = re.compile(r"[a-zA-Z][\w+.-]+://")
"""How an address begins; one letter before a colon is a drive of Windows."""

LOCAL = ("file", "local")
"""Schemes of addresses that name a folder."""


@dataclass(frozen=True)
class StoreAddress:
    """A folder, or an address of fsspec such as `s3://BUCKET/NAME`.

    Attributes:
        shown: the absolute path, or the address without credentials.
        full: the same with credentials; only the store receives it.
    """

    shown: str
    full: str = field(repr=False)

    @classmethod
    def of(cls, address: str | os.PathLike[str]) -> StoreAddress:
        """Read the path of a folder, or an address.

        Raises:
            ParameterError: it is neither, it names no place below its scheme, or its credentials were
                replaced by `***`.
        """
        text = str(address) if isinstance(address, str | os.PathLike) else ""
        fix = "Name a folder, or an address such as s3://BUCKET/NAME"
        if not text.strip():
            raise ParameterError(f"{address!r} names no store of records", fix=fix)
        if "::" in text and "://" in text:
            fault = "a chain of addresses (::) is no store of records"
            raise ParameterError(fault, where=masked(text), fix=fix)
        if not _URL.match(text):
            if not isinstance(address, str) and re.match(r"[a-zA-Z][\w+.-]+:[/\\]\w", text):
                fault = "a path has no //, so that it cannot be the address of a store"
                raise ParameterError(fault, where=text, fix='Name the address as text: "s3://BUCKET/NAME"')
            path = str(output.location(text).absolute())
            return cls(path, path)
        if HIDDEN in text:
            fault = "the address of the store was written without its credentials"
            raise ParameterError(fault, where=masked(text), fix="Name it again, with the whole address")
        scheme, _, place = text.partition("://")
        if scheme.lower() in LOCAL:
            if not re.match(r"(localhost)?/", place, re.IGNORECASE):
                fault = "the address of a folder has three slashes, and its whole path after them"
                raise ParameterError(
                    fault, where=text, fix="For example file:///data/records, or data/records"
                )
            path = str(Path(url2pathname(urlsplit(text).path)).absolute())
            return cls(path, path)
        if not place.strip("/"):
            raise ParameterError("the address names no place below its scheme", where=text, fix=fix)
        text = text.rstrip("/")
        return cls(masked(text), text)

    def open(self) -> RecordStore:
        """Return the store.

        Raises:
            MissingExtra: fsspec is not installed.
            ParameterError: no installed package reads such addresses.
        """
        if not _URL.match(self.full):
            return FolderStore(Path(self.full))
        return RemoteStore(self.full, self.shown, self.hidden)

    @property
    def local(self) -> bool:
        """Whether the store exists in the memory of this process alone."""
        return self.full.lower().startswith("memory:")

    def hidden(self, text: str) -> str:
        """Return a text without the credentials of the address, wherever in it they are."""
        for secret in secrets(self.full):
            text = text.replace(secret, HIDDEN)
        return masked(text)
