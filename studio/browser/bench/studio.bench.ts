import { test } from "vitest";

import { selection } from "./documents";
import { firstPaint, manyElements, sliderToPlot, slowdown, tenPlots } from "./measures";

test("first paint of the gallery", () => firstPaint("the gallery", null, "img"));
test("first paint of a document", () => firstPaint("a document", selection, ".plot-host canvas"));
test("response of a plot to a slider", () => sliderToPlot(20));
test("ten plots", tenPlots);
test("canvas with two hundred elements", () => manyElements(200));
test("canvas with five hundred elements", () => manyElements(500));
test("slowdown of the engine", () => slowdown(5));
