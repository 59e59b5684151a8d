import react from "@vitejs/plugin-react";
import { defineConfig } from "vite";

import { fonts } from "./fonts.ts";
import { licences } from "./licences.ts";

/**
 * A studio that runs, for `npm run dev`: the page comes from Vite, everything else from there. It answers
 * only to its own address and token.
 */
const {
  origin: STUDIO,
  port,
  searchParams,
} = new URL(process.env["DEODAR_STUDIO"] ?? "http://127.0.0.1:8430");
const headers = { origin: STUDIO, cookie: `deodar_token_${port}=${searchParams.get("token") ?? ""}` };

/** Libraries that change rarely, one file each: the browser fetches them side by side. */
const APART = ["react", "@mantine", "@xyflow", "@dagrejs", "katex"];

export default defineConfig({
  base: "./",
  plugins: [fonts(), licences(), react()],
  build: {
    outDir: "../src/deodar_studio/static",
    emptyOutDir: true,
    sourcemap: false,
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    chunkSizeWarningLimit: 800,
    rolldownOptions: {
      output: {
        codeSplitting: {
          groups: APART.map((name) => ({
            name: name.replace(/^@/, ""),
            test: new RegExp(`[\\\\/]node_modules[\\\\/]${name}[^\\\\/]*[\\\\/]`),
          })),
        },
      },
    },
  },
  server: {
    proxy: {
      "/ws": { target: STUDIO, ws: true, changeOrigin: true, headers },
      "/plots": { target: STUDIO, changeOrigin: true, headers },
      "/examples": { target: STUDIO, changeOrigin: true, headers },
    },
  },
});
