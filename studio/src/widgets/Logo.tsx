// The mark of deodar: the tree, in the colour of the text around it or of the accent. The favicon draws the
// same path.

const TREE =
  "M16 1.5C15.2 5.2 12.6 8.4 9.2 10Q11.4 10.9 13.2 10C11.6 13.6 8.9 16 5.6 17.4Q8.6 18.4 11.2 17.2" +
  "C9.2 20.8 6.2 23.6 2.5 25Q9 27 14.6 25" +
  "V30.5H17.4V25Q23 27 29.5 25C25.8 23.6 22.8 20.8 20.8 17.2" +
  "Q23.4 18.4 26.4 17.4C23.1 16 20.4 13.6 18.8 10Q20.6 10.9 22.8 10C19.4 8.4 16.8 5.2 16 1.5Z";

export function Logo({ size, color = "var(--accent)" }: { size: number; color?: string }) {
  return (
    <svg
      width={size}
      height={size}
      viewBox="0 0 32 32"
      aria-hidden="true"
      style={{ display: "block", flexShrink: 0 }}
    >
      <path d={TREE} fill={color} />
    </svg>
  );
}
