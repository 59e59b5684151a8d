"""Which deodar wrote a file, and what to install to read a file of a later one.

Every file that deodar reads back states the version of its form, a whole number, and the deodar that wrote
it: under `written_by`, or in the versions of its provenance. A reader reads both before anything else.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Generator, Mapping
from typing import Any, cast

from deodar import __version__
from deodar.errors import DeodarError, DocumentError, show

KEY = "written_by"
"""Key of plain data under which a file states the deodar that wrote it."""

HERE = f"deodar {__version__}"
"""What files that are written here state."""

RELEASE = re.compile(r"(?:deodar )?(\d{1,6}(?:\.\d{1,6}){0,3}(?:(?:a|b|rc)\d{1,4})?(?:\.dev\d{1,6})?)")
"""A version of deodar. Any other text of a file is ignored, because messages propose to type it."""


def writer(plain: object) -> str:
    """Return the version of the deodar that wrote plain data; "": they state none.

    >>> writer({"written_by": "deodar 0.9.0"}), writer({"made_by": {"deodar": "0.9.0"}}), writer({})
    ('0.9.0', '0.9.0', '')
    """
    stated = cast("Mapping[str, Any]", plain) if isinstance(plain, Mapping) else {}
    made_by = stated.get("made_by")
    text = stated.get(KEY) or (made_by.get("deodar") if isinstance(made_by, Mapping) else None)
    release = RELEASE.fullmatch(text) if isinstance(text, str) else None
    return release[1] if release else ""


def require_readable(
    noun: str, version: object, latest: int, plain: object, error: type[DeodarError] = DocumentError
) -> None:
    """Refuse a file of a form that this deodar does not read.

    Args:
        noun: what the file is, with its article.
        version: the version of its form, as it states it.
        latest: the latest version that is read; the first one is 1.
        plain: plain data that state which deodar wrote it.
        error: class of the error.
    """
    number = version if isinstance(version, int) and not isinstance(version, bool) else 0
    if 1 <= number <= latest:
        return
    by = writer(plain)
    raise error(
        f"is {noun} of version {show(version)}{f', written by deodar {by}' if by else ''}; this deodar,"
        f" {__version__}, reads {f'versions 1 to {latest}' if latest > 1 else 'version 1'}",
        fix=_install(by) if number > latest else "",
    )


@contextlib.contextmanager
def naming_later_writer(plain: object) -> Generator[None]:
    """State in the errors of a block that a later deodar wrote the plain data it reads, if one did."""
    try:
        yield
    except DeodarError as error:
        by = writer(plain)
        if _is_later(by):
            error.advise(f"It was written by deodar {by}, and this is deodar {__version__}. {_install(by)}")
        raise


def _install(by: str) -> str:
    """Return what to type so that files of a version are read; "": it is not known."""
    requirement = f"'deodar>={by}'" if _is_later(by) else "deodar"
    return f"Type: pip install --upgrade {requirement}"


def _is_later(version: str) -> bool:
    # start-up time
    from packaging.version import Version

    return bool(version) and Version(version) > Version(__version__)
