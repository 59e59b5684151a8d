"""Reader of AEDAT4 files in a process of its own: `python aedat4_process.py`; it imports nothing of deodar.

The package `aedat` trusts a file, and a damaged one can end the process that reads it. Each line of the input
is a request, the path in hexadecimal and the position of a stream. The output is a sequence of messages, each
a line and the bytes that it announces:

* `streams TEXT`: type and size of every stream.
* `size COLUMNS ROWS`: of the stream that is read.
* `events N`: then N times (int64), columns, rows (uint16 each) and polarities (bool).
* `end` after the last event, or `error TEXT`.
"""

from __future__ import annotations

import os
import sys

import aedat
import numpy as np

MOST_BYTES = 2**33
"""Most memory of the process, where the system can limit it: a small file may state a huge array."""


def limit_memory() -> None:
    """Limit the memory of this process."""
    try:
        # absent on Windows
        import resource
    except ImportError:
        return
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    most = MOST_BYTES if hard == resource.RLIM_INFINITY else min(MOST_BYTES, hard)
    resource.setrlimit(resource.RLIMIT_AS, (most, hard))


def main() -> None:
    """CommandAnswer requests until the input ends."""
    # what else writes to the output must not be taken for a message
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    limit_memory()
    for line in sys.stdin:
        path, stream = line.split()

        def say(text: str, *arrays: np.ndarray) -> None:
            output.write(" ".join(text.split()).encode() + b"\n" + b"".join(a.tobytes() for a in arrays))
            output.flush()

        try:
            decoder = aedat.Decoder(os.fsdecode(bytes.fromhex(path)))
            streams = sorted(decoder.id_to_stream().items())
            shapes = {k: (s["width"], s["height"]) for k, s in streams if s["type"] == "events"}
            others = [s["type"] for k, s in streams if k not in shapes]
            say(f"streams {', '.join([*(f'events {w} x {h}' for w, h in shapes.values()), *others])}")
            if int(stream) < len(shapes):
                chosen = list(shapes)[int(stream)]
                say(f"size {shapes[chosen][0]} {shapes[chosen][1]}")
                for packet in decoder:
                    if packet["stream_id"] == chosen and "events" in packet:
                        e = packet["events"]
                        columns = (e["t"].astype(np.int64), e["x"], e["y"], e["on"])
                        say(f"events {len(e)}", *(np.ascontiguousarray(c) for c in columns))
            say("end")
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # a panic of Rust is no Exception
            say(f"error {type(error).__name__}: {error}"[:300])


if __name__ == "__main__":
    main()
