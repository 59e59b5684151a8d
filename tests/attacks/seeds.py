"""Sound files of a format, which attacks mutate, and what reads them."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Mapping
from pathlib import Path

ROOT = Path(__file__).parents[2]

CORPUS = Path(__file__).with_name("corpus")

MARK = "executed"
"""Name of the file that is left by what must never run."""


@dc.dataclass(frozen=True)
class Seed:
    """Files that lie together, some of which are mutated.

    Attributes:
        files: the files, by their names in one folder.
        entry: the name that is opened; "": the folder.
        attacked: names of those that are mutated.
    """

    files: Mapping[str, Path]
    entry: str
    attacked: tuple[str, ...]

    @property
    def paths(self) -> list[Path]:
        """The files."""
        return list(self.files.values())

    def beside(self, path: Path) -> Seed:
        """Return the same files with another one, which is mutated, too; a JSON file is what is opened."""
        entry = path.name if path.suffix == ".json" else self.entry
        return Seed({**self.files, path.name: path}, entry, (*self.attacked, path.name))

    @property
    def place(self) -> Path:
        """Where what is opened lies in the repository."""
        name, path = next(iter(self.files.items()))
        return Path(str(path).removesuffix(name)) / self.entry


@dc.dataclass(frozen=True)
class Format:
    """A format of files.

    Attributes:
        seeds: sound files.
        read: what reads a file; its folder has the files beside it.
        connects: whether a file may name an address, to which its reader connects.
    """

    seeds: Callable[[], list[Seed]]
    read: Callable[[Path], object]
    connects: bool = False
