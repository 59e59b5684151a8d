"""Read damaged files of NIR, each in a process of its own: `python fuzz.py FILE SEED COUNT`.

Prints how many were read, refused, ran into the limit of time, crashed the HDF5 library, or raised anything
else, which is the only wrong result.
"""

from __future__ import annotations

import os
import random
import signal
import sys
from collections import Counter
from pathlib import Path

from deodar.errors import GraphError
from deodar_spikes.nir_reader import parse_nir

READ, REFUSED, WRONG = 0, 1, 2


def damaged(content: bytes, source: random.Random) -> bytes:
    """The content with some bytes changed, or cut off."""
    out = bytearray(content)
    if source.random() < 0.1:
        return bytes(out[: source.randrange(len(out))])
    for _ in range(source.choice([1, 1, 1, 2, 4, 16])):
        at = source.randrange(len(out))
        out[at] = source.choice([0, 255, source.randrange(256), out[at] ^ (1 << source.randrange(8))])
    return bytes(out)


def outcome(content: bytes) -> str:
    """What reading does, in a forked process."""
    child = os.fork()
    if not child:
        signal.alarm(2)
        try:
            parse_nir(content)
            os._exit(READ)
        except GraphError:
            os._exit(REFUSED)
        except BaseException as error:
            sys.stderr.write(f"{type(error).__name__}: {error}\n")
            os._exit(WRONG)
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return "timeout" if os.WTERMSIG(status) == signal.SIGALRM else "crash"
    return ("read", "refused", "wrong")[os.WEXITSTATUS(status)]


if __name__ == "__main__":
    file, seed, count = sys.argv[1:4]
    source, whole = random.Random(int(seed)), Path(file).read_bytes()
    found = Counter(outcome(damaged(whole, source)) for _ in range(int(count)))
    sys.stdout.write(" ".join(f"{k}={v}" for k, v in sorted(found.items())) + "\n")
