"""Which files a script or a notebook has written itself, and may therefore replace.

A list for each script, in the folder of states of the user, has the size and the time of the last change of
what the script wrote. A file that has changed since, or that another script wrote, is not the script's. An
installed program, such as `deodar` on the command line, and a console have no list.
"""

from __future__ import annotations

import hashlib
import os
import sys
from pathlib import Path
from typing import Any

from deodar import codec, regular_file

STATES = "DEODAR_STATE"
"""The variable of the environment that names another folder than that of the user's states."""


def script() -> str:
    """Return what names the running script or notebook; "" for an installed program and for a console.

    A notebook is named by its path, which Jupyter and Visual Studio Code state; elsewhere by its kernel, so
    that the name is valid until the kernel ends.
    """
    main: Any = sys.modules.get("__main__")
    if "ipykernel" in sys.modules and not hasattr(main, "__file__"):
        notebook = os.environ.get("JPY_SESSION_NAME") or getattr(main, "__vsc_ipynb_file__", "")
        return f"notebook {notebook}" if notebook else f"kernel {_process()}"
    file, spec = getattr(main, "__file__", None), getattr(main, "__spec__", None)
    if file is None or (spec is not None and spec.name.partition(".")[0] == "deodar"):
        return ""
    path = Path(file).resolve()
    installed = any(path.is_relative_to(Path(prefix).resolve()) for prefix in (sys.prefix, sys.base_prefix))
    return "" if installed else f"script {path}"


def states() -> Path:
    """Return the folder of the states of the user."""
    # start-up time
    import platformdirs

    return Path(os.environ.get(STATES) or platformdirs.user_state_dir("deodar"))


def listed(name: str) -> tuple[Path, dict[str, str]]:
    """Return the file of the list of a script, and the state of each path in it."""
    file = states() / "written" / f"{hashlib.sha256(name.encode()).hexdigest()[:32]}.json"
    try:
        stored = codec.parse(regular_file.read_bytes(file).decode())
        return file, dict(stored["files"]) if stored["script"] == name else {}
    except (OSError, ValueError, LookupError, TypeError):
        return file, {}


def state(path: Path) -> str:
    """Return the size and the time of the last change of a file, or of all files of a folder; "": there is
    none.
    """
    try:
        if not path.is_dir():
            return _state(path)
        files = sorted(Path(folder, name) for folder, _, names in os.walk(path) for name in names)
        text = "\n".join(f"{file.relative_to(path)} {_state(file)}" for file in files)
        return hashlib.sha256(text.encode()).hexdigest()
    except OSError:
        return ""


def owned(path: Path) -> bool:
    """Return whether the running script wrote what is at a path, and it has not changed since."""
    name = script()
    if not name:
        return False
    noted = listed(name)[1].get(str(path.resolve()))
    return noted is not None and noted == state(path)


def _state(path: Path) -> str:
    status = path.stat()
    return f"{status.st_size} {status.st_mtime_ns}"


def _process() -> str:
    """Return a name of this process that no later one has."""
    # start-up time
    import psutil

    return f"{os.getpid()} {psutil.Process().create_time()}"
