"""The controls of a window in a document: sliders as pins, sets of values as presets.

A control of several parameters becomes a document parameter, which all of them follow, where they have the
same value here and in every preset; otherwise each of them has a slider of its own.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from deodar.codec import Json
from deodar.errors import DeodarError
from deodar.importers.report import Line, Verdict
from deodar.leaves import get
from deodar.model import edit
from deodar.model.document import Document, Entry
from deodar.model.kept_presets import KeptPreset, with_presets
from deodar.model.paths import display
from deodar_interop.importers._foreign import FreeNames
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.constructors import SIZES
from deodar_interop.importers.cosivina.controls import (
    BUTTONS,
    ButtonControl,
    Control,
    DropdownControl,
    FilesControl,
    LostControl,
    SliderControl,
    SwitchControl,
    Targets,
)
from deodar_interop.importers.cosivina.responses import Follower, LeafPath, Responses, Unfollowed, aligned
from deodar_interop.importers.cosivina.translate import Translation
from deodar_interop.importers.cosivina.values import size

PINS = "pins"
"""Key of the layout for pinned sliders."""

Files = Callable[[str], file.Simulator]
"""Returns the simulator of a parameter file; raises ValueError with the reason if it cannot."""


@dc.dataclass
class _Row:
    """A control as a row of sliders: what follows it, and whether it is a switch."""

    control: SliderControl | SwitchControl
    followers: list[Follower]
    other: list[LeafPath]


@dc.dataclass
class _Set:
    """The values of one choice of a control."""

    name: str
    control: Control
    values: dict[LeafPath, Any]


class LauncherPanel:
    """The controls of a window, as pins, document parameters and presets.

    Args:
        translation: the translation of the simulator.
        controls: the controls.
        files: reads parameter files.
    """

    def __init__(self, translation: Translation, controls: Sequence[Control], files: Files) -> None:
        self._responses = Responses(translation)
        self._files = files
        self._rows: list[_Row] = []
        self._sets: list[_Set] = []
        self._labels = Counter(c.label for c in controls if isinstance(c, (SliderControl, SwitchControl)))
        self._places = {id(control): k for k, control in enumerate(controls)}
        self._lines: list[tuple[int, Line]] = []
        for control in controls:
            try:
                self._take(control)
            except Unfollowed as error:
                self._say(control, "dropped", str(error))

    def _say(self, control: Control, verdict: Verdict, why: str) -> None:
        self._add(control, Line(control.label, "control", control.kind, verdict, why))

    def _add(self, control: Control, line: Line) -> None:
        self._lines.append((self._places[id(control)], line))

    def _take(self, control: Control) -> None:
        match control:
            case SliderControl():
                self._rows.append(self._row(control, control.lower, control.upper))
            case SwitchControl():
                self._switch(control)
            case DropdownControl():
                self._choices(control, control.choices, control.values, control.targets)
                self._say(control, "carried", f"{len(control.choices)} presets")
            case FilesControl():
                self._preset_files(control)
            case ButtonControl():
                replacement = BUTTONS.get(control.member)
                self._say(
                    control,
                    "dropped" if replacement is None else "carried",
                    replacement or f"the studio has nothing in place of {control.member!r}",
                )
            case LostControl():
                self._say(control, "dropped", control.why)

    # ----------------------------------------------------------------------------------------------- controls

    def _row(self, control: SliderControl | SwitchControl, low: Any, high: Any) -> _Row:
        """Return what follows a control between two values of its parameters."""
        ends = [_finite(v) for v in (low, high)]
        if isinstance(control, SliderControl):
            if not control.factor or not math.isfinite(control.factor):
                raise Unfollowed(f"its factor is {control.factor:g}")
            ends = [v / control.factor for v in ends]
        if ends[0] == ends[1]:
            raise Unfollowed("its range is a single value")
        row = _Row(control, [], [])
        for label, name in dict.fromkeys(control.targets):
            followers, others = self._responses.followers(label, name, *ends)
            row.followers += followers
            row.other += others
        if not row.followers:
            raise Unfollowed("it sets no parameter")
        return row

    def _switch(self, control: SwitchControl) -> None:
        self._choices(control, ("off", "on"), (control.off, control.on), control.targets)
        off, on = ({_scalar(v) for v in side} for side in (control.off, control.on))
        if len(off) == len(on) == 1 and None not in off | on and off != on:
            try:
                row = self._row(control, *off, *on)
            except Unfollowed:
                pass
            else:
                if len(row.followers) == len(set(control.targets)):
                    self._rows.append(row)
                    return
        self._say(control, "carried", "2 presets")

    def _choices(
        self,
        control: SwitchControl | DropdownControl,
        choices: Sequence[str],
        values: Sequence[Sequence[Any]],
        targets: Targets,
    ) -> None:
        """Add a preset for each choice: the values that differ from those at present in some choice."""
        raw: list[dict[LeafPath, Any]] = []
        before: dict[LeafPath, Any] = {}
        for leaves in values:
            by_label: dict[str, dict[str, Any]] = {}
            for (label, name), value in zip(targets, leaves, strict=True):
                self._responses.require(label, name)
                if value is None:
                    raise Unfollowed(f"a value for {name!r} of {label!r} is not known")
                by_label.setdefault(label, {})[name] = value
            raw.append({})
            for label, new in by_label.items():
                before |= self._responses.present(label)
                raw[-1] |= self._responses.changed(label, new)
        present, sets = aligned(before, raw)
        varied = [leaf for leaf in present if any(f[leaf] != present[leaf] for f in sets)]
        if not varied:
            raise Unfollowed("its choices do not differ in what deodar computes")
        for choice, leaves in zip(choices, sets, strict=True):
            chosen = {leaf: leaves[leaf] for leaf in varied}
            self._sets.append(_Set(f"{control.label}: {choice}", control, chosen))

    def _preset_files(self, control: FilesControl) -> None:
        count = 0
        for choice, name in zip(control.choices, control.files, strict=True):
            try:
                simulator = self._files(name)
            except ValueError as error:
                self._add(control, Line(control.label, "preset", choice, "dropped", str(error)))
                continue
            self._sets.append(_Set(choice, control, self._of_file(control, choice, simulator)))
            count += 1
        if not count:
            raise Unfollowed("none of its files was read")
        self._say(control, "carried", f"{count} presets; the run is not reset when one is applied")

    def _of_file(self, control: FilesControl, choice: str, simulator: file.Simulator) -> dict[LeafPath, Any]:
        """Return all values that a parameter file gives to elements of the same label and class."""
        out: dict[LeafPath, Any] = {}
        ours = self._responses.translation.simulator.by_label
        lost: list[str] = []
        for e in simulator.elements:
            element = ours.get(e.label)
            if element is None or element.kind != e.kind:
                lost.append(f"{e.label!r} is not in the model")
                continue
            values = {name: value for name, value in e.values.items() if name not in SIZES}
            if any(
                name in e.values and size(e.values[name]) != size(element.values.get(name)) for name in SIZES
            ):
                lost.append(f"{e.label!r} has another size there")
            try:
                present = self._responses.present(e.label)
                changed = self._responses.changed(e.label, values)
            except Unfollowed as error:
                if element.values != e.values:
                    lost.append(str(error))
                continue
            out |= aligned(present, [changed])[1][0]
        lost += [f"{label!r} is not in the file" for label in ours if label not in simulator.by_label]
        if lost:
            why = "; ".join(lost[:5]) + (f"; and {len(lost) - 5} more" if len(lost) > 5 else "")
            self._add(control, Line(control.label, "preset", choice, "approximated", why))
        return out

    # ----------------------------------------------------------------------------------------------- document

    def finish(self, doc: Document) -> tuple[Document, list[Line]]:
        """Return the document with pins, document parameters and presets, and the report lines."""
        by = {entry.element.name: entry for entry in doc.entries}
        names = FreeNames([*by, *(k.name for k in doc.parameters)])
        pins: list[Json] = []
        driven: dict[LeafPath, str] = {}
        pinned: set[LeafPath] = set()
        for row in self._rows:
            leaves = [f.leaf for f in row.followers]
            if pinned & set(leaves):
                taken = ", ".join(display((leaf[0], leaf[1])) for leaf in leaves if leaf in pinned)
                verdict: Verdict = "carried" if isinstance(row.control, SwitchControl) else "approximated"
                replacement = "2 presets" if verdict == "carried" else "it has no slider of its own"
                self._say(row.control, verdict, f"{replacement}: {taken} has one already")
                continue
            name = ""
            if self._shared(row):
                doc, name = self._linked(doc, row, by, names)
            if not name and len(leaves) > 1 and isinstance(row.control, SwitchControl):
                self._say(row.control, "carried", "2 presets")
                continue
            if name:
                driven |= dict.fromkeys(leaves, name)
                pins.append(_pin("", name, row.control, row.followers[0], row.control.label))
            else:
                for f in row.followers:
                    ident = by[f.leaf[0]].id
                    pins.append(_pin(ident, f.leaf[1], row.control, f, self._label(row, f)))
            pinned |= set(leaves)
            self._report(row, name)
        if pins:
            doc = edit.arrange(doc, {**doc.layout, PINS: pins})
        presets = self._presets(doc, by, driven)
        lines = [line for _, line in sorted(self._lines, key=lambda entry: entry[0])]
        return (with_presets(doc, presets) if presets else doc), lines

    def _shared(self, row: _Row) -> bool:
        """Return whether one document parameter can drive what follows a control, with all presets."""
        first, *others = row.followers
        if not others or any(
            (f.now, f.lower, f.upper) != (first.now, first.lower, first.upper) for f in others
        ):
            return False
        leaves = [f.leaf for f in row.followers]
        for preset in self._sets:
            values = [preset.values[leaf] for leaf in leaves if leaf in preset.values]
            if values and (len(values) < len(leaves) or any(v != values[0] for v in values)):
                return False
        return True

    def _linked(
        self, doc: Document, row: _Row, by: Mapping[str, Entry], names: FreeNames
    ) -> tuple[Document, str]:
        """Return the document with a parameter that drives several, and its name; "" if it cannot."""
        name = names.new(row.control.label.strip() or "slider")
        try:
            new = edit.document_parameter(doc, name, row.followers[0].now)
            for f in row.followers:
                new = edit.link(new, by[f.leaf[0]].id, f.leaf[1], name)
        except DeodarError:
            return doc, ""
        return new, name

    def _label(self, row: _Row, follower: Follower) -> str:
        """Return the label of a slider; the element is part of it where several have the same."""
        label = row.control.label
        alone = len(row.followers) == 1 and self._labels[label] == 1
        return label if alone else f"{label} ({follower.leaf[0]})"

    def _report(self, row: _Row, name: str) -> None:
        widget = "switch" if isinstance(row.control, SwitchControl) else "slider"
        paths = [display((f.leaf[0], *f.leaf[1].split("."))) for f in row.followers]
        why = (
            f"{widget} of {', '.join(paths)}" if not name else f"{widget} of the document parameter {name!r}"
        )
        if row.other:
            still = ", ".join(display((leaf[0], *leaf[1].split("."))) for leaf in row.other)
            stays = "stays as it is" if len(row.other) == 1 else "stay as they are"
            self._say(row.control, "approximated", f"{why}; {still} {stays}")
        elif len(paths) > 1 and not name:
            self._say(row.control, "approximated", f"a {widget} for each: their values differ")
        else:
            self._say(row.control, "carried", why)

    def _presets(
        self, doc: Document, by: Mapping[str, Entry], driven: Mapping[LeafPath, str]
    ) -> list[KeptPreset]:
        names = FreeNames(())
        out: list[KeptPreset] = []
        for preset in self._sets:
            values: dict[str, dict[str, Json]] = {}
            lost: list[str] = []
            for leaf, value in preset.values.items():
                plain = _plain(value)
                if leaf in driven:
                    values.setdefault("", {})[driven[leaf]] = plain
                elif plain is not None or value is None:
                    values.setdefault(by[leaf[0]].id, {})[leaf[1]] = plain
                elif value != _present(doc, by, leaf):
                    lost.append(display((leaf[0], *leaf[1].split("."))))
            if lost:
                why = f"{', '.join(lost)} is not a number, and stays as it is"
                line = Line(preset.control.label, "preset", preset.name, "approximated", why)
                self._add(preset.control, line)
            out.append(KeptPreset(names.new(preset.name), preset.control.label, values))
        return out


def _pin(
    ident: str, parameter: str, control: SliderControl | SwitchControl, f: Follower, label: str
) -> dict[str, Json]:
    """Return a pin as the studio stores it; a switch goes from its first value to its second one."""
    switched = isinstance(control, SwitchControl)
    low, high = (f.lower, f.upper) if switched else sorted((f.lower, f.upper))
    pin: dict[str, Json] = {"element": ident, "parameter": parameter, "lower": low, "upper": high}
    if label and label != parameter:
        pin["label"] = label
    return {**pin, "switch": True} if switched else pin


def _finite(value: Any) -> float:
    end = float(value)
    if not math.isfinite(end):
        raise Unfollowed(f"its range ends at {end:g}")
    return end


def _scalar(value: Any) -> float | None:
    """Return a number; None for anything else."""
    return float(value) if isinstance(value, (bool, int, float)) else None


def _plain(value: Any) -> Json:
    """Return a value as JSON holds it; None if it is an array or a part."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, tuple) and all(isinstance(v, (bool, int, float, str)) for v in value):
        return list(value)
    return None


def _present(doc: Document, by: Mapping[str, Entry], leaf: LeafPath) -> Any:
    return get(doc.by_id()[by[leaf[0]].id].element, leaf[1])
