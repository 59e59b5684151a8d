// The end of a connection that was begun: at a port, at an element, or on the empty ground, where the palette
// offers what fits.

import type { Point } from "../model/rects";
import type { Fits, FitView, Kind, OfferView } from "../protocol";
import { useStudio } from "../server/store";
import { useChooser } from "../state/choice";
import { addElement, connect, reconnect } from "./edits";
import { between, type End, type Side, type WireEnds } from "../model/ends";
import type { ListEntry } from "../model/entries";
import { isEditable } from "../state/editable";
import { elementEntry, kindEntries } from "./palette";
import { atEnd, beside, between as betweenBoxes, type Placing, sizeOfKind } from "./placing";
import { drawnNode, getStage } from "./stage";
import { begin, end, fitOf, judged, stateOf, useWiring, type Wiring } from "./wiring";

// A connection that was begun; `moved` is the one whose end is moved, and which the new one replaces.
type Begun = Pick<Wiring, "from" | "side" | "moved">;
type WireTarget = { element: string; port: string | null };

// The pointer was released at `at`, over a port, an element or the ground.
export async function finish(at: Point, to: WireTarget | null): Promise<void> {
  const known = await judged();
  end();
  // the connection with the server may be lost meanwhile
  if (!isEditable()) {
    return;
  }
  // a port may lead to another one of its element; the element as a whole is no target
  if (
    known === null ||
    (to?.element === known.from.element && (to.port ?? known.from.port) === known.from.port)
  ) {
    return;
  }
  const { moved } = known;
  if (to === null) {
    offerKinds(at, known, known.fits);
    return;
  }
  if (moved !== undefined && isEndOf(moved, known.side, to)) {
    return;
  }
  const fit = fitOf(known.fits, to.element, to.port);
  if (fit === undefined || stateOf(fit) === "no") {
    const side = known.side === "source" ? "input" : "output";
    useStudio.getState().notify({ what: fit?.reason ?? `This element has no ${side}.` }, "info");
  } else if (fit.fits) {
    const ends = between(known.from, known.side, fit);
    await (moved === undefined ? connect(ends) : reconnect(moved, ends));
  } else {
    offerCouplings(at, known, fit);
  }
}

function offerCouplings(at: Point | null, begun: Begun, fit: FitView): void {
  useChooser.getState().open({
    label: "Choose a coupling",
    placeholder: "Coupling",
    hint: fit.reason,
    at,
    entries: fit.offers.map((offer) => offerEntry("Couplings that fit", begun, fit, offer)),
    empty: "No coupling matches",
  });
}

// A connection of which a problem says what is missing: an end, or the coupling between its ends.
export async function complete(wire: WireEnds): Promise<void> {
  if (wire.source === "" || wire.target === "") {
    useStudio.getState().select([wire.source || wire.target]);
    return connectByKeys(wire.source_port || wire.target_port);
  }
  const from = { element: wire.source, port: wire.source_port };
  const fits = await begin(from, "source");
  end();
  const fit = fits === null ? undefined : fitOf(fits, wire.target, wire.target_port);
  if (fit !== undefined) {
    offerCouplings(besideOnScreen(wire.target), { from, side: "source", moved: wire }, fit);
  }
}

// Whether a connection that begins at `side` ends at this port or element already.
function isEndOf(wire: WireEnds, side: Side, { element, port }: WireTarget): boolean {
  const [own, ownPort] =
    side === "source" ? [wire.target, wire.target_port] : [wire.source, wire.source_port];
  return element === own && (port === null || port === ownPort);
}

// A connection on the empty ground: what fits its end.
function offerKinds(at: Point, begun: Begun, fits: Fits): void {
  const stage = getStage();
  if (stage === null) {
    return;
  }
  const right = begun.side === "source";
  const spot = (kind: Kind) => atEnd(stage.toFlow(at), right, stage.scene(), sizeOfKind(kind));
  useChooser.getState().open({
    label: "Add a connected element",
    placeholder: "Name, family or parameter",
    hint: `Connected with ${called(begun.from)}`,
    at,
    entries: fitting(fits, begun, spot),
    empty: "No kind that fits matches",
  });
}

// Kinds whose new element is connected.
function fitting(fits: Fits, begun: Begun, spot: (kind: Kind) => Placing): ListEntry[] {
  const { from, side, moved: replaces } = begun;
  const add = (kind: Kind) => addElement(kind.name, spot(kind), { [side]: from, replaces });
  const names = new Set(fits.kinds.map(({ kind }) => kind));
  return kindEntries(useStudio.getState().kinds, null, add, false).filter(
    ({ kind, why }) => why === undefined && names.has(kind?.name ?? ""),
  );
}

