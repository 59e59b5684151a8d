"""The measured regime of a field in words."""

from __future__ import annotations

from collections.abc import Iterator

from deodar.analysis.peaks import Peak
from deodar.analysis.preshape import Boosted
from deodar.analysis.regimes import NOT_ASKED, Regimes

WordRows = Iterator[tuple[str, str]]


def heading(found: Regimes) -> list[str]:
    """Return what was measured, and with which input: lines of text."""
    isolated = found.isolated
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


def rows(found: Regimes) -> list[tuple[str, str]]:
    """Return the measurements: a name each, and its value in words."""
    return [
        ("regime", "; ".join(found.words)),
        *_detection(found),
        *_memory(found),
        *_selection(found),
        *_notes(found),
    ]


def _lit(found: Regimes) -> str:
    return "peak" if found.isolated.axes else "activation above threshold"


def _detection(found: Regimes) -> WordRows:
    up, down = found.thresholds.detection, found.thresholds.reverse
    if up is not None:
        kind = (
            "the activation jumps: an instability"
            if up.jump
            else "the activation grows gradually: no instability"
        )
        yield "detection threshold", f"{_bracket(found, 'detection')}  ({kind})"
        low = "0" if found.isolated.axes else f"-{found.thresholds.searched:g}"
        stays = f"none: the {_lit(found)} stays down to an input of {low}"
        yield "reverse detection", _bracket(found, "reverse") if down is not None else stays
        both = found.bistable
        yield "bistable range", f"{both[0]:.4g} to {both[1]:.4g}" if both and both[0] < both[1] else "none"
    if found.peak is not None:
        yield "just above detection", _peak(found, found.peak)


def _memory(found: Regimes) -> WordRows:
    if found.memory is not None:
        left = found.memory.left
        kept = f"{_count(len(left))} left: {_peak(found, left[0])}" if left else f"no {_lit(found)} is left"
        yield "input taken away", kept
    if found.forgetting is not None:
        stays = (
            "is erased by a homogeneous input below"
            if found.self_sustained
            else "would stay with a homogeneous input above"
        )
        yield "memory", f"a peak {stays} {_bracket(found, 'forgetting')}"
        if found.suppression is not None:
            yield "", f"or by a localised input below {_bracket(found, 'suppression')}"
    if found.boosts:
        yield "boost on a pre-shape", "; ".join(_boosted(b) for b in found.boosts)


def _selection(found: Regimes) -> WordRows:
    s = found.selection
    if s is None:
        return
    stronger = (
        "" if s.right is None else " (at the stronger one)" if s.right else " (not at the stronger one)"
    )
    apart = "at no distance do both stay"
    if found.separation:
        apart = f"both stay from a distance of {_distance(found)} on"
    yield "two equal inputs", f"{_count(len(s.equal))}; {apart}"
    yield "two inputs, one stronger", _count(len(s.different)) + stronger


def _notes(found: Regimes) -> WordRows:
    if found.transitions and found.coarse_alone not in ("", NOT_ASKED) and found.isolated.axes:
        yield "discretisation error", f"not measured: {found.coarse_alone}"
    swept = found.ramp
    if not (swept.up.settled.all() and swept.down.settled.all()):
        yield "note", "the field did not settle at some inputs; their values are where it stood at the limit"


def _bracket(found: Regimes, name: str) -> str:
    """Return a threshold, half of its interval, and its shift on a grid twice as fine if that exceeds half
    the interval.
    """
    t = found.transitions[name]
    half = (t.interval[1] - t.interval[0]) / 2
    text = f"{t.value:.4g} ± {half:.1g}"
    if found.discretisation is None:
        return text
    moved = found.discretisation[name]
    if moved is None:
        return text + ", none on a grid twice as fine"
    return text + (
        f", discretisation error {moved:.2g}"
        if abs(moved) > half
        else f", discretisation error below {half:.1g}"
    )


def _peak(found: Regimes, peak: Peak) -> str:
    axes = found.isolated.axes
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


def _distance(found: Regimes) -> str:
    share = found.separation or 0.0
    return ", ".join(f"{share * a.range:.3g}{_unit(a.unit)}" for a in found.isolated.axes)


def _count(number: int) -> str:
    return f"{number or 'no'} peak{'' if number == 1 else 's'}"


def _unit(unit: str) -> str:
    return f" {unit}" if unit else ""
