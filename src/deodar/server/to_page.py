"""The messages of the server to the page, each declared once."""

from __future__ import annotations

from typing import Any, Literal

from deodar.family import Family
from deodar.server.message import Data, Id, Message

MESSAGES = Family(Message)
"""Every message to the page, registered where it is declared."""


class ListedProblem(Data, frozen=True):
    """One thing that is wrong: where, what, what to type; and the element it belongs to, if it is one.

    A warning stops no run.
    """

    what: str
    where: str = ""
    fix: str = ""
    element: Id = ""
    severity: Literal["problem", "warning"] = "problem"


class ParameterForm(Data, frozen=True):
    """How a parameter is shown and changed.

    `form` is the shape of the value; `of` names the kinds that may stand in a `part` or `parts`; `symbol` is
    TeX.
    """

    name: str
    form: Literal[
        "number",
        "integer",
        "flag",
        "text",
        "texts",
        "per_axis",
        "axes",
        "axis",
        "part",
        "parts",
        "array",
        "numbers",
        "pairs",
    ]
    cost: Literal["live", "rebuild", "recompile"]
    meaning: str
    description: str
    symbol: str
    unit: str
    lower: float | None
    upper: float | None
    default: Any
    optional: bool
    choices: list[str]
    of: list[str]


class Kind(Data, frozen=True):
    """A registered kind: the part of its description (`deodar.kinds`) that forms, equations and plots need.

    `room` is elements, couplings, kernels, sigmoids, windows, worlds or own. `levels` names for a port the
    parameters that are levels on its scale (threshold, resting level). `example` is a value to start from,
    where it stands inside a part.
    """

    name: str
    room: str
    title: str
    equation: list[str]
    reference: str
    parameters: list[ParameterForm]
    ports: dict[str, str]
    levels: dict[str, dict[str, str]]
    example: Any


class AxisView(Data, frozen=True):
    """A metric dimension, under its key in the document."""

    key: str
    name: str
    lower: float
    upper: float
    samples: int
    periodic: bool
    unit: str


class ElementView(Data, frozen=True):
    """An element of the document.

    `axes` gives for each port the keys of its axes, as far as they are known.
    """

    id: Id
    path: str
    name: str
    group: list[str]
    kind: str
    every: int
    values: dict[str, Any]
    inputs: list[str]
    outputs: list[str]
    axes: dict[str, list[str]]
    pushable: bool


class ConnectionView(Data, frozen=True):
    """From an output port to an input port."""

    source: Id
    source_port: str
    target: Id
    target_port: str
    reads: str


class LinkView(Data, frozen=True):
    """A parameter that a document parameter drives."""

    element: Id
    parameter: str


class KnobView(Data, frozen=True):
    """A document parameter and what it drives."""

    name: str
    value: float
    links: list[LinkView]


class DocumentView(Data, frozen=True):
    """The document as it is edited.

    `file` is relative to the root, empty without one; `unsaved`: edited since it was written.
    """

    file: str
    title: str
    time_unit: str
    dt: float | None
    notes: str
    axes: list[AxisView]
    elements: list[ElementView]
    connections: list[ConnectionView]
    groups: list[list[str]]
    knobs: list[KnobView]
    layout: dict[str, Any]
    problems: list[ListedProblem]
    unsaved: bool
    undo: int
    redo: int


class ExampleView(Data, frozen=True):
    """An entry of the gallery; `picture` is an address on the server, empty without one."""

    name: str
    title: str
    sentence: str
    picture: str


class Recovery(Data, frozen=True):
    """Unsaved edits that were kept: name, title, the file they belong to, and when (ISO)."""

    name: str
    title: str
    file: str
    when: str


@MESSAGES.register
class Welcome(Message, frozen=True, tag="welcome"):
    """First message on a connection: what there is, whatever is open."""

    version: str
    root: str
    kinds: list[Kind]
    examples: list[ExampleView]


@MESSAGES.register
class Gallery(Message, frozen=True, tag="gallery"):
    """What can be gone on with: documents opened before (below the root), unsaved edits."""

    recent: list[str]
    recoveries: list[Recovery]


@MESSAGES.register
class Opened(Message, frozen=True, tag="opened"):
    """The whole document; None: none is open. `session` changes with each document that is opened."""

    session: int
    version: int
    document: DocumentView | None


@MESSAGES.register
class Trouble(Message, frozen=True, tag="trouble"):
    """The file that could not be opened, with every problem in it; an empty list: no trouble any more."""

    file: str
    problems: list[ListedProblem]


@MESSAGES.register
class Changed(Message, frozen=True, tag="changed"):
    """One parameter has another value; nothing else differs from the document of the version before."""

    version: int
    element: Id
    parameter: str
    value: Any
    cost: Literal["live", "rebuild", "recompile"]
    unsaved: bool
    undo: int
    redo: int


