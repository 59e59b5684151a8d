"""A piece of work that can be packed: what it is, what made it, and its files.

A model, a record, an experiment, its results, or the file of a figure. Files keep their places relative to
each other, so that what names another file by a relative path finds it in every copy.
"""

from __future__ import annotations

import dataclasses as dc
import os
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from deodar import codec, registry, regular_file
from deodar.errors import DocumentError, Fix, RecordError, reading
from deodar.experiments import results
from deodar.experiments.design import Design
from deodar.experiments.record_target import PLACE
from deodar.importers import examples, opening
from deodar.model import document_files
from deodar.model.document import Document
from deodar.model.package import is_package
from deodar.model.package_contents import PackedKind
from deodar.packing.modules import of_document, of_world
from deodar.recording import files, provenance
from deodar.recording.record import about as origin_of
from deodar.summary import counted

if TYPE_CHECKING:
    import xarray

Needs = Mapping[str, tuple[str, ...]]
"""For each module of the user the names that are needed of it."""


@dc.dataclass(frozen=True)
class Work:
    """Something that can be packed.

    Attributes:
        kind: document, record, experiment, results or figure.
        path: the file or folder that is opened, as a path in the package.
        files: content, or place, of each file, by its path in the package.
        lines: what it is and what made it: names and values, for people.
        needs: modules of the user without which it does not run, and the names that are needed of each.
    """

    kind: PackedKind
    path: str
    files: Mapping[str, Path | bytes]
    lines: Mapping[str, str]
    needs: Needs = dc.field(default_factory=lambda: {})


def work_at(path: str | Path) -> Work:
    """Return the work at a path: a document of any format, a record, an experiment, its results or a figure.

    Raises:
        DocumentError, RecordError, FigureError: there is nothing of these, it cannot be read, or it names a
            file by its full path, which is not found on another computer.
    """
    place = Path(os.path.abspath(examples.named(path)))
    if os.path.isdir(place):  # False for a name that is too long
        return _results_folder(place) if (place / results.ROWS).is_file() else _record(place)
    if place.name in (results.TABLE, results.DATASET) and (place.parent / results.ROWS).is_file():
        return _results_folder(place.parent)
    if place.suffix.lower() == ".toml":
        return _figure(place)
    if place.suffix.lower() in (".nc", ".csv"):
        return _record(place)
    opening.require(place)
    if is_package(place):
        fix = Fix("Unpack it: dd.unpack(FILE)", "Unpack it: deodar pack FILE --unpack")
        raise DocumentError("is a package already", where=str(path), fix=fix)
    return _experiment(place) if _is_experiment(place) else document_at(place)


# ------------------------------------------------------------------------------------------ kinds of work


def document_at(place: Path) -> Work:
    """Return the model of a file of any format, a package of a model included."""
    doc = opening.load(place).document
    text, arrays = document_files.dumps(doc, place.stem)
    content = {f"{place.stem}.json": text.encode()}
    content |= {document_files.array_file(text): arrays} if arrays is not None else {}
    return Work("document", f"{place.stem}.json", content, _of_document(doc), of_document(doc))


def _record(place: Path) -> Work:
    inner, _ = files.locate(place)
    record = files.open_record(place)
    try:
        with reading(place, RecordError):
            origin: dict[str, Any] = origin_of(record)
            if "document" not in origin:
                return _table(place, record, origin)
            doc, world = provenance.document(origin), origin.get("world")
        variables = [str(name) for name in record.data_vars]
    finally:
        record.close()
    content = _below(place, place.parent)
    content |= _beside(world, str(PurePosixPath(inner.relative_to(place.parent).as_posix()).parent))
    run = [
        f"{key} {origin[key]:g}" for key in ("duration", "dt", "seed", "trials") if _is_number(origin, key)
    ]
    lines = {"model": _named(doc), "run": ", ".join(run) or "a session"}
    lines |= {"sweep": _swept(origin["sweep"])} if origin.get("sweep") else {}
    lines |= _of_described(world)
    lines |= {"holds": ", ".join(variables), "made by": _made_by(origin)}
    return Work("record", place.name, content, lines, _merged(of_document(doc), of_world(world)))


