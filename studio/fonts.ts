/** Fonts of stylesheets from libraries: in the one format that every browser of the page reads, woff2. */
import type { Plugin } from "vite";

const OTHER = /,\s*url\([^)]*\.(?:woff|ttf)["']?\)\s*format\(["'](?:woff|truetype)["']\)/g;

/** Alphabets that no formula of deodar has; in one of a package their letters have the font of the text. */
const UNUSED = /@font-face\{[^}]*KaTeX_(?:Fraktur|SansSerif|Script|Typewriter)[^}]*\}/g;

/** The stylesheet without the sources in woff and ttf that stand behind one in woff2. */
export function onlyWoff2(css: string): string {
  return css.replace(OTHER, "");
}

/** The stylesheet of the formulas without the alphabets that none has. */
export function onlyUsed(css: string): string {
  return css.replace(UNUSED, "");
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
