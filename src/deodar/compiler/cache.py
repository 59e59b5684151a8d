"""Compiled programs kept between processes, in the user's own cache folder.

Only deodar's programs are kept, by a key made of the lowered program, the versions and the machine: JAX's own
cache and its flags are left alone. `DEODAR_CACHE` names another folder; set to "off" it keeps nothing.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
from pathlib import Path
from typing import Any

import jax
import jaxlib.version
import platformdirs
from jax.experimental import serialize_executable

from deodar.model import output

MOST_BYTES = 512 * 2**20
LISTED = 16
"""One write in this many lists the folder for files to drop: listing thousands of files for every write takes
as long as compiling.
"""


def folder() -> Path | None:
    """Where compiled programs are kept, or None where they are not."""
    given = os.environ.get("DEODAR_CACHE", "")
    if given == "off":
        return None
    return Path(given) if given else Path(platformdirs.user_cache_dir("deodar")) / "programs"


def compile(lowered: Any, options: dict[str, Any] | None, device: Any) -> tuple[Any, bool]:
    """The executable of a program lowered for a device, and whether it had to be compiled."""
    place = folder()
    if place is None:
        return lowered.compile(compiler_options=options), True
    path = place / key(lowered, options, device)
    found = _read(path, lowered, device)
    if found is not None:
        return found, False
    compiled = lowered.compile(compiler_options=options)
    _write(path, compiled)
    return compiled, True


def key(lowered: Any, options: dict[str, Any] | None, device: Any) -> str:
    """Name of the file of a program: equal programs on equal devices with equal versions share it."""
    about = [
        jax.__version__,
        jaxlib.version.__version__,
        device.platform,
        device.device_kind,
        str(device.id),
        platform.machine(),
        _processor(),
    ]
    about += [
        os.environ.get("XLA_FLAGS", ""),
        os.environ.get("NPROC", ""),
        str(os.cpu_count()),
        repr(options),
        str(lowered.in_tree),
    ]
    # an argument that is not used is missing in the text of the program, and is checked all the same when it
    # is called
    about.append(repr(lowered.args_info))
    text = "\n".join(about) + lowered.as_text()
    return hashlib.sha256(text.encode()).hexdigest()[:40]


def options(device: Any) -> dict[str, Any]:
    """Options for compiling: the processor's widest vectors, where XLA would take half (elementwise work is
    25 to 30 % faster).
    """
    wide = device.platform == "cpu" and "avx512f" in _processor().split()
    return {"xla_cpu_prefer_vector_width": "512"} if wide else {}


def _processor() -> str:
    """The processor's instruction sets where the system tells: a program for others would not run."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith(("flags", "Features")):
                return line
    return platform.processor()


def _read(path: Path, lowered: Any, device: Any) -> Any:
    try:
        payload = path.read_bytes()
        with contextlib.suppress(OSError):
            os.utime(path)  # used now: the longest unused go first
        return serialize_executable.deserialize_and_load(
            payload, lowered.in_tree, lowered.out_tree, device.client, [device]
        )
    except FileNotFoundError:
        return None
    except Exception:  # a damaged file, or one of another build: it is compiled anew and replaced
        return None


def _write(path: Path, compiled: Any) -> None:
    try:
        payload = serialize_executable.serialize(compiled)[0]
        path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        output.write(path, payload, durable=False, private=True)
        if int(path.name[:8], 16) % LISTED == 0:  # the name is a hash: no process has to count
            _prune(path.parent)
    except (
        Exception
    ):  # a full or read-only disk, or a backend that cannot serialise, costs time and nothing else
        return


def _prune(place: Path) -> None:
    """Drop the programs longest unused while there are too many."""
    files = sorted((p for p in place.iterdir() if p.is_file()), key=lambda p: p.stat().st_mtime)
    size = sum(p.stat().st_size for p in files)
    for p in files:
        if size <= MOST_BYTES:
            break
        size -= p.stat().st_size
        p.unlink(missing_ok=True)
