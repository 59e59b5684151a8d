"""A model as a graph of NIR for a chip: translated, built, fitted, with the report of all of it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

from deodar.errors import ParameterError, instance_of
from deodar.importers.report import ImportReport, Line
from deodar.model.model import Model
from deodar.summary import Summarised, Summary
from deodar_spikes.build import build
from deodar_spikes.chip_limits import ChipLimits, chip_limits
from deodar_spikes.fitting import Fitted, fit
from deodar_spikes.translate import NEURONS, Translated, translate

CHIP = "ideal"
DIFFERING: tuple[str, ...] = ("v_threshold", "bias")
"""What a single number of mismatch is about: thresholds and constant currents."""


@dc.dataclass(frozen=True)
class SpikingOptions:
    """How a model becomes a graph.

    Attributes:
        neurons: neurons of a cell.
        step: dt in the document's time unit; none: the document's.
        chip: name of the chip.
        mismatch: relative standard deviation of thresholds and constant currents; none: the chip's own.
        seed: seed of the mismatch, of Poisson spikes and of the world.
        tonic: whether neurons that spike in every step give the resting levels, in place of constant
            currents, which mismatch spreads.
    """

    neurons: int = NEURONS
    step: float | None = None
    chip: str = CHIP
    mismatch: float | None = None
    seed: int = 0
    tonic: bool = False


@dc.dataclass(frozen=True, repr=False)
class Prepared(Summarised):
    """A model as a graph for a chip.

    Attributes:
        translated: the network, and what is computed by deodar.
        limits, fitted: the chip and the graph for it.
        spread: relative standard deviation between neurons, by parameter.
        report: of the translation and the chip.
    """

    translated: Translated
    limits: ChipLimits
    fitted: Fitted
    spread: Mapping[str, float]
    report: ImportReport

    def _summary(self) -> Summary:
        network, chip = self.translated.network, self.limits.name
        return Summary(f"{network.neurons} neurons and {network.synapses} synapses for {chip}")


def prepare(model: Model, name: str = "", options: SpikingOptions | None = None) -> Prepared:
    """Translate a model and fit it to a chip.

    Args:
        model: the model; it must be free of problems.
        name: name of the file, for the report.
        options: how.

    Raises:
        UnknownName: there is no chip of that name.
        ParameterError: the mismatch is not 0 or above.
        ModelError: the model has problems, or nothing in it has a counterpart that spikes.
        TimeError: the step is not shorter than every time constant.
        TooLarge: the network has too many neurons or weights.
    """
    settings = SpikingOptions() if options is None else instance_of(SpikingOptions, options, "options")
    limits = chip_limits(settings.chip)
    if settings.mismatch is not None and not 0 <= settings.mismatch < 1:
        raise ParameterError(f"a mismatch of {settings.mismatch:g}", fix="Give a share, for example 0.1")
    spread = limits.mismatch
    if settings.mismatch is not None:
        spread = {field: settings.mismatch for field in DIFFERING}
    translated = translate(model, name, settings.neurons, settings.step, tonic=settings.tonic)
    fitted = fit(build(translated.network), limits)
    network, cores = translated.network, fitted.cores
    size = (
        f"{network.neurons:,} neurons, {network.synapses:,} synapses, steps of {network.step * 1e3:g} ms,"
        f" {cores} core{'s' if cores > 1 else ''} of {settings.chip}"
    )
    lines = [*translated.report.lines, Line("", "file", "network", "carried", size), *fitted.lines]
    for what, share in spread.items():
        if share:
            why = f"differs between neurons by {share:.0%}"
            lines.append(Line("", "file", what, "approximated", why))
    report = ImportReport("nir", name, lines)
    return Prepared(translated, limits, fitted, spread, report)
