// Generated from src/deodar/server/to_server.py and to_page.py; change those, not this one:
// python -m deodar.server.protocol
// A new document parameter, at the value of the first parameter that it drives.
export type AddKnob = {
  type: "add_knob";
  request?: number;
  session?: number;
  name: string;
  element: string;
  parameter: string;
};

// So many Euler steps, then stand still.
export type Advance = {
  type: "step";
  request?: number;
  n?: number;
};

// What a stream holds from now on: its shape, and the axes as they are thinned.
//
// `folded` names axes over which the maximum is taken, because an array has more than two dimensions;
// `channels`: a picture. A time course has the shape [2]: pairs of time and value.
export type Announced = {
  type: "announced";
  stream: number;
  shape: number[];
  axes: AxisView[];
  folded: string[];
  channels: boolean;
};

// The end of a request; with problems, nothing was done.
//
// `ask` names the question that has to be settled first: `unsaved` (send it again with discard) or `replace`
// (send it again with replace). `cost` is what a change cost. Of a preset, `carried` counts the values it
// changed and `unmatched` lists what it could not change. `imported` says in a sentence what became of a file
// of another tool that was opened. `version` is the first version of the document that holds the change,
// where the request was one.
export type Answer = {
  type: "answer";
  request: number;
  problems?: ListedProblem[];
  ask?: "" | "replace" | "unsaved";
  cost?: "" | "live" | "rebuild" | "recompile";
  file?: string;
  carried?: number;
  unmatched?: string[];
  imported?: string;
  version?: number;
};

// Take over the values of another file below the root, by names and kinds, as one step of undo; connections
// stay. The answer lists what did not match.
export type ApplyPreset = {
  type: "apply_preset";
  request?: number;
  session?: number;
  path: string;
};

// The same with the content of a file of the person's own.
export type ApplyPresetText = {
  type: "apply_preset_text";
  request?: number;
  session?: number;
  name: string;
  text: string;
};

// Change parts of the layout: each key given replaces that key of the document's layout, None takes it away.
export type Arrange = {
  type: "arrange";
  request?: number;
  session?: number;
  layout: Record<string, unknown>;
  undoable?: boolean;
};

// A metric dimension, under its key in the document.
export type AxisView = {
  key: string;
  name: string;
  lower: number;
  upper: number;
  samples: number;
  periodic: boolean;
  unit: string;
};

// Where the bodies are now, and what is new of their way: rows of x and y of each body; `fresh`: what was
// known of it before is over.
export type Bodies = {
  type: "bodies";
  bodies: BodyView[];
  fresh: boolean;
  way: number[][];
};

// Something round that moves by itself, and where it looks (rad; 0 along x, counter-clockwise).
export type BodyView = {
  name: string;
  x: number;
  y: number;
  heading: number;
  radius: number;
};

// Something solid in the world, from above: its middle, its size, its colour (red, green, blue, 0 to 1);
// `fixed`: it cannot be moved.
export type BoxView = {
  name: string;
  x: number;
  y: number;
  width: number;
  height: number;
  color: number[];
  fixed: boolean;
};

// One parameter has another value; nothing else differs from the document of the version before.
export type Changed = {
  type: "changed";
  version: number;
  element: string;
  parameter: string;
  value: unknown;
  cost: "live" | "rebuild" | "recompile";
  unsaved: boolean;
  undo: number;
  redo: number;
};

// The problems and warnings of that version of the document, where single changes led to it; of a whole
// document it holds them itself.
export type Checked = {
  type: "checked";
  version: number;
  problems: ListedProblem[];
};

// Close the document and go to the gallery.
export type Close = {
  type: "close";
  request?: number;
  session?: number;
  discard?: boolean;
};

// From an output port to an input port.
export type ConnectionView = {
  source: string;
  source_port: string;
  target: string;
  target_port: string;
  reads: string;
};

// What an element costs: microseconds of a step.
//
// `alike` elements are computed together and share the time; `once`: it stands still and is computed once a
// chunk. What a connection resamples or delays has a path but is no element of the document.
export type CostView = {
  element: string;
  path: string;
  kind: string;
  us: number;
  alike: number;
  once: boolean;
};

