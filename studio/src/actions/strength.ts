// The strength of a connection as a number that a person changes: 1 is a plain connection, and another one is
// the factor of a Gain inside it, which the server makes and removes.

import { useMemo, useRef } from "react";
import type { WireEnds } from "../model/ends";
import type { SliderRange } from "../model/sliderRange";
import { driver } from "../model/leaf";
import { type SendSetting, type Setting, useSetting } from "./setting";
import type { DocumentView, ElementView } from "../protocol";
import { request } from "../server/socket";
import { type Studio, useStudio } from "../server/store";
import { current } from "../model/facts";
import type { Chain } from "../architecture/chains";

// What a pixel of a drag changes, with Shift less; with Ctrl in coarse steps.
const PIXEL = { usual: 0.05, fine: 0.005, step: 0.5 };
const KEY = 0.1;

// The slider of a strength.
export const RANGE: SliderRange = { lower: -10, upper: 10, logarithmic: false, step: 0.1 };

type Modifiers = Pick<PointerEvent, "shiftKey" | "ctrlKey" | "metaKey">;

// The number of a drag, not rounded to steps, after `pixels` more.
export const dragged = (value: number, pixels: number, { shiftKey }: Modifiers): number =>
  value + pixels * (shiftKey ? PIXEL.fine : PIXEL.usual);

export const stepped = (value: number, { ctrlKey, metaKey }: Modifiers): number =>
  rounded(ctrlKey || metaKey ? Math.round(value / PIXEL.step) * PIXEL.step : value);

// The number after a key, or null where the key changes none.
export function pressed(value: number, key: string): number | null {
  switch (key) {
    case "ArrowUp":
    case "ArrowRight":
      return rounded(value + KEY);
    case "ArrowDown":
    case "ArrowLeft":
      return rounded(value - KEY);
    case "-":
      return -value;
    default:
      return null;
  }
}

const rounded = (value: number): number => Number(value.toFixed(4));

// From 1.4 to 2.6 px; ten times the strength is 0.6 px more.
export function widthOf(strength: number): number {
  const size = Math.abs(strength);
  return size === 0 ? 1.4 : Math.min(2.6, Math.max(1.4, 2 + 0.6 * Math.log10(size)));
}

type Weighted = Pick<Chain, "couplings" | "gain">;

// The element that has the strength of a connection, and its parameter: its Gain, or the one coupling with a
// single number. Null: nothing has, and another strength than 1 makes a Gain.
export function holderOf(
  { couplings, gain }: Weighted,
  elements: Studio["elements"],
): { element: string; path: string } | null {
  const stated = (gain === null ? couplings : [gain]).flatMap((element) => {
    const path = elements.get(element)?.strength ?? "";
    return path === "" ? [] : [{ element, path }];
  });
  return stated.length === 1 ? (stated[0] ?? null) : null;
}

// Whether the strength is a number of the connection itself, and of no coupling with a name.
export const hasOwn = (chain: Weighted, elements: Studio["elements"]): boolean =>
  chain.gain !== null || holderOf(chain, elements) === null;

export function strengthOf(
  chain: Weighted,
  { elements, document }: Pick<Studio, "elements" | "document">,
): number {
  const { element: id = "", path = "" } = holderOf(chain, elements) ?? {};
  const element = elements.get(id);
  return element === undefined || document === null ? 1 : (numberAt(element, path, document) ?? 1);
}

// The number at a path of an element, or of the document parameter that drives it.
export function numberAt(element: ElementView, path: string, document: DocumentView): number | null {
  const value = current(element, path, document);
  return typeof value === "number" ? value : null;
}

// What a connection does, in words: "saccade → decision, inhibits".
export function wireText({ source, target, sign }: Chain, elements: Studio["elements"]): string {
  const path = (id: string) => elements.get(id)?.path ?? id;
  const does = { "+": "excites", "-": "inhibits", "±": "excites and inhibits" }[sign];
  return `${path(source)} → ${path(target)}, ${does}`;
}

// The strength of a connection in a control: the number of its coupling, or of the connection itself. While
// it is dragged it may pass 1, and the last value is sent once more when the drag ends.
export function useStrength(chain: Chain): Setting<number> {
  const holder = useStudio((state) => holderOf(chain, state.elements)?.element ?? "");
  const path = useStudio((state) => holderOf(chain, state.elements)?.path ?? "");
  const stored = useStudio((state) => strengthOf(chain, state));
  const isOwn = useStudio((state) => hasOwn(chain, state.elements));
  const { send, hold } = useSending(chain);
  const last = useRef<number | null>(null);
  const setting = useNumber(holder, path, stored, isOwn ? send : undefined);
  return {
    ...setting,
    move: (value) => {
      hold(true);
      last.current = value;
      setting.move(value);
    },
    end: () => {
      hold(false);
      if (last.current !== null) {
        setting.move(last.current);
      }
      last.current = null;
      setting.end();
    },
  };
}

// A number of an element in a control: sent to the document parameter that drives it, or by `send`, or as a
// parameter of the element.
export function useNumber(
  element: string,
  path: string,
  stored: number,
  send?: SendSetting,
): Setting<number> {
  const linked = useStudio(({ document }) => driver(document, element, path)?.name);
  const isSent = linked === undefined && send !== undefined;
  return useSetting(
    linked !== undefined || isSent ? "" : element,
    linked ?? (isSent ? "strength" : path),
    stored,
    "live",
    isSent ? send : undefined,
  );
}

// The connection into the Gain, or the one into which it is made: the last, so that it scales what arrives.
function weightedEnds({ couplings, gain, ...ends }: Chain, now: string | null): WireEnds {
  const before = couplings.slice(0, now === null || now !== gain ? undefined : couplings.indexOf(now));
  const last = before.findLast((id) => id !== gain);
  return {
    source: last ?? ends.source,
    source_port: last === undefined ? ends.source_port : "",
    target: now ?? ends.target,
    target_port: now === null ? ends.target_port : "",
  };
}

function useSending(chain: Chain): { send: SendSetting; hold: (held: boolean) => void } {
  const latest = useRef({ chain, gain: chain.gain, flying: 0, held: false });
  latest.current.chain = chain;
  if (latest.current.flying === 0) {
    latest.current.gain = chain.gain;
  }
  return useMemo(() => {
    const send: SendSetting = async (_, value, gesture) => {
      const now = latest.current;
      now.flying += 1;
      const answer = await request({
        type: "set_strength",
        wire: weightedEnds(now.chain, now.gain),
        value: value as number,
        gesture,
        dragging: now.held,
      });
      now.flying -= 1;
      if ((answer.problems ?? []).length === 0) {
        now.gain = answer.made?.[0] ?? null;
      }
      return answer;
    };
    const hold = (held: boolean) => {
      latest.current.held = held;
    };
    return { send, hold };
  }, []);
}
