"""The messages of the page to the server, each declared once."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec

from deodar.family import Family
from deodar.server.message import Id, Message

Text = Annotated[str, msgspec.Meta(max_length=4096)]
Count = Annotated[int, msgspec.Meta(ge=0, le=2**31 - 1)]
Seed = Annotated[int, msgspec.Meta(ge=0, le=2**32 - 1)]


class Request(Message, frozen=True):
    """What the page asks for. Where `request` is not 0, an `answer` with the same number follows."""

    request: Count = 0


MESSAGES = Family(Request)
"""Every message to the server, registered where it is declared."""


class DocumentRequest(Request, frozen=True):
    """A request that changes which document is open or what it holds.

    The server does one after the other, whichever page they come from. `session` is the document that the
    request is meant for, as counted by `opened`; where another one was opened since, the request is refused.
    0: whichever is open.
    """

    session: Count = 0


@MESSAGES.register
class OpenFile(DocumentRequest, frozen=True, kw_only=True, tag="open_file"):
    """Open a document below the root. `discard` allows to throw unsaved edits away."""

    path: Text
    discard: bool = False


@MESSAGES.register
class OpenExample(DocumentRequest, frozen=True, kw_only=True, tag="open_example"):
    """Open one of the examples, as a document without a file."""

    name: Text
    discard: bool = False


@MESSAGES.register
class OpenText(DocumentRequest, frozen=True, kw_only=True, tag="open_text"):
    """Open the content of a file that was dropped on the page, as a document without a file."""

    name: Text
    text: str
    discard: bool = False


@MESSAGES.register
class OpenPackage(DocumentRequest, frozen=True, kw_only=True, tag="open_package"):
    """Open the content (base64) of a package (`NAME.deodar`) that was dropped on the page, as a document
    without a file.
    """

    name: Text
    content: str
    discard: bool = False


@MESSAGES.register
class Recover(DocumentRequest, frozen=True, kw_only=True, tag="recover"):
    """Open unsaved edits that were kept."""

    name: Text
    discard: bool = False


@MESSAGES.register
class Forget(Request, frozen=True, kw_only=True, tag="forget"):
    """Throw unsaved edits away that were kept."""

    name: Text


@MESSAGES.register
class Close(DocumentRequest, frozen=True, kw_only=True, tag="close"):
    """Close the document and go to the gallery."""

    discard: bool = False


@MESSAGES.register
class Save(DocumentRequest, frozen=True, kw_only=True, tag="save"):
    """Write the document, to its own file where `path` is empty.

    `replace` allows to write over a file that is not the one it came from, or that changed on disk since.
    """

    path: Text = ""
    replace: bool = False


@MESSAGES.register
class ListFolder(Request, frozen=True, kw_only=True, tag="list_folder"):
    """Ask for the documents and folders in a folder below the root; a `folder` follows."""

    path: Text = ""


@MESSAGES.register
class SetParameter(DocumentRequest, frozen=True, kw_only=True, tag="set"):
    """Change a parameter of an element (`kernel.0.sigma`), or, with an empty element, the document parameter
    of that name.

    `value` is as documents write it: numbers, text, parts with their kind, axes by their key. Changes that
    share a `gesture` (not 0) are one step of undo: a slider that is dragged.
    """

    element: Id
    parameter: Text
    value: Any
    gesture: Count = 0


@MESSAGES.register
class Describe(DocumentRequest, frozen=True, kw_only=True, tag="describe"):
    """Change general properties of the document; what is None stays."""

    name: Text | None = None
    notes: str | None = None
    dt: float | None = None


@MESSAGES.register
class AddKnob(DocumentRequest, frozen=True, kw_only=True, tag="add_knob"):
    """A new document parameter, at the value of the first parameter that it drives."""

    name: Text
    element: Id
    parameter: Text


@MESSAGES.register
class Link(DocumentRequest, frozen=True, kw_only=True, tag="link"):
    """Let a document parameter drive a parameter of an element."""

    name: Text
    element: Id
    parameter: Text


@MESSAGES.register
class Unlink(DocumentRequest, frozen=True, kw_only=True, tag="unlink"):
    """Let a parameter stand for itself again."""

    element: Id
    parameter: Text


@MESSAGES.register
class RemoveKnob(DocumentRequest, frozen=True, kw_only=True, tag="remove_knob"):
    """Take a document parameter away; what it drove keeps its value."""

    name: Text


@MESSAGES.register
class Arrange(DocumentRequest, frozen=True, kw_only=True, tag="arrange"):
    """Change parts of the layout: each key given replaces that key of the document's layout, None takes it
    away.
    """

    layout: dict[str, Any]
    undoable: bool = True


@MESSAGES.register
class ApplyPreset(DocumentRequest, frozen=True, kw_only=True, tag="apply_preset"):
    """Take over the values of another file below the root, by names and kinds, as one step of undo;
    connections stay. The answer lists what did not match.
    """

    path: Text


@MESSAGES.register
class ApplyPresetText(DocumentRequest, frozen=True, kw_only=True, tag="apply_preset_text"):
    """The same with the content of a file of the person's own."""

    name: Text
    text: str


