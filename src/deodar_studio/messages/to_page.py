"""The messages from the server to the page."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

import msgspec

from deodar.declarations import Cost, FormSection, Names
from deodar.family import Family
from deodar.importers.report import Verdict
from deodar.numerics.signs import Sign
from deodar.parameters import ValueForm
from deodar.worlds._scene import SolidShape
from deodar_studio.messages.message import Data, Id, Message

MESSAGES = Family(Message)
"""All messages to the page; each class below is registered by a decorator."""

ViewName: TypeAlias = Literal["build", "run", "experiment", "robot"]
"""A view of the page."""


class EndsView(Data, frozen=True):
    """The ends of a connection."""

    source: Id
    source_port: str
    target: Id
    target_port: str


class ListedProblem(Data, frozen=True):
    """A problem or a warning: what is wrong, where, what to type, and the element concerned, if any.

    A warning does not prevent a run. `repair` says what the request of that name does about it; empty:
    nothing. `wire` is a connection of which the person has to choose a part: an empty end, or the coupling
    between two ends. `world`: another world, or another sensor or motor of the world, may solve it. `trust`:
    the document names functions, which the studio runs only with trust.
    """

    what: str
    where: str = ""
    fix: str = ""
    element: Id = ""
    severity: Literal["problem", "warning"] = "problem"
    repair: str = ""
    wire: EndsView | None = None
    world: bool = False
    trust: bool = False


class ParameterForm(Data, frozen=True):
    """Description of a parameter for its input form.

    `form` is the type of the value; `of` lists the kinds allowed for a `part` or `parts`; `symbol` is TeX;
    `names` is what a text names, so that the form can list the names. `section` is the section of the form
    that lists it; empty: its head. `if_none` and `if_empty` are words for null and for an empty list; empty:
    none.
    """

    name: str
    form: ValueForm
    cost: Cost
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
    names: Names = ""
    section: FormSection = ""
    if_none: str = ""
    if_empty: str = ""


class WorldSettingView(Data, frozen=True):
    """A setting of a world; `form` is the type of its value, `file` a file that it opens."""

    name: str
    form: Literal["file", "text", "number", "flag", "numbers"]
    meaning: str
    default: Any


class Kind(Data, frozen=True):
    """A registered kind: the part of its description (`deodar.kinds`) that forms, equations and plots need.

    `room` is elements, couplings, kernels, sigmoids, windows, worlds or own. `levels` lists for each port the
    parameters that are levels on its scale (threshold, resting level), `maps` for each array parameter from a
    source to a target the ports whose axes its dimensions have. `example` is the initial value of a
    parameter whose value is a part of this kind. `opens` lists the endings of the files that a world opens,
    `names` what it opens besides files, and `settings` the values that it is made from; empty: it cannot be
    opened.
    """

    name: str
    room: str
    title: str
    equation: list[str]
    reference: str
    parameters: list[ParameterForm]
    ports: dict[str, str]
    levels: dict[str, dict[str, str]]
    maps: dict[str, list[str]]
    example: Any
    opens: list[str]
    names: list[str]
    settings: list[WorldSettingView]


class ExperimentForms(Data, frozen=True):
    """Descriptions of all that an experiment is made of, for the forms of its cards.

    `design` has the parameters of the experiment itself. `usual` is the kind of a measure that does not state
    one.
    """

    design: list[ParameterForm]
    conditions: list[Kind]
    actions: list[Kind]
    measures: list[Kind]
    usual: str


class AxisView(Data, frozen=True):
    """An axis of the document, with its key there."""

    key: str
    name: str
    lower: float
    upper: float
    samples: int
    periodic: bool
    unit: str


class ElementView(Data, frozen=True):
    """An element of the document.

    `axes` lists for each port the keys of its axes, if they are known. `pushable`: whether an input can be
    injected; `kernel`: whether the element has an interaction kernel; `effect`: the sign that it gives to its
    connections, for their marks; `strength`: the path of the number that is the strength of a coupling.
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
    kernel: bool
    effect: Sign
    strength: str


