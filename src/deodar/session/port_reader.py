"""Read many ports of a running program at one moment with one compiled function, a `PortReader`.

Elements of equal structure are rows of one array, so that a `PortReader` for hundreds of elements compiles
and runs as fast as one for a few.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterable, Mapping

import numpy as np
from jax.stages import Compiled

from deodar.compiler.executable import Executable
from deodar.compiler.program import Port

PortKey = tuple[str, str]
"""An element by its id, and one of its ports."""


@dc.dataclass(frozen=True)
class PortReader:
    """A compiled reader of ports of one program; another program needs another one."""

    program: Executable
    ports: tuple[Port, ...]
    reader: Compiled | None

    def fits(self, places: Iterable[PortKey]) -> bool:
        """Return whether it reads exactly the ports that these places need."""
        return whole(self.program, places) == set(self.ports)

    def arrays(self, seen: Iterable[np.ndarray], places: Iterable[PortKey]) -> Mapping[PortKey, np.ndarray]:
        """Return the arrays of places from the values of the reader, without places that it does not read."""
        by_port = dict(zip(self.ports, seen, strict=True))
        out: dict[PortKey, np.ndarray] = {}
        for ident, name in places:
            if ident in self.program.plan.row:
                port = self.program.port(ident, name)
                rows = by_port.get(dc.replace(port, row=None))
                if rows is not None and port.row is not None:
                    out[ident, name] = np.asarray(rows)[port.row]
        return out


def port_reader(program: Executable, places: Iterable[PortKey]) -> PortReader:
    """Compile a `PortReader` for places; it does not touch the run, so another thread may compile it
    meanwhile.
    """
    ports = tuple(sorted(whole(program, places), key=lambda p: (p.group, p.name)))
    return PortReader(program, ports, program.new_reader(ports) if ports else None)


def whole(program: Executable, places: Iterable[PortKey]) -> set[Port]:
    """Return the ports of whole groups that contain the places; places not in the program are omitted."""
    out: set[Port] = set()
    for ident, name in places:
        if ident in program.plan.row:
            port = program.port(ident, name)
            node = program.plan.groups[port.group].like
            if name in node.outs or name in node.ins:
                out.add(dc.replace(port, row=None))
    return out
