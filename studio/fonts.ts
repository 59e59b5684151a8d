/** Fonts of stylesheets from libraries: in the one format that every browser of the page reads, woff2. */
import type { Plugin } from "vite";

const OTHER = /,\s*url\([^)]*\.(?:woff|ttf)["']?\)\s*format\(["'](?:woff|truetype)["']\)/g;

/** Alphabets that no formula of deodar has; in one of a package their letters have the font of the text. */
const UNUSED = /@font-face\{[^}]*KaTeX_(?:Fraktur|SansSerif|Script|Typewriter)[^}]*\}/g;

/** Scripts of which the page writes no word; letters of one in a document have a font of the system. */
const OTHER_SCRIPTS =
  /@font-face\s*\{[^}]*inter-(?:cyrillic|cyrillic-ext|greek-ext|latin-ext|vietnamese)-wght[^}]*\}/g;

/** The stylesheet without the sources in woff and ttf that stand behind one in woff2. */
export function onlyWoff2(css: string): string {
  return css.replace(OTHER, "");
}

/** The stylesheet without the alphabets that no formula has, and without the scripts that the page lacks. */
export function onlyUsed(css: string): string {
  return css.replace(UNUSED, "").replace(OTHER_SCRIPTS, "");
}

export function fonts(): Plugin {
  return {
    name: "fonts",
    enforce: "pre",
    transform(code, id) {
      const css = id.split("?")[0]?.endsWith(".css") && code.includes("woff2");
      return css ? { code: onlyUsed(onlyWoff2(code)), map: null } : null;
    },
  };
}