class ConnectionView(EndsView, frozen=True):
    """A connection from an output port to an input port."""

    reads: str


class LinkView(Data, frozen=True):
    """A parameter of an element that a document parameter sets."""

    element: Id
    parameter: str


class DocumentParameterView(Data, frozen=True):
    """A document parameter and the parameters that it sets."""

    name: str
    value: float
    links: list[LinkView]


class CopyDimension(Data, frozen=True):
    """A dimension of trials or of a sweep, with its values as text."""

    name: str
    values: list[str]


class RecordView(Data, frozen=True):
    """An open record.

    `path` is relative to the root. `growing`: a process writes it. `notes` are sentences on what is missing
    in it. `ports` lists for each element the ports that were recorded.
    """

    path: str
    complete: bool
    growing: bool
    notes: list[str]
    copies: list[CopyDimension]
    ports: dict[str, list[str]]


class BoxPlace(Data, frozen=True):
    """The upper left corner of a box, in pixels."""

    x: float
    y: float


class CommentView(BoxPlace, frozen=True):
    """A comment on the canvas."""

    text: str
    width: float
    height: float


class PinView(Data, frozen=True):
    """A pinned parameter; `element` is empty for a document parameter.

    `lower` and `upper` are a chosen range, `label` is a name of its own; `switch`: a switch between the ends
    of the range takes the place of a slider.
    """

    element: Id
    parameter: str
    lower: float | msgspec.UnsetType = msgspec.UNSET
    upper: float | msgspec.UnsetType = msgspec.UNSET
    label: Annotated[str, msgspec.Meta(min_length=1)] | msgspec.UnsetType = msgspec.UNSET
    switch: bool | msgspec.UnsetType = msgspec.UNSET


class KeptPresetView(Data, frozen=True):
    """A preset of the document; `group` is the menu or switch that it is a choice of, if any."""

    name: str
    group: str


class PlottedPort(Data, frozen=True):
    """A port that the document names for its first plots."""

    element: Id
    port: str


class TileView(Data, frozen=True):
    """A plot; of a `kind` that the page does not know, or None, it shows the first that fits the port."""

    element: Id
    kind: str | None
    port: str
    settings: dict[str, Any]


class LayoutView(Data, frozen=True):
    """How the document is shown.

    `boxes` and `comments` are by id, `tiles` by view. `folded` are the folded groups, None if the document
    does not state them; `tiles`: None, if it has none. `view` is the one in which the document opens.
    `every_element`: the canvas contracts none.
    """

    boxes: dict[str, BoxPlace]
    folded: list[str] | None
    comments: dict[str, CommentView]
    pins: list[PinView]
    presets: list[KeptPresetView]
    tiles: dict[str, list[TileView]] | None
    plots: list[PlottedPort]
    view: ViewName | None
    every_element: bool


