/** What the tests ask of a browser, however it is driven. */
export interface Driver {
  open: (url: string) => Promise<void>;
  /** The result of a function in the page; it may use only its argument. */
  evaluate: <A, T>(look: (argument: A) => T, argument: A) => Promise<T>;
  move: (x: number, y: number) => Promise<void>;
  down: (button?: Button) => Promise<void>;
  up: (button?: Button) => Promise<void>;
  /** Two clicks in one command: a browser counts those of two commands as one and one. */
  doubleClick: (x: number, y: number) => Promise<void>;
  /** Press a key, and before it the modifier, if there is one. */
  press: (key: string, modifier?: "Control") => Promise<void>;
  /** Write a picture of the page as a PNG file. */
  picture: (path: string) => Promise<void>;
  /** The errors that the page reported since it was opened. */
  errors: () => Promise<string[]>;
  close: () => Promise<void>;
}

export type Button = "left" | "right";

/** The program that `studio/build.py` found and gave to the tests. */
export function programOf(variable: string): string {
  const program = process.env[variable];
  if (program === undefined)
    throw new Error(`${variable} is not set. Start these tests with studio/build.py, which finds browsers.`);
  return program;
}
