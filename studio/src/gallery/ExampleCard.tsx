// An example of the gallery: its picture and its first sentence.

import { useState } from "react";

import type { ExampleView } from "../protocol";
import { Logo } from "./Logo";
import { leave } from "../files/flows";
import classes from "./ExampleCard.module.css";

export function ExampleCard({ example }: { example: ExampleView }) {
  const [missing, setMissing] = useState(example.picture === "");
  return (
    <button
      type="button"
      className={classes.card}
      onClick={() => void leave({ type: "open_example", name: example.name })}
    >
      <span className={classes.picture}>
        {missing && <Logo size={40} color="var(--edge)" />}
        {!missing && <img src={example.picture} alt="" loading="lazy" onError={() => setMissing(true)} />}
      </span>
      <span className={classes.text}>
        <span className={classes.title}>{example.title}</span>
        <span className={classes.sentence}>{example.sentence}</span>
      </span>
    </button>
  );
}