class DocumentView(Data, frozen=True):
    """The open document.

    `file` is relative to the root, and empty if the document has no file; `unsaved`: it was edited since it
    was written. `undo` and `redo` are the numbers of steps available. `record`: the document is that of an
    open record, and nothing runs.
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
    parameters: list[DocumentParameterView]
    layout: LayoutView
    problems: list[ListedProblem]
    unsaved: bool
    undo: int
    redo: int
    record: RecordView | None = None


class ExampleView(Data, frozen=True):
    """An entry of the gallery; `picture` is an address on the server, or empty."""

    name: str
    title: str
    sentence: str
    picture: str


class TemplateView(Data, frozen=True):
    """A model that can be added to a document as a group.

    `room` is `architectures`, published models, or `examples`, documents of the gallery. `picture` is the
    address of a picture; it may be empty.
    """

    name: str
    title: str
    sentence: str
    picture: str
    room: Literal["architectures", "examples"]


class PlotView(Data, frozen=True):
    """A plot from an installed package, in addition to those of the page.

    `axes` is the number of axes that it draws: 1; 2 (of more axes, the maximum over the others); 3: pictures.
    `periodic`: all axes have to be periodic. `module` is the address of its ES module on the server.
    """

    name: str
    title: str
    package: str
    axes: int
    periodic: bool
    module: str


class Recovery(Data, frozen=True):
    """Stored unsaved edits: name, title, the file they belong to, and the time of storing (ISO 8601).

    `experiment` is the name of the experiment whose model the document is; empty: the document itself has the
    edits.
    """

    name: str
    title: str
    file: str
    when: str
    experiment: str = ""


@MESSAGES.register
class Welcome(Message, frozen=True, tag="welcome"):
    """First message on a connection: the data that do not depend on the open document.

    An experiment runs in `usual_workers` processes unless a page states a number, `most_workers` at most;
    `clusters`: whether pages may name any cluster, or only the processes of `local:N`.
    """

    version: str
    root: str
    usual_workers: int
    most_workers: int
    clusters: bool
    kinds: list[Kind]
    experiment: ExperimentForms
    examples: list[ExampleView]
    templates: list[TemplateView]
    plots: list[PlotView]


@MESSAGES.register
class Gallery(Message, frozen=True, tag="gallery"):
    """Documents to open again: files below the root that were open before, and stored unsaved edits."""

    recent: list[str]
    recoveries: list[Recovery]


@MESSAGES.register
class Opened(Message, frozen=True, tag="opened"):
    """The whole document; None: none is open. `session` increases when a document is opened or closed."""

    session: int
    version: int
    document: DocumentView | None


class ReportLineView(Data, frozen=True):
    """An item of an imported file: an element, parameter or connection, and what became of it.

    `where` is the label of the element in the file, and `element` the id that it got in the document, also if
    it was renamed or removed since; both are empty for what belongs to no element. Of a group, `group` has
    the names that it had, and `element` is the first element in it. `part` is the sort of the item, and
    `what` its name. `why` states how it was approximated or why it was dropped; for a carried item, its
    counterpart.
    """

    where: str
    element: Id
    part: str
    what: str
    verdict: Verdict
    why: str
    group: list[str]


@MESSAGES.register
class ImportReportView(Message, frozen=True, tag="import_report"):
    """The report on the file of another tool that the document was made from; an empty `tool`: none.

    The lines of a label follow each other. `bugs` are known errors of the tool that the file touches.
    """

    tool: str
    file: str
    lines: list[ReportLineView]
    bugs: list[str]


@MESSAGES.register
class FileProblems(Message, frozen=True, tag="file_problems"):
    """A file that could not be opened, with all its problems; an empty list clears an earlier message."""

    file: str
    problems: list[ListedProblem]


class SnapshotView(Data, frozen=True):
    """A stored snapshot: document time, time of saving (ISO 8601), size in bytes."""

    name: str
    time: float
    saved: str
    size: int


class PresetView(Data, frozen=True):
    """Stored values of parameters: path below the root, time of saving (ISO 8601), size in bytes."""

    name: str
    path: str
    saved: str
    size: int


@MESSAGES.register
class SavedFiles(Message, frozen=True, tag="saved_files"):
    """The snapshots and presets of the open document, the newest first."""

    snapshots: list[SnapshotView]
    presets: list[PresetView]


class DifferenceView(Data, frozen=True):
    """The first moment at which a port of two records differs, and the sample with the largest difference.

    `at` is the position of the sample, as text; `copy` the trial and the point of a sweep, as indices. A
    value that is not finite is None.
    """

    element: Id
    path: str
    time: float
    copy: dict[str, int]
    at: str
    value: float | None
    other: float | None


@MESSAGES.register
class Comparison(Message, frozen=True, tag="comparison"):
    """The comparison of the open record with another one; an empty `path`: there is none.

    `progress` is the share that was compared, 1 at the end. `differences` lists the first one of each port
    that differs, the earliest first, `compared` the ports that both records have. `notes` are sentences on
    what was not compared.
    """

    path: str
    progress: float
    compared: int
    differences: list[DifferenceView]
    notes: list[str]
    problems: list[ListedProblem]


class KeyedDifference(Data, frozen=True, omit_defaults=True):
    """What an edit changes of an object or a list, by key.

    The keys in `removed` go, `inside` has the differences of entries that changed in part, `changed` the new
    values of the others. A list has the indices of its entries as keys: in `removed` and `inside` those
    before the edit, in `changed` those after it, where the entries are inserted in ascending order.
    """

    removed: list[str] = msgspec.field(default_factory=list[str])
    inside: dict[str, KeyedDifference] = msgspec.field(default_factory=dict[str, Any])
    changed: dict[str, Any] = msgspec.field(default_factory=dict[str, Any])


@MESSAGES.register
class Edited(Message, frozen=True, tag="edited"):
    """The difference of a `DocumentView` to that of the previous version.

    Its problems are part of it if the structure has or had any; `checked` messages with warnings follow.
    `cost` is the cost of the edit.
    """

    version: int
    difference: KeyedDifference
    cost: Cost


@MESSAGES.register
class Checked(Message, frozen=True, tag="checked"):
    """Problems and warnings of a version of the document that pages know from `edited` messages.

    A whole document (`opened`) contains its own problems.
    """

    version: int
    problems: list[ListedProblem]


class TimelineView(Data, frozen=True):
    """The moments that the page can show, in document time, and the one that it shows.

    `frames` is their number. From `full_from` on none was removed to save memory. `time` is the moment shown
    (None: the present), and `frame` its number from 0 on. `second` is the document time in one second of real
    time, and `step` the smallest difference of two moments.
    """

    first: float
    last: float
    frames: int
    full_from: float
    frame: int
    time: float | None
    second: float
    step: float


class CompilingView(Data, frozen=True):
    """A compilation in progress: its phase, and in seconds how long it lasts already and will take in all.

    `expected` is the time that the last program of this size took; None: not known.
    """

    phase: Literal["planning", "compiling"]
    elapsed: float
    expected: float | None


class RecordingView(Data, frozen=True):
    """The record of the run: its path below the root, and why it ended; empty while it is written."""

    path: str
    ended: str


@MESSAGES.register
class RunClock(Message, frozen=True, tag="clock"):
    """Time and status of the run. Sent after the frames of the same number, and whenever something changes.

    `factor` is the measured ratio of document time to wall time; `speed` is the requested ratio (None: as
    fast as possible); one unit of `abstract` time counts as 1 ms. In ms of wall time: `lag` is how far the
    run is behind and will catch up, `worst` the largest lag since the run was started, `lost` the time that
    it will not catch up; `overruns` is the number of times it fell behind. `longest` is the limit up to which
    the step may grow to keep up (None: the step is constant), and `lengthened` is the number of longer steps
    taken. `busy` is a phrase for the compilation in progress; `failure` lists why the run stopped; `world` is
    a phrase for the world that the sensors read. `timeline`: see there; None: no moment can be shown.
    `recording`: None if nothing was recorded in this session.
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
    compiling: CompilingView | None
    failure: list[ListedProblem]
    world: str
    senses: bool
    pushing: Id
    timeline: TimelineView | None
    recording: RecordingView | None


