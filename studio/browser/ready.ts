/** Before the first test: can a browser start? If not, that is said once, not by every test. */
import { launch } from "./chromium";

export default async function setup(): Promise<void> {
  const browser = await launch();
  await browser.close();
}
