"""Settings of a studio: what it serves, and the address that it listens at."""

from __future__ import annotations

import dataclasses as dc
from pathlib import Path

from deodar.worlds._base import World
from deodar_studio.access.guard import is_local


@dc.dataclass(frozen=True)
class Service:
    """Settings of a studio: what it serves, and the address that it listens at.

    Attributes:
        root: the folder below which the studio reads and writes files.
        file: the document to open first; None: show the gallery of examples.
        trust: whether functions that documents name may be run.
        world: the world that sensors read; None: examples of worlds are used.
        host: name or number of the address; the default is reachable from this machine only.
        port: None: the first free port from `deodar_studio.web.serve.PORT` on; 0: any free port.
        token: whether pages need a token; without it everybody who can connect may use the studio.
        unattended: whether a run that moves a robot continues while no page is open.
    """

    root: Path
    file: Path | None = None
    trust: bool = False
    world: World | None = None
    host: str = "127.0.0.1"
    port: int | None = None
    token: bool = True
    unattended: bool = False

    @property
    def private(self) -> bool:
        """Whether only the user who started the studio can use it: it listens on this machine alone, and
        pages need the token, which others cannot read.
        """
        return self.token and is_local(self.host)