// What a step costs, as it was measured last, the dearest first; `step` is that of the whole step in
// microseconds, 0 before it was measured.
export type Costs = {
  type: "costs";
  measuring: boolean;
  step: number;
  elements: CostView[];
  problems: ListedProblem[];
};

// Change general properties of the document; what is None stays.
export type Describe = {
  type: "describe";
  request?: number;
  session?: number;
  name?: string | null;
  notes?: string | null;
  dt?: number | null;
};

// The document as it is edited.
//
// `file` is relative to the root, empty without one; `unsaved`: edited since it was written.
export type DocumentView = {
  file: string;
  title: string;
  time_unit: string;
  dt: number | null;
  notes: string;
  axes: AxisView[];
  elements: ElementView[];
  connections: ConnectionView[];
  groups: string[][];
  knobs: KnobView[];
  layout: Record<string, unknown>;
  problems: ListedProblem[];
  unsaved: boolean;
  undo: number;
  redo: number;
};

// The page has taken in the frames up to the clock of this number; only then the next ones are sent.
export type Drawn = {
  type: "drawn";
  request?: number;
  frame: number;
};

// An element of the document.
//
// `axes` gives for each port the keys of its axes, as far as they are known.
export type ElementView = {
  id: string;
  path: string;
  name: string;
  group: string[];
  kind: string;
  every: number;
  values: Record<string, unknown>;
  inputs: string[];
  outputs: string[];
  axes: Record<string, string[]>;
  pushable: boolean;
};

// An entry of the gallery; `picture` is an address on the server, empty without one.
export type ExampleView = {
  name: string;
  title: string;
  sentence: string;
  picture: string;
};

// What lies in a folder below the root.
export type Folder = {
  type: "folder";
  request: number;
  path: string;
  folders: string[];
  files: string[];
  pictures: string[];
};

// Throw unsaved edits away that were kept.
export type Forget = {
  type: "forget";
  request?: number;
  name: string;
};

// What can be gone on with: documents opened before (below the root), unsaved edits.
export type Gallery = {
  type: "gallery";
  recent: string[];
  recoveries: Recovery[];
};

// A registered kind: the part of its description (`deodar.kinds`) that forms, equations and plots need.
//
// `room` is elements, couplings, kernels, sigmoids, windows, worlds or own. `levels` names for a port the
// parameters that are levels on its scale (threshold, resting level). `example` is a value to start from,
// where it stands inside a part.
export type Kind = {
  name: string;
  room: string;
  title: string;
  equation: string[];
  reference: string;
  parameters: ParameterForm[];
  ports: Record<string, string>;
  levels: Record<string, Record<string, string>>;
  example: unknown;
};

// A document parameter and what it drives.
export type KnobView = {
  name: string;
  value: number;
  links: LinkView[];
};

// Let the step grow up to `longest` (document time) where time is short; None: it stays, and the run falls
// behind.
export type Lengthen = {
  type: "lengthen";
  request?: number;
  longest: number | null;
};

// Let a document parameter drive a parameter of an element.
export type Link = {
  type: "link";
  request?: number;
  session?: number;
  name: string;
  element: string;
  parameter: string;
};

// A parameter that a document parameter drives.
export type LinkView = {
  element: string;
  parameter: string;
};

// Ask for the documents and folders in a folder below the root; a `folder` follows.
export type ListFolder = {
  type: "list_folder";
  request?: number;
  path?: string;
};

// One thing that is wrong: where, what, what to type; and the element it belongs to, if it is one.
//
// A warning stops no run.
export type ListedProblem = {
  what: string;
  where?: string;
  fix?: string;
  element?: string;
  severity?: "problem" | "warning";
};

// A stream that gives nothing, and why: the element is gone, or the port cannot be read.
export type Lost = {
  type: "lost";
  stream: number;
  problem: ListedProblem;
};

// A place in the world that has a name, such as a goal; `fixed`: it cannot be moved.
export type MarkView = {
  name: string;
  x: number;
  y: number;
  fixed: boolean;
};

// Measure what each element costs, while the run goes on; `costs` tells when it begins and when it is done.
export type MeasureCosts = {
  type: "measure_costs";
  request?: number;
};

// Put a thing or a mark of the world elsewhere: x and y of its middle.
export type MoveThing = {
  type: "move_thing";
  request?: number;
  name: string;
  x: number;
  y: number;
};

