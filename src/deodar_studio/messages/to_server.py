"""The messages from the page to the server."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec

from deodar.family import Family
from deodar_studio.messages.message import Data, Id, Message

Text = Annotated[str, msgspec.Meta(max_length=4096)]
Count = Annotated[int, msgspec.Meta(ge=0, le=2**31 - 1)]
Seed = Annotated[int, msgspec.Meta(ge=0, le=2**32 - 1)]


class Request(Message, frozen=True):
    """Base class of requests. If `request` is not 0, an `answer` with the same number follows."""

    request: Count = 0


MESSAGES = Family(Request)
"""All messages to the server; each class below is registered by a decorator."""


class DocumentRequest(Request, frozen=True):
    """A request that opens, closes or changes a document or an experiment.

    The server handles the requests of all pages one after the other. `session` is the number of the document
    that the request is meant for, as in `opened`; the request is refused if another document was opened
    since. With 0 it is meant for any open document.
    """

    session: Count = 0


class OpeningRequest(DocumentRequest, frozen=True):
    """A request that opens another document, whichever is open."""


@MESSAGES.register
class OpenFile(OpeningRequest, frozen=True, kw_only=True, tag="open_file"):
    """Open a document, a record or an experiment below the root.

    `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
    """

    path: Text
    discard: bool = False
    discard_experiment: bool = False


@MESSAGES.register
class OpenRecordModel(DocumentRequest, frozen=True, kw_only=True, tag="open_record_model"):
    """Open the document of the open record, as a document without a file, which runs."""

    discard: bool = False


@MESSAGES.register
class CompareRecord(DocumentRequest, frozen=True, kw_only=True, tag="compare_record"):
    """Compare the open record with another one below the root; a `comparison` message follows."""

    path: Text


@MESSAGES.register
class EndComparison(DocumentRequest, frozen=True, kw_only=True, tag="end_comparison"):
    """Show the open record alone again."""


@MESSAGES.register
class OpenExample(OpeningRequest, frozen=True, kw_only=True, tag="open_example"):
    """Open an example, as a document without a file."""

    name: Text
    discard: bool = False


@MESSAGES.register
class OpenText(OpeningRequest, frozen=True, kw_only=True, tag="open_text"):
    """Open the text of a file that was dropped on the page, as a document without a file."""

    name: Text
    text: str
    discard: bool = False


@MESSAGES.register
class OpenPackage(OpeningRequest, frozen=True, kw_only=True, tag="open_package"):
    """Open a package (`NAME.deodar`) that was dropped on the page, as a document without a file.

    `content` is base64.
    """

    name: Text
    content: str
    discard: bool = False


@MESSAGES.register
class Recover(OpeningRequest, frozen=True, kw_only=True, tag="recover"):
    """Open stored unsaved edits of a document, or of an experiment with its model.

    `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
    """

    name: Text
    discard: bool = False
    discard_experiment: bool = False


@MESSAGES.register
class Forget(Request, frozen=True, kw_only=True, tag="forget"):
    """Delete stored unsaved edits."""

    name: Text


@MESSAGES.register
class Close(DocumentRequest, frozen=True, kw_only=True, tag="close"):
    """Close the document and show the gallery."""

    discard: bool = False


@MESSAGES.register
class Save(DocumentRequest, frozen=True, kw_only=True, tag="save"):
    """Write the document to `path`, or to its own file if `path` is empty.

    `replace` allows another file, or a file that changed on disk since it was read, to be overwritten.
    """

    path: Text = ""
    replace: bool = False


@MESSAGES.register
class ListFolder(Request, frozen=True, kw_only=True, tag="list_folder"):
    """List the documents and folders in a folder below the root; a `folder` message follows."""

    path: Text = ""


@MESSAGES.register
class SetParameter(DocumentRequest, frozen=True, kw_only=True, tag="set"):
    """Change a parameter of an element (`kernel.0.sigma`), or the document parameter if `element` is empty.

    `value` has the format of documents: numbers, text, parts with their kind, axes by their key. Changes with
    the same `gesture` (not 0) are one step of undo, such as the drag of a slider.
    """

    element: Id
    parameter: Text
    value: Any
    gesture: Count = 0


@MESSAGES.register
class Describe(DocumentRequest, frozen=True, kw_only=True, tag="describe"):
    """Change general properties of the document; None leaves a property unchanged."""

    name: Text | None = None
    notes: str | None = None
    dt: float | None = None


@MESSAGES.register
class AddDocumentParameter(DocumentRequest, frozen=True, kw_only=True, tag="add_document_parameter"):
    """Add a document parameter with the value of the first parameter that it sets."""

    name: Text
    element: Id
    parameter: Text


@MESSAGES.register
class Link(DocumentRequest, frozen=True, kw_only=True, tag="link"):
    """Link a parameter of an element to a document parameter."""

    name: Text
    element: Id
    parameter: Text


@MESSAGES.register
class Unlink(DocumentRequest, frozen=True, kw_only=True, tag="unlink"):
    """Unlink a parameter of an element from its document parameter."""

    element: Id
    parameter: Text


@MESSAGES.register
class RemoveDocumentParameter(DocumentRequest, frozen=True, kw_only=True, tag="remove_document_parameter"):
    """Remove a document parameter; the parameters that it set keep their values."""

    name: Text


@MESSAGES.register
class Arrange(DocumentRequest, frozen=True, kw_only=True, tag="arrange"):
    """Change parts of the layout: each key replaces that key of the document's layout, None removes it."""

    layout: dict[str, Any]
    undoable: bool = True


