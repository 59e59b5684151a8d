// The content of an element's tooltip: its main parameters with their present values and units.

import { unitText } from "./unit";
import type { DocumentView, ElementView, Kind, ParameterForm } from "../protocol";
import { valueAt } from "./values";

export type Fact = { name: string; label: string; symbol: string; value: string };

type Context = Pick<DocumentView, "axes" | "parameters" | "time_unit">;

const SIMPLE: ParameterForm["form"][] = ["number", "integer", "per_axis", "flag", "text"];
const MOST = 7;

// The parameters that a glance is for: numbers and choices first, then the kinds of its parts.
export function facts(element: ElementView, kind: Kind, kinds: Map<string, Kind>, context: Context): Fact[] {
  const rank = (form: ParameterForm) => (SIMPLE.includes(form.form) ? 0 : 1);
  return [...kind.parameters]
    .sort((a, b) => rank(a) - rank(b))
    .flatMap((form) => {
      const value = said(form, current(element, form.name, context), element, kinds, context);
      return value === ""
        ? []
        : [
            {
              name: form.name,
              label: form.meaning === "" ? form.name : form.meaning,
              symbol: form.symbol,
              value,
            },
          ];
    })
    .slice(0, MOST);
}

// The number that a coupling is known by: its first parameter that is a number. Empty where it has none.
export function mainNumber(element: ElementView, kind: Kind | undefined, context: Context): string {
  const form = kind?.parameters.find(
    (p) => p.form === "number" && typeof current(element, p.name, context) === "number",
  );
  return form === undefined
    ? ""
    : withUnit(short(current(element, form.name, context) as number), unitOf(form.unit, element, context));
}

// At most four digits that count, with a true minus sign.
export function short(value: number): string {
  const text =
    value !== 0 && (Math.abs(value) >= 1e5 || Math.abs(value) < 1e-3)
      ? value.toExponential(2)
      : String(Number(value.toPrecision(4)));
  return text.replaceAll("-", "−");
}

// The value that counts: a driven parameter has the value of its document parameter.
export function current(
  element: ElementView,
  path: string,
  { parameters }: Pick<Context, "parameters">,
): unknown {
  const driver = parameters.find((k) =>
    k.links.some((link) => link.element === element.id && link.parameter === path),
  );
  return driver?.value ?? valueAt(element.values, path);
}

function said(
  form: ParameterForm,
  value: unknown,
  element: ElementView,
  kinds: Map<string, Kind>,
  context: Context,
): string {
  const unit = unitOf(form.unit, element, context);
  switch (form.form) {
    case "number":
    case "integer":
      return typeof value === "number" ? withUnit(short(value), unit) : "";
    case "per_axis":
      return withUnit(
        typeof value === "number"
          ? short(value)
          : Array.isArray(value)
            ? value.map((v) => (typeof v === "number" ? short(v) : "")).join(", ")
            : "",
        unit,
      );
    case "flag":
      return typeof value === "boolean" ? (value ? "yes" : "no") : "";
    case "text":
      return typeof value === "string" && form.choices.length > 0 ? value : "";
    case "part":
      return title(value, kinds);
    case "parts":
      return Array.isArray(value)
        ? value.map((part) => title(part, kinds)).join(", ") || (form.if_empty ?? "")
        : (form.if_none ?? "");
    default:
      return "";
  }
}

function title(part: unknown, kinds: Map<string, Kind>): string {
  const kind = (part as { kind?: unknown } | null)?.kind;
  return typeof kind === "string" ? (kinds.get(kind)?.title ?? kind) : "";
}

function unitOf(unit: string, element: ElementView, { axes, time_unit }: Context): string {
  const keys = element.axes[element.outputs[0] ?? ""] ?? [];
  return unitText(
    unit,
    time_unit,
    keys.flatMap((key) => axes.find((axis) => axis.key === key) ?? []),
  );
}

function withUnit(text: string, unit: string): string {
  return text === "" || unit === "" ? text : `${text} ${unit}`;
}
