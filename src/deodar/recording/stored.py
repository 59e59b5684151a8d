"""States of runs as files, so that another process can continue from them.

A file is a sealed NumPy archive (.npz, never pickled): the arrays of a PyTree in order, and one text, JSON,
with everything else. The structure of the tree is not stored: the reader has an equal one, of the same model.
Files of earlier versions have no seal.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import jax
import numpy as np

from deodar import codec, file_version, npz, regular_file, sealed
from deodar.codec import JsonObject
from deodar.compiler import hosts
from deodar.errors import DamagedFile, RecordError, reading
from deodar.model import output
from deodar.numerics.pytree import PyTree

VERSION = 2
UNSEALED = 1
"""Version of the files without a seal."""

HEADER = "header"


def leaves(tree: PyTree, of: str) -> list[np.ndarray]:
    """Return the arrays of a PyTree, copied to the host.

    Raises:
        RecordError: a leaf is not a number, array, truth value or text; `of` names its owner.
    """
    arrays = [np.array(hosts.gathered(leaf)) for leaf in jax.tree.leaves(tree)]
    for leaf in arrays:
        if leaf.dtype.kind not in "biufcU":
            raise RecordError(
                f"the state of {of} contains a {leaf.dtype} value, which a file cannot hold",
                fix="Let its `keep` return arrays, numbers and containers of them",
            )
    return arrays


def filled(template: PyTree, stored: Sequence[np.ndarray], of: str) -> PyTree:
    """Return a PyTree of the structure of `template` with other leaves.

    Raises:
        RecordError: the number, shapes or types of the leaves differ; `of` names their owner.
    """
    places, structure = jax.tree.flatten(template)
    arrays = [hosts.gathered(leaf) for leaf in places]
    if [(a.shape, a.dtype.kind) for a in arrays] != [(a.shape, a.dtype.kind) for a in stored]:
        raise RecordError(f"the stored state of {of} does not fit: it is of another model or world")
    return jax.tree.unflatten(structure, list(stored))


def write(path: Path, metadata: Mapping[str, Any], arrays: Sequence[np.ndarray], kind: str) -> None:
    """Write a state: it is complete or absent.

    Raises:
        OutputError: the system refused.
    """
    text = codec.line({"kind": kind, "version": VERSION, file_version.KEY: file_version.HERE, **metadata})
    numbered = {f"{k:06}": array for k, array in enumerate(arrays)}
    content = npz.packed({HEADER: np.frombuffer(text.encode(), np.uint8)} | numbered)
    output.write(path, sealed.seal(content), durable=False)


def header(path: Path) -> JsonObject:
    """Return the text of a state without its arrays.

    Raises:
        RecordError: there is no such file, or it is of a later version.
        DamagedFile: it is damaged.
    """
    return _opened(path, arrays=False)[0]


def read(path: Path, kind: str) -> tuple[JsonObject, list[np.ndarray]]:
    """Return the text and the arrays of a state.

    Raises:
        RecordError: there is no such file, or it is of another kind, or of a later version.
        DamagedFile: it is damaged.
    """
    metadata: Any
    metadata, arrays = _opened(path)
    if metadata.get("kind") != kind:
        raise RecordError(f"expected a {kind}, got another file", where=str(path))
    return metadata, arrays


def _opened(path: Path, arrays: bool = True) -> tuple[JsonObject, list[np.ndarray]]:
    """Return the text and the arrays of a state; without `arrays` the text alone, the first entry."""
    where = str(path)
    try:
        content = regular_file.read_bytes(path)
    except OSError as error:
        raise RecordError(f"cannot be read: {error.strerror or error}", where=where) from None
    try:
        proven = sealed.is_sealed(content)
        entries = npz.arrays(sealed.unseal(content) if proven else content)
        named = dict(entries if arrays else itertools.islice(entries, 1))
        metadata = codec.parse(named.pop(HEADER).tobytes().decode())
        if not isinstance(metadata, dict):
            raise ValueError("its text is not an object")
        with reading(path, RecordError):  # before the seal, which a later version may have in another form
            noun, version = f"a {metadata.get('kind', 'state')}", metadata.get("version", UNSEALED)
            file_version.require_readable(noun, version, VERSION, metadata, RecordError)
        if not proven and metadata.get("version") != UNSEALED:
            raise ValueError("it has no seal")
    except DamagedFile as error:
        raise DamagedFile(f"is damaged: {error.problems[0].what}", where=where) from None
    except (ValueError, KeyError, MemoryError) as error:
        raise DamagedFile(f"cannot be read, it may be damaged ({error})", where=where) from None
    return metadata, [named[name] for name in sorted(named)]
