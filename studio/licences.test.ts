import { expect, test } from "vitest";

import { notice, packageFolder } from "./licences";

test("a module belongs to the innermost package around it", () => {
  expect(packageFolder("/a/node_modules/react/index.js")).toBe("/a/node_modules/react");
  expect(packageFolder("/a/node_modules/@mantine/core/esm/x.mjs?used")).toBe("/a/node_modules/@mantine/core");
  expect(packageFolder("/a/node_modules/b/node_modules/c/x.js")).toBe("/a/node_modules/b/node_modules/c");
  expect(packageFolder("\0/a/node_modules/react/index.js?commonjs")).toBe("/a/node_modules/react");
  expect(packageFolder("C:\\a\\node_modules\\react\\index.js")).toBe("C:\\a\\node_modules\\react");
});

test("modules of the studio belong to no package", () => {
  expect(packageFolder("/a/src/main.tsx")).toBeUndefined();
});

test("a notice names the package and has the text of its licence", () => {
  const text = notice("node_modules/react");
  expect(text).toMatch(/^react \d+\.\d+\.\d+ \(MIT\)\n/);
  expect(text).toContain("Permission is hereby granted, free of charge");
});