class CostView(Data, frozen=True):
    """Cost of an element: microseconds per step.

    `alike` is the number of elements that are computed together and share the time; `once`: the element is
    constant and is computed once per chunk. The resampling or delay of a connection has a path, but is not an
    element of the document.
    """

    element: Id
    path: str
    kind: str
    us: float
    alike: int
    once: bool


@MESSAGES.register
class Costs(Message, frozen=True, tag="costs"):
    """Cost of a step as last measured, the most expensive element first.

    `step` is the time of the whole step in microseconds, 0 before the first measurement.
    """

    measuring: bool
    step: float
    elements: list[CostView]
    problems: list[ListedProblem]


class RegimeRow(Data, frozen=True):
    """A measurement of a regime: its name, and its value in words."""

    name: str
    text: str


class RegimeCurve(Data, frozen=True):
    """Settled activation at its maximum over the strength of a localised input, for growing (`up`) and for
    falling (`down`) input; a peak exists above `threshold`.
    """

    input: list[float]
    up: list[float | None]
    down: list[float | None]
    threshold: float


@MESSAGES.register
class Regime(Message, frozen=True, tag="regime"):
    """What the field that was measured last does, alone and without noise.

    `element` is empty before the first measurement. `words` are the regime, the most important first; they
    are empty while it is measured, and if that was not possible. `stale`: the element has changed since.
    """

    element: Id
    measuring: bool
    stale: bool
    words: list[str]
    rows: list[RegimeRow]
    curve: RegimeCurve | None
    problems: list[ListedProblem]


