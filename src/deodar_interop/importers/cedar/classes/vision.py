"""Pictures: cameras and files, colours, channels, masks and histograms.

cedar's pictures hold 0 to 255 in the order blue, green, red; deodar's sensors 0 to 1 in the order red, green,
blue.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.gain import Gain
from deodar.couplings.hue_saturation_value import HueSaturationValue
from deodar.couplings.product import Product
from deodar.couplings.project import Project
from deodar.couplings.sigmoid import Sigmoid
from deodar.couplings.sum import Sum
from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.pattern import Pattern
from deodar.elements.sensor import Sensor
from deodar.numerics.axes import Axis
from deodar.numerics.sigmoids.step import Step
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.arrays import layered
from deodar_interop.importers.cedar.composition import Composition
from deodar_interop.importers.cedar.file import members, pairs, text
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, Refused, SourceStep, StepPiece

WHITE = 255.0
TINY = 1e-30

MOST_COMPARED = 4_000_000
"""Most comparisons of samples with edges of bins (a guess)."""

HALF = 180.0
"""cedar's hue of a whole turn, so that it fits in 8 bits."""

SIZE = (480, 640)
"""Rows and columns of a picture of unknown size (a guess: that of most cameras)."""

HUE = np.array([HALF / 360.0, WHITE, WHITE])
"""cedar's hue, saturation and value for 1 degree, 1 and 1."""


def picture(b: SourceStep) -> StepPiece:
    """Translate Picture, Camera, CameraStream and Video by a sensor of a world with pictures."""
    slot = {"Picture": "Picture", "Video": "Video", "Camera": "camera", "CameraStream": "stream"}[
        b.step.short
    ]
    name = _file(b)
    for key in b.values.body:
        if key not in ("name", "comments", "threaded"):
            b.values.say(key, "carried", "of the world: open it with --world")
    dims = (*SIZE, 3)
    axes = b.axes(dims)
    rows, columns, channels = axes
    seen = Sensor(
        b.named("sensor"),
        [
            Axis("column", columns.lower, columns.upper, columns.samples, columns.periodic),
            Axis("row", rows.lower, rows.upper, rows.samples, rows.periodic),
            Axis("colour", channels.lower, channels.upper, channels.samples, channels.periodic),
        ],
        sensor="picture",
    )
    turned = Project(
        axes, "sum", {"row": rows.name, "column": columns.name, "colour": channels.name}, name=b.named("rows")
    )
    order = AxisWeights(WHITE * np.eye(3)[::-1], channels, channels.name, name=b.label)
    world = {"Camera": "camera:0", "CameraStream": "camera:0", "Video": "video:FILE"}.get(
        b.step.short, "picture:FILE"
    )
    hint = f" ({name})" if name else ""
    return StepPiece(
        [order, turned, seen],
        outlets={slot: OutputSlot(b.label, dims)},
        inner=[(seen.name, turned.name), (turned.name, b.label)],
        verdict="approximated",
        why=f"Sensor of {SIZE[1]} x {SIZE[0]} pixels; open a world with a picture{hint}: --world {world}",
    )


def _file(b: SourceStep) -> str:
    """Return the name of the file that a grabber reads, for the report."""
    for _, grabber in pairs(b.values.body):
        for _, channel in pairs(members(grabber).get("channels")):
            filename = members(channel).get("filename")
            path = text(members(filename).get("path")) or text(filename)
            if path:
                return path.replace("\\", "/").rpartition("/")[2]
    return ""


