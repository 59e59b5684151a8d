/** The licences of the libraries that are part of the built page, as the text file licences.txt beside it. */
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import type { Plugin } from "vite";

const MISSING = "The package has no file with its licence.";
const NAMES = /^(licen[cs]e|copying|notice)/i;

interface Package {
  name: string;
  version: string;
  license: string;
}

/** The folder of the package that a module belongs to, or nothing for our own modules. */
export function packageFolder(id: string): string | undefined {
  const path = id.replace(/^\0/, "").split("?")[0] ?? "";
  const match = /^(.*[\\/]node_modules[\\/](?:@[^\\/]+[\\/])?[^\\/]+)[\\/]/.exec(path);
  return match?.[1];
}

/** Name, version and the text of the licence of the package in a folder. */
export function notice(folder: string): string {
  const about = JSON.parse(readFileSync(join(folder, "package.json"), "utf8")) as Package;
  const texts = readdirSync(folder)
    .filter((name) => NAMES.test(name))
    .sort();
  const text = texts.map((name) => readFileSync(join(folder, name), "utf8").trim()).join("\n\n");
  return `${about.name} ${about.version} (${about.license})\n\n${text || MISSING}\n`;
}

export function licences(): Plugin {
  const folders = new Set<string>();
  return {
    name: "licences",
    apply: "build",
    // not taken from the bundle: stylesheets are no modules of a chunk
    transform(_code, id) {
      const folder = packageFolder(id);
      if (folder && existsSync(join(folder, "package.json"))) folders.add(folder);
      return null;
    },
    generateBundle() {
      const notices = [...folders].sort().map(notice);
      this.emitFile({
        type: "asset",
        fileName: "licences.txt",
        source: notices.join(`\n${"-".repeat(80)}\n\n`),
      });
    },
  };
}