class RequirementView(Data, frozen=True):
    """A requirement of a tuned field: its text, a sentence on what was found, its margin (0 or above: it is
    met, 1: in the middle of its tolerance), its value if it has one, and whether that is exact.
    """

    text: str
    sentence: str
    margin: float | None
    value: float | None
    exact: bool


class TunedValue(Data, frozen=True):
    """A parameter of a tuned field, by path."""

    path: str
    before: float
    value: float


@MESSAGES.register
class Tuning(Message, frozen=True, tag="tuning"):
    """The tuning of a field to a stated regime.

    `element` is empty before the first one. `candidates` counts what was tried; `requirements` and `values`
    are empty while it runs, and if that was not possible. `tolerated` is the relative change that all
    parameters may have at once; `reasons` say why not all requirements are met. `applied`: the document has
    these values.
    """

    element: Id
    tuning: bool
    candidates: int
    requirements: list[RequirementView]
    values: list[TunedValue]
    tolerated: float
    reasons: list[str]
    applied: bool
    problems: list[ListedProblem]


class BoxView(Data, frozen=True):
    """A solid box of the world: its middle, size and colour (red, green, blue, 0 to 1).

    `fixed`: the box cannot be moved.
    """

    name: str
    x: float
    y: float
    width: float
    height: float
    color: list[float]
    fixed: bool


class MarkView(Data, frozen=True):
    """A named position in the world, such as a goal; `fixed`: the mark cannot be moved."""

    name: str
    x: float
    y: float
    fixed: bool


class BodyView(Data, frozen=True):
    """A round body that moves by itself; `heading` is in rad, 0 along x, counter-clockwise."""

    name: str
    x: float
    y: float
    heading: float
    radius: float


class SceneView(Data, frozen=True):
    """Boxes and marks of the world, in its unit of length; `border` is lower x, lower y, upper x, upper y."""

    unit: str
    border: list[float]
    boxes: list[BoxView]
    marks: list[MarkView]


class PictureView(Data, frozen=True):
    """A picture that a camera of the world sees, and its size in pixels."""

    name: str
    columns: int
    rows: int


@MESSAGES.register
class WorldScene(Message, frozen=True, tag="scene"):
    """The world from above, sent whenever a box or mark changed; None: the world has no view from above.

    `note` is a sentence on what a record does not contain of the world; `camera`: the world has a sensor of
    that name; `solid`: it can be shown in three dimensions; `can_place`: objects can be added; `picture`:
    what its camera sees is in the messages on bodies.
    """

    scene: SceneView | None
    note: str = ""
    camera: bool = False
    solid: bool = False
    can_place: bool = False
    picture: PictureView | None = None


class SignalView(Data, frozen=True):
    """A sensor or motor of a world as a new element: its kind, name, title, meaning and values."""

    kind: str
    name: str
    title: str
    meaning: str
    values: dict[str, Any]


class WorldSignals(Data, frozen=True):
    """What a world, given by a phrase, offers."""

    world: str
    signals: list[SignalView]


