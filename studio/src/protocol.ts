// Generated from src/deodar_studio/requests and messages/to_page.py; change those, not this one:
// python tools/generate.py
// Add an axis that no element has yet; `axis` has the properties of `change_axis`.
export type AddAxis = {
  type: "add_axis";
  request?: number;
  session?: number;
  axis: Record<string, unknown>;
};

// Add a document parameter with the value of the first parameter that it sets.
export type AddDocumentParameter = {
  type: "add_document_parameter";
  request?: number;
  session?: number;
  name: string;
  element: string;
  parameter: string;
};

// Add an element of a kind; the answer has its id in `made`.
//
// `values` has the format of documents. Parameters without a value get one that works at once: axes are those
// of the ports that the element is connected with, else those of the first field, else a new axis x.
// `source`, `target`: ports that it is connected with; `wire`: a connection that it is inserted into;
// `replaces`: a connection that is removed. An empty name means a free one after its kind; a taken one gets a
// number. `at` is the position of its box; `positions` and `comments` are those of boxes and comments that
// make room for it, in the same step of undo.
export type AddElement = {
  type: "add_element";
  request?: number;
  session?: number;
  kind: string;
  values?: Record<string, unknown>;
  name?: string;
  group?: string[];
  at?: unknown[] | null;
  source?: PortEnd | null;
  target?: PortEnd | null;
  wire?: Ends | null;
  replaces?: Ends | null;
  positions?: Record<string, unknown[]>;
  comments?: Record<string, unknown[]>;
};

// Add a template of `welcome` as a new group; the answer has its ids in `made` and its names in `group`.
//
// `group` is the group that it is added to, `at` the position of its upper left corner.
export type AddTemplate = {
  type: "add_template";
  request?: number;
  session?: number;
  name: string;
  group?: string[];
  at?: unknown[] | null;
};

// Advance by `n` Euler steps, then pause.
export type Advance = {
  type: "step";
  request?: number;
  n?: number;
};

// Format of the following frames of a stream: the shape after thinning, and the axes.
//
// `rest` lists the axes of the array that are not drawn, and `folded` the names of those over which the
// maximum is taken; `channels`: the array is a picture. A time course has the shape [2], pairs of time and
// value; one of rows has the shape [1 + n], a time and n values.
export type Announced = {
  type: "announced";
  stream: number;
  shape: number[];
  axes: AxisView[];
  rest: AxisView[];
  folded: string[];
  channels: boolean;
};

// The result of a request; if it has problems, the request had no effect.
//
// `ask` is a question for the user before the request can be repeated: `unsaved` (repeat it with discard),
// `unsaved_experiment` (repeat it with discard_experiment) or `replace` (repeat it with replace; `file` is
// the file in the way, if the request does not name it). `cost` is the cost of a change. For a preset,
// `carried` is the number of values that changed and `unmatched` lists the values that could not be applied.
// `imported` is a sentence on the import of a file of another tool. `version` is the first version of the
// document with the change, if the request made one. `made` lists the ids of new elements, `group` the names
// of a new group; `text` is what the request asked for: a document for the clipboard, a script, or a report.
// `fault` is true if deodar itself failed: the page offers a report.
export type Answer = {
  type: "answer";
  request: number;
  problems?: ListedProblem[];
  ask?: "" | "replace" | "unsaved" | "unsaved_experiment";
  cost?: "" | "live" | "rebuild" | "recompile";
  file?: string;
  carried?: number;
  unmatched?: string[];
  imported?: string;
  preview?: WorldPreview | null;
  version?: number;
  made?: string[];
  group?: string[];
  text?: string;
  fault?: boolean;
};

// Apply a preset that the document keeps in its layout, as one step of undo.
//
// The answer lists the values that could not be applied.
export type ApplyKeptPreset = {
  type: "apply_kept_preset";
  request?: number;
  session?: number;
  name: string;
};

// Apply the values of another file below the root, by names and kinds, as one step of undo.
//
// Connections stay. The answer lists the values that did not match.
export type ApplyPreset = {
  type: "apply_preset";
  request?: number;
  session?: number;
  path: string;
};

// Apply the values of a file as `apply_preset` does, given its text.
export type ApplyPresetText = {
  type: "apply_preset_text";
  request?: number;
  session?: number;
  name: string;
  text: string;
};

// Give the parameters of the field the values that were found, as one change.
export type ApplyTuning = {
  type: "apply_tuning";
  request?: number;
  session?: number;
};

// Change parts of the layout: each key replaces that key of `LayoutView`, None removes it.
//
// What later versions and other programs store beside it stays in the document.
export type Arrange = {
  type: "arrange";
  request?: number;
  session?: number;
  layout: Record<string, unknown>;
  undoable?: boolean;
};

// An axis of the document, with its key there.
export type AxisView = {
  key: string;
  name: string;
  lower: number;
  upper: number;
  samples: number;
  periodic: boolean;
  unit: string;
};

// The bodies now, and the new part of their path.
//
// Each row of `path` has x and y of each body; `fresh`: the path starts again, and the page drops the old
// one. `poses` (base64 of float32) has for each solid its position and the rows of its rotation matrix.
// `picture` (base64) has red, green and blue of what a camera sees, a byte each, row by row from the top.
export type Bodies = {
  type: "bodies";
  bodies: BodyView[];
  fresh: boolean;
  path: number[][];
  poses?: string;
  picture?: string;
};

// A round body that moves by itself; `heading` is in rad, 0 along x, counter-clockwise.
export type BodyView = {
  name: string;
  x: number;
  y: number;
  heading: number;
  radius: number;
};

// The upper left corner of a box, in pixels.
export type BoxPlace = {
  x: number;
  y: number;
};

// A solid box of the world: its middle, size and colour (red, green, blue, 0 to 1).
//
// `fixed`: the box cannot be moved.
export type BoxView = {
  name: string;
  x: number;
  y: number;
  width: number;
  height: number;
  color: number[];
  fixed: boolean;
};

// Change an axis, given by its key, for all elements that have it.
//
// `axis` has the properties of the new one: name, lower, upper, samples, periodic, unit.
export type ChangeAxis = {
  type: "change_axis";
  request?: number;
  session?: number;
  key: string;
  axis: Record<string, unknown>;
};

// Problems and warnings of a version of the document that pages know from `edited` messages.
//
// A whole document (`opened`) contains its own problems.
export type Checked = {
  type: "checked";
  version: number;
  problems: ListedProblem[];
};

// Show another trial or point of a sweep of the open record: the index along one of its dimensions.
export type ChooseCopy = {
  type: "choose_copy";
  request?: number;
  dimension: string;
  index: number;
};