Coordinate = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]
Position = tuple[Coordinate, Coordinate]
Group = Annotated[list[Text], msgspec.Meta(max_length=64)]
Many = msgspec.Meta(max_length=100_000)
Ids = Annotated[list[Id], Many]
Groups = Annotated[list[Group], Many]


class PortEnd(Data, frozen=True, kw_only=True):
    """A port of an element; an empty `port` means the default one: the output, the first input."""

    element: Id
    port: Text = ""


class Ends(Data, frozen=True, kw_only=True):
    """The ends of a connection; an empty port means the default one."""

    source: Id
    source_port: Text = ""
    target: Id
    target_port: Text = ""


@MESSAGES.register
class NewDocument(OpeningRequest, frozen=True, kw_only=True, tag="new"):
    """Open an empty document without a file."""

    discard: bool = False


@MESSAGES.register
class AddElement(DocumentRequest, frozen=True, kw_only=True, tag="add_element"):
    """Add an element of a kind; the answer has its id in `made`.

    `values` has the format of documents. Parameters without a value get one that works at once: axes are
    those of the ports that the element is connected with, else those of the first field, else a new axis x.
    `source`, `target`: ports that it is connected with; `wire`: a connection that it is inserted into;
    `replaces`: a connection that is removed. An empty name means a free one after its kind; a taken one gets
    a number. `at` is the position of its box.
    """

    kind: Text
    values: dict[str, Any] = {}
    name: Text = ""
    group: Group = []
    at: Position | None = None
    source: PortEnd | None = None
    target: PortEnd | None = None
    wire: Ends | None = None
    replaces: Ends | None = None


@MESSAGES.register
class InsertElement(DocumentRequest, frozen=True, kw_only=True, tag="insert"):
    """Insert an existing element into a connection, by its default ports; `positions` are those of boxes."""

    element: Id
    wire: Ends
    positions: dict[Id, Position] = {}


@MESSAGES.register
class Connect(DocumentRequest, frozen=True, kw_only=True, tag="connect"):
    """Connect an output port to an input port; `reads` is previous, current, delayed, or empty."""

    source: Id
    source_port: Text = ""
    target: Id
    target_port: Text = ""
    reads: Text = ""


