"""A module that lets the first return to a moment fail, as an error of deodar itself would."""

from deodar.model.document import Document
from deodar_studio.live.engine import Engine

before = Engine.branch


def failing(self: Engine, time: float) -> Document:
    setattr(Engine, "branch", before)  # noqa: B010  # the next one works
    raise RuntimeError("the states are lost")


setattr(Engine, "branch", failing)  # noqa: B010  # the signature differs