// Close the document and show the gallery.
export type Close = {
  type: "close";
  request?: number;
  session?: number;
  discard?: boolean;
};

// Close the experiment. `discard_experiment` allows its unsaved edits to be lost.
export type CloseExperiment = {
  type: "close_experiment";
  request?: number;
  session?: number;
  discard_experiment?: boolean;
};

// Add, change or remove a comment on the graph; the answer has the id of a new one in `made`.
//
// An empty `comment` adds one. None leaves text, position or size (width, height) unchanged. Comments are in
// the layout, `comments` by id, with `text`, `x`, `y`, `width` and `height`.
export type Comment = {
  type: "comment";
  request?: number;
  session?: number;
  comment?: string;
  text?: string | null;
  at?: unknown[] | null;
  size?: unknown[] | null;
  remove?: boolean;
};

// A comment on the canvas.
export type CommentView = {
  x: number;
  y: number;
  text: string;
  width: number;
  height: number;
};

// Compare the open record with another one below the root; a `comparison` message follows.
export type CompareRecord = {
  type: "compare_record";
  request?: number;
  session?: number;
  path: string;
};

// The comparison of the open record with another one; an empty `path`: there is none.
//
// `progress` is the share that was compared, 1 at the end. `differences` lists the first one of each port
// that differs, the earliest first, `compared` the ports that both records have. `notes` are sentences on
// what was not compared.
export type Comparison = {
  type: "comparison";
  path: string;
  progress: number;
  compared: number;
  differences: DifferenceView[];
  notes: string[];
  problems: ListedProblem[];
};

// A compilation in progress: its phase, and in seconds how long it lasts already and will take in all.
//
// `expected` is the time that the last program of this size took; None: not known.
export type CompilingView = {
  phase: "compiling" | "planning";
  elapsed: number;
  expected: number | null;
};

// Connect an output port to an input port; `reads` is previous, current, delayed, or empty.
export type Connect = {
  type: "connect";
  request?: number;
  session?: number;
  source: string;
  source_port?: string;
  target: string;
  target_port?: string;
  reads?: string;
};

// A connection from an output port to an input port.
export type ConnectionView = {
  source: string;
  source_port: string;
  target: string;
  target_port: string;
  reads: string;
};

// A dimension of trials or of a sweep, with its values as text.
export type CopyDimension = {
  name: string;
  values: string[];
};

// Return elements and groups as a document of their own, the JSON text `text` of the answer.
export type CopyElements = {
  type: "copy";
  request?: number;
  elements?: string[];
  groups?: string[][];
};

// Cost of an element: microseconds per step.
//
// `alike` is the number of elements that are computed together and share the time; `once`: the element is
// constant and is computed once per chunk. The resampling or delay of a connection has a path, but is not an
// element of the document.
export type CostView = {
  element: string;
  path: string;
  kind: string;
  us: number;
  alike: number;
  once: boolean;
};

// Cost of a step as last measured, the most expensive element first.
//
// `step` is the time of the whole step in microseconds, 0 before the first measurement.
export type Costs = {
  type: "costs";
  measuring: boolean;
  step: number;
  elements: CostView[];
  problems: ListedProblem[];
};

// Change general properties of the document; None leaves a property unchanged.
export type Describe = {
  type: "describe";
  request?: number;
  session?: number;
  name?: string | null;
  notes?: string | null;
  dt?: number | null;
  time_unit?: string | null;
};

// The first moment at which a port of two records differs, and the sample with the largest difference.
//
// `at` is the position of the sample, as text; `copy` the trial and the point of a sweep, as indices. A value
// that is not finite is None.
export type DifferenceView = {
  element: string;
  path: string;
  time: number;
  copy: Record<string, number>;
  at: string;
  value: number | null;
  other: number | null;
};

// Remove a connection.
export type Disconnect = {
  type: "disconnect";
  request?: number;
  session?: number;
  source: string;
  source_port?: string;
  target: string;
  target_port?: string;
};

// A document parameter and the parameters that it sets.
export type DocumentParameterView = {
  name: string;
  value: number;
  links: LinkView[];
};

// The open document.
//
// `file` is relative to the root, and empty if the document has no file; `unsaved`: it was edited since it
// was written. `undo` and `redo` are the numbers of steps available. `record`: the document is that of an
// open record, and nothing runs.
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
  parameters: DocumentParameterView[];
  layout: LayoutView;
  problems: ListedProblem[];
  unsaved: boolean;
  undo: number;
  redo: number;
  record?: RecordView | null;
};

// Confirm that the page has drawn the frames up to the clock of this number; the next ones follow.
export type Drawn = {
  type: "drawn";
  request?: number;
  frame: number;
};

// Replace the plain data of the experiment of that version.
export type EditExperiment = {
  type: "edit_experiment";
  request?: number;
  session?: number;
  data: Record<string, unknown>;
  version: number;
};

// The difference of a `DocumentView` to that of the previous version.
//
// Its problems are part of it if the structure has or had any; `checked` messages with warnings follow.
// `cost` is the cost of the edit.
export type Edited = {
  type: "edited";
  version: number;
  difference: KeyedDifference;
  cost: "live" | "rebuild" | "recompile";
};

// An element of the document.
//
// `axes` lists for each port the keys of its axes, if they are known. `pushable`: whether an input can be
// injected; `kernel`: whether the element has an interaction kernel; `effect`: the sign that it gives to its
// connections, for their marks; `strength`: the path of the number that is the strength of a coupling.
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
  kernel: boolean;
  effect: "+" | "-" | "±";
  strength: string;
};

// Show the open record alone again.
export type EndComparison = {
  type: "end_comparison";
  request?: number;
  session?: number;
};

// The ends of a connection; an empty port means the default one.
export type Ends = {
  source: string;
  source_port?: string;
  target: string;
  target_port?: string;
};

// The ends of a connection.
export type EndsView = {
  source: string;
  source_port: string;
  target: string;
  target_port: string;
};

// An entry of the gallery; `picture` is an address on the server, or empty.
export type ExampleView = {
  name: string;
  title: string;
  sentence: string;
  picture: string;
};

// Descriptions of all that an experiment is made of, for the forms of its cards.
//
// `design` has the parameters of the experiment itself. `usual` is the kind of a measure that does not state
// one.
export type ExperimentForms = {
  design: ParameterForm[];
  conditions: Kind[];
  actions: Kind[];
  measures: Kind[];
  usual: string;
};