@MESSAGES.register
class Disconnect(DocumentRequest, frozen=True, kw_only=True, tag="disconnect"):
    """Remove a connection."""

    source: Id
    source_port: Text = ""
    target: Id
    target_port: Text = ""


@MESSAGES.register
class Reconnect(DocumentRequest, frozen=True, kw_only=True, tag="reconnect"):
    """Move the ends of a connection."""

    old: Ends
    new: Ends


@MESSAGES.register
class RemoveElements(DocumentRequest, frozen=True, kw_only=True, tag="remove"):
    """Remove elements, groups with their content, and connections."""

    elements: Ids = []
    groups: Groups = []
    connections: Annotated[list[Ends], Many] = []


@MESSAGES.register
class Rename(DocumentRequest, frozen=True, kw_only=True, tag="rename"):
    """Rename an element, or with an empty `element` a group. A name that is taken is refused."""

    name: Text
    element: Id = ""
    group: Group = []


@MESSAGES.register
class MoveInto(DocumentRequest, frozen=True, kw_only=True, tag="move_into"):
    """Move elements and groups into a group; an empty `group` is the top level.

    `positions` are those of boxes, which change in the same step of undo.
    """

    elements: Ids = []
    groups: Groups = []
    group: Group = []
    positions: dict[Id, Position] = {}


@MESSAGES.register
class MakeGroup(DocumentRequest, frozen=True, kw_only=True, tag="group"):
    """Put elements and groups into a new group, whose names are `group` of the answer.

    An empty name means a free one. `at`: the boxes are moved together, their corner to there.
    """

    elements: Ids = []
    groups: Groups = []
    name: Text = ""
    at: Position | None = None


@MESSAGES.register
class Ungroup(DocumentRequest, frozen=True, kw_only=True, tag="ungroup"):
    """Move the content of a group to its parent."""

    group: Group


@MESSAGES.register
class CopyElements(Request, frozen=True, kw_only=True, tag="copy"):
    """Return elements and groups as a document of their own, the JSON text `text` of the answer."""

    elements: Ids = []
    groups: Groups = []


@MESSAGES.register
class ExportScript(Request, frozen=True, kw_only=True, tag="export_script"):
    """Return a Python script that makes the document, the `text` of the answer."""


@MESSAGES.register
class Paste(DocumentRequest, frozen=True, kw_only=True, tag="paste"):
    """Add the content of a document, given as text, to a group; the answer has the new ids in `made`.

    `at` is the position of its upper left corner. Other text is refused, and nothing changes.
    """

    text: str
    group: Group = []
    at: Position | None = None


@MESSAGES.register
class PlaceBoxes(DocumentRequest, frozen=True, kw_only=True, tag="place"):
    """Move boxes to positions, by the ids of their elements."""

    positions: dict[Id, Position]


@MESSAGES.register
class SetMany(DocumentRequest, frozen=True, kw_only=True, tag="set_many"):
    """Change one parameter of several elements to the same value, as `set` does for one."""

    elements: Ids
    parameter: Text
    value: Any
    gesture: Count = 0


@MESSAGES.register
class ChangeAxis(DocumentRequest, frozen=True, kw_only=True, tag="change_axis"):
    """Change an axis, given by its key, for all elements that have it.

    `axis` has the properties of the new one: name, lower, upper, samples, periodic, unit.
    """

    key: Text
    axis: dict[str, Any]


@MESSAGES.register
class AddTemplate(DocumentRequest, frozen=True, kw_only=True, tag="add_template"):
    """Add a template of `welcome` as a new group; the answer has its ids in `made` and its names in `group`.

    `group` is the group that it is added to, `at` the position of its upper left corner.
    """

    name: Text
    group: Group = []
    at: Position | None = None


@MESSAGES.register
class Comment(DocumentRequest, frozen=True, kw_only=True, tag="comment"):
    """Add, change or remove a comment on the graph; the answer has the id of a new one in `made`.

    An empty `comment` adds one. None leaves text, position or size (width, height) unchanged. Comments are in
    the layout, `comments` by id, with `text`, `x`, `y`, `width` and `height`.
    """

    comment: Id = ""
    text: str | None = None
    at: Position | None = None
    size: Position | None = None
    remove: bool = False