function offerEntry(family: string, begun: Begun, to: End, offer: OfferView): ListEntry {
  const { from, side, moved: replaces } = begun;
  const { elements, kinds } = useStudio.getState();
  const kind = kinds.get(offer.kind);
  const { source, source_port, target, target_port } = between(from, side, to);
  const run = () =>
    addElement(offer.kind, midway(source, target, kind), {
      values: offer.values,
      source: { element: source, port: source_port },
      target: { element: target, port: target_port },
      replaces,
    });
  const title = kind?.title ?? offer.kind;
  const base = kind === undefined ? { id: "", title, family } : elementEntry(kind, run);
  return {
    ...base,
    id: `${to.element} ${to.port} ${offer.kind} ${JSON.stringify(offer.values)}`,
    family,
    title,
    note: offer.note,
    words: `${base.words ?? ""} ${elements.get(to.element)?.path ?? ""}`,
    run,
  };
}

function midway(source: string, target: string, kind: Kind | undefined): Placing {
  const scene = getStage()?.scene();
  return scene === undefined
    ? { at: { x: 0, y: 0 }, group: "" }
    : betweenBoxes(source, target, scene, sizeOfKind(kind));
}

// Begin a connection at the selected element and choose its other end by words and arrow keys.
export async function connectByKeys(port?: string): Promise<void> {
  const { selected, elements } = useStudio.getState();
  const element = selected.length === 1 ? elements.get(selected[0] as string) : undefined;
  const stage = getStage();
  if (element === undefined || stage === null || !isEditable()) {
    useStudio.getState().notify({ what: "Select one element to connect it." }, "info");
    return;
  }
  const side: Side = element.outputs.length > 0 && !element.inputs.includes(port ?? "") ? "source" : "target";
  const ports = side === "source" ? element.outputs : element.inputs;
  const from = { element: element.id, port: port ?? ports[0] ?? "" };
  const begun = { from, side };
  const fits = await begin(from, side);
  if (fits === null) {
    end();
    return;
  }
  const others = [...element.outputs, ...element.inputs].filter((name) => name !== from.port);
  const order = { yes: 0, offer: 1, no: 2 };
  const ends = [...fits.ports].sort((a, b) => order[stateOf(a)] - order[stateOf(b)]);
  const right = side === "source";
  const targets = ends.flatMap((fit) => portEntries(begun, fit));
  useChooser.getState().open({
    label: `Connect ${called(from)}`,
    placeholder: right ? "To an element, or a new one" : "From an element, or a new one",
    at: besideOnScreen(element.id),
    entries: [
      ...targets.filter(({ why }) => why === undefined),
      ...fitting(fits, begun, (kind) => beside(element.id, right, stage.scene(), sizeOfKind(kind))),
      ...others.map((name) => ({
        id: `port ${name}`,
        family: "Begin at another port",
        title: name,
        run: () => connectByKeys(name),
      })),
      ...targets.filter(({ why }) => why !== undefined),
    ],
    empty: "Nothing matches",
    onLook: (entry) => useWiring.setState({ target: entry?.element ?? null }),
    onClose: end,
  });
}

// The entries of a port: to connect it, or to put a coupling between.
function portEntries(begun: Begun, fit: FitView): ListEntry[] {
  const { from, side } = begun;
  const { element, port, reason } = fit;
  const title = called(fit);
  const entry = { id: `${element} ${port}`, title, element, family: side === "source" ? "To" : "From" };
  switch (stateOf(fit)) {
    case "yes":
      return [{ ...entry, note: reason, run: () => connect(between(from, side, fit)) }];
    case "offer":
      return fit.offers.map((offer) => {
        const made = offerEntry("Through a coupling", begun, fit, offer);
        return { ...made, element, title: `${title}, by ${made.title}` };
      });
    case "no":
      return [{ ...entry, family: "Does not fit", why: reason }];
  }
}

// The path of an element, with the port where there are several.
function called({ element, port }: End): string {
  const found = useStudio.getState().elements.get(element);
  const ports = found?.outputs.includes(port) === true ? found.outputs : (found?.inputs ?? []);
  return ports.length > 1 ? `${found?.path ?? ""}.${port}` : (found?.path ?? "");
}

export function besideOnScreen(element: string): Point | null {
  const rect = drawnNode(element)?.getBoundingClientRect();
  return rect === undefined ? null : { x: rect.right + 16, y: rect.top };
}
