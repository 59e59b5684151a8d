// What a person keeps in the browser, for all documents: widths, folds and habits.

import { create } from "zustand";
import { isView, type View } from "./page";

export type PersonState = Readonly<{
  // The width of the dock in px; 0: that of the page.
  dock: number;
  // Whether the palette shows names on a wide page.
  palette: boolean;
  // The tool that the person chose last in each view.
  tabs: Readonly<Partial<Record<View, string>>>;
  // The view that the person chose last, by the path of the file.
  views: Readonly<Record<string, string>>;
}>;

const KEY = "deodar";
export const STANDARD: PersonState = { dock: 0, palette: true, tabs: {}, views: {} };
const MOST_FILES = 50;

export const usePerson = create<PersonState>(() => restored(stored()));

// What another page of the same browser stored meanwhile stays.
export function changePerson(change: Partial<PersonState>): void {
  usePerson.setState({ ...restored(stored()), ...change });
  try {
    localStorage.setItem(KEY, JSON.stringify(usePerson.getState()));
  } catch {
    // Without storage the choice holds until the page is closed.
  }
}

export function rememberView(file: string, view: View): void {
  if (file !== "") {
    const { [file]: _, ...others } = usePerson.getState().views;
    const newest = Object.entries(others).slice(1 - MOST_FILES);
    changePerson({ views: { ...Object.fromEntries(newest), [file]: view } });
  }
}

export function viewOf(file: string): View | null {
  const view = usePerson.getState().views[file];
  return isView(view) ? view : null;
}

// A stored value counts where it has the type of its default.
export function restored(text: string): PersonState {
  let values: unknown;
  try {
    values = JSON.parse(text);
  } catch {
    return STANDARD;
  }
  const known = Object.entries((values ?? {}) as object).filter(
    ([name, value]) =>
      name in STANDARD && value !== null && typeof value === typeof STANDARD[name as keyof PersonState],
  );
  return { ...STANDARD, ...Object.fromEntries(known) };
}

function stored(): string {
  try {
    return localStorage.getItem(KEY) ?? "{}";
  } catch {
    return "{}";
  }
}
