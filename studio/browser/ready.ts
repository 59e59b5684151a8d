/** Start a browser before the first test, so that a failure is reported once, not by every test. */
import { launch } from "./chromium";

export default async function setup(): Promise<void> {
  const browser = await launch();
  await browser.close();
}
