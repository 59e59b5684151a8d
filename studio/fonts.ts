/** Fonts of stylesheets from libraries in one format: every browser that runs the page reads woff2. */
import type { Plugin } from "vite";

const OTHER = /,\s*url\([^)]*\.(?:woff|ttf)["']?\)\s*format\(["'](?:woff|truetype)["']\)/g;

/** The stylesheet without the sources in woff and ttf that stand behind one in woff2. */
export function onlyWoff2(css: string): string {
  return css.replace(OTHER, "");
}

export function fonts(): Plugin {
  return {
    name: "fonts",
    enforce: "pre",
    transform(code, id) {
      const css = id.split("?")[0]?.endsWith(".css") && code.includes("woff2");
      return css ? { code: onlyWoff2(code), map: null } : null;
    },
  };
}