def _table(place: Path, table: xarray.Dataset, origin: Mapping[str, Any]) -> Work:
    lines = {"experiment": str(origin.get("name", "")), "trials": str(table.sizes.get("trial", 0))}
    lines |= _of_described(origin.get("world"))
    lines |= {"columns": _columns(table), "made by": _made_by(origin)}
    return Work("table", place.name, {place.name: place}, lines)


def _results_folder(place: Path) -> Work:
    identity, rows = results.stored(place)
    doc: Document = document_files.load(place / results.MODEL)
    world: Any = identity.get("world")
    lines = {"experiment": str(identity["name"]), "model": _named(doc)}
    lines |= {"trials": f"{len(rows)} of {len(_design(place / results.EXPERIMENT).cells)}"}
    lines |= _of_described(world)
    lines |= {"columns": _columns(results.load_results(place))}
    if (place / PLACE).is_file():
        lines["records"] = "in a store elsewhere, which is not included"
    lines["made by"] = _made_by(identity)
    content = _below(place, place.parent) | _beside(world, place.name)
    return Work("results", place.name, content, lines, _merged(of_document(doc), of_world(world)))


def _experiment(place: Path) -> Work:
    design, named = _design(place), codec.read(regular_file.read_bytes(place))
    doc = opening.load(str(design.model)).document
    beside = [place, *_model_files(place, str(named["model"]))]
    kind, _, argument = str(named.get("world", "")).partition(":")
    file = argument.partition(",")[0].strip()
    if file and (place.parent / file).is_file():
        beside.append(_relative(place, file, "the file of the world"))
    root = _root(beside)
    lines = {"experiment": design.name, "model": _named(doc), "trials": str(len(design.cells))}
    lines |= {"world": str(named["world"])} if kind else {}
    lines |= {"factors": ", ".join(factor.name for factor in design.factors)} if design.factors else {}
    worlds = {name.lower(): world for name, world in registry.kinds("worlds").items()}
    needs = _merged(of_document(doc), of_world(worlds.get(kind.lower())))
    content = {_inside(path, root): path for path in beside}
    return Work("experiment", _inside(place, root), content, lines, needs)


def _model_files(place: Path, name: str) -> list[Path]:
    """Return the file of the model of an experiment, and its array file; none of an example of deodar."""
    if name.startswith(examples.PREFIX):
        return []
    model = _relative(place, name, "the model")
    arrays = model.with_name(document_files.array_file(regular_file.read_bytes(model)) or model.name)
    return [model, arrays] if arrays != model and arrays.is_file() else [model]


def _figure(place: Path) -> Work:
    # start-up time: this brings matplotlib
    from deodar.figures._file import FigureFile

    figure = FigureFile.read(place)
    names = [name for name in (figure.record, *(panel.record for panel in figure.panels)) if name is not None]
    if not names:
        raise DocumentError(
            "names no record, so there is nothing to draw elsewhere",
            where=str(place),
            fix='Write a line: record = "RECORD"',
        )
    records = [_relative(place, name, "the record") for name in dict.fromkeys(names)]
    root = _root([place, *records])
    content: dict[str, Path | bytes] = {_inside(place, root): place}
    machines: dict[str, None] = {}
    needs: Needs = {}
    for path in records:
        work = _record(path)
        top = path.parent
        content |= {_inside(top / name, root): file for name, file in work.files.items()}
        machines[work.lines["made by"]] = None
        needs = _merged(needs, work.needs)
    lines = {
        "panels": ", ".join(panel.variable for panel in figure.panels),
        "records": ", ".join(_inside(path, root) for path in records),
        "made by": "; ".join(machines),
    }
    return Work("figure", _inside(place, root), content, lines, needs)


