// Keys of a keyboard: which are pressed, how they are called, and where they go.

export type Press = Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">;

export type Shortcut = {
  keys: readonly string[];
  does: string;
  run: () => unknown;
  // Also without an open document.
  always?: boolean;
  // Again and again while the key is held.
  repeats?: boolean;
  // Also while the user types; the typed value is committed first.
  typing?: boolean;
  // Only where the page shows the past, and no control has the focus that uses the key itself.
  past?: boolean;
  // Only where the canvas has the focus, or nothing.
  canvas?: boolean;
  // An event of the browser follows the keys, and it is what acts.
  event?: boolean;
};

// Whether a key press is the one that is written, such as "Ctrl+Shift+Z". Ctrl is Command on a Mac. Of signs
// such as "?" it does not matter whether a keyboard needs Shift for them.
export function isPressed(keys: string, press: Press): boolean {
  const parts = keys.split("+");
  const key = parts.at(-1) ?? "";
  const shift = parts.includes("Shift");
  const same = key === "Space" ? press.key === " " : press.key.toLowerCase() === key.toLowerCase();
  const shiftMatters = key === "Space" || /^[a-z]$/i.test(key);
  return (
    same &&
    !press.altKey &&
    (press.ctrlKey || press.metaKey) === parts.includes("Ctrl") &&
    (!shiftMatters || press.shiftKey === shift)
  );
}

// Keys as this computer calls them.
export function keysText(keys: string, mac = isMac()): string {
  const named = keys.replace("ArrowLeft", "←").replace("ArrowRight", "→");
  return mac ? named.replace("Ctrl+", "⌘").replace("Shift+", "⇧") : named;
}

function isMac(): boolean {
  return typeof navigator !== "undefined" && /Mac|iP(ad|hone|od)/.test(navigator.userAgent);
}

// Whether the keys go into a text, or a choice that is searched by letters.
export function isTyping(target: Element | null): boolean {
  if (target === null) {
    return false;
  }
  const field = target.closest("input, textarea, select, [contenteditable]:not([contenteditable=false])");
  return (
    field !== null &&
    !field.matches("input:is([type=checkbox], [type=radio], [type=range], [type=button], [type=submit])")
  );
}
