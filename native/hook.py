"""The hook that hatchling calls before it makes a wheel or an editable installation: it compiles the kernels.

The compiler is `CXX` of the environment, else c++. The file `kernels.cc` is compiled once for each set of
vector instructions; `handlers.cc` chooses one at run time.
"""

from __future__ import annotations

import os
import platform
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import jax
from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SOURCES = Path(__file__).parent / "src" / "deodar_native"
LIBRARY = SOURCES / "kernels.so"

# without these two the compiler would keep the order of errors and exceptions, and use no vectors
COMMON = ("-O3", "-std=c++17", "-fPIC", "-fvisibility=hidden", "-fno-math-errno", "-fno-trapping-math")

VECTORS: dict[str, tuple[str, ...]] = {"plain": ()}
"""For each set of vector instructions the options of the compiler; `plain` is what every processor of this
kind has (NEON on aarch64).
"""

if platform.machine() in ("x86_64", "AMD64"):
    VECTORS |= {
        "avx2": ("-mavx2", "-mfma"),
        "avx512": (
            *("-mavx2", "-mfma", "-mavx512f", "-mavx512bw", "-mavx512dq", "-mavx512vl"),
            "-mprefer-vector-width=512",
        ),
    }


class KernelsHook(BuildHookInterface[Any]):
    """Compiles the kernels into one shared library."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile before each build of a wheel; an sdist has the sources alone."""
        if self.target_name != "wheel":
            return
        compiler = shlex.split(os.environ.get("CXX", "")) or ["c++"]
        if shutil.which(compiler[0]) is None:
            self.app.abort(
                f"There is no compiler {compiler[0]!r}. Install g++ or clang, or name one: CXX=clang++"
            )
        build(compiler)
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{_platform()}"


def build(compiler: list[str]) -> None:
    """Compile the library into its place among the sources."""
    with tempfile.TemporaryDirectory() as folder:
        objects: list[str] = []
        for name, options in VECTORS.items():
            objects.append(str(Path(folder) / f"{name}.o"))
            _run(
                *(*compiler, *COMMON, *options, f"-DDEODAR_VECTORS={name}"),
                *("-c", str(SOURCES / "kernels.cc"), "-o", objects[-1]),
            )
        headers = ("-isystem", jax.ffi.include_dir())
        made = Path(folder) / LIBRARY.name
        _run(
            *(*compiler, *COMMON, *headers, "-shared", str(SOURCES / "handlers.cc"), *objects),
            *("-o", str(made)),
        )
        # a new file: a process may have the old one open
        LIBRARY.unlink(missing_ok=True)
        shutil.copyfile(made, LIBRARY)


def _run(*command: str) -> None:
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{shlex.join(command)} failed:\n{done.stderr}")


def _platform() -> str:
    # hatchling's requirement
    from packaging.tags import sys_tags

    return next(tag.platform for tag in sys_tags() if not tag.platform.startswith(("manylinux", "musllinux")))
