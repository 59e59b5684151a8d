"""Run a record again from its provenance, and compare."""

from __future__ import annotations

import dataclasses as dc
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar import registry
from deodar.errors import DeodarError, Fix, RecordError, WorldError, option
from deodar.model.migrations import recorded
from deodar.model.model import Model
from deodar.precision import Arithmetic
from deodar.recording import provenance
from deodar.recording.opened import again
from deodar.recording.record import about
from deodar.recording.sound import DAMAGED
from deodar.resources import Resources, use_resources
from deodar.sweep import Points, Sweep
from deodar.worlds._base import World

USED = ("workers", "batch", "device", "devices")
"""The resources that a record states, because the last digits depend on them."""

Simulate = Callable[..., xarray.Dataset]
"""A function that runs a model: `deodar.batch.simulate.simulate`."""


@dc.dataclass(frozen=True)
class Difference:
    """A setting that differs from that of the record."""

    what: str
    then: str
    now: str

    def __str__(self) -> str:
        return f"{self.what}: {self.then} then, {self.now} now"


@dc.dataclass(frozen=True)
class Repetition:
    """The comparison of a record with its repetition.

    Attributes:
        data: the new record.
        differences: versions, device, machine and world that differ from those of the record.
        largest: for each variable the largest difference of a value from the old record; infinite if it
            cannot be compared.
        same_bits: whether every value is equal to the last bit.
        compared: number of times that were compared; fewer than in the new record if the old record is
            incomplete or damaged.
        damage: what is missing in a damaged record; "": nothing.
    """

    data: xarray.Dataset
    differences: tuple[Difference, ...]
    largest: Mapping[str, float]
    same_bits: bool
    compared: int
    damage: str = ""

    @property
    def faithful(self) -> bool:
        """Whether the guarantee holds: the same bits if versions, machine and world are the same."""
        return self.same_bits or bool(self.differences)

    def __str__(self) -> str:
        if self.damage and not self.compared:
            return f"The record is damaged, so that nothing of it could be compared: {self.damage}"
        if self.same_bits:
            text = "The repetition has the same bits as the record"
            if self.damage:
                text = f"The record is damaged: {self.damage}. The repetition has the same bits as the rest"
            return text + (
                ", although these differ: " + "; ".join(map(str, self.differences))
                if self.differences
                else ""
            )
        worst = ", ".join(f"{name} {value:.3g}" for name, value in self.largest.items())
        if self.differences:
            changed = "; ".join(map(str, self.differences))
            return (
                f"The repetition differs from the record. What differs: {changed}. Largest differences:"
                f" {worst}"
            )
        same = "nothing explains it: versions, machine and world are the same"
        return f"The repetition differs from the record, and {same}. Largest differences: {worst}"


def repeat(
    data: xarray.Dataset,
    simulate: Simulate,
    world: World | None = None,
    trust: bool = False,
    on: Resources = Resources(),
) -> Repetition:
    """Run a record again and compare.

    Args:
        data: the record.
        simulate: the function that runs it.
        world: the world to run it in; None: the world of the record, opened again.
        trust: whether functions that its document names may be imported and run.
        on: the device to run it on, else that of the record, and whether to show progress.

    Raises:
        RecordError: the record has no provenance.
        Untrusted: its document names a function, and `trust` is not given.
    """
    model, settings = request(data, trust)
    use_resources(on, "dd.repeat", "device", "progress")
    recorded = settings.pop("on")
    used = dc.replace(recorded, device=on.device or recorded.device, progress=on.progress)
    new = simulate(model, world=world or world_of(data), on=used, **settings)
    return compare(data, new)


def request(data: xarray.Dataset, trust: bool = False) -> tuple[Model, dict[str, Any]]:
    """Return the model of a record, and the arguments of `simulate` that made it.

    Raises:
        RecordError: the record has no provenance, or a session made it.
        Untrusted: its document names a function, and `trust` is not given.
    """
    origin = _origin(data)
    if "session" in origin:
        raise RecordError(
            "was recorded from a session, which may be changed while it runs, so it cannot be run again",
            fix="Run its model: the file model.json in the folder of the record",
        )
    try:
        model = Model(document=provenance.document(origin), trusted=trust)
        settings = {key: origin[key] for key in ("duration", "dt", "seed", "every", "trials")}
        settings |= {"record": _recorded(origin, model), "sweep": _sweep(origin)}
        settings |= {"precision": Arithmetic(origin["precision"], origin.get("accuracy", "default")).name}
        settings |= {"on": Resources(**{key: origin.get(key) for key in USED})}
    except (KeyError, TypeError, ValueError) as error:
        raise RecordError(f"what made the record cannot be read ({type(error).__name__}: {error})") from None
    return model, settings


def _sweep(origin: Mapping[str, Any]) -> Sweep | None:
    sweep: Any = origin["sweep"]
    return Points(sweep, own_noise=True) if origin.get("own_noise", False) else sweep or None


def _recorded(origin: Mapping[str, Any], model: Model) -> list[str] | None:
    """Return the ports that were recorded; before document version 3 a field's path meant another port."""
    record: list[str] | None = origin["record"]
    if record is None or origin["document"].get("deodar", 0) >= 3:
        return record
    return [recorded(model.document, path) for path in record]


def world_of(record: xarray.Dataset) -> World | None:
    """Open the world of a record again; None if it had no world.

    Raises:
        RecordError: the record has no provenance.
        WorldError: the world no longer exists, or is a different one.
    """
    source = record.encoding.get("source")
    return _world(_origin(record).get("world"), None if source is None else Path(source).parent)


