"""Pictures: cameras and files, colours, channels, masks and histograms.

cedar's pictures hold 0 to 255 in the order blue, green, red; deodar's sensors 0 to 1 in the order red, green,
blue.
"""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.pictures import HueSaturationValue
from deodar.couplings.weights import AxisWeights
from deodar.elements.stimuli import Pattern
from deodar.elements.world_ports import Sensor
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.arrays import layered
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.file import members, pairs, text
from deodar_interop.importers.cedar.piece import Refused

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

SHADES = ("AUTO", "BGR", "HSV", "HLS", "YUV", "YCrCb", "Lab")


def seen_by(s: SourceStep) -> StepSignal:
    """Translate Picture, Camera, CameraStream and Video by a sensor of a world with pictures."""
    name = _file(s)
    for key in s.values.body:
        if key not in ("name", "comments", "threaded"):
            s.values.say(key, "carried", "of the world: open it with --world")
    axes = rows, columns, channels = s.axes((*SIZE, 3))
    named = dict(zip(("column", "row", "colour"), (columns, rows, channels), strict=True))
    picture_axes = [dc.replace(axis, name=name) for name, axis in named.items()]
    seen = s.add(Sensor(s.named("sensor"), picture_axes, sensor="picture"))
    turned = s.projected("rows", seen, axes, [columns, rows, channels])
    world = {"Camera": "camera:0", "CameraStream": "camera:0", "Video": "video:FILE"}.get(
        s.step.short, "picture:FILE"
    )
    hint = f" ({name})" if name else ""
    why = f"Sensor of {SIZE[1]} x {SIZE[0]} pixels; open a world with a picture{hint}: --world {world}"
    s.explain(why, "approximated")
    return s.turned("", WHITE * np.eye(3)[::-1], channels, turned, 2)


picture = step("cedar.processing.sources.Picture", gives="Picture", sized=True)(seen_by)
video = step("cedar.processing.sources.Video", gives="Video", sized=True, looped=True)(seen_by)
camera = step("cedar.processing.sources.Camera", gives="camera", sized=True, looped=True)(seen_by)
stream = step("cedar.processing.sources.CameraStream", gives="stream", sized=True, looped=True)(seen_by)


def _file(s: SourceStep) -> str:
    """Return the name of the file that a grabber reads, for the report."""
    for _, grabber in pairs(s.values.body):
        for _, channel in pairs(members(grabber).get("channels")):
            filename = members(channel).get("filename")
            path = text(members(filename).get("path")) or text(filename)
            if path:
                return path.replace("\\", "/").rpartition("/")[2]
    return ""


@step("cedar.processing.steps.ColorConversion", "input image", gives="converted image")
def conversion(s: SourceStep, image: StepSignal) -> StepSignal:
    """Translate ColorConversion from blue, green and red."""
    channels = _channels(image)
    source = s.values.word("source type", "AUTO", SHADES)
    target = s.values.word("target type", "HSV", SHADES)
    if source not in ("AUTO", "BGR"):
        raise Unfit(f"deodar converts from red, green and blue, not from {source}")
    if target in ("AUTO", "BGR"):
        return s.copy(image)
    if target != "HSV":
        raise Unfit(f"deodar does not convert to {target}")
    s.explain("HueSaturationValue in cedar's units")
    red_first = AxisWeights(np.eye(3)[::-1] / WHITE, channels, name=s.named("red first"))
    colours = s.add(HueSaturationValue(name=s.named("colours")), input=s.add(red_first, input=image))
    return s.add(AxisWeights(np.diag(HUE), channels, name=s.label), image.axes, input=colours)


def _channels(image: StepSignal) -> Axis:
    """Return the axis of the channels of a picture."""
    if len(image.dims) != 3 or image.dims[2] != 3:
        raise Refused(f"its input has the size {list(image.dims)}, not two dimensions and three channels")
    return image.axes[2]