@MESSAGES.register
class OfferedSignals(Message, frozen=True, tag="offered_signals"):
    """The sensors and motors that the document can use: those of its world, or, where it has none yet, those
    of every world of which there is an example and that has all that the document reads and drives.
    """

    worlds: list[WorldSignals]


class MotorLimits(Data, frozen=True):
    """What a motor of a robot allows: the range of its commands, and their greatest change per second.

    None: any value, or any change.
    """

    motor: str
    lower: float | None = None
    upper: float | None = None
    slew: float | None = None
    unit: str = ""


@MESSAGES.register
class RobotLink(Message, frozen=True, tag="robot_link"):
    """The link with a robot in another process, a few times a second.

    `robot`: its name; empty: the world is in this process. `age`: time since its last message, ms; `lost`:
    periods that did not arrive; `refused`: messages that one of both sides refused; `round_trip`: time from a
    command to the message that answers it, ms. `motors`: what its motors allow; `can_narrow`: whether the
    request `narrow_motor` narrows them.
    """

    robot: str = ""
    motors: list[MotorLimits] = []
    can_narrow: bool = False
    age: float = 0.0
    lost: int = 0
    refused: int = 0
    round_trip: float = 0.0


@MESSAGES.register
class Bodies(Message, frozen=True, tag="bodies"):
    """The bodies now, and the new part of their path.

    Each row of `path` has x and y of each body; `fresh`: the path starts again, and the page drops the old
    one. `poses` (base64 of float32) has for each solid its position and the rows of its rotation matrix.
    `picture` (base64) has red, green and blue of what a camera sees, a byte each, row by row from the top.
    """

    bodies: list[BodyView]
    fresh: bool
    path: list[list[float]]
    poses: str = ""
    picture: str = ""


class SolidView(Data, frozen=True):
    """A rigid solid of the world in three dimensions.

    `size` has half lengths along its own axes; of a sphere the radius first; of a capsule or cylinder the
    radius and half of the straight part, along its z; of a plane 0 for an endless one. `color` is red, green,
    blue and opacity. `thing` is the box of the scene that it shows; empty: none. `points` (float32) and
    `faces` (int32), as base64, are the triangles of a mesh.
    """

    body: str
    shape: SolidShape
    size: list[float]
    color: list[float]
    thing: str
    pushable: bool
    points: str = ""
    faces: str = ""


@MESSAGES.register
class WorldSolids(Message, frozen=True, tag="solids"):
    """All solids of the world, sent before the first `poses` of them."""

    solids: list[SolidView]


class RunView(Data, frozen=True):
    """The run of an experiment: how many rows of how many trials there are, and the remaining time in s.

    `number` changes with each run; `folder` is below the root. A run is `followed` while another process
    writes its rows. Of a run of this studio, `stopping` is true after a stop until it ends, `cluster` is the
    address of its workers (empty: processes of this machine), `workers` their present number, and `pieces`
    the number of pieces that they have. While rows arrive, `slowest` describes the combination of levels with
    the longest trials, and `diverged` those whose trials diverge.
    """

    number: int
    folder: str
    state: Literal["running", "followed", "complete", "stopped", "failed"]
    rows: int
    trials: int
    left: float | None
    problems: list[ListedProblem]
    stopping: bool
    cluster: str
    workers: int
    pieces: int
    slowest: str
    diverged: list[str]


@MESSAGES.register
class ExperimentView(Message, frozen=True, tag="experiment"):
    """The open experiment; `data` is None without one.

    `data` is what its file contains, without the version and the model; `version` grows with each change.
    `undo` and `redo` are the numbers of edits that can be undone and redone. `problems` prevent a run, which
    has `trials` trials. `repeated` is the trial whose record is open.
    """

    data: dict[str, Any] | None
    version: int
    file: str
    unsaved: bool
    undo: int
    redo: int
    problems: list[ListedProblem]
    trials: int
    repeated: int | None
    run: RunView | None