@MESSAGES.register
class FindFits(Request, frozen=True, kw_only=True, tag="fits"):
    """Judge what a port can be connected with; a `fitting` message follows.

    An empty `port` means the default output, or the first input of an element without outputs.
    """

    element: Id
    port: Text = ""


@MESSAGES.register
class ApplyPreset(DocumentRequest, frozen=True, kw_only=True, tag="apply_preset"):
    """Apply the values of another file below the root, by names and kinds, as one step of undo.

    Connections stay. The answer lists the values that did not match.
    """

    path: Text


@MESSAGES.register
class ApplyKeptPreset(DocumentRequest, frozen=True, kw_only=True, tag="apply_kept_preset"):
    """Apply a preset that the document keeps in its layout, as one step of undo.

    The answer lists the values that could not be applied.
    """

    name: Text


@MESSAGES.register
class ApplyPresetText(DocumentRequest, frozen=True, kw_only=True, tag="apply_preset_text"):
    """Apply the values of a file as `apply_preset` does, given its text."""

    name: Text
    text: str


@MESSAGES.register
class Undo(DocumentRequest, frozen=True, kw_only=True, tag="undo"):
    """Undo the last change."""


@MESSAGES.register
class Redo(DocumentRequest, frozen=True, kw_only=True, tag="redo"):
    """Redo the change that was undone last."""


@MESSAGES.register
class Play(Request, frozen=True, kw_only=True, tag="play"):
    """Start or continue the run."""


@MESSAGES.register
class Pause(Request, frozen=True, kw_only=True, tag="pause"):
    """Pause the run."""


@MESSAGES.register
class Advance(Request, frozen=True, kw_only=True, tag="step"):
    """Advance by `n` Euler steps, then pause."""

    n: Annotated[int, msgspec.Meta(ge=1, le=1_000_000)] = 1


@MESSAGES.register
class ResetRun(Request, frozen=True, kw_only=True, tag="reset"):
    """Reset state, time and noise to the start, with another seed if one is given. Parameters stay."""

    seed: Seed | None = None


@MESSAGES.register
class Speed(Request, frozen=True, kw_only=True, tag="speed"):
    """Set the ratio of document time to wall time: 1 is real time, None as fast as possible."""

    factor: Annotated[float, msgspec.Meta(gt=0, le=1e6)] | None


@MESSAGES.register
class Lengthen(Request, frozen=True, kw_only=True, tag="lengthen"):
    """Let the step grow up to `longest` (document time) if the machine is too slow.

    None: the step is constant, and the run falls behind.
    """

    longest: Annotated[float, msgspec.Meta(gt=0)] | None


@MESSAGES.register
class Seek(Request, frozen=True, kw_only=True, tag="seek"):
    """Show the last frame up to a document time; None: the present. Other pages are not affected."""

    time: float | None


@MESSAGES.register
class RunFrom(DocumentRequest, frozen=True, kw_only=True, tag="run_from"):
    """Continue the run from the last frame up to a document time, with the parameters of that moment.

    The change of parameters is one step of undo.
    """

    time: float


@MESSAGES.register
class RunRecordFrom(Request, frozen=True, kw_only=True, tag="run_record_from"):
    """Open a copy of the open record's document, which runs on from the last sample up to a document time.

    The run of the record is repeated up to there, with later requests of the page meanwhile; opening another
    document ends the repetition. The answer follows when the copy runs.
    """

    time: float


@MESSAGES.register
class ListSaved(Request, frozen=True, kw_only=True, tag="list_saved"):
    """List snapshots and presets again; a `saved_files` message follows if the list changed."""


@MESSAGES.register
class SaveSnapshot(DocumentRequest, frozen=True, kw_only=True, tag="save_snapshot"):
    """Save the present state of the run as a snapshot under a new name."""

    name: Text


