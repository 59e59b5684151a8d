// TeX, typeset. KaTeX is large and is loaded when it is first needed; until then, and if it cannot read the
// source, the source is shown.

import type Katex from "katex";
import { useEffect, useMemo, useState } from "react";

type Typesetter = typeof Katex;

let typesetter: Typesetter | null = null;
let coming: Promise<Typesetter> | null = null;

function load(): Promise<Typesetter> {
  coming ??= Promise.all([import("katex"), import("katex/dist/katex.min.css")]).then(
    ([katex]) => (typesetter = katex.default),
  );
  return coming;
}

function typeset(katex: Typesetter, source: string, block: boolean): string | null {
  try {
    return katex.renderToString(source, { displayMode: block, throwOnError: true, strict: "ignore" });
  } catch {
    return null;
  }
}

export function Tex({ source, block = false }: { source: string; block?: boolean }) {
  const [katex, setKatex] = useState<Typesetter | null>(() => typesetter);
  useEffect(() => {
    if (katex === null) {
      load().then(
        (loaded) => setKatex(() => loaded),
        () => undefined,
      );
    }
  }, [katex]);
  const html = useMemo(() => (katex === null ? null : typeset(katex, source, block)), [katex, source, block]);
  if (html === null) {
    return <span className="tex-source">{source}</span>;
  }
  // biome-ignore lint/security/noDangerouslySetInnerHtml: KaTeX made it from TeX that it does not trust
  return <span className="tex" dangerouslySetInnerHTML={{ __html: html }} />;
}