// The open experiment; `data` is None without one.
//
// `data` is what its file contains, without the version and the model; `version` grows with each change.
// `undo` and `redo` are the numbers of edits that can be undone and redone. `problems` prevent a run, which
// has `trials` trials. `repeated` is the trial whose record is open.
export type ExperimentView = {
  type: "experiment";
  data: Record<string, unknown> | null;
  version: number;
  file: string;
  unsaved: boolean;
  undo: number;
  redo: number;
  problems: ListedProblem[];
  trials: number;
  repeated: number | null;
  run: RunView | null;
};

// Return a Python script that makes the document, the `text` of the answer.
export type ExportScript = {
  type: "export_script";
  request?: number;
};

// Return the text of `deodar doctor --report` as the `text` of the answer.
export type FaultReport = {
  type: "fault_report";
  request?: number;
};

// A file that could not be opened, with all its problems; an empty list clears an earlier message.
export type FileProblems = {
  type: "file_problems";
  file: string;
  problems: ListedProblem[];
};

// Judge what a port can be connected with; a `fitting` message follows.
//
// An empty `port` means the default output, or the first input of an element without outputs.
export type FindFits = {
  type: "fits";
  request?: number;
  element: string;
  port?: string;
};

// Whether a port can be connected, and why not, or how the values change on the way.
//
// `offers`: couplings for ports whose axes differ, the best first.
export type FitView = {
  element: string;
  port: string;
  fits: boolean;
  reason: string;
  offers: OfferView[];
};

// What a port can be connected with: all ports of the other direction, and kinds of new elements.
export type Fits = {
  type: "fitting";
  request: number;
  element: string;
  port: string;
  ports: FitView[];
  kinds: FittingKindView[];
};

// A kind whose new element can be connected, and its port.
export type FittingKindView = {
  kind: string;
  port: string;
};

// Content of a folder below the root; `records` are files, and folders that are not in `folders`; `others`
// are further files. `facts` has the size in bytes of files and records that are files, and the time of their
// last change, in seconds since 1970.
export type Folder = {
  type: "folder";
  request: number;
  path: string;
  facts: Record<string, unknown[]>;
  folders: string[];
  files: string[];
  pictures: string[];
  records: string[];
  others: string[];
};

// Delete stored unsaved edits.
export type Forget = {
  type: "forget";
  request?: number;
  name: string;
};

// Documents to open again: files below the root that were open before, and stored unsaved edits.
export type Gallery = {
  type: "gallery";
  recent: string[];
  recoveries: Recovery[];
};

// The report on the file of another tool that the document was made from; an empty `tool`: none.
//
// The lines of a label follow each other. `bugs` are known errors of the tool that the file touches.
export type ImportReportView = {
  type: "import_report";
  tool: string;
  file: string;
  lines: ReportLineView[];
  bugs: string[];
};

// Insert an existing element into a connection, by its default ports.
//
// `positions` and `comments` are those of boxes and comments, which change in the same step of undo.
export type InsertElement = {
  type: "insert";
  request?: number;
  session?: number;
  element: string;
  wire: Ends;
  positions?: Record<string, unknown[]>;
  comments?: Record<string, unknown[]>;
};

// A preset of the document; `group` is the menu or switch that it is a choice of, if any.
export type KeptPresetView = {
  name: string;
  group: string;
};

// What an edit changes of an object or a list, by key.
//
// The keys in `removed` go, `inside` has the differences of entries that changed in part, `changed` the new
// values of the others. A list has the indices of its entries as keys: in `removed` and `inside` those before
// the edit, in `changed` those after it, where the entries are inserted in ascending order.
export type KeyedDifference = {
  removed?: string[];
  inside?: Record<string, KeyedDifference>;
  changed?: Record<string, unknown>;
};

// A registered kind: the part of its description (`deodar.kinds`) that forms, equations and plots need.
//
// `room` is elements, couplings, kernels, sigmoids, windows, worlds or own. `levels` lists for each port the
// parameters that are levels on its scale (threshold, resting level), `maps` for each array parameter from a
// source to a target the ports whose axes its dimensions have. `example` is the initial value of a parameter
// whose value is a part of this kind. `opens` lists the endings of the files that a world opens, `names` what
// it opens besides files, and `settings` the values that it is made from; empty: it cannot be opened.
export type Kind = {
  name: string;
  room: string;
  title: string;
  equation: string[];
  reference: string;
  parameters: ParameterForm[];
  ports: Record<string, string>;
  levels: Record<string, Record<string, string>>;
  maps: Record<string, string[]>;
  example: unknown;
  opens: string[];
  names: string[];
  settings: WorldSettingView[];
};

// How the document is shown.
//
// `boxes` and `comments` are by id, `tiles` by view. `folded` are the folded groups, None if the document
// does not state them; `tiles`: None, if it has none. `view` is the one in which the document opens.
// `every_element`: the canvas contracts none.
export type LayoutView = {
  boxes: Record<string, BoxPlace>;
  folded: string[] | null;
  comments: Record<string, CommentView>;
  pins: PinView[];
  presets: KeptPresetView[];
  tiles: Record<string, TileView[]> | null;
  plots: PlottedPort[];
  view: "build" | "experiment" | "robot" | "run" | null;
  every_element: boolean;
};

// Open the document that was set aside for the record of a trial, with its edits.
export type LeaveTrial = {
  type: "leave_trial";
  request?: number;
  session?: number;
};

// Let the step grow up to `longest` (document time) if the machine is too slow.
//
// None: the step is constant, and the run falls behind.
export type Lengthen = {
  type: "lengthen";
  request?: number;
  longest: number | null;
};

// Link a parameter of an element to a document parameter.
export type Link = {
  type: "link";
  request?: number;
  session?: number;
  name: string;
  element: string;
  parameter: string;
};

// A parameter of an element that a document parameter sets.
export type LinkView = {
  element: string;
  parameter: string;
};

// List the documents and folders in a folder below the root; a `folder` message follows.
export type ListFolder = {
  type: "list_folder";
  request?: number;
  path?: string;
};

// List snapshots and presets again; a `saved_files` message follows if the list changed.
export type ListSaved = {
  type: "list_saved";
  request?: number;
};

// A problem or a warning: what is wrong, where, what to type, and the element concerned, if any.
//
// A warning does not prevent a run. `repair` says what the request of that name does about it; empty:
// nothing. `wire` is a connection of which the person has to choose a part: an empty end, or the coupling
// between two ends. `world`: another world, or another sensor or motor of the world, may solve it. `trust`:
// the document names functions, which the studio runs only with trust.
export type ListedProblem = {
  what: string;
  where?: string;
  fix?: string;
  element?: string;
  severity?: "problem" | "warning";
  repair?: string;
  wire?: EndsView | null;
  world?: boolean;
  trust?: boolean;
};