// Open one of the examples, as a document without a file.
export type OpenExample = {
  type: "open_example";
  request?: number;
  session?: number;
  name: string;
  discard?: boolean;
};

// Open a document below the root. `discard` allows to throw unsaved edits away.
export type OpenFile = {
  type: "open_file";
  request?: number;
  session?: number;
  path: string;
  discard?: boolean;
};

// Open the content (base64) of a package (`NAME.deodar`) that was dropped on the page, as a document without
// a file.
export type OpenPackage = {
  type: "open_package";
  request?: number;
  session?: number;
  name: string;
  content: string;
  discard?: boolean;
};

// Open the content of a file that was dropped on the page, as a document without a file.
export type OpenText = {
  type: "open_text";
  request?: number;
  session?: number;
  name: string;
  text: string;
  discard?: boolean;
};

// The whole document; None: none is open. `session` changes with each document that is opened.
export type Opened = {
  type: "opened";
  session: number;
  version: number;
  document: DocumentView | null;
};

// How a parameter is shown and changed.
//
// `form` is the shape of the value; `of` names the kinds that may stand in a `part` or `parts`; `symbol` is
// TeX.
export type ParameterForm = {
  name: string;
  form:
    | "array"
    | "axes"
    | "axis"
    | "flag"
    | "integer"
    | "number"
    | "numbers"
    | "pairs"
    | "part"
    | "parts"
    | "per_axis"
    | "text"
    | "texts";
  cost: "live" | "rebuild" | "recompile";
  meaning: string;
  description: string;
  symbol: string;
  unit: string;
  lower: number | null;
  upper: number | null;
  default: unknown;
  optional: boolean;
  choices: string[];
  of: string[];
};

// Stand still.
export type Pause = {
  type: "pause";
  request?: number;
};

// Put a new thing into the world: its middle and its size.
export type PlaceThing = {
  type: "place_thing";
  request?: number;
  name: string;
  x: number;
  y: number;
  width: number;
  height: number;
};

// Run on.
export type Play = {
  type: "play";
  request?: number;
};

// Add an input to an element until `release`: a Gaussian around `center` (axis units), or everywhere the same
// where it is None.
export type PushInput = {
  type: "push";
  request?: number;
  element: string;
  amplitude: number;
  center?: number[] | null;
  sigma?: number[] | null;
};

// Open unsaved edits that were kept.
export type Recover = {
  type: "recover";
  request?: number;
  session?: number;
  name: string;
  discard?: boolean;
};

// Unsaved edits that were kept: name, title, the file they belong to, and when (ISO).
export type Recovery = {
  name: string;
  title: string;
  file: string;
  when: string;
};

// Make the change again that was taken back.
export type Redo = {
  type: "redo";
  request?: number;
  session?: number;
};

// End of `push`.
export type Release = {
  type: "release";
  request?: number;
};

// Take a document parameter away; what it drove keeps its value.
export type RemoveKnob = {
  type: "remove_knob";
  request?: number;
  session?: number;
  name: string;
};

// Take a thing out of the world.
export type RemoveThing = {
  type: "remove_thing";
  request?: number;
  name: string;
};

// State, time and noise back to the start; with a seed, another one from then on. Parameters stay.
export type ResetRun = {
  type: "reset";
  request?: number;
  seed?: number | null;
};

// Where the run is. Sent after the frames of the same number, and whenever something changes.
//
// `factor` is document time over time on the wall, measured; `speed` is what was asked for (None: as fast as
// possible); `abstract` time counts 1 unit as 1 ms. In ms on the wall: `lag` is how far the run is behind and
// will catch up, `worst` the largest lag since it was played, `lost` what was given up; `overruns` counts how
// often it fell behind. `longest` is the step up to which it may grow to keep up (None: it stays), and
// `lengthened` counts the steps that did. `busy` says in words what is being made; `failure` why the run
// stopped; `world` what the sensors read.
export type RunClock = {
  type: "clock";
  frame: number;
  running: boolean;
  time: number;
  tick: number;
  dt: number;
  seed: number;
  speed: number | null;
  factor: number;
  steps: number;
  lag: number;
  worst: number;
  lost: number;
  overruns: number;
  longest: number | null;
  lengthened: number;
  busy: string;
  failure: ListedProblem[];
  world: string;
  senses: boolean;
  pushing: string;
};

