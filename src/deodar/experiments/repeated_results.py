"""The comparison of the results of an experiment with those of its repetition."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from deodar.experiments import results
from deodar.experiments.merging import computed
from deodar.experiments.rows import KEY
from deodar.recording.repeat import Difference, differences
from deodar.summary import Summarised, Summary, counted


@dataclass(frozen=True, repr=False)
class RepeatedResults(Summarised):
    """The rows of an experiment and of its repetition, compared.

    Attributes:
        compared: number of trials that have a row in both.
        changed: numbers of the trials whose rows differ.
        differences: versions, device, machine and world that differ.
    """

    compared: int
    changed: tuple[int, ...]
    differences: tuple[Difference, ...]

    @property
    def faithful(self) -> bool:
        """Whether the guarantee holds: the same rows if versions, machine and world are the same."""
        return not self.changed or bool(self.differences)

    def __str__(self) -> str:
        reasons = "; ".join(map(str, self.differences))
        if not self.changed:
            text = f"The repetition has the same rows, in {counted(self.compared, 'trial')}"
            return text + (f", although these differ: {reasons}" if reasons else "")
        text = f"The repetition has other rows in {len(self.changed)} of {counted(self.compared, 'trial')}"
        why = (
            f"What differs: {reasons}"
            if reasons
            else "Nothing explains it: versions and machine are the same"
        )
        return f"{text}, the first is trial {self.changed[0]}. {why}"

    def _summary(self) -> Summary:
        return Summary(str(self))


def compare_results(before: str | Path, after: str | Path) -> RepeatedResults:
    """Compare the folders of an experiment and of its repetition; trials that only one has are left out.

    Raises:
        RecordError: one of them is not the folder of an experiment.
    """
    (identity, rows), (new_identity, new_rows) = results.stored(Path(before)), results.stored(Path(after))
    then = {row[KEY]: computed(row) for row in rows}
    pairs = [(then[row[KEY]], computed(row)) for row in new_rows if row[KEY] in then]
    changed = tuple(int(new["trial"]) for old, new in pairs if old != new)
    return RepeatedResults(len(pairs), changed, differences(identity, new_identity))