// A stream without data, and the reason: the element was removed, or the port cannot be read.
export type Lost = {
  type: "lost";
  stream: number;
  problem: ListedProblem;
};

// Put elements and groups into a new group, whose names are `group` of the answer.
//
// An empty name means a free one. `at`: the boxes are moved together, their corner to there.
export type MakeGroup = {
  type: "group";
  request?: number;
  session?: number;
  elements?: string[];
  groups?: string[][];
  name?: string;
  at?: unknown[] | null;
};

// A named position in the world, such as a goal; `fixed`: the mark cannot be moved.
export type MarkView = {
  name: string;
  x: number;
  y: number;
  fixed: boolean;
};

// Measure the cost of each element during the run; a `costs` message follows at start and end.
export type MeasureCosts = {
  type: "measure_costs";
  request?: number;
};

// Measure what a field or node does alone, without noise: the `regime` follows when it is found.
export type MeasureRegime = {
  type: "measure_regime";
  request?: number;
  element: string;
};

// What a motor of a robot allows: the range of its commands, and their greatest change per second.
//
// None: any value, or any change.
export type MotorLimits = {
  motor: string;
  lower?: number | null;
  upper?: number | null;
  slew?: number | null;
  unit?: string;
};

// Move elements and groups into a group; an empty `group` is the top level.
//
// `positions` are those of boxes, which change in the same step of undo.
export type MoveInto = {
  type: "move_into";
  request?: number;
  session?: number;
  elements?: string[];
  groups?: string[][];
  group?: string[];
  positions?: Record<string, unknown[]>;
};

// Move an object or a mark of the world; `x` and `y` are its new middle.
export type MoveObject = {
  type: "move_object";
  request?: number;
  name: string;
  x: number;
  y: number;
};

// Narrow what a motor of the running world allows, from its next command on; nothing widens it again.
export type NarrowMotor = {
  type: "narrow_motor";
  request?: number;
  limits: MotorLimits;
};

// Open an empty document without a file.
export type NewDocument = {
  type: "new";
  request?: number;
  session?: number;
  discard?: boolean;
};

// Open a new experiment whose model is the open document.
//
// `discard_experiment` allows unsaved edits of the open experiment to be lost.
export type NewExperiment = {
  type: "new_experiment";
  request?: number;
  session?: number;
  discard_experiment?: boolean;
};

// A coupling that can stand between two ports whose axes differ: `add_element` with these values.
//
// `note` states what it loses; it is empty if every position is kept.
export type OfferView = {
  kind: string;
  values: Record<string, unknown>;
  note: string;
};

// The sensors and motors that the document can use: those of its world, or, where it has none yet, those of
// every world of which there is an example and that has all that the document reads and drives.
export type OfferedSignals = {
  type: "offered_signals";
  worlds: WorldSignals[];
};

// Open an example, as a document without a file.
export type OpenExample = {
  type: "open_example";
  request?: number;
  session?: number;
  name: string;
  discard?: boolean;
};

// Open an experiment below the root, and its model.
//
// `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
export type OpenExperimentFile = {
  type: "open_experiment";
  request?: number;
  session?: number;
  path: string;
  discard?: boolean;
  discard_experiment?: boolean;
};

// Open a document, a record, an experiment or a package below the root.
//
// `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
// The `text` of the answer is a sentence on the package that was opened.
export type OpenFile = {
  type: "open_file";
  request?: number;
  session?: number;
  path: string;
  discard?: boolean;
  discard_experiment?: boolean;
};

// Open a package (`NAME.deodar`) that was dropped on the page, as a document without a file.
//
// `content` is base64.
export type OpenPackage = {
  type: "open_package";
  request?: number;
  session?: number;
  name: string;
  content: string;
  discard?: boolean;
};

// Open the document of the open record, as a document without a file, which runs.
export type OpenRecordModel = {
  type: "open_record_model";
  request?: number;
  session?: number;
  discard?: boolean;
};

// Open the text of a file that was dropped on the page, as a document without a file.
export type OpenText = {
  type: "open_text";
  request?: number;
  session?: number;
  name: string;
  text: string;
  discard?: boolean;
};

// Remove the elements that run functions which the file names, as one step of undo.
export type OpenWithoutFunctions = {
  type: "open_without_functions";
  request?: number;
  session?: number;
};

// The whole document; None: none is open. `session` increases when a document is opened or closed.
export type Opened = {
  type: "opened";
  session: number;
  version: number;
  document: DocumentView | null;
};

// Description of a parameter for its input form.
//
// `form` is the type of the value; `of` lists the kinds allowed for a `part` or `parts`; `symbol` is TeX;
// `names` is what a text names, so that the form can list the names. `section` is the section of the form
// that lists it; empty: its head. `if_none` and `if_empty` are words for null and for an empty list; empty:
// none.
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
    | "texts"
    | "value";
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
  names?: "" | "element" | "event" | "parameter" | "port";
  section?: "" | "axes" | "interaction" | "noise" | "time course";
  if_none?: string;
  if_empty?: string;
};

// Add the content of a document, given as text, to a group; the answer has the new ids in `made`.
//
// `at` is the position of its upper left corner. Other text is refused, and nothing changes.
export type Paste = {
  type: "paste";
  request?: number;
  session?: number;
  text: string;
  group?: string[];
  at?: unknown[] | null;
};

// Pause the run.
export type Pause = {
  type: "pause";
  request?: number;
};

// A picture that a camera of the world sees, and its size in pixels.
export type PictureView = {
  name: string;
  columns: number;
  rows: number;
};

// Pin up to five parameters that are tuned most, chosen by what they are for.
export type PinUsual = {
  type: "pin_usual";
  request?: number;
  session?: number;
};

// A pinned parameter; `element` is empty for a document parameter.
//
// `lower` and `upper` are a chosen range, `label` is a name of its own; `switch`: a switch between the ends
// of the range takes the place of a slider.
export type PinView = {
  element: string;
  parameter: string;
  lower?: number;
  upper?: number;
  label?: string;
  switch?: boolean;
};

// Move boxes to positions, by the ids of their elements.
export type PlaceBoxes = {
  type: "place";
  request?: number;
  session?: number;
  positions: Record<string, unknown[]>;
};

// Add an object to the world, with its middle and its size.
//
// `color` is red, green and blue, 0 to 1; None: that of the world.
export type PlaceObject = {
  type: "place_object";
  request?: number;
  name: string;
  x: number;
  y: number;
  width: number;
  height: number;
  color?: number[] | null;
};

// Start or continue the run.
export type Play = {
  type: "play";
  request?: number;
};