@MESSAGES.register
class Checked(Message, frozen=True, tag="checked"):
    """The problems and warnings of that version of the document, where single changes led to it; of a whole
    document it holds them itself.
    """

    version: int
    problems: list[ListedProblem]


@MESSAGES.register
class RunClock(Message, frozen=True, tag="clock"):
    """Where the run is. Sent after the frames of the same number, and whenever something changes.

    `factor` is document time over time on the wall, measured; `speed` is what was asked for (None: as fast as
    possible); `abstract` time counts 1 unit as 1 ms. In ms on the wall: `lag` is how far the run is behind
    and will catch up, `worst` the largest lag since it was played, `lost` what was given up; `overruns`
    counts how often it fell behind. `longest` is the step up to which it may grow to keep up (None: it
    stays), and `lengthened` counts the steps that did. `busy` says in words what is being made; `failure` why
    the run stopped; `world` what the sensors read.
    """

    frame: int
    running: bool
    time: float
    tick: int
    dt: float
    seed: int
    speed: float | None
    factor: float
    steps: float
    lag: float
    worst: float
    lost: float
    overruns: int
    longest: float | None
    lengthened: int
    busy: str
    failure: list[ListedProblem]
    world: str
    senses: bool
    pushing: Id


class CostView(Data, frozen=True):
    """What an element costs: microseconds of a step.

    `alike` elements are computed together and share the time; `once`: it stands still and is computed once a
    chunk. What a connection resamples or delays has a path but is no element of the document.
    """

    element: Id
    path: str
    kind: str
    us: float
    alike: int
    once: bool


@MESSAGES.register
class Costs(Message, frozen=True, tag="costs"):
    """What a step costs, as it was measured last, the dearest first; `step` is that of the whole step in
    microseconds, 0 before it was measured.
    """

    measuring: bool
    step: float
    elements: list[CostView]
    problems: list[ListedProblem]


class BoxView(Data, frozen=True):
    """Something solid in the world, from above: its middle, its size, its colour (red, green, blue, 0 to 1);
    `fixed`: it cannot be moved.
    """

    name: str
    x: float
    y: float
    width: float
    height: float
    color: list[float]
    fixed: bool


class MarkView(Data, frozen=True):
    """A place in the world that has a name, such as a goal; `fixed`: it cannot be moved."""

    name: str
    x: float
    y: float
    fixed: bool


class BodyView(Data, frozen=True):
    """Something round that moves by itself, and where it looks (rad; 0 along x, counter-clockwise)."""

    name: str
    x: float
    y: float
    heading: float
    radius: float


class SceneView(Data, frozen=True):
    """What stands in the world, in its unit of length; `border` is lower x, lower y, upper x, upper y."""

    unit: str
    border: list[float]
    boxes: list[BoxView]
    marks: list[MarkView]


@MESSAGES.register
class WorldScene(Message, frozen=True, tag="scene"):
    """The world from above, whenever something in it was moved; None: there is nothing to see from above."""

    scene: SceneView | None


@MESSAGES.register
class Bodies(Message, frozen=True, tag="bodies"):
    """Where the bodies are now, and what is new of their way: rows of x and y of each body; `fresh`: what was
    known of it before is over.
    """

    bodies: list[BodyView]
    fresh: bool
    way: list[list[float]]


@MESSAGES.register
class Announced(Message, frozen=True, tag="announced"):
    """What a stream holds from now on: its shape, and the axes as they are thinned.

    `folded` names axes over which the maximum is taken, because an array has more than two dimensions;
    `channels`: a picture. A time course has the shape [2]: pairs of time and value.
    """

    stream: int
    shape: list[int]
    axes: list[AxisView]
    folded: list[str]
    channels: bool


@MESSAGES.register
class Lost(Message, frozen=True, tag="lost"):
    """A stream that gives nothing, and why: the element is gone, or the port cannot be read."""

    stream: int
    problem: ListedProblem


@MESSAGES.register
class Folder(Message, frozen=True, tag="folder"):
    """What lies in a folder below the root."""

    request: int
    path: str
    folders: list[str]
    files: list[str]
    pictures: list[str]


@MESSAGES.register
class Answer(Message, frozen=True, tag="answer"):
    """The end of a request; with problems, nothing was done.

    `ask` names the question that has to be settled first: `unsaved` (send it again with discard) or `replace`
    (send it again with replace). `cost` is what a change cost. Of a preset, `carried` counts the values it
    changed and `unmatched` lists what it could not change. `imported` says in a sentence what became of a
    file of another tool that was opened. `version` is the first version of the document that holds the
    change, where the request was one.
    """

    request: int
    problems: list[ListedProblem] = []
    ask: Literal["", "unsaved", "replace"] = ""
    cost: Literal["", "live", "rebuild", "recompile"] = ""
    file: str = ""
    carried: int = 0
    unmatched: list[str] = []
    imported: str = ""
    version: int = 0