def compare(old: xarray.Dataset, new: xarray.Dataset) -> Repetition:
    """Return the differences between two records of one run; an incomplete one is compared up to its end."""
    before, after = _origin(old), _origin(new)
    times = min(old.sizes.get("time", 0), new.sizes.get("time", 0))
    damage = str(old.attrs.get(DAMAGED, ""))
    whole = before.get("complete", True) and after.get("complete", True) and not damage
    a, b = (old, new) if whole else _common(old, new)
    largest = {str(name): _largest(a.get(name), b.get(name)) for name in {**a.variables, **b.variables}}
    same = all(
        name in a.variables and name in b.variables and _same(a[name].values, b[name].values)
        for name in {**a.variables, **b.variables}
    )
    differing = {
        name: value for name, value in largest.items() if name in a.data_vars or name in b.data_vars or value
    }
    return Repetition(
        new, differences(before, after), differing, same and (times > 0 or not damage), times, damage
    )


def _common(old: xarray.Dataset, new: xarray.Dataset) -> tuple[xarray.Dataset, xarray.Dataset]:
    """Return both records cut to their common times, and trials or points of a sweep."""
    for dim in [d for d in old.sizes if d in new.sizes and d in old.coords and d in new.coords]:
        shared = np.intersect1d(old[dim].values, new[dim].values)
        old, new = (record.isel({dim: np.isin(record[dim].values, shared)}) for record in (old, new))
    return old, new


def _origin(record: xarray.Dataset) -> dict[str, Any]:
    try:
        origin = about(record)
    except ValueError:
        origin = {}
    if "document" not in origin:
        raise RecordError("the record does not say what made it, so it cannot be repeated or compared")
    return origin


def differences(before: Mapping[str, Any], after: Mapping[str, Any]) -> tuple[Difference, ...]:
    """Return the versions, the device, the machine and the world that differ between two provenances."""
    then, present = before.get("made_by", {}), after.get("made_by", {})
    out = [
        Difference(k, str(then.get(k, "unknown")), str(present.get(k, "unknown")))
        for k in {**then, **present}
        if then.get(k) != present.get(k)
    ]
    was, is_ = _identity(before.get("world")), _identity(after.get("world"))
    if was != is_:
        out.append(Difference("world", _shown(before.get("world")), _shown(after.get("world"))))
    return tuple(out)


def _same(a: np.ndarray, b: np.ndarray) -> bool:
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def _largest(a: xarray.DataArray | None, b: xarray.DataArray | None) -> float:
    if a is None or b is None or a.shape != b.shape:
        return float("inf")
    if a.dtype.kind not in "biuf":
        return 0.0 if _same(a.values, b.values) else float("inf")
    if not a.size:
        return 0.0
    gap = np.abs(a.values.astype(np.float64) - b.values.astype(np.float64))
    gap[np.isnan(a.values) & np.isnan(b.values)] = 0.0  # copies that diverged in both records
    return float("inf") if np.isnan(gap).any() else float(gap.max())


# ----------------------------------------------------------------------------------------------------- worlds


def _world(described: Mapping[str, Any] | None, folder: Path | None = None) -> World | None:
    """Return the world of a record, opened again from the file it names, or from the one of this name in the
    folder of the record if that one has gone.
    """
    if described is None:
        return None
    file = Path(str(described.get("file", "")))
    if folder is not None and not file.is_file() and (folder / file.name).is_file():
        described = {**described, "file": str(folder / file.name)}
    kind = str(described.get("world"))
    world_class = registry.kinds("worlds").get(kind) or _imported(described)
    circumstances = f"the record was made with the world {_shown(described)}"
    if world_class is None:
        raise WorldError(f"{circumstances}, which is not known here", fix=_import(described))
    give = option("Give it:", "world", f"{kind.lower()}:FILE", f"{kind}(...)")
    try:
        world = again(world_class, described)
    except DeodarError as error:
        raise WorldError(f"{circumstances}, and it cannot be opened: {error.problems[0]}", fix=give) from (
            error.__cause__
        )
    if _identity(provenance.described(world)) != _identity(described):
        file = str(described.get("file", "FILE"))
        raise WorldError(
            f"{circumstances}, and this file now holds something else",
            fix=option(
                "Give the file that it was made with, or this one to compare nevertheless:",
                "world",
                f"{kind.lower()}:{file}",
                f"{kind}({file!r})",
            ),
        )
    return world


def _imported(described: Mapping[str, Any]) -> type[World] | None:
    """Return the class of a world from the module that the record names, if it has been imported: a record
    imports nothing itself.
    """
    module = sys.modules.get(str(described.get("module")))
    world_class: Any = getattr(module, str(described.get("world")), None)
    return world_class if isinstance(world_class, type) and issubclass(world_class, World) else None


def _import(described: Mapping[str, Any]) -> Fix:
    """Return how a world that is not known becomes so."""
    kind, module = described.get("world"), described.get("module")
    give = f"Give it: dd.repeat(record, world={kind}(...))"
    if module is None:
        return Fix(give, "Install the package that it is of, or repeat it in a script with its class")
    first = f"Import its module {module}"
    return Fix(f"{first}. {give}", f"{first}: deodar --import {module} run RECORD")


def _identity(described: Any) -> Any:
    """Return the identity of the world: its description without the places of its file and of its class."""
    if not isinstance(described, dict):
        return described
    return {k: v for k, v in described.items() if k not in ("file", "module")}


def _shown(described: Any) -> str:
    if not isinstance(described, dict):
        return "none"
    digest = str(described.get("sha256", ""))[:12]
    parts = [
        str(described.get("world")),
        str(described.get("file", "")),
        f"sha256 {digest}" if digest else "",
    ]
    return " ".join(p for p in parts if p)
