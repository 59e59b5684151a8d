"""The provenance of a record: the document, the run, the versions and the machine."""

from __future__ import annotations

import base64
import importlib.metadata
import platform
from collections.abc import Mapping
from typing import Any

from deodar import file_version, plugins
from deodar.codec import Json, JsonObject
from deodar.compiler import hosts
from deodar.compiler.device import cores
from deodar.compiler.rounding import SEPARATELY, separate_rounding
from deodar.errors import DamagedFile
from deodar.model import document_files
from deodar.model.document import Document
from deodar.numerics import native
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of

KEY = "deodar"
"""Name of the attribute of a record that holds its provenance, as JSON text."""


def described(world: World | None) -> dict[str, Json] | None:
    """Return the description of a world that records store; None without a world.

    It names the module of a class that is not deodar's, unless that is the script itself.
    """
    if world is None:
        return None
    with errors_of(world, "describe"):
        stated = world.describe()
    module = type(world).__module__
    return dict(stated) if module == "__main__" or plugins.is_own(module) else {**stated, "module": module}


def provenance(doc: Document, run: Any, **settings: Any) -> JsonObject:
    """Return everything that is needed to repeat a run, and everything that determines its bits."""
    return {
        **stored(doc),
        "dt": run.clock.dt,
        "precision": run.program.precision,
        "world": described(run.world),
        **settings,
        "made_by": made_by(
            run.program.device,
            run.program.precision,
            1 if run.program.distribution is None else len(run.program.distribution.devices),
            hosts.count() if run.program.fields is not None and run.program.across else 1,
        ),
    }


def stored(doc: Document) -> JsonObject:
    """Return a document as records contain it; `document` reads it."""
    body, arrays = document_files.to_data(doc)
    packed = base64.b64encode(document_files.pack(arrays)).decode() if arrays else ""
    return {"document": body, "arrays": packed}


def made_by(device: Any, precision: str = "float32", devices: int = 1, joined: int = 1) -> dict[str, str]:
    """Return versions, device and machine, the cores and the numbers of devices and of hosts that have joined
    for a divided program, because they change the order of sums, and the rounding if it is not the default
    one.

    The compiled kernels are named where programs of this precision call them.
    """
    versions = {name: importlib.metadata.version(name) for name in ("deodar", "jax", "jaxlib", "numpy")}
    if kernels := native.version(native.kernels(device.platform, precision)):
        versions[native.DISTRIBUTION] = kernels
    where = {"device": f"{device.platform} {device.device_kind}"} | (
        {"cores": str(cores())} if device.platform == "cpu" else {}
    )
    where |= {"devices": str(devices)} if devices > 1 else {}
    where |= {"hosts": str(joined)} if joined > 1 else {}
    rounding = {"rounding": SEPARATELY} if separate_rounding() else {}
    return versions | {"python": platform.python_version(), **where, **rounding, "machine": machine()}


def rounds_separately(origin: Mapping[str, Any]) -> bool:
    """Return whether a record was made with separate rounding of products and sums."""
    return (origin.get("made_by") or {}).get("rounding") == SEPARATELY


def cores_of(origin: Mapping[str, Any]) -> int:
    """Return the number of cores that a record was made with; 1 if it states none."""
    cores = str((origin.get("made_by") or {}).get("cores", ""))
    return max(1, int(cores)) if cores.isdecimal() else 1


def devices_of(origin: Mapping[str, Any]) -> int:
    """Return the number of devices that shared the run of a record; 1 if it states none."""
    return int((origin.get("made_by") or {}).get("devices", 1))


def machine() -> str:
    """Return system and processor."""
    return f"{platform.system()} {platform.machine()} {_processor()}".strip()


def _processor() -> str:
    try:
        with open("/proc/cpuinfo") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor()


def document(origin: Mapping[str, Any]) -> Document:
    """Return the document of a record.

    Raises:
        DamagedFile: it states none, or its arrays are no text in base 64.
        DocumentError: the document that it states has problems, or is of a later version.
    """
    if "document" not in origin:
        raise DamagedFile("is damaged: it does not state the document that made it")
    document_files.require_document(origin["document"])
    try:
        packed = base64.b64decode(str(origin.get("arrays") or ""))
    except ValueError as error:
        raise DamagedFile(
            f"is damaged: the arrays of its document are no text in base 64 ({error})"
        ) from None
    arrays = document_files.unpack(packed, "the record") if packed else {}
    with file_version.naming_later_writer(origin):
        return document_files.from_data(origin["document"], arrays)
