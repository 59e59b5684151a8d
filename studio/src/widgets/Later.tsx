// A part of the page whose code is loaded when it is first shown. Where that fails, it says so in its place.

import { Component, type ComponentType, lazy, type ReactNode, Suspense, useState } from "react";

import { PanelButton } from "./Buttons";
import classes from "./connection.module.css";

class NotLoaded extends Error {
  override message =
    "This part of the page could not be loaded. The server does not answer, or has a newer page: try " +
    "again, and if that does not help, reload the page.";
}

export function later<Props extends object>(load: () => Promise<ComponentType<Props>>): ComponentType<Props> {
  // React keeps a failure: what is shown next is asked for again.
  const ask = () =>
    lazy(async () => {
      try {
        return { default: await load() };
      } catch (cause) {
        newest = ask();
        throw new NotLoaded("", { cause });
      }
    });
  let newest = ask();
  return function Later(props: Props) {
    const [Part, show] = useState(() => newest);
    const again = () => {
      askForStyles();
      show(() => newest);
    };
    return (
      <Boundary again={again}>
        <Suspense>
          <Part {...props} />
        </Suspense>
      </Boundary>
    );
  };
}

// The built page asks for each style sheet once, also where it did not come.
function askForStyles(): void {
  for (const link of document.querySelectorAll<HTMLLinkElement>('link[rel="stylesheet"]')) {
    if (link.sheet === null) {
      link.replaceWith(link.cloneNode());
    }
  }
}

class Boundary extends Component<{ again: () => void; children: ReactNode }, { failure: unknown }> {
  override state = { failure: null };

  static getDerivedStateFromError(failure: unknown) {
    return { failure };
  }

  override render() {
    const { failure }: { failure: unknown } = this.state;
    if (failure === null) {
      return this.props.children;
    }
    const again = () => {
      this.setState({ failure: null });
      this.props.again();
    };
    return (
      <div className={`wrapped ${classes.failed}`} role="alert">
        <p>
          {failure instanceof NotLoaded
            ? failure.message
            : `This part of the page failed: ${String(failure)}`}
        </p>
        <PanelButton label="Try again" onClick={again} />
      </div>
    );
  }
}