@MESSAGES.register
class ReturnTo(DocumentRequest, frozen=True, kw_only=True, tag="return_to"):
    """Return to a snapshot: states, time, noise, world and parameters; the run pauses."""

    name: Text


@MESSAGES.register
class SavePreset(DocumentRequest, frozen=True, kw_only=True, tag="save_preset"):
    """Save the present values of the parameters as a preset under a new name."""

    name: Text


@MESSAGES.register
class RemoveSaved(DocumentRequest, frozen=True, kw_only=True, tag="remove_saved"):
    """Delete a snapshot or a preset."""

    sort: Literal["snapshot", "preset"]
    name: Text


@MESSAGES.register
class ChooseCopy(Request, frozen=True, kw_only=True, tag="choose_copy"):
    """Show another trial or point of a sweep of the open record: the index along one of its dimensions."""

    dimension: Text
    index: Count


@MESSAGES.register
class SeekFrames(Request, frozen=True, kw_only=True, tag="seek_frames"):
    """Show the frame that is `frames` later than the one shown; a negative number goes back."""

    frames: Annotated[int, msgspec.Meta(ge=-(2**31), le=2**31 - 1)]


class RecordedPort(Data, frozen=True):
    """A port to record."""

    element: Id
    port: Text


@MESSAGES.register
class StartRecord(Request, frozen=True, kw_only=True, tag="start_record"):
    """Record ports of the running model into a new folder below the root; `clock` states its path.

    Without ports: the activation of every field. `every` is the document time between two samples, None every
    step.
    """

    ports: Annotated[list[RecordedPort], msgspec.Meta(max_length=500)] = []
    every: Annotated[float, msgspec.Meta(gt=0)] | None = None


@MESSAGES.register
class StopRecord(Request, frozen=True, kw_only=True, tag="stop_record"):
    """Complete the record that is being written."""


@MESSAGES.register
class SaveFigure(Request, frozen=True, kw_only=True, tag="save_figure"):
    """Save a plot as the file of a figure, which `deodar plot` draws; the answer states its path.

    `kind` is that of the plot, `range` the range of its values; None: it follows the data.
    """

    element: Id
    port: Text
    kind: Text
    range: tuple[float, float] | None = None


@MESSAGES.register
class MeasureCosts(Request, frozen=True, kw_only=True, tag="measure_costs"):
    """Measure the cost of each element during the run; a `costs` message follows at start and end."""


@MESSAGES.register
class MeasureRegime(Request, frozen=True, kw_only=True, tag="measure_regime"):
    """Measure what a field or node does alone, without noise: the `regime` follows when it is found."""

    element: Id


@MESSAGES.register
class StopRegime(Request, frozen=True, kw_only=True, tag="stop_regime"):
    """End the measurement of a regime."""


@MESSAGES.register
class TuneField(Request, frozen=True, kw_only=True, tag="tune_field"):
    """Find values of parameters at which a field meets requirements: `tuning` follows.

    `parameters` are names of parameters of the field, such as `kernel.0.sigma`. A requirement is a name, or
    an object such as `{"detects": {"at": 3, "within": 0.2}}`, as in the files of `deodar tune`.
    """

    element: Id
    parameters: list[Text]
    requirements: list[Any]


@MESSAGES.register
class StopTuning(Request, frozen=True, kw_only=True, tag="stop_tuning"):
    """End the tuning of a field, and forget what was found."""


@MESSAGES.register
class ApplyTuning(DocumentRequest, frozen=True, kw_only=True, tag="apply_tuning"):
    """Give the parameters of the field the values that were found, as one change."""


@MESSAGES.register
class PushInput(Request, frozen=True, kw_only=True, tag="push"):
    """Add an input to an element until `release`.

    The input is a Gaussian around `center` (axis units), or constant over the axes if that is None.
    """

    element: Id
    amplitude: float
    center: list[float] | None = None
    sigma: list[float] | None = None


