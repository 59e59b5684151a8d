"""A file that redirects a browser to the address of the studio.

Every user of the machine can read the command line of a browser, and a token in it. The browser is therefore
started with the name of a file that only this user can read and that contains the address.
"""

from __future__ import annotations

import html
import os
import shutil
import tempfile
from pathlib import Path

PAGE = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>deodar studio</title>
<meta http-equiv="refresh" content="0; url={address}">
<p><a href="{address}">Open the studio</a></p>
</html>
"""


class RedirectFile:
    """An HTML file with mode 0600 in a new folder with mode 0700.

    Attributes:
        path: the file.

    Args:
        address: target of the redirect.

    Raises:
        OSError: the file cannot be written.
    """

    def __init__(self, address: str) -> None:
        folder = Path(tempfile.mkdtemp(prefix="deodar-studio-"))
        self.path = folder / "open.html"
        try:
            descriptor = os.open(
                self.path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0), 0o600
            )
            with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                file.write(PAGE.format(address=html.escape(address)))
        except OSError:
            self.remove()
            raise

    @property
    def address(self) -> str:
        """URI of the file."""
        return self.path.as_uri()

    def remove(self) -> None:
        """Remove the file and its folder."""
        shutil.rmtree(self.path.parent, ignore_errors=True)
