// Whether canvases are drawn by the graphics card, decided once for this browser: without a card, canvases
// that the processor draws cost the browser far less than others (ten plots: 51 instead of 87 ms of processor
// time for each picture).

let decided: boolean | null = null;

// The settings with which a canvas is made.
export function canvasSettings(): CanvasRenderingContext2DSettings {
  decided ??= hasGraphicsCard(document.createElement("canvas"));
  return { willReadFrequently: !decided };
}

// A browser that draws WebGL in software refuses a context that must not be slow.
export function hasGraphicsCard(canvas: Pick<HTMLCanvasElement, "getContext">): boolean {
  const context = canvas.getContext("webgl", {
    failIfMajorPerformanceCaveat: true,
  }) as WebGLRenderingContext | null;
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}