@MESSAGES.register
class Release(Request, frozen=True, kw_only=True, tag="release"):
    """End the input of `push`."""


@MESSAGES.register
class UseWorld(DocumentRequest, frozen=True, kw_only=True, tag="use_world"):
    """Use a world of a kind, opened with a file below the root, or with another argument of `open`.

    `settings` are further arguments of its constructor.
    """

    kind: Text
    path: Text
    settings: dict[str, Any] = {}


@MESSAGES.register
class PreviewWorld(Request, frozen=True, kw_only=True, tag="preview_world"):
    """Open a world as `use_world` does, without using it; the answer has its `preview`."""

    kind: Text
    path: Text
    settings: dict[str, Any] = {}


@MESSAGES.register
class UseWorldContent(DocumentRequest, frozen=True, kw_only=True, tag="use_world_content"):
    """Use a world of a kind, made from the content (base64) of a file that was dropped on the page."""

    kind: Text
    name: Text
    content: str
    settings: dict[str, Any] = {}


@MESSAGES.register
class WatchWorld(Request, frozen=True, kw_only=True, tag="watch_world"):
    """Start or stop sending `bodies`; `solid`: with the solids and their poses."""

    on: bool
    solid: bool = False


@MESSAGES.register
class MoveObject(Request, frozen=True, kw_only=True, tag="move_object"):
    """Move an object or a mark of the world; `x` and `y` are its new middle."""

    name: Text
    x: float
    y: float


@MESSAGES.register
class PlaceObject(Request, frozen=True, kw_only=True, tag="place_object"):
    """Add an object to the world, with its middle and its size.

    `color` is red, green and blue, 0 to 1; None: that of the world.
    """

    name: Text
    x: float
    y: float
    width: float
    height: float
    color: list[float] | None = None


@MESSAGES.register
class RemoveObject(Request, frozen=True, kw_only=True, tag="remove_object"):
    """Remove an object from the world."""

    name: Text


@MESSAGES.register
class PushBody(Request, frozen=True, kw_only=True, tag="push_body"):
    """Push a body of the world with a force along x, y and z, in N, until the next one; zeros end it.

    It ends too when the page disconnects.
    """

    body: Text
    force: list[float]


@MESSAGES.register
class Watch(Request, frozen=True, kw_only=True, tag="watch"):
    """Send a port of an element as frames, thinned to at most `most` samples along each axis (0: all).

    The page chooses the number `stream`. `other`: of the record that the open one is compared with. `drawn`
    names the axes to send, at most two (empty: the first ones, or all of a picture); `at` states a position
    on other axes, by name and in axis units. Over the rest the maximum is taken.
    """

    stream: Count
    element: Id
    port: Text
    most: Count = 0
    other: bool = False
    drawn: list[Text] = []
    at: dict[Text, float] = {}


@MESSAGES.register
class WatchTrace(Request, frozen=True, kw_only=True, tag="trace"):
    """Send a time course of a port: a node's value, or an array's value at a position, maximum or mean.

    `at` is in axis units; `other` as in `watch`.
    """

    stream: Count
    element: Id
    port: Text
    reduce: Literal["at", "max", "mean"] = "max"
    at: list[float] = []
    other: bool = False


@MESSAGES.register
class WatchRows(Request, frozen=True, kw_only=True, tag="rows"):
    """Send the values of a port along one axis over time, thinned to at most `most` samples (0: all).

    `drawn` names the axis (empty: the first); `at` and `other` as in `watch`.
    """

    stream: Count
    element: Id
    port: Text
    most: Count = 0
    drawn: Text = ""
    at: dict[Text, float] = {}
    other: bool = False


@MESSAGES.register
class WatchKernel(Request, frozen=True, kw_only=True, tag="kernel"):
    """Send the interaction kernel of an element over the lag, with its parameters as they are now.

    Of more than two axes it is sent at lag 0 on the others. `most` and `other` as in `watch`.
    """

    stream: Count
    element: Id
    most: Count = 0
    other: bool = False