def conversion(b: SourceStep) -> StepPiece:
    """Translate ColorConversion from blue, green and red."""
    dims = _picture(b, "input image")
    source = b.values.word("source type", "AUTO", ("AUTO", "BGR", "HSV", "HLS", "YUV", "YCrCb", "Lab"))
    target = b.values.word("target type", "HSV", ("AUTO", "BGR", "HSV", "HLS", "YUV", "YCrCb", "Lab"))
    channels = b.axes(dims)[2]
    if source not in ("AUTO", "BGR"):
        raise Unfit(f"deodar converts from red, green and blue, not from {source}")
    if target in ("AUTO", "BGR"):
        return _one(b, [Sum(name=b.label)], dims, "Sum, a copy")
    if target == "HSV":
        first, colours = b.named("red first"), b.named("colours")
        elements: list[Element] = [
            AxisWeights(np.diag(HUE), channels, name=b.label),
            HueSaturationValue(name=colours),
            AxisWeights(np.eye(3)[::-1] / WHITE, channels, name=first),
        ]
        return _one(b, elements, dims, "HueSaturationValue in cedar's units")
    raise Unfit(f"deodar does not convert to {target}")


def _one(b: SourceStep, elements: list[Element], dims: tuple[int, ...], why: str) -> StepPiece:
    names = [e.name for e in elements[::-1]]
    return StepPiece(
        elements,
        {"input image": [[InputSlot(names[0])]]},
        {"converted image": OutputSlot(b.label, dims)},
        list(itertools.pairwise(names)),
        needs=("input image",),
        why=why,
    )


def _picture(b: SourceStep, slot: str) -> tuple[int, ...]:
    dims = b.first(slot)
    if len(dims) != 3 or dims[2] != 3:
        raise Refused(f"its input has the size {list(dims)}, not two dimensions and three channels")
    return dims


def split(b: SourceStep) -> StepPiece:
    """Translate ChannelSplit: each channel as an array of its own."""
    dims = _picture(b, "three channel input")
    axes, flat = b.axes(dims), dims[:2]
    flat_axis = Axis("channel", 0, 1, 1, periodic=True)
    piece = StepPiece([], {"three channel input": [[]]}, needs=("three channel input",), why="a channel each")
    for k in range(3):
        name = b.label if k == 0 else b.named(f"channel {k + 1}")
        chosen = b.named(f"of channel {k + 1}")
        piece.elements += [
            Project(b.axes(flat), "sum", name=name),
            AxisWeights(np.eye(3)[k : k + 1], flat_axis, axes[2].name, name=chosen),
        ]
        piece.inner.append((chosen, name))
        piece.inlets["three channel input"][0].append(InputSlot(chosen))
        piece.outlets[f"channel {k + 1}"] = OutputSlot(name, flat)
    return piece


def merge(b: SourceStep) -> StepPiece:
    """Translate ChannelMerge: three arrays become the channels of a picture."""
    slots = ("channel 1", "channel 2", "channel 3")
    sizes = {b.first(slot) for slot in slots}
    flat = next(iter(sizes))
    if len(sizes) > 1 or len(flat) != 2:
        raise Refused(f"its channels have the sizes {', '.join(str(list(d)) for d in sizes)}")
    return layered(b, slots, "output", flat)


def threshold(b: SourceStep) -> StepPiece:
    """Translate Threshold: 255 where the input is between two limits, else 0."""
    dims = b.first("input")
    lower, upper = b.values.number("lower threshold", 0.0), b.values.number("upper threshold", WHITE)
    above = Sigmoid(Step(lower), name=b.named("above"))
    minus, below = Gain(-1.0, name=b.named("minus")), Sigmoid(Step(-upper), name=b.named("below"))
    between = Product(name=b.named("both"))
    piece = StepPiece(
        [Gain(WHITE, name=b.label), between],
        {"input": [[]]},
        {"thresholded input": OutputSlot(b.label, dims)},
        [(between.name, b.label)],
        needs=("input",),
        verdict="approximated",
        why="Sigmoid with Step; at a limit itself the result may differ",
    )
    unit = Boost(b.named("one"), (), 1.0)
    if b.values.flag("apply lower threshold", True):
        piece.elements.append(above)
        piece.inner.append((above.name, between.name))
        piece.inlets["input"][0].append(InputSlot(above.name))
    else:
        raise Unfit("it applies no lower threshold")
    if b.values.flag("apply upper threshold", True):
        piece.elements += [minus, below]
        piece.inner += [(minus.name, below.name), (below.name, between.name, "factor")]
        piece.inlets["input"][0].append(InputSlot(minus.name))
    else:
        piece.elements.append(unit)
        piece.inner.append((unit.name, between.name, "factor"))
    return piece


