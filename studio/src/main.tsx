import "./mantine.css";
import "@fontsource-variable/inter/wght.css";
import "./theme.css";

import { MantineProvider } from "@mantine/core";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";

import { App } from "./App";
import { FORMS } from "./forms/forms";
import { Forms } from "./forms/props";
import { socket } from "./server/socket";
import { theme, variables } from "./theme";
import { TYPEFACE } from "./draw/ink";

const root = document.getElementById("root");
if (root === null) {
  throw new Error("index.html has no element with the id root");
}
socket.open();
const page = (
  <StrictMode>
    <MantineProvider theme={theme} cssVariablesResolver={variables} defaultColorScheme="auto">
      <Forms value={FORMS}>
        <App />
      </Forms>
    </MantineProvider>
  </StrictMode>
);
// a canvas that is drawn before its typeface is there keeps another one
void document.fonts.load(`13px ${TYPEFACE}`).finally(() => createRoot(root).render(page));