// Write the document, to its own file where `path` is empty.
//
// `replace` allows to write over a file that is not the one it came from, or that changed on disk since.
export type Save = {
  type: "save";
  request?: number;
  session?: number;
  path?: string;
  replace?: boolean;
};

// What stands in the world, in its unit of length; `border` is lower x, lower y, upper x, upper y.
export type SceneView = {
  unit: string;
  border: number[];
  boxes: BoxView[];
  marks: MarkView[];
};

// Change a parameter of an element (`kernel.0.sigma`), or, with an empty element, the document parameter of
// that name.
//
// `value` is as documents write it: numbers, text, parts with their kind, axes by their key. Changes that
// share a `gesture` (not 0) are one step of undo: a slider that is dragged.
export type SetParameter = {
  type: "set";
  request?: number;
  session?: number;
  element: string;
  parameter: string;
  value: unknown;
  gesture?: number;
};

// Document time in relation to the clock on the wall: 1 is real time, None as fast as possible.
export type Speed = {
  type: "speed";
  request?: number;
  factor: number | null;
};

export type ToPage =
  | Welcome
  | Gallery
  | Opened
  | Trouble
  | Changed
  | Checked
  | RunClock
  | Costs
  | WorldScene
  | Bodies
  | Announced
  | Lost
  | Folder
  | Answer;

export type ToServer =
  | OpenFile
  | OpenExample
  | OpenText
  | OpenPackage
  | Recover
  | Forget
  | Close
  | Save
  | ListFolder
  | SetParameter
  | Describe
  | AddKnob
  | Link
  | Unlink
  | RemoveKnob
  | Arrange
  | ApplyPreset
  | ApplyPresetText
  | Undo
  | Redo
  | Play
  | Pause
  | Advance
  | ResetRun
  | Speed
  | Lengthen
  | MeasureCosts
  | PushInput
  | Release
  | UseWorld
  | UseWorldContent
  | WatchWorld
  | MoveThing
  | PlaceThing
  | RemoveThing
  | Watch
  | WatchTrace
  | Unwatch
  | Drawn;

// The file that could not be opened, with every problem in it; an empty list: no trouble any more.
export type Trouble = {
  type: "trouble";
  file: string;
  problems: ListedProblem[];
};

// Take the last change back.
export type Undo = {
  type: "undo";
  request?: number;
  session?: number;
};

// Let a parameter stand for itself again.
export type Unlink = {
  type: "unlink";
  request?: number;
  session?: number;
  element: string;
  parameter: string;
};

// End a stream.
export type Unwatch = {
  type: "unwatch";
  request?: number;
  stream: number;
};

// Let the sensors read a world of that kind, opened with a file below the root.
export type UseWorld = {
  type: "use_world";
  request?: number;
  session?: number;
  kind: string;
  path: string;
};

// Let the sensors read a world made of the content (base64) of a file that was dropped on the page.
export type UseWorldContent = {
  type: "use_world_content";
  request?: number;
  session?: number;
  kind: string;
  name: string;
  content: string;
};

// Send a port of an element as frames under a number of the page's choice, thinned to at most `most` samples
// along each axis (0: all).
export type Watch = {
  type: "watch";
  request?: number;
  stream: number;
  element: string;
  port: string;
  most?: number;
};

// Send a time course: of a node, or of an array its value at a place (axis units), its maximum or its mean.
export type WatchTrace = {
  type: "trace";
  request?: number;
  stream: number;
  element: string;
  port: string;
  reduce?: "at" | "max" | "mean";
  at?: number[];
};

// Send `bodies` from now on, or no longer.
export type WatchWorld = {
  type: "watch_world";
  request?: number;
  on: boolean;
};

// First message on a connection: what there is, whatever is open.
export type Welcome = {
  type: "welcome";
  version: string;
  root: string;
  kinds: Kind[];
  examples: ExampleView[];
};

// The world from above, whenever something in it was moved; None: there is nothing to see from above.
export type WorldScene = {
  type: "scene";
  scene: SceneView | null;
};
