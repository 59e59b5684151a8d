"""What a package says of itself: `contents.json`, its first entry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, cast

import msgspec

from deodar import file_version
from deodar.codec import JsonObject
from deodar.errors import DocumentError, first_line
from deodar.summary import Summarised, Summary, counted, sized

CONTENTS = "contents.json"
"""Name of the entry."""

VERSION = 1

NOUNS = {
    "document": "a model",
    "record": "a record",
    "experiment": "an experiment",
    "results": "the results of an experiment",
    "table": "the table of an experiment",
    "figure": "the file of a figure",
}
"""What can be packed, and how messages call it."""

PackedKind = Literal["document", "record", "experiment", "results", "table", "figure"]
ShortText = Annotated[str, msgspec.Meta(max_length=2000)]
Hash = Annotated[str, msgspec.Meta(pattern="^[0-9a-f]{64}$")]


class PackedFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An entry of a package.

    Attributes:
        size: its size in bytes.
        sha256: its SHA-256.
    """

    size: Annotated[int, msgspec.Meta(ge=0)]
    sha256: Hash


class Module(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A module of the user that is needed to run what is packed.

    Attributes:
        name: its name, as it is imported.
        defines: the classes and functions that are needed of it.
        files: its entries in the package, and those of modules that it imports; empty: it is not included.
        distribution: name and version of the installed package that it is of; "": it is of none.
    """

    name: Annotated[str, msgspec.Meta(pattern=r"^[^\W\d]\w*(\.[^\W\d]\w*)*$", max_length=200)]
    defines: tuple[ShortText, ...] = ()
    files: tuple[ShortText, ...] = ()
    distribution: ShortText = ""


class Contents(Summarised, msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What is in a package.

    Attributes:
        kind: what is packed: document, record, experiment, results, table (of results, alone) or
            figure.
        path: the entry, or the folder of entries, that is opened.
        about: what it is and what made it: names and values, for people.
        modules: modules of the user that are needed to run it.
        files: size and hash of each entry; empty for the package of a document without contents.
    """

    kind: PackedKind
    path: ShortText
    about: dict[ShortText, ShortText] = {}
    modules: tuple[Module, ...] = ()
    files: dict[ShortText, PackedFile] = {}

    @property
    def noun(self) -> str:
        """What is packed, with its article."""
        return NOUNS[self.kind]

    @property
    def size(self) -> int:
        """Bytes of all files together."""
        return sum(entry.size for entry in self.files.values())

    def _summary(self) -> Summary:
        rows = [*self.about.items()]
        for module in self.modules:
            place = module.distribution or (", ".join(module.files) if module.files else "not included")
            rows.append((f"needs {module.name}", f"{', '.join(module.defines)}: {place}"))
        size = f"{counted(len(self.files), 'file')}, {sized(self.size)}"
        return Summary(f"{self.noun}: {self.path} ({size})", rows)

    def of(self, files: Mapping[str, PackedFile]) -> Contents:
        """Return the same contents with these entries."""
        return msgspec.structs.replace(self, files=dict(files))

    def to_data(self) -> JsonObject:
        """Return plain data; `from_data` reads it."""
        return {"deodar_package": VERSION, file_version.KEY: file_version.HERE, **msgspec.to_builtins(self)}

    @classmethod
    def from_data(cls, plain: Any) -> Contents:
        """Return the contents that plain data state.

        Raises:
            DocumentError: they are not the contents of a package, or of a later version of deodar.
        """
        content = dict(cast("dict[str, Any]", plain)) if isinstance(plain, dict) else {}
        version = content.pop("deodar_package", None)
        if version is None:
            raise DocumentError(f"is not a package of deodar: its {CONTENTS} does not say so")
        file_version.require_readable("a package", version, VERSION, content)
        content.pop(file_version.KEY, None)
        try:
            return msgspec.convert(content, cls)
        except msgspec.ValidationError as error:
            raise DocumentError(first_line(error), where=CONTENTS) from None
