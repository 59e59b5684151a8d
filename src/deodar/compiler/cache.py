"""The cache of compiled programs between processes, in the user's cache folder.

The cache stores deodar's programs only, sealed (`deodar.sealed`); their key depends on the lowered program,
the versions and the machine. JAX's own cache and its flags are unchanged. `DEODAR_CACHE` names another
folder; "off" disables the cache.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import cast

import jax
import jaxlib.version
import platformdirs
from jax.experimental import serialize_executable
from jax.stages import Compiled, Lowered

from deodar import regular_file, sealed
from deodar.compiler import hosts
from deodar.compiler.device import Device
from deodar.errors import DamagedFile
from deodar.model import output

CompilerOptions = dict[str, str | bool | int]

MOST_BYTES = 512 * 2**20
LISTED = 16
"""Number of writes between two searches for files to drop: listing thousands of files takes as long as
compiling.
"""


def folder() -> Path | None:
    """Return the folder of compiled programs, or None without a cache."""
    setting = os.environ.get("DEODAR_CACHE", "")
    if setting == "off":
        return None
    return Path(setting) if setting else Path(platformdirs.user_cache_dir("deodar")) / "programs"


def compile(
    lowered: Lowered,
    options: CompilerOptions | None,
    device: Device,
    kernels: str = "",
    others: Sequence[Device] = (),
) -> tuple[Compiled, bool]:
    """Return the executable of a program lowered for a device, and whether it was compiled.

    `others` are the further devices of a program that runs on several.

    `kernels` is the version of the compiled kernels that the program may call. XLA knows them by name when a
    program that calls them is read, because tracing it made them known.
    """
    place = folder()
    jax_options = cast("dict[str, str | bool] | None", options)  # JAX accepts whole numbers, too
    if place is None:
        hosts.any_of("the cache of programs", True, hosts.span((device, *others)))
        return lowered.compile(compiler_options=jax_options), True
    path = place / key(lowered, options, device, kernels, others)
    stored = _read(path, lowered, (device, *others))
    # hosts compile together, or not at all: some compilers exchange what they measure
    missing = hosts.any_of("the cache of programs", stored is None, hosts.span((device, *others)))
    if stored is not None and not missing:
        return stored, False
    compiled = lowered.compile(compiler_options=jax_options)
    _write(path, compiled)
    return compiled, True


def key(
    lowered: Lowered,
    options: CompilerOptions | None,
    device: Device,
    kernels: str = "",
    others: Sequence[Device] = (),
) -> str:
    """Return the file name of a program, equal for equal programs, devices and versions."""
    parts = [
        jax.__version__,
        jaxlib.version.__version__,
        device.platform,
        device.device_kind,
        " ".join(str(d.id) for d in (device, *others)),
        platform.machine(),
        _processor(),
    ]
    parts += [
        os.environ.get("XLA_FLAGS", ""),
        os.environ.get("NPROC", ""),
        str(os.cpu_count()),
        repr(options),
        str(lowered.in_tree),
        kernels,
    ]
    if topology := hosts.topology((device, *others)):
        parts.append(repr(topology))
    # an argument that is not used is missing in the text of the program, and is checked all the same when it
    # is called
    parts.append(repr(lowered.args_info))
    text = "\n".join(parts) + lowered.as_text()
    return hashlib.sha256(text.encode()).hexdigest()[:40]


def options(device: Device) -> CompilerOptions:
    """Return options for compiling: the processor's widest vectors, where XLA would use half (elementwise
    operations are 25 to 30 % faster).
    """
    wide = device.platform == "cpu" and "avx512f" in _processor().split()
    return {"xla_cpu_prefer_vector_width": "512"} if wide else {}


@functools.cache
def _processor() -> str:
    """Return the processor's instruction sets, if known; a program for other ones would not run."""
    # kept: every program asks twice, and the file takes milliseconds to read
    with contextlib.suppress(OSError):
        for line in regular_file.read_text(Path("/proc/cpuinfo")).splitlines():
            if line.startswith(("flags", "Features")):
                return line
    return platform.processor()


def _read(path: Path, lowered: Lowered, devices: Sequence[Device]) -> Compiled | None:
    try:
        # checked before it is loaded: a program with one wrong bit may end Python, or compute other numbers
        payload = sealed.unseal(regular_file.read_bytes(path))
    except FileNotFoundError:
        return None
    except (OSError, DamagedFile):  # also one of an earlier version, without a seal
        with contextlib.suppress(OSError):
            path.unlink()
        return None
    with contextlib.suppress(OSError):
        os.utime(path)  # mark the file as used: the longest unused files are dropped first
    try:
        return serialize_executable.deserialize_and_load(
            bytes(payload), lowered.in_tree, lowered.out_tree, devices[0].client, [*devices]
        )
    # a program of another build of XLA: it is compiled again and the file replaced
    except Exception:
        return None


def _write(path: Path, compiled: Compiled) -> None:
    try:
        payload = serialize_executable.serialize(compiled)[0]
        path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        output.write(path, sealed.seal(payload), durable=False, private=True)
        if int(path.name[:8], 16) % LISTED == 0:  # the name is a hash, so every process finds the same files
            _prune(path.parent)
    except Exception:  # a full or read-only disk, or a backend that cannot serialise, only costs time
        return


def _prune(place: Path) -> None:
    """Drop the longest unused programs above the limit."""
    files = sorted((p for p in place.iterdir() if p.is_file()), key=lambda p: p.stat().st_mtime)
    size = sum(p.stat().st_size for p in files)
    for p in files:
        if size <= MOST_BYTES:
            break
        size -= p.stat().st_size
        p.unlink(missing_ok=True)