// A plot from an installed package, in addition to those of the page.
//
// `axes` is the number of axes that it draws: 1; 2 (of more axes, the maximum over the others); 3: pictures.
// `periodic`: all axes have to be periodic. `module` is the address of its ES module on the server.
export type PlotView = {
  name: string;
  title: string;
  package: string;
  axes: number;
  periodic: boolean;
  module: string;
};

// A port that the document names for its first plots.
export type PlottedPort = {
  element: string;
  port: string;
};

// A port of an element; an empty `port` means the default one: the output, the first input.
export type PortEnd = {
  element: string;
  port?: string;
};

// Stored values of parameters: path below the root, time of saving (ISO 8601), size in bytes.
export type PresetView = {
  name: string;
  path: string;
  saved: string;
  size: number;
};

// Open a world as `use_world` does, without using it; the answer has its `preview`.
export type PreviewWorld = {
  type: "preview_world";
  request?: number;
  kind: string;
  path: string;
  settings?: Record<string, unknown>;
};

// Push a body of the world with a force along x, y and z, in N, until the next one; zeros end it.
//
// It ends too when the page disconnects.
export type PushBody = {
  type: "push_body";
  request?: number;
  body: string;
  force: number[];
};

// Add an input to an element until `release`.
//
// The input is a Gaussian around `center` (axis units), or constant over the axes if that is None.
export type PushInput = {
  type: "push";
  request?: number;
  element: string;
  amplitude: number;
  center?: number[] | null;
  sigma?: number[] | null;
};

// Move the ends of a connection.
export type Reconnect = {
  type: "reconnect";
  request?: number;
  session?: number;
  old: Ends;
  new: Ends;
};

// An open record.
//
// `path` is relative to the root. `growing`: a process writes it. `notes` are sentences on what is missing in
// it. `ports` lists for each element the ports that were recorded.
export type RecordView = {
  path: string;
  complete: boolean;
  growing: boolean;
  notes: string[];
  copies: CopyDimension[];
  ports: Record<string, string[]>;
};

// A port to record.
export type RecordedPort = {
  element: string;
  port: string;
};

// The record of the run: its path below the root, and why it ended; empty while it is written.
export type RecordingView = {
  path: string;
  ended: string;
};

// Open stored unsaved edits of a document, or of an experiment with its model.
//
// `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
export type Recover = {
  type: "recover";
  request?: number;
  session?: number;
  name: string;
  discard?: boolean;
  discard_experiment?: boolean;
};

// Stored unsaved edits: name, title, the file they belong to, and the time of storing (ISO 8601).
//
// `experiment` is the name of the experiment whose model the document is; empty: the document itself has the
// edits.
export type Recovery = {
  name: string;
  title: string;
  file: string;
  when: string;
  experiment?: string;
};

// Redo the change that was undone last.
export type Redo = {
  type: "redo";
  request?: number;
  session?: number;
};

// Redo the edit of the experiment that was undone last.
export type RedoExperiment = {
  type: "redo_experiment";
  request?: number;
  session?: number;
};

// What the field that was measured last does, alone and without noise.
//
// `element` is empty before the first measurement. `words` are the regime, the most important first; they are
// empty while it is measured, and if that was not possible. `stale`: the element has changed since.
export type Regime = {
  type: "regime";
  element: string;
  measuring: boolean;
  stale: boolean;
  words: string[];
  rows: RegimeRow[];
  curve: RegimeCurve | null;
  problems: ListedProblem[];
};

// Settled activation at its maximum over the strength of a localised input, for growing (`up`) and for
// falling (`down`) input; a peak exists above `threshold`.
export type RegimeCurve = {
  input: number[];
  up: (number | null)[];
  down: (number | null)[];
  threshold: number;
};

// A measurement of a regime: its name, and its value in words.
export type RegimeRow = {
  name: string;
  text: string;
};

// End the input of `push`.
export type Release = {
  type: "release";
  request?: number;
};

// Remove an axis, given by its key, also from the elements that have it; refused if one needs it.
export type RemoveAxis = {
  type: "remove_axis";
  request?: number;
  session?: number;
  key: string;
};

// Remove a document parameter; the parameters that it set keep their values.
export type RemoveDocumentParameter = {
  type: "remove_document_parameter";
  request?: number;
  session?: number;
  name: string;
};

// Remove elements, groups with their content, and connections.
export type RemoveElements = {
  type: "remove";
  request?: number;
  session?: number;
  elements?: string[];
  groups?: string[][];
  connections?: Ends[];
};

// Remove an object from the world.
export type RemoveObject = {
  type: "remove_object";
  request?: number;
  name: string;
};

// Delete a snapshot or a preset.
export type RemoveSaved = {
  type: "remove_saved";
  request?: number;
  session?: number;
  sort: "preset" | "snapshot";
  name: string;
};

// Rename an element, or with an empty `element` a group. A name that is taken is refused.
export type Rename = {
  type: "rename";
  request?: number;
  session?: number;
  name: string;
  element?: string;
  group?: string[];
};

// Do what the `repair` of a listed problem says, as one step of undo.
export type Repair = {
  type: "repair";
  request?: number;
  session?: number;
  where: string;
  what: string;
};

// Run a trial of the experiment again, and open its record; the document with its edits is set aside.
export type RepeatTrial = {
  type: "repeat_trial";
  request?: number;
  trial: number;
};

// An item of an imported file: an element, parameter or connection, and what became of it.
//
// `where` is the label of the element in the file, and `element` the id that it got in the document, also if
// it was renamed or removed since; both are empty for what belongs to no element. Of a group, `group` has the
// names that it had, and `element` is the first element in it. `part` is the sort of the item, and `what` its
// name. `why` states how it was approximated or why it was dropped; for a carried item, its counterpart.
export type ReportLineView = {
  where: string;
  element: string;
  part: string;
  what: string;
  verdict: "approximated" | "carried" | "dropped";
  why: string;
  group: string[];
};

// A requirement of a tuned field: its text, a sentence on what was found, its margin (0 or above: it is met,
// 1: in the middle of its tolerance), its value if it has one, and whether that is exact.
export type RequirementView = {
  text: string;
  sentence: string;
  margin: number | null;
  value: number | null;
  exact: boolean;
};

// Reset state, time and noise to the start, with another seed if one is given. Parameters stay.
export type ResetRun = {
  type: "reset";
  request?: number;
  seed?: number | null;
};

// Return to a snapshot: states, time, noise, world and parameters; the run pauses.
export type ReturnTo = {
  type: "return_to";
  request?: number;
  session?: number;
  name: string;
};