def histogram(b: SourceStep) -> StepPiece:
    """Translate Histogram: the number of samples in bins of equal width.

    The samples below each edge are counted; the difference of two edges is the count of their bin.
    """
    dims, bins = b.first("input"), b.values.whole("bins", 10, 1, 10_000)
    lower, upper = b.values.number("range lower", 0.0), b.values.number("range upper", 255.0)
    kinds = ("None", "ImageSize", "Maximum")
    kind = b.values.word("normalization type", "None", kinds)
    if upper <= lower:
        raise Refused(f"its range ends at {upper:g}, before its beginning {lower:g}")
    if math.prod(dims) * (bins + 1) > MOST_COMPARED:
        raise Unfit(f"it compares {math.prod(dims)} samples with {bins + 1} edges")
    axes, edge = b.axes(dims), Axis("edge", 0, bins, bins + 1)
    every, c = (*axes, edge), Composition(b)
    edges = c.add(Pattern(b.named("edges"), [edge], np.linspace(lower, upper, bins + 1)))
    wide = c.projected("at every edge", c.slot("input"), axes, every, list(axes))
    below = c.above("below", 0.0, c.total("distance", c.gain("minus", -1.0, wide), edges))
    doubts = ["bins without their upper end"]
    if "mask" in b.ins:
        if b.first("mask") != dims:
            raise Refused(f"its mask has the size {list(b.first('mask'))}, and its input {list(dims)}")
        in_mask = c.above("shown", 0.0, c.function("size of the mask", "abs", c.slot("mask")))
        below = c.product(
            "shown below", below, c.projected("shown at edges", in_mask, axes, every, list(axes))
        )
        doubts.append("samples where the mask is not 0")
    counts = c.projected("counts", below, every, [edge], [*(None for _ in axes), edge])
    places = (bins,) if bins > 1 else ()
    share = 1 / math.prod(dims) if kind == "ImageSize" else 1.0
    of_bins = share * (np.eye(bins, bins + 1, 1) - np.eye(bins, bins + 1))
    name = "" if kind != "Maximum" else "of each bin"
    if bins > 1:
        in_bins = c.add(AxisWeights(of_bins, b.axes(places)[0], "edge", name=c.named(name)), input=counts)
    else:
        in_bins = c.add(Weights(of_bins[0], (), name=c.named(name)), input=counts)
    if kind == "Maximum":
        largest = c.projected("largest", in_bins, b.axes(places), (), [None] * len(places), "max")
        in_bins = c.quotient("", in_bins, largest, TINY)
    c.outlet("histogram", in_bins, places)
    why = f"a comparison with every edge; {' and '.join(doubts)} are a guess"
    return c.done(why, "approximated")


CLASSES = {
    "cedar.processing.sources.Picture": picture,
    "cedar.processing.sources.Video": picture,
    "cedar.processing.sources.Camera": picture,
    "cedar.processing.sources.CameraStream": picture,
    "cedar.processing.steps.ColorConversion": conversion,
    "cedar.processing.steps.ChannelSplit": split,
    "cedar.processing.steps.ChannelMerge": merge,
    "cedar.processing.steps.Histogram": histogram,
    "cedar.processing.steps.Threshold": threshold,
}

DECLARED = frozenset(
    {
        "cedar.processing.sources.Camera",
        "cedar.processing.sources.CameraStream",
        "cedar.processing.sources.Picture",
        "cedar.processing.sources.Video",
    }
)

LOOPED = frozenset(
    {
        "cedar.processing.sources.Camera",
        "cedar.processing.sources.CameraStream",
        "cedar.processing.sources.Video",
    }
)
