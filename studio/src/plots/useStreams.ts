// Live arrays for a component: drawing happens once for each picture of the browser and past React; the
// component renders again only when the content of the streams changes.

import { useContext, useEffect, useState } from "react";
import type { Announced, ListedProblem } from "../protocol";
import { OtherRecord } from "../state/OtherRecord";
import { socket } from "../server/socket";
import type { Live, Wish } from "../server/streams";
import { useLatest } from "../widgets/useLatest";

export type Streaming = {
  // What each stream holds; null as long as it is not known.
  forms: (Announced | null)[];
  // The reason of a stream without data.
  lost: ListedProblem | null;
  // Whether anything came yet.
  seen: boolean;
};

const NOTHING: Streaming = { forms: [], lost: null, seen: false };

export function useStreams(wishes: Wish[], on: boolean, draw: (lives: Live[]) => void): Streaming {
  const [streaming, setStreaming] = useState(NOTHING);
  const drawing = useLatest(draw);
  const other = useContext(OtherRecord);
  const key = JSON.stringify(other ? wishes.map((wish) => ({ ...wish, other })) : wishes);

  useEffect(() => {
    if (!on) {
      return;
    }
    const asked = JSON.parse(key) as Wish[];
    const lives: (Live | null)[] = asked.map(() => null);
    let known = NOTHING;
    let due = false;
    let ended = false;
    const take = () => {
      due = false;
      if (ended) {
        return;
      }
      const next = summary(lives);
      if (
        next.seen !== known.seen ||
        next.lost !== known.lost ||
        next.forms.some((form, i) => form !== known.forms[i])
      ) {
        known = next;
        // The values of another section follow at once: until then the last ones stay.
        setStreaming((shown) => (shown.seen && !next.seen && next.lost === null ? shown : next));
      }
      if (lives.every((live) => live !== null)) {
        drawing.current(lives as Live[]);
      }
    };
    // Streams are notified one after another within one task: a microtask runs after all of them.
    const later = () => {
      if (!due) {
        due = true;
        queueMicrotask(take);
      }
    };
    const ends = asked.map((wish, i) =>
      socket.streams.subscribe(wish, (live) => {
        lives[i] = live;
        later();
      }),
    );
    return () => {
      ended = true;
      // After the next streams are asked for: what both have in common continues.
      queueMicrotask(() => ends.forEach((end) => end()));
    };
  }, [key, on, drawing]);

  return streaming;
}

function summary(lives: (Live | null)[]): Streaming {
  return {
    forms: lives.map((live) => live?.form ?? null),
    lost: lives.find((live) => live?.lost != null)?.lost?.problem ?? null,
    seen: lives.some((live) => live?.frame != null),
  };
}
