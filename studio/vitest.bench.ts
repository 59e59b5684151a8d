import { defineConfig } from "vitest/config";

/** What the page promises about time, printed: benchmarks/studio.py starts it. */
export default defineConfig({
  test: {
    include: ["browser/bench/*.bench.ts"],
    globalSetup: "browser/ready.ts",
    reporters: [
      {
        onTestRunEnd: (modules, errors) =>
          tell(
            modules
              .flatMap((module) =>
                [...module.children.allTests()].flatMap((one) => one.result().errors ?? []),
              )
              .concat(errors),
          ),
      },
    ],
    disableConsoleIntercept: true,
    testTimeout: 300_000,
    hookTimeout: 120_000,
  },
});

/** Figures are all that is printed, unless something fails. */
function tell(errors: readonly { message: string; stack?: string | undefined }[]): void {
  for (const { message, stack } of errors) console.error(stack ?? message);
}
