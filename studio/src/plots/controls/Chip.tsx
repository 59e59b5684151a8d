// An entry of a legend, which shows and hides its curve.

type Entry = { label: string; color: string; dashed?: boolean; on: boolean; toggle: () => void };

export function Chip({ label, color, dashed = false, on, toggle }: Entry) {
  return (
    <button type="button" className="plot-chip" aria-pressed={on} onClick={toggle}>
      <span className="plot-swatch" data-dashed={dashed || undefined} style={{ borderColor: color }} />
      {label}
    </button>
  );
}
