// Parameters by their section; in a section they keep the order of their declaration.

import type { ParameterForm } from "../../protocol";

export type Section = NonNullable<ParameterForm["section"]>;

// In the order of the inspector: what is tuned most comes first.
const SECTIONS: readonly Section[] = ["", "time course", "interaction", "noise", "axes"];

export function sectionsOf(forms: ParameterForm[]): { section: Section; forms: ParameterForm[] }[] {
  return SECTIONS.map((section) => ({
    section,
    forms: forms.filter((form) => (form.section ?? "") === section),
  })).filter((found) => found.forms.length > 0);
}

export function titleOf(section: Section): string {
  return section === "" ? "Parameters" : section.charAt(0).toUpperCase() + section.slice(1);
}