@step("cedar.processing.steps.ChannelSplit", "three channel input", why="a channel each")
def split(s: SourceStep, image: StepSignal) -> None:
    """Translate ChannelSplit: each channel as an array of its own."""
    _channels(image)
    flat, channel = s.axes(image.dims[:2]), Axis("channel", 0, 1, 1, periodic=True)
    for k in range(3):
        chosen = s.turned(f"of channel {k + 1}", np.eye(3)[k : k + 1], channel, image, 2)
        alone = s.projected(f"channel {k + 1}" if k else "", chosen, flat, [*flat, None])
        s.outlet(f"channel {k + 1}", alone)


@step("cedar.processing.steps.ChannelMerge", "channel 1", "channel 2", "channel 3", gives="output")
def merge(s: SourceStep, *channels: StepSignal) -> StepSignal:
    """Translate ChannelMerge: three arrays become the channels of a picture."""
    sizes = {channel.dims for channel in channels}
    if len(sizes) > 1 or len(channels[0].dims) != 2:
        raise Refused(f"its channels have the sizes {', '.join(str(list(d)) for d in sizes)}")
    return layered(s, channels)


@step("cedar.processing.steps.Threshold", "input", gives="thresholded input")
def threshold(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Threshold: 255 where the input is between two limits, else 0."""
    lower, upper = s.values.number("lower threshold", 0.0), s.values.number("upper threshold", WHITE)
    if not s.values.flag("apply lower threshold", True):
        raise Unfit("it applies no lower threshold")
    s.explain("Sigmoid with Step; at a limit itself the result may differ", "approximated")
    above = s.above("above", lower, seen)
    limited = s.values.flag("apply upper threshold", True)
    below = s.below("below", upper, seen) if limited else s.constant("one", 1.0)
    return s.gain("", WHITE, s.product("both", above, below))


@step("cedar.processing.steps.Histogram", "input", "mask?", gives="histogram")
def histogram(s: SourceStep, seen: StepSignal, mask: StepSignal | None) -> StepSignal:
    """Translate Histogram: the number of samples in bins of equal width.

    The samples below each edge are counted; the difference of two edges is the count of their bin.
    """
    dims, bins = seen.dims, s.values.whole("bins", 10, 1, 10_000)
    lower, upper = s.values.number("range lower", 0.0), s.values.number("range upper", 255.0)
    kind = s.values.word("normalization type", "None", ("None", "ImageSize", "Maximum"))
    if upper <= lower:
        raise Refused(f"its range ends at {upper:g}, before its beginning {lower:g}")
    if math.prod(dims) * (bins + 1) > MOST_COMPARED:
        raise Unfit(f"it compares {math.prod(dims)} samples with {bins + 1} edges")
    edge = Axis("edge", 0, bins, bins + 1)
    every = (*seen.axes, edge)
    edges = s.add(Pattern(s.named("edges"), [edge], np.linspace(lower, upper, bins + 1)))
    wide = s.projected("at every edge", seen, every, seen.axes)
    below = s.above("below", 0.0, s.total("distance", s.gain("minus", -1.0, wide), edges))
    doubts = ["bins without their upper end"]
    if mask is not None:
        if mask.dims != dims:
            raise Refused(f"its mask has the size {list(mask.dims)}, and its input {list(dims)}")
        in_mask = s.above("shown", 0.0, s.function("size of the mask", "abs", mask))
        below = s.product("shown below", below, s.projected("shown at edges", in_mask, every, seen.axes))
        doubts.append("samples where the mask is not 0")
    s.explain(f"a comparison with every edge; {' and '.join(doubts)} are a guess", "approximated")
    counts = s.projected("counts", below, [edge], [*(None for _ in dims), edge])
    share = 1 / math.prod(dims) if kind == "ImageSize" else 1.0
    of_bins = share * (np.eye(bins, bins + 1, 1) - np.eye(bins, bins + 1))
    role = "of each bin" if kind == "Maximum" else ""
    if bins > 1:
        in_bins = s.turned(role, of_bins, s.axes((bins,))[0], counts, 0)
    else:
        in_bins = s.weighted(role, of_bins[0], (), counts)
    if kind == "Maximum":
        return s.quotient("", in_bins, s.reduced("largest", in_bins, "max"), TINY)
    return in_bins
