"""A module that makes planning slow, and lets every program be compiled."""

import os
import time
from typing import Any

from deodar.session.session import Session

os.environ["DEODAR_CACHE"] = "off"
before = Session.__init__


def slow(self: Session, *args: Any, **kwargs: Any) -> None:
    time.sleep(4)
    before(self, *args, **kwargs)


setattr(Session, "__init__", slow)  # noqa: B010  # the signature differs