@MESSAGES.register
class Undo(DocumentRequest, frozen=True, kw_only=True, tag="undo"):
    """Take the last change back."""


@MESSAGES.register
class Redo(DocumentRequest, frozen=True, kw_only=True, tag="redo"):
    """Make the change again that was taken back."""


@MESSAGES.register
class Play(Request, frozen=True, kw_only=True, tag="play"):
    """Run on."""


@MESSAGES.register
class Pause(Request, frozen=True, kw_only=True, tag="pause"):
    """Stand still."""


@MESSAGES.register
class Advance(Request, frozen=True, kw_only=True, tag="step"):
    """So many Euler steps, then stand still."""

    n: Annotated[int, msgspec.Meta(ge=1, le=1_000_000)] = 1


@MESSAGES.register
class ResetRun(Request, frozen=True, kw_only=True, tag="reset"):
    """State, time and noise back to the start; with a seed, another one from then on. Parameters stay."""

    seed: Seed | None = None


@MESSAGES.register
class Speed(Request, frozen=True, kw_only=True, tag="speed"):
    """Document time in relation to the clock on the wall: 1 is real time, None as fast as possible."""

    factor: Annotated[float, msgspec.Meta(gt=0, le=1e6)] | None


@MESSAGES.register
class Lengthen(Request, frozen=True, kw_only=True, tag="lengthen"):
    """Let the step grow up to `longest` (document time) where time is short; None: it stays, and the run
    falls behind.
    """

    longest: Annotated[float, msgspec.Meta(gt=0)] | None


@MESSAGES.register
class MeasureCosts(Request, frozen=True, kw_only=True, tag="measure_costs"):
    """Measure what each element costs, while the run goes on; `costs` tells when it begins and when it is
    done.
    """


@MESSAGES.register
class PushInput(Request, frozen=True, kw_only=True, tag="push"):
    """Add an input to an element until `release`: a Gaussian around `center` (axis units), or everywhere the
    same where it is None.
    """

    element: Id
    amplitude: float
    center: list[float] | None = None
    sigma: list[float] | None = None


@MESSAGES.register
class Release(Request, frozen=True, kw_only=True, tag="release"):
    """End of `push`."""


@MESSAGES.register
class UseWorld(DocumentRequest, frozen=True, kw_only=True, tag="use_world"):
    """Let the sensors read a world of that kind, opened with a file below the root."""

    kind: Text
    path: Text


@MESSAGES.register
class UseWorldContent(DocumentRequest, frozen=True, kw_only=True, tag="use_world_content"):
    """Let the sensors read a world made of the content (base64) of a file that was dropped on the page."""

    kind: Text
    name: Text
    content: str


@MESSAGES.register
class WatchWorld(Request, frozen=True, kw_only=True, tag="watch_world"):
    """Send `bodies` from now on, or no longer."""

    on: bool


@MESSAGES.register
class MoveThing(Request, frozen=True, kw_only=True, tag="move_thing"):
    """Put a thing or a mark of the world elsewhere: x and y of its middle."""

    name: Text
    x: float
    y: float


@MESSAGES.register
class PlaceThing(Request, frozen=True, kw_only=True, tag="place_thing"):
    """Put a new thing into the world: its middle and its size."""

    name: Text
    x: float
    y: float
    width: float
    height: float


@MESSAGES.register
class RemoveThing(Request, frozen=True, kw_only=True, tag="remove_thing"):
    """Take a thing out of the world."""

    name: Text


@MESSAGES.register
class Watch(Request, frozen=True, kw_only=True, tag="watch"):
    """Send a port of an element as frames under a number of the page's choice, thinned to at most `most`
    samples along each axis (0: all).
    """

    stream: Count
    element: Id
    port: Text
    most: Count = 0


@MESSAGES.register
class WatchTrace(Request, frozen=True, kw_only=True, tag="trace"):
    """Send a time course: of a node, or of an array its value at a place (axis units), its maximum or its
    mean.
    """

    stream: Count
    element: Id
    port: Text
    reduce: Literal["at", "max", "mean"] = "max"
    at: list[float] = []


@MESSAGES.register
class Unwatch(Request, frozen=True, kw_only=True, tag="unwatch"):
    """End a stream."""

    stream: Count


@MESSAGES.register
class Drawn(Request, frozen=True, kw_only=True, tag="drawn"):
    """The page has taken in the frames up to the clock of this number; only then the next ones are sent."""

    frame: Count
