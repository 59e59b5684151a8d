"""Read a file of NIR from standard input and write its arrays to standard output, within limits of memory."""

from __future__ import annotations

import sys

from deodar.errors import GraphError
from deodar_spikes.nir_file import pack
from deodar_spikes.nir_reader import MOST_BYTES, parse_nir


def main(name: str) -> None:
    """Read and write."""
    try:
        # not every system has it
        import resource

        most = 6 * MOST_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
    except (ImportError, ValueError, OSError):
        pass  # not every system limits memory; sizes are checked anyway
    try:
        found = parse_nir(sys.stdin.buffer.read(), name)
    except GraphError as error:
        found = error
    sys.stdout.buffer.write(pack(found))


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "")
