"""The measured regime of a field in words."""

from __future__ import annotations

from collections.abc import Iterator

from deodar.analysis.peaks import Peak
from deodar.analysis.regimes import NOT_ASKED, Regimes
from deodar.analysis.thresholds import Boosted

WordRows = Iterator[tuple[str, str]]


def heading(measured: Regimes) -> list[str]:
    """Return what was measured, and with which input: lines of text."""
    isolated = measured.isolated
    field = isolated.field
    axes = ", ".join(str(a) for a in isolated.axes)
    lines = [
        f"{isolated.path}: {f'a field over {axes}' if axes else 'a node'}; tau {field.tau:g}"
        f" {isolated.time_unit}, resting level"
    ]
    lines[0] += f" {field.resting_level:g}"
    if isolated.axes:
        at = ", ".join(
            f"{a.name} = {c:g}{_unit(a.unit)}" for a, c in zip(isolated.axes, isolated.center, strict=True)
        )
        wide = ", ".join(
            f"{s:.3g}{_unit(a.unit)}" for a, s in zip(isolated.axes, isolated.sigma, strict=True)
        )
        lines.append(f"Measured alone, without noise, with a Gaussian input at {at} of width {wide}.")
    else:
        lines.append("Measured alone, without noise, with a constant input.")
    if isolated.background:
        lines.append(f"Kept as constant input: {', '.join(isolated.background)}.")
    return lines


def rows(measured: Regimes) -> list[tuple[str, str]]:
    """Return the measurements: a name each, and its value in words."""
    return [
        ("regime", "; ".join(measured.words)),
        *_detection(measured),
        *_memory(measured),
        *_selection(measured),
        *_notes(measured),
    ]


def _lit(measured: Regimes) -> str:
    return "peak" if measured.isolated.axes else "activation above threshold"


def _detection(measured: Regimes) -> WordRows:
    up, down = measured.thresholds.detection, measured.thresholds.reverse
    if up is not None:
        kind = (
            "the activation jumps: an instability"
            if up.jump
            else "the activation grows gradually: no instability"
        )
        yield "detection threshold", f"{_bracket(measured, 'detection')}  ({kind})"
        low = "0" if measured.isolated.axes else f"-{measured.thresholds.searched:g}"
        stays = f"none: the {_lit(measured)} stays down to an input of {low}"
        yield "reverse detection", _bracket(measured, "reverse") if down is not None else stays
        bistable = measured.bistable
        yield (
            "bistable range",
            f"{bistable[0]:.4g} to {bistable[1]:.4g}" if bistable and bistable[0] < bistable[1] else "none",
        )
    if measured.peak is not None:
        yield "just above detection", _peak(measured, measured.peak)


def _memory(measured: Regimes) -> WordRows:
    if measured.memory is not None:
        peaks_left = measured.memory.left
        remains = (
            f"{_count(len(peaks_left))} left: {_peak(measured, peaks_left[0])}"
            if peaks_left
            else f"no {_lit(measured)} is left"
        )
        yield "input taken away", remains
    if measured.forgetting is not None:
        stays = (
            "is erased by a homogeneous input below"
            if measured.self_sustained
            else "would stay with a homogeneous input above"
        )
        yield "memory", f"a peak {stays} {_bracket(measured, 'forgetting')}"
        if measured.suppression is not None:
            yield "", f"or by a localised input below {_bracket(measured, 'suppression')}"
    if measured.boosts:
        yield "boost on a pre-shape", "; ".join(_boosted(b) for b in measured.boosts)


def _selection(measured: Regimes) -> WordRows:
    s = measured.selection
    if s is None:
        return
    stronger = (
        "" if s.right is None else " (at the stronger one)" if s.right else " (not at the stronger one)"
    )
    apart = "at no distance do both stay"
    if measured.separation:
        apart = f"both stay from a distance of {_distance(measured)} on"
    yield "two equal inputs", f"{_count(len(s.equal))}; {apart}"
    yield "two inputs, one stronger", _count(len(s.different)) + stronger


def _notes(measured: Regimes) -> WordRows:
    if measured.transitions and measured.coarse_alone not in ("", NOT_ASKED) and measured.isolated.axes:
        yield "discretisation error", f"not measured: {measured.coarse_alone}"
    swept = measured.ramp
    if not (swept.up.settled.all() and swept.down.settled.all()):
        yield "note", "the field did not settle at some inputs; their values are where it stood at the limit"


def _bracket(measured: Regimes, name: str) -> str:
    """Return a threshold, half of its interval, and its shift on a grid twice as fine if that exceeds half
    the interval.
    """
    t = measured.transitions[name]
    half = (t.interval[1] - t.interval[0]) / 2
    text = f"{t.value:.4g} ± {half:.1g}"
    if measured.discretisation is None:
        return text
    moved = measured.discretisation[name]
    if moved is None:
        return text + ", none on a grid twice as fine"
    return text + (
        f", discretisation error {moved:.2g}"
        if abs(moved) > half
        else f", discretisation error below {half:.1g}"
    )


def _peak(measured: Regimes, peak: Peak) -> str:
    axes = measured.isolated.axes
    widths = [f"{w:.3g}{_unit(a.unit)}" for a, w in zip(axes, peak.width, strict=True)]
    return (
        f"width {' x '.join(widths)}, amplitude {peak.amplitude:.3g}"
        if axes
        else f"activation {peak.amplitude:.3g}"
    )


def _boosted(b: Boosted) -> str:
    share = f"input {b.preshape:.3g}: "
    if b.boost is None:
        return share + "none makes a peak"
    return share + f"{b.boost:.4g}" + ("" if b.localised else " (not one peak there)")


def _distance(measured: Regimes) -> str:
    share = measured.separation or 0.0
    return ", ".join(f"{share * a.range:.3g}{_unit(a.unit)}" for a in measured.isolated.axes)


def _count(number: int) -> str:
    return f"{number or 'no'} peak{'' if number == 1 else 's'}"


def _unit(unit: str) -> str:
    return f" {unit}" if unit else ""
