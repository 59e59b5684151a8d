// The equation of a kind, typeset, and its source in the literature.

import { Tex } from "../../widgets/Tex";

export function Equation({ lines, reference }: { lines: string[]; reference: string }) {
  return (
    <section className="equation" aria-label="Equation">
      {lines.map((line) => (
        <div className="equation-line" key={line} tabIndex={-1}>
          <Tex source={line} block />
        </div>
      ))}
      {reference !== "" && <p className="reference">{reference}</p>}
    </section>
  );
}
