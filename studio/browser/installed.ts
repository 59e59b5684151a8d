import { readFileSync } from "node:fs";
import { join } from "node:path";

const PACKAGE = join(import.meta.dirname, "..", "..", "examples", "package");

/** What the example package consists of, for `startStudio`: the server finds it in its working folder. */
export function examplePackage(): { copies: string[]; folders: Record<string, Record<string, string>> } {
  const project = readFileSync(join(PACKAGE, "pyproject.toml"), "utf8");
  const entries = project
    .slice(project.indexOf("[project.entry-points"))
    .replace(/\[project\.entry-points\."(.+)"\]/g, "[$1]")
    .replaceAll('"', "");
  return {
    copies: ["examples/package/deodar_change"],
    folders: { "deodar_change-0.1.0.dist-info": infoOf("deodar-change", entries) },
  };
}

/** The files that state the metadata of an installed package. */
export function infoOf(name: string, entries: string): Record<string, string> {
  return {
    METADATA: `Metadata-Version: 2.1\nName: ${name}\nVersion: 0.1.0\n`,
    "entry_points.txt": entries,
  };
}
