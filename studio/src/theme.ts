// The theme of Mantine's controls: deodar green, greys, one typeface, small sizes. All other colours are
// in theme.css.

import { createTheme, type CSSVariablesResolver, type MantineColorsTuple } from "@mantine/core";

import { TYPEFACE } from "./draw/ink";

// From light to dark.
const shades = (colours: string) => colours.split(" ") as unknown as MantineColorsTuple;

const deodar = shades("#eef7f2 #dbede3 #b7dbc8 #90c8ab #6bb691 #4ba37b #3a9069 #1f7a50 #186842 #115235");
const gray = shades("#f4f4f5 #ededef #e2e2e5 #d0d0d5 #b4b4bc #8b8b94 #5b5b64 #434349 #2c2c31 #18181b");
const dark = shades("#ececef #c6c6cd #a5a5b0 #6d6d78 #3b3b42 #2c2c31 #232327 #1a1a1d #121214 #0d0d0f");

const SMALL = { defaultProps: { size: "xs" } };
const LIST = { defaultProps: { size: "xs", comboboxProps: { shadow: "md" } } };

export const theme = createTheme({
  respectReducedMotion: true,
  primaryColor: "deodar",
  primaryShade: 7,
  colors: { deodar, gray, dark },
  black: "#18181b",
  fontFamily: TYPEFACE,
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
    // the placeholder for the first focus is no entry, and a menu may contain only entries
    Menu: { defaultProps: { withInitialFocusPlaceholder: false, shadow: "md" } },
    Popover: { defaultProps: { shadow: "md" } },
    Autocomplete: LIST,
    Checkbox: SMALL,
    MultiSelect: LIST,
    NativeSelect: SMALL,
    SegmentedControl: SMALL,
    Select: LIST,
    Switch: SMALL,
    Textarea: SMALL,
    TextInput: { defaultProps: { size: "xs", autoComplete: "off", spellCheck: false } },
  },
});

// Mantine and theme.css use the same background.
const COLOURS = {
  "--mantine-color-body": "var(--panel)",
  "--mantine-color-text": "var(--text)",
  "--mantine-color-dimmed": "var(--dim)",
  "--mantine-color-error": "var(--error)",
  "--mantine-color-anchor": "var(--accent)",
};

export const variables: CSSVariablesResolver = () => ({ variables: {}, light: COLOURS, dark: COLOURS });