// The link with a robot in another process, a few times a second.
//
// `robot`: its name; empty: the world is in this process. `age`: time since its last message, ms; `lost`:
// periods that did not arrive; `refused`: messages that one of both sides refused; `round_trip`: time from a
// command to the message that answers it, ms. `motors`: what its motors allow; `can_narrow`: whether the
// request `narrow_motor` narrows them.
export type RobotLink = {
  type: "robot_link";
  robot?: string;
  motors?: MotorLimits[];
  can_narrow?: boolean;
  age?: number;
  lost?: number;
  refused?: number;
  round_trip?: number;
};

// Time and status of the run. Sent after the frames of the same number, and whenever something changes.
//
// `factor` is the measured ratio of document time to wall time; `speed` is the requested ratio (None: as fast
// as possible); one unit of `abstract` time counts as 1 ms. In ms of wall time: `lag` is how far the run is
// behind and will catch up, `worst` the largest lag since the run was started, `lost` the time that it will
// not catch up; `overruns` is the number of times it fell behind. `longest` is the limit up to which the step
// may grow to keep up (None: the step is constant), and `lengthened` is the number of longer steps taken.
// `busy` is a phrase for the compilation in progress; `failure` lists why the run stopped; `world` is a
// phrase for the world that the sensors read. `timeline`: see there; None: no moment can be shown.
// `recording`: None if nothing was recorded in this session.
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
  compiling: CompilingView | null;
  failure: ListedProblem[];
  world: string;
  senses: boolean;
  pushing: string;
  timeline: TimelineView | null;
  recording: RecordingView | null;
};

// Run the experiment in worker processes, or on a cluster; a run that was stopped continues.
//
// `workers` is the number of processes on this machine; 0: the usual one. `cluster` is an address as on the
// command line, such as `local:4` or `tcp://HOST:8786`; empty: none. `patience` is the time in s without any
// worker after which the run ends, `trust_network` allows a scheduler beyond this machine without encryption,
// and `mixed` workers whose processors differ.
export type RunExperiment = {
  type: "run_experiment";
  request?: number;
  session?: number;
  workers?: number;
  cluster?: string;
  patience?: number;
  trust_network?: boolean;
  mixed?: boolean;
};

// Continue the run from the last frame up to a document time, with the parameters of that moment.
//
// The change of parameters is one step of undo.
export type RunFrom = {
  type: "run_from";
  request?: number;
  session?: number;
  time: number;
};

// Open a copy of the open record's document, which runs on from the last sample up to a document time.
//
// The run of the record is repeated up to there, with later requests of the page meanwhile; opening another
// document ends the repetition. The answer follows when the copy runs.
export type RunRecordFrom = {
  type: "run_record_from";
  request?: number;
  time: number;
};

// The run of an experiment: how many rows of how many trials there are, and the remaining time in s.
//
// `number` changes with each run; `folder` is below the root. A run is `followed` while another process
// writes its rows. Of a run of this studio, `stopping` is true after a stop until it ends, `cluster` is the
// address of its workers (empty: processes of this machine), `workers` their present number, and `pieces` the
// number of pieces that they have. While rows arrive, `slowest` describes the combination of levels with the
// longest trials, and `diverged` those whose trials diverge.
export type RunView = {
  number: number;
  folder: string;
  state: "complete" | "failed" | "followed" | "running" | "stopped";
  rows: number;
  trials: number;
  left: number | null;
  problems: ListedProblem[];
  stopping: boolean;
  cluster: string;
  workers: number;
  pieces: number;
  slowest: string;
  diverged: string[];
};

// Write the document to `path`, or to its own file if `path` is empty.
//
// `replace` allows another file, or a file that changed on disk since it was read, to be overwritten.
export type Save = {
  type: "save";
  request?: number;
  session?: number;
  path?: string;
  replace?: boolean;
};

// Write the experiment to `path`, or to its own file if `path` is empty.
//
// A model without a file is written beside it. `replace` allows another file to be overwritten.
export type SaveExperiment = {
  type: "save_experiment";
  request?: number;
  session?: number;
  path?: string;
  replace?: boolean;
};

// Save a plot as the file of a figure, which `deodar plot` draws; the answer states its path.
//
// `kind` is that of the plot, `range` the range of its values; None: it follows the data.
export type SaveFigure = {
  type: "save_figure";
  request?: number;
  element: string;
  port: string;
  kind: string;
  range?: unknown[] | null;
};

// Save the present values of the parameters as a preset under a new name.
export type SavePreset = {
  type: "save_preset";
  request?: number;
  session?: number;
  name: string;
};

// Save the present state of the run as a snapshot under a new name.
export type SaveSnapshot = {
  type: "save_snapshot";
  request?: number;
  session?: number;
  name: string;
};

// The snapshots and presets of the open document, the newest first.
export type SavedFiles = {
  type: "saved_files";
  snapshots: SnapshotView[];
  presets: PresetView[];
};

// Boxes and marks of the world, in its unit of length; `border` is lower x, lower y, upper x, upper y.
export type SceneView = {
  unit: string;
  border: number[];
  boxes: BoxView[];
  marks: MarkView[];
};

// Show the last frame up to a document time; None: the present. Other pages are not affected.
export type Seek = {
  type: "seek";
  request?: number;
  time: number | null;
};

// Show the frame that is `frames` later than the one shown; a negative number goes back.
export type SeekFrames = {
  type: "seek_frames";
  request?: number;
  frames: number;
};

// Change one parameter of several elements to the same value, as `set` does for one.
export type SetMany = {
  type: "set_many";
  request?: number;
  session?: number;
  elements: string[];
  parameter: string;
  value: unknown;
  gesture?: number;
};

// Change a parameter of an element (`kernel.0.sigma`), or the document parameter if `element` is empty.
//
// `value` has the format of documents: numbers, text, parts with their kind, axes by their key. Changes with
// the same `gesture` (not 0) are one step of undo, such as the drag of a slider.
export type SetParameter = {
  type: "set";
  request?: number;
  session?: number;
  element: string;
  parameter: string;
  value: unknown;
  gesture?: number;
};

// Change the strength of a connection; a Gain inside it is made, and removed at strength 1.
//
// `wire` is a plain connection or the one into its Gain, whose id the answer has in `made`. Changes with the
// same `gesture` (not 0) are one step of undo; while `dragging` the Gain stays at strength 1.
export type SetStrength = {
  type: "set_strength";
  request?: number;
  session?: number;
  wire: Ends;
  value: number;
  gesture?: number;
  dragging?: boolean;
};

