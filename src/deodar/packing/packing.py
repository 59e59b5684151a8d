"""Pack a piece of work into one file, see what such a file holds, and unpack it."""

from __future__ import annotations

import contextlib
import shutil
import tempfile
from collections.abc import Generator, Mapping
from pathlib import Path

from deodar.errors import DeodarError, DocumentError, TooLarge, reading
from deodar.model import output, package
from deodar.model.package import Package
from deodar.model.package_contents import Contents, Module
from deodar.packing import modules
from deodar.packing.work import Work, document_at, work_at
from deodar.recording import places


def pack(
    path: str | Path, out: str | Path | None = None, with_code: bool = False, force: bool = False
) -> Path:
    """Pack a model, a record, an experiment, its results or the file of a figure into one file.

    What it names by a relative path comes with it: the model of an experiment, the records of a figure, the
    file of a world. A file whose world or elements are of modules of the user names them.

    Args:
        path: a document, `example:NAME`, a record, an experiment, or the file of a figure.
        out: the file to write; its name ends in .deodar. None: the name of `path`, in the working folder.
        with_code: whether modules of the user are included, with the modules beside them that they import.
        force: whether to replace an existing file.

    Returns:
        The file that was written.

    Raises:
        DocumentError, RecordError, FigureError: there is no such work, or it names a file by its full path.
        OutputExists: the file exists, and `force` is not given.
    """
    work = work_at(path)
    target = Path(f"{Path(work.path).stem}{package.SUFFIX}") if out is None else output.location(out)
    if target.suffix.lower() != package.SUFFIX:
        raise DocumentError(
            f"the name of a package ends in {package.SUFFIX}",
            where=str(target),
            fix=f"Call it {target.with_suffix(package.SUFFIX).name}",
        )
    output.claim(target, force)
    needed, files = _modules(work, with_code)
    if work.kind == "document" and not needed:
        entries = {name: content for name, content in work.files.items() if isinstance(content, bytes)}
        output.write(target, package.pack(entries))
        return target
    stated = Contents(work.kind, work.path, dict(work.lines), needed)
    entries = {**work.files, **files}
    output.write(target, lambda beside: package.write(beside, stated, entries))
    return target


def contents(path: str | Path) -> Contents:
    """Return what a package holds, what made it and which modules of the user it needs; nothing in it is run.

    A model, a record, an experiment or a figure that is not packed is described in the same way.

    Raises:
        DocumentError: the file is damaged, or nothing that can be packed.
    """
    path = output.location(path)
    if _is_package(path):
        if (stated := _stated(path)).files:
            return stated
        work = document_at(path)
    else:
        work = work_at(path)
    stated = {name: package.stated_entry(content) for name, content in work.files.items()}
    return Contents(work.kind, work.path, dict(work.lines), _modules(work, False)[0], stated)


def unpack(
    path: str | Path, folder: str | Path | None = None, trust: bool = False, force: bool = False
) -> Path:
    """Unpack a package into a new folder.

    Every file is compared with its stated hash first. Modules in it lie in the folder `code`, and are
    imported only with `trust`.

    Args:
        path: the package.
        folder: the folder to write. None: the name of the package, in the working folder.
        trust: whether modules that come with it may be imported and run, so that what needs them runs.
        force: whether to replace an existing folder.

    Returns:
        The path of what was packed: a document, a record, an experiment, a folder of results or a figure.

    Raises:
        DocumentError: the file is damaged, or no package.
        OutputExists: the folder exists, and `force` is not given.
    """
    path = output.location(path)
    target = Path(path.stem) if folder is None else output.location(folder)
    return _unpacked(path, target, trust or None, force)


@contextlib.contextmanager
def opened(path: Path, trust: bool, runs: bool = True) -> Generator[Path]:
    """Yield the path of what a package holds, in a folder that is removed afterwards.

    Args:
        path: the package.
        trust: whether modules that come with it may be imported and run.
        runs: whether it is run, so that the modules which it needs must be there.
    """
    with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
        yield _unpacked(path, Path(folder, path.stem), trust if runs else None)


def has_contents(path: Path) -> bool:
    """Return whether a file is a package that holds more than a model."""
    if not _is_package(path):
        return False
    return bool(_stated(path).files)


def unpack_beside(path: Path, trust: bool) -> tuple[Path, Contents]:
    """Unpack a package into a folder beside it, or find it there; return the path of what was packed, and the
    contents.

    Args:
        path: a package with contents.
        trust: whether modules that come with it may be imported and run.

    Raises:
        DocumentError: the file is damaged; what it holds is a model or an experiment, and its modules are
            missing or not trusted.
    """
    stated = _stated(path)
    folder = path.with_suffix("")
    if not _holds(folder, stated):
        folder = places.free(path.parent, path.stem) if folder.exists() else folder
        _unpacked(path, folder, None)
    if stated.kind != "record":  # a record is played without the modules that made it
        with _located(path):
            modules.require(stated, folder, trust)
    return folder / stated.path, stated


def _stated(path: Path) -> Contents:
    """Return what a package states that it holds."""
    with _located(path), Package(path) as packed:
        return packed.contents


def _unpacked(path: Path, folder: Path, trust: bool | None, force: bool = False) -> Path:
    """Unpack a package into a folder, and return the path of what was packed.

    Args:
        path: the package.
        folder: the folder to write.
        trust: whether modules that come with it may be imported; None: it is not run, and needs no modules.
        force: whether to replace an existing folder.
    """
    if not _is_package(path):
        raise DocumentError("is not a package", where=str(path))
    places.claim_folder(folder, force)
    with _located(path), Package(path) as packed:
        free = shutil.disk_usage(folder.absolute().parent).free
        if packed.size > free:
            raise TooLarge(
                f"takes {packed.size / 2**30:,.1f} GiB on the disk, and {free / 2**30:,.1f} GiB are free"
            )
        places.write_folder(folder, lambda beside: _extract(packed, beside), force)
        if trust is not None:
            modules.require(packed.contents, folder, trust)
        return folder / packed.contents.path


def _holds(folder: Path, stated: Contents) -> bool:
    """Return whether a folder has all files of a package, unchanged."""
    return all(
        (folder / name).is_file() and package.stated_entry(folder / name) == file
        for name, file in stated.files.items()
    )


def _is_package(path: Path) -> bool:
    with reading(path, DocumentError):
        return path.is_file() and package.is_package(path)


def _modules(work: Work, with_code: bool) -> tuple[tuple[Module, ...], Mapping[str, Path]]:
    needed: list[Module] = []
    files: dict[str, Path] = {}
    for name, defines in work.needs.items():
        module, content = modules.located(name, defines, with_code)
        needed.append(module)
        files |= content
    return tuple(needed), files


def _extract(packed: Package, folder: Path) -> None:
    for name in packed.names:
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        packed.extract(name, target)


@contextlib.contextmanager
def _located(path: Path) -> Generator[None]:
    """Name the package in errors."""
    try:
        yield
    except DeodarError as error:
        raise type(error)(error.inside(path)) from None