@MESSAGES.register
class WatchWeights(Request, frozen=True, kw_only=True, tag="weights"):
    """Send an array parameter that is a map from a source to a target (`Kind.maps`), as it is now.

    `most`, `drawn`, `at` and `other` as in `watch`.
    """

    stream: Count
    element: Id
    parameter: Text
    most: Count = 0
    other: bool = False
    drawn: list[Text] = []
    at: dict[Text, float] = {}


@MESSAGES.register
class Unwatch(Request, frozen=True, kw_only=True, tag="unwatch"):
    """End a stream."""

    stream: Count


@MESSAGES.register
class Drawn(Request, frozen=True, kw_only=True, tag="drawn"):
    """Confirm that the page has drawn the frames up to the clock of this number; the next ones follow."""

    frame: Count


@MESSAGES.register
class NewExperiment(DocumentRequest, frozen=True, kw_only=True, tag="new_experiment"):
    """Open a new experiment whose model is the open document.

    `discard_experiment` allows unsaved edits of the open experiment to be lost.
    """

    discard_experiment: bool = False


@MESSAGES.register
class OpenExperimentFile(OpeningRequest, frozen=True, kw_only=True, tag="open_experiment"):
    """Open an experiment below the root, and its model.

    `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
    """

    path: Text
    discard: bool = False
    discard_experiment: bool = False


@MESSAGES.register
class EditExperiment(DocumentRequest, frozen=True, kw_only=True, tag="edit_experiment"):
    """Replace the plain data of the experiment of that version."""

    data: dict[str, Any]
    version: Count


@MESSAGES.register
class UndoExperiment(DocumentRequest, frozen=True, kw_only=True, tag="undo_experiment"):
    """Undo the last edit of the experiment."""


@MESSAGES.register
class RedoExperiment(DocumentRequest, frozen=True, kw_only=True, tag="redo_experiment"):
    """Redo the edit of the experiment that was undone last."""


@MESSAGES.register
class SaveExperiment(DocumentRequest, frozen=True, kw_only=True, tag="save_experiment"):
    """Write the experiment to `path`, or to its own file if `path` is empty.

    A model without a file is written beside it. `replace` allows another file to be overwritten.
    """

    path: Text = ""
    replace: bool = False


@MESSAGES.register
class CloseExperiment(DocumentRequest, frozen=True, kw_only=True, tag="close_experiment"):
    """Close the experiment. `discard_experiment` allows its unsaved edits to be lost."""

    discard_experiment: bool = False


@MESSAGES.register
class RunExperiment(DocumentRequest, frozen=True, kw_only=True, tag="run_experiment"):
    """Run the experiment in worker processes, or on a cluster; a run that was stopped continues.

    `workers` is the number of processes on this machine; 0: the usual one. `cluster` is an address as on the
    command line, such as `local:4` or `tcp://HOST:8786`; empty: none. `patience` is the time in s without any
    worker after which the run ends, `trust_network` allows a scheduler beyond this machine without
    encryption, and `mixed` workers whose processors differ.
    """

    workers: Count = 0
    cluster: Text = ""
    patience: Annotated[float, msgspec.Meta(gt=0, le=1e7)] = 60.0
    trust_network: bool = False
    mixed: bool = False


@MESSAGES.register
class StopExperiment(Request, frozen=True, kw_only=True, tag="stop_experiment"):
    """Stop the run of the experiment; its rows are kept."""


@MESSAGES.register
class RepeatTrial(Request, frozen=True, kw_only=True, tag="repeat_trial"):
    """Run a trial of the experiment again, and open its record; the document with its edits is set aside."""

    trial: Count


@MESSAGES.register
class LeaveTrial(DocumentRequest, frozen=True, kw_only=True, tag="leave_trial"):
    """Open the document that was set aside for the record of a trial, with its edits."""