// A sensor or motor of a world as a new element: its kind, name, title, meaning and values.
export type SignalView = {
  kind: string;
  name: string;
  title: string;
  meaning: string;
  values: Record<string, unknown>;
};

// A stored snapshot: document time, time of saving (ISO 8601), size in bytes.
export type SnapshotView = {
  name: string;
  time: number;
  saved: string;
  size: number;
};

// A rigid solid of the world in three dimensions.
//
// `size` has half lengths along its own axes; of a sphere the radius first; of a capsule or cylinder the
// radius and half of the straight part, along its z; of a plane 0 for an endless one. `color` is red, green,
// blue and opacity. `thing` is the box of the scene that it shows; empty: none. `points` (float32) and
// `faces` (int32), as base64, are the triangles of a mesh.
export type SolidView = {
  body: string;
  shape: "box" | "capsule" | "cylinder" | "ellipsoid" | "mesh" | "plane" | "sphere";
  size: number[];
  color: number[];
  thing: string;
  pushable: boolean;
  points?: string;
  faces?: string;
};

// Set the ratio of document time to wall time: 1 is real time, None as fast as possible.
export type Speed = {
  type: "speed";
  request?: number;
  factor: number | null;
};

// Record ports of the running model into a new folder below the root; `clock` states its path.
//
// Without ports: the activation of every field. `every` is the document time between two samples, None every
// step.
export type StartRecord = {
  type: "start_record";
  request?: number;
  ports?: RecordedPort[];
  every?: number | null;
};

// Stop the run of the experiment; its rows are kept.
export type StopExperiment = {
  type: "stop_experiment";
  request?: number;
};

// Complete the record that is being written.
export type StopRecord = {
  type: "stop_record";
  request?: number;
};

// End the measurement of a regime.
export type StopRegime = {
  type: "stop_regime";
  request?: number;
};

// End the tuning of a field, and forget what was found.
export type StopTuning = {
  type: "stop_tuning";
  request?: number;
};

// A model that can be added to a document as a group.
//
// `room` is `architectures`, published models, or `examples`, documents of the gallery. `picture` is the
// address of a picture; it may be empty.
export type TemplateView = {
  name: string;
  title: string;
  sentence: string;
  picture: string;
  room: "architectures" | "examples";
};

// A plot; of a `kind` that the page does not know, or None, it shows the first that fits the port.
export type TileView = {
  element: string;
  kind: string | null;
  port: string;
  settings: Record<string, unknown>;
};

// The moments that the page can show, in document time, and the one that it shows.
//
// `frames` is their number. From `full_from` on none was removed to save memory. `time` is the moment shown
// (None: the present), and `frame` its number from 0 on. `second` is the document time in one second of real
// time, and `step` the smallest difference of two moments.
export type TimelineView = {
  first: number;
  last: number;
  frames: number;
  full_from: number;
  frame: number;
  time: number | null;
  second: number;
  step: number;
};

export type ToPage =
  | Announced
  | Answer
  | Bodies
  | Checked
  | Comparison
  | Costs
  | Edited
  | ExperimentView
  | FileProblems
  | Fits
  | Folder
  | Gallery
  | ImportReportView
  | Lost
  | OfferedSignals
  | Opened
  | Regime
  | RobotLink
  | RunClock
  | SavedFiles
  | TrialRows
  | Tuning
  | Welcome
  | WorldScene
  | WorldSolids;

export type ToServer =
  | AddAxis
  | AddDocumentParameter
  | AddElement
  | AddTemplate
  | Advance
  | ApplyKeptPreset
  | ApplyPreset
  | ApplyPresetText
  | ApplyTuning
  | Arrange
  | ChangeAxis
  | ChooseCopy
  | Close
  | CloseExperiment
  | Comment
  | CompareRecord
  | Connect
  | CopyElements
  | Describe
  | Disconnect
  | Drawn
  | EditExperiment
  | EndComparison
  | ExportScript
  | FaultReport
  | FindFits
  | Forget
  | InsertElement
  | LeaveTrial
  | Lengthen
  | Link
  | ListFolder
  | ListSaved
  | MakeGroup
  | MeasureCosts
  | MeasureRegime
  | MoveInto
  | MoveObject
  | NarrowMotor
  | NewDocument
  | NewExperiment
  | OpenExample
  | OpenExperimentFile
  | OpenFile
  | OpenPackage
  | OpenRecordModel
  | OpenText
  | OpenWithoutFunctions
  | Paste
  | Pause
  | PinUsual
  | PlaceBoxes
  | PlaceObject
  | Play
  | PreviewWorld
  | PushBody
  | PushInput
  | Reconnect
  | Recover
  | Redo
  | RedoExperiment
  | Release
  | RemoveAxis
  | RemoveDocumentParameter
  | RemoveElements
  | RemoveObject
  | RemoveSaved
  | Rename
  | Repair
  | RepeatTrial
  | ResetRun
  | ReturnTo
  | RunExperiment
  | RunFrom
  | RunRecordFrom
  | Save
  | SaveExperiment
  | SaveFigure
  | SavePreset
  | SaveSnapshot
  | Seek
  | SeekFrames
  | SetMany
  | SetParameter
  | SetStrength
  | Speed
  | StartRecord
  | StopExperiment
  | StopRecord
  | StopRegime
  | StopTuning
  | TuneField
  | Undo
  | UndoExperiment
  | Ungroup
  | Unlink
  | Unwatch
  | UseWorld
  | UseWorldContent
  | Watch
  | WatchKernel
  | WatchRows
  | WatchTrace
  | WatchWeights
  | WatchWorld;

// Further rows of a run: those from number `first` on, as `trials.jsonl` contains them.
export type TrialRows = {
  type: "trial_rows";
  run: number;
  first: number;
  rows: (Record<string, unknown>)[];
};

// Find values of parameters at which a field meets requirements: `tuning` follows.
//
// `parameters` are names of parameters of the field, such as `kernel.0.sigma`. A requirement is a name, or an
// object such as `{"detects": {"at": 3, "within": 0.2}}`, as in the files of `deodar tune`. Another `seed`
// searches elsewhere.
export type TuneField = {
  type: "tune_field";
  request?: number;
  element: string;
  parameters: string[];
  requirements: unknown[];
  seed?: number;
};

// A parameter of a tuned field, by path.
export type TunedValue = {
  path: string;
  before: number;
  value: number;
};

// The tuning of a field to a stated regime.
//
// `element` is empty before the first one. `candidates` counts what was tried; `requirements` and `values`
// are empty while it runs, and if that was not possible. `tolerated` is the relative change that all
// parameters may have at once; `reasons` say why not all requirements are met. `applied`: the document has
// these values.
export type Tuning = {
  type: "tuning";
  element: string;
  tuning: boolean;
  candidates: number;
  requirements: RequirementView[];
  values: TunedValue[];
  tolerated: number;
  reasons: string[];
  applied: boolean;
  problems: ListedProblem[];
};

