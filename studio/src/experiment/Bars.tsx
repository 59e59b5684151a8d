// The distribution of a column in each combination of levels: a histogram of numbers, bars of texts.

import { short } from "../draw/text";
import { bins, type Column, conditionsOf, median, rangeOf, shares, type TrialRow } from "../model/trialRows";

// Of a drawing, which is stretched to the width that it has.
const HEIGHT = 26;

export function Bars({ rows, column }: { rows: TrialRow[]; column: Column }) {
  const conditions = conditionsOf(rows);
  const cells = rows.map(column.of);
  const numbers = cells.filter((cell) => typeof cell === "number");
  const range = rangeOf(numbers);
  const texts = [...new Set(cells.filter((cell) => typeof cell === "string"))].sort();
  return (
    <figure className="down experiment-bars" aria-label={`${column.name} in each condition`}>
      {conditions.map((condition) => (
        <div key={condition.label} className="experiment-bar">
          <span className="one-line" title={condition.label}>
            {condition.short || "all trials"}
          </span>
          {column.sort === "text" ? (
            <Texts texts={texts} counts={shares(condition.rows.map(column.of), texts)} />
          ) : (
            <Numbers
              label={condition.label || "all trials"}
              values={condition.rows.map(column.of).filter((cell) => typeof cell === "number")}
              range={range}
              of={condition.rows.length}
            />
          )}
        </div>
      ))}
      {column.sort === "number" && (
        <figcaption className="experiment-bar dim">
          <span className="one-line">{Object.keys(rows[0]?.levels ?? {}).join(", ")}</span>
          <span className="experiment-ends">
            <span>{short(range[0])}</span>
            <span>{short(range[1])}</span>
          </span>
          <span>median, trials</span>
        </figcaption>
      )}
    </figure>
  );
}

type NumbersProps = { label: string; values: number[]; range: [number, number]; of: number };

function Numbers({ label, values, range, of }: NumbersProps) {
  const counts = bins(values, range);
  const most = Math.max(1, ...counts);
  const middle = median(values);
  const share = middle === null ? 0 : (middle - range[0]) / (range[1] - range[0]);
  const said = middle === null ? "no value" : short(middle);
  return (
    <>
      <svg
        viewBox={`0 0 ${counts.length} ${HEIGHT}`}
        preserveAspectRatio="none"
        role="img"
        aria-label={`${label}: median ${said} of ${values.length} trials`}
      >
        {counts.map(
          (count, i) =>
            count > 0 && (
              <rect
                key={i}
                x={i + 0.05}
                width={0.9}
                y={HEIGHT * (1 - count / most)}
                height={(HEIGHT * count) / most}
              />
            ),
        )}
        {middle !== null && <line x1={share * counts.length} x2={share * counts.length} y2={HEIGHT} />}
      </svg>
      <span>
        {said}, {values.length === of ? of : `${values.length} of ${of}`}
      </span>
    </>
  );
}

function Texts({ texts, counts }: { texts: string[]; counts: number[] }) {
  const total = counts.reduce((a, b) => a + b, 0) || 1;
  return (
    <>
      <span className="experiment-shares">
        {texts.map((text, i) => (
          <span
            key={text}
            className="experiment-share one-line"
            data-rank={i % RANKS}
            style={{ width: `${(100 * (counts[i] ?? 0)) / total}%` }}
            title={`${text}: ${counts[i]} of ${total}`}
          >
            {text}
          </span>
        ))}
      </span>
      <span>{texts.flatMap((text, i) => (counts[i] ? [`${text} ${counts[i]}`] : [])).join(", ")}</span>
    </>
  );
}

const RANKS = 4;