# -------------------------------------------------------------------------------------------------- parts


def _design(place: Path) -> Design:
    return Design.load(place, opening.load)


def _is_experiment(place: Path) -> bool:
    """Return whether a file is an experiment: JSON with the key `experiment`."""
    try:
        content = codec.parse(regular_file.read_bytes(place)) if place.suffix.lower() == ".json" else None
    except ValueError:
        return False
    return isinstance(content, dict) and "experiment" in content


def _below(place: Path, root: Path) -> dict[str, Path | bytes]:
    """Return a file, or all files of a folder but hidden ones and links, by their paths below `root`."""
    if place.is_file():
        return {_inside(place, root): place}
    content: dict[str, Path | bytes] = {}
    for folder, folders, names in os.walk(place):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        paths = [Path(folder, name) for name in sorted(names) if not name.startswith(".")]
        content |= {_inside(path, root): path for path in paths if path.is_file() and not path.is_symlink()}
    return content


def _beside(world: Any, folder: str) -> dict[str, Path | bytes]:
    """Return the file of a world that a record describes, as a file in the folder of the record."""
    text = world.get("file") if isinstance(world, dict) else None
    file = Path(text) if isinstance(text, str) and text else None
    if file is None or not file.is_file():
        return {}
    return {str(PurePosixPath(folder, file.name)): file.resolve()}


def _relative(place: Path, name: str, noun: str) -> Path:
    """Return the path of a file that another one names, which must be relative to its folder."""
    if Path(name).is_absolute():
        raise DocumentError(
            f"names {noun} by the full path {name!r}, which another computer does not have",
            where=str(place),
            fix="Write its path relative to this file",
        )
    return Path(os.path.normpath(place.parent / name))


def _root(paths: Iterable[Path]) -> Path:
    return Path(os.path.commonpath([str(path.parent) for path in paths]))


def _inside(path: Path, root: Path) -> str:
    return path.relative_to(root).as_posix()


def _is_number(origin: Mapping[str, Any], key: str) -> bool:
    return isinstance(origin.get(key), (int, float))


def _of_document(doc: Document) -> dict[str, str]:
    lines = {"model": _named(doc)}
    return lines | ({"notes": doc.notes.strip().splitlines()[0][:200]} if doc.notes.strip() else {})


def _named(doc: Document) -> str:
    return f"{doc.name} ({counted(len(doc.entries), 'element')})"


def _of_described(world: Any) -> dict[str, str]:
    """Return the line about a world that a record or its results describe."""
    return {"world": str(world["world"])} if isinstance(world, dict) and "world" in world else {}


def _swept(sweep: Any) -> str:
    """Return the parameters of a sweep: of a grid, or of a list of points."""
    if isinstance(sweep, dict):
        return ", ".join(sweep)
    paths = dict.fromkeys(path for point in sweep if isinstance(point, dict) for path in point)
    return f"{', '.join(paths)} at {counted(len(sweep), 'point')}"


def _columns(table: xarray.Dataset) -> str:
    return ", ".join(map(str, (*table.coords, *table.data_vars)))


def _made_by(origin: Mapping[str, Any]) -> str:
    stated: Any = origin.get("made_by")
    makers: Mapping[str, Any] = stated if isinstance(stated, dict) else {}
    programs = ("deodar", "jax", "numpy", "python")
    versions = [f"{name} {makers[name]}" for name in programs if name in makers]
    where = [str(makers[name]) for name in ("device", "machine") if name in makers]
    return ", ".join([*versions, *where]) or "not stated"


def _merged(*needs: Needs) -> Needs:
    merged: dict[str, tuple[str, ...]] = {}
    for modules in needs:
        for module, names in modules.items():
            merged[module] = tuple(dict.fromkeys((*merged.get(module, ()), *names)))
    return merged