// Undo the last change.
export type Undo = {
  type: "undo";
  request?: number;
  session?: number;
};

// Undo the last edit of the experiment.
export type UndoExperiment = {
  type: "undo_experiment";
  request?: number;
  session?: number;
};

// Move the content of a group to its parent.
export type Ungroup = {
  type: "ungroup";
  request?: number;
  session?: number;
  group: string[];
};

// Unlink a parameter of an element from its document parameter.
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

// Use a world of a kind, opened with a file below the root, or with another argument of `open`.
//
// `settings` are further arguments of its constructor. Motors are narrowed to `limits` before the first
// command.
export type UseWorld = {
  type: "use_world";
  request?: number;
  session?: number;
  kind: string;
  path: string;
  settings?: Record<string, unknown>;
  limits?: MotorLimits[];
};

// Use a world of a kind, made from the content (base64) of a file that was dropped on the page.
export type UseWorldContent = {
  type: "use_world_content";
  request?: number;
  session?: number;
  kind: string;
  name: string;
  content: string;
  settings?: Record<string, unknown>;
};

// Send a port of an element as frames, thinned to at most `most` samples along each axis (0: all).
//
// The page chooses the number `stream`. `other`: of the record that the open one is compared with. `drawn`
// names the axes to send, at most two (empty: the first ones, or all of a picture); `at` states a position on
// other axes, by name and in axis units. Over the rest the maximum is taken.
export type Watch = {
  type: "watch";
  request?: number;
  stream: number;
  element: string;
  port: string;
  most?: number;
  other?: boolean;
  drawn?: string[];
  at?: Record<string, number>;
};

// Send the interaction kernel of an element over the lag, with its parameters as they are now.
//
// Of more than two axes it is sent at lag 0 on the others. `most` and `other` as in `watch`.
export type WatchKernel = {
  type: "kernel";
  request?: number;
  stream: number;
  element: string;
  most?: number;
  other?: boolean;
};

// Send the values of a port along one axis over time, thinned to at most `most` samples (0: all).
//
// `drawn` names the axis (empty: the first); `at` and `other` as in `watch`.
export type WatchRows = {
  type: "rows";
  request?: number;
  stream: number;
  element: string;
  port: string;
  most?: number;
  drawn?: string;
  at?: Record<string, number>;
  other?: boolean;
};

// Send a time course of a port: a node's value, or an array's value at a position, maximum or mean.
//
// `at` is in axis units; `other` as in `watch`.
export type WatchTrace = {
  type: "trace";
  request?: number;
  stream: number;
  element: string;
  port: string;
  reduce?: "at" | "max" | "mean";
  at?: number[];
  other?: boolean;
};

// Send an array parameter that is a map from a source to a target (`Kind.maps`), as it is now.
//
// `most`, `drawn`, `at` and `other` as in `watch`.
export type WatchWeights = {
  type: "weights";
  request?: number;
  stream: number;
  element: string;
  parameter: string;
  most?: number;
  other?: boolean;
  drawn?: string[];
  at?: Record<string, number>;
};

// Start or stop sending `bodies`; `solid`: with the solids and their poses.
export type WatchWorld = {
  type: "watch_world";
  request?: number;
  on: boolean;
  solid?: boolean;
};

// First message on a connection: the data that do not depend on the open document.
//
// An experiment runs in `usual_workers` processes unless a page states a number, `most_workers` at most;
// `clusters`: whether pages may name any cluster, or only the processes of `local:N`.
export type Welcome = {
  type: "welcome";
  version: string;
  root: string;
  usual_workers: number;
  most_workers: number;
  clusters: boolean;
  kinds: Kind[];
  experiment: ExperimentForms;
  examples: ExampleView[];
  templates: TemplateView[];
  plots: PlotView[];
};

// What a world looks like: from above, or what its sensor reads, as bytes (base64) of rows of pixels.
//
// `missing` lists sensors and motors of the document that the world does not have; `limits` what the motors
// of a robot allow, if they can be narrowed.
export type WorldPreview = {
  sensors: string[];
  motors: string[];
  missing: string[];
  limits: MotorLimits[];
  scene: SceneView | null;
  width: number;
  height: number;
  pixels: string;
};

// The world from above, sent whenever a box or mark changed; None: the world has no view from above.
//
// `note` is a sentence on what a record does not contain of the world; `camera`: the world has a sensor of
// that name; `solid`: it can be shown in three dimensions; `can_place`: objects can be added; `picture`: what
// its camera sees is in the messages on bodies.
export type WorldScene = {
  type: "scene";
  scene: SceneView | null;
  note?: string;
  camera?: boolean;
  solid?: boolean;
  can_place?: boolean;
  picture?: PictureView | null;
};

// A setting of a world; `form` is the type of its value, `file` a file that it opens.
export type WorldSettingView = {
  name: string;
  form: "file" | "flag" | "number" | "numbers" | "text";
  meaning: string;
  default: unknown;
};

// What a world, given by a phrase, offers.
export type WorldSignals = {
  world: string;
  signals: SignalView[];
};

// All solids of the world, sent before the first `poses` of them.
export type WorldSolids = {
  type: "solids";
  solids: SolidView[];
};

// Types of the requests that are meant for the document that the page shows.
export const MEANT: readonly ToServer["type"][] = [
  "add_axis",
  "add_document_parameter",
  "add_element",
  "add_template",
  "apply_kept_preset",
  "apply_preset",
  "apply_preset_text",
  "apply_tuning",
  "arrange",
  "change_axis",
  "close",
  "close_experiment",
  "comment",
  "compare_record",
  "connect",
  "describe",
  "disconnect",
  "edit_experiment",
  "end_comparison",
  "group",
  "insert",
  "leave_trial",
  "link",
  "move_into",
  "new_experiment",
  "open_record_model",
  "open_without_functions",
  "paste",
  "pin_usual",
  "place",
  "reconnect",
  "redo",
  "redo_experiment",
  "remove",
  "remove_axis",
  "remove_document_parameter",
  "remove_saved",
  "rename",
  "repair",
  "return_to",
  "run_experiment",
  "run_from",
  "save",
  "save_experiment",
  "save_preset",
  "save_snapshot",
  "set",
  "set_many",
  "set_strength",
  "undo",
  "undo_experiment",
  "ungroup",
  "unlink",
  "use_world",
  "use_world_content",
];