@MESSAGES.register
class TrialRows(Message, frozen=True, tag="trial_rows"):
    """Further rows of a run: those from number `first` on, as `trials.jsonl` contains them."""

    run: int
    first: int
    rows: list[dict[str, Any]]


@MESSAGES.register
class Announced(Message, frozen=True, tag="announced"):
    """Format of the following frames of a stream: the shape after thinning, and the axes.

    `rest` lists the axes of the array that are not drawn, and `folded` the names of those over which the
    maximum is taken; `channels`: the array is a picture. A time course has the shape [2], pairs of time and
    value; one of rows has the shape [1 + n], a time and n values.
    """

    stream: int
    shape: list[int]
    axes: list[AxisView]
    rest: list[AxisView]
    folded: list[str]
    channels: bool


@MESSAGES.register
class Lost(Message, frozen=True, tag="lost"):
    """A stream without data, and the reason: the element was removed, or the port cannot be read."""

    stream: int
    problem: ListedProblem


class WorldPreview(Data, frozen=True):
    """What a world looks like: from above, or what its sensor reads, as bytes (base64) of rows of pixels.

    `missing` lists sensors and motors of the document that the world does not have; `limits` what the motors
    of a robot allow, if they can be narrowed.
    """

    sensors: list[str]
    motors: list[str]
    missing: list[str]
    limits: list[MotorLimits]
    scene: SceneView | None
    width: int
    height: int
    pixels: str


@MESSAGES.register
class Folder(Message, frozen=True, tag="folder"):
    """Content of a folder below the root; `records` are files, and folders that are not in `folders`;
    `others` are further files. `facts` has the size in bytes of files and records that are files, and the
    time of their last change, in seconds since 1970.
    """

    request: int
    path: str
    facts: dict[str, tuple[int, float]]
    folders: list[str]
    files: list[str]
    pictures: list[str]
    records: list[str]
    others: list[str]


class OfferView(Data, frozen=True):
    """A coupling that can stand between two ports whose axes differ: `add_element` with these values.

    `note` states what it loses; it is empty if every position is kept.
    """

    kind: str
    values: dict[str, Any]
    note: str


class FitView(Data, frozen=True):
    """Whether a port can be connected, and why not, or how the values change on the way.

    `offers`: couplings for ports whose axes differ, the best first.
    """

    element: Id
    port: str
    fits: bool
    reason: str
    offers: list[OfferView]


class FittingKindView(Data, frozen=True):
    """A kind whose new element can be connected, and its port."""

    kind: str
    port: str


@MESSAGES.register
class Fits(Message, frozen=True, tag="fitting"):
    """What a port can be connected with: all ports of the other direction, and kinds of new elements."""

    request: int
    element: Id
    port: str
    ports: list[FitView]
    kinds: list[FittingKindView]


@MESSAGES.register
class Answer(Message, frozen=True, tag="answer"):
    """The result of a request; if it has problems, the request had no effect.

    `ask` is a question for the user before the request can be repeated: `unsaved` (repeat it with discard),
    `unsaved_experiment` (repeat it with discard_experiment) or `replace` (repeat it with replace; `file` is
    the file in the way, if the request does not name it). `cost` is the cost of a change. For a preset,
    `carried` is the number of values that changed and `unmatched` lists the values that could not be applied.
    `imported` is a sentence on the import of a file of another tool. `version` is the first version of the
    document with the change, if the request made one. `made` lists the ids of new elements, `group` the names
    of a new group; `text` is what the request asked for: a document for the clipboard, a script, or a report.
    `fault` is true if deodar itself failed: the page offers a report.
    """

    request: int
    problems: list[ListedProblem] = []
    ask: Literal["", "unsaved", "unsaved_experiment", "replace"] = ""
    cost: Literal["", Cost] = ""
    file: str = ""
    carried: int = 0
    unmatched: list[str] = []
    imported: str = ""
    preview: WorldPreview | None = None
    version: int = 0
    made: list[Id] = []
    group: list[str] = []
    text: str = ""
    fault: bool = False
