import { test } from "vitest";

import { nine, selection, ten } from "./documents";
import { firstPaint, manyElements, manyPlots, sliderToPlot, slowdown } from "./measures";

test("first paint of the gallery", () => firstPaint("the gallery", null, "img"));
test("first paint of a document", () => firstPaint("a document", selection, ".plot-host canvas"));
test("response of a plot to a slider", () => sliderToPlot(20));
test("nine plots", () => manyPlots("nine plots", nine));
test("ten plots", () => manyPlots("ten plots", ten));
test("canvas with two hundred elements", () => manyElements(200));
test("canvas with five hundred elements", () => manyElements(500));
test("slowdown of the engine", () => slowdown(5));
