// The theme of Mantine's controls: deodar green, calm greys, system fonts, small sizes. All other colours are
// in theme.css.

import { createTheme, type CSSVariablesResolver, type MantineColorsTuple } from "@mantine/core";

const deodar: MantineColorsTuple = [
  "#eef7f2",
  "#dbede3",
  "#b7dbc8",
  "#90c8ab",
  "#6bb691",
  "#4ba37b",
  "#3a9069",
  "#2f7d5b",
  "#276a4d",
  "#1e563e",
];

const gray: MantineColorsTuple = [
  "#f5f7f5",
  "#edf0ed",
  "#e2e6e3",
  "#d3d9d5",
  "#b9c1bc",
  "#8f9a94",
  "#5f6a64",
  "#454f4a",
  "#2f3733",
  "#1c2420",
];

const dark: MantineColorsTuple = [
  "#e4e9e6",
  "#c3ccc7",
  "#9aa69f",
  "#76837c",
  "#3a433e",
  "#2e3632",
  "#232a26",
  "#1a1f1c",
  "#131715",
  "#0d100e",
];

export const theme = createTheme({
  respectReducedMotion: true,
  primaryColor: "deodar",
  primaryShade: 7,
  colors: { deodar, gray, dark },
  black: "#1c2420",
  fontFamily:
    '-apple-system, "Segoe UI", Roboto, Cantarell, Ubuntu, "Noto Sans", "Helvetica Neue", Arial, sans-serif',
  fontFamilyMonospace: 'ui-monospace, SFMono-Regular, Menlo, Consolas, "Liberation Mono", monospace',
  fontSizes: { xs: "12px", sm: "13px", md: "14px", lg: "16px", xl: "19px" },
  headings: { fontWeight: "600" },
  defaultRadius: "sm",
  cursorType: "pointer",
  components: {
    Tooltip: {
      defaultProps: { openDelay: 400, fz: "xs", withArrow: true, arrowSize: 6, multiline: true, maw: 280 },
    },
    ActionIcon: { defaultProps: { variant: "subtle", color: "gray" } },
    // the arrow keys step a number; its two buttons are too small for a finger
    NumberInput: { defaultProps: { hideControls: true } },
    // the placeholder for the first focus is no entry, and a menu may contain only entries
    Menu: { defaultProps: { withInitialFocusPlaceholder: false } },
  },
});

// Mantine and theme.css use the same background.
const COLOURS = {
  "--mantine-color-body": "var(--surface-raised)",
  "--mantine-color-text": "var(--text)",
  "--mantine-color-dimmed": "var(--text-dim)",
  "--mantine-color-error": "var(--error)",
  "--mantine-color-anchor": "var(--accent)",
};

export const variables: CSSVariablesResolver = () => ({ variables: {}, light: COLOURS, dark: COLOURS });
