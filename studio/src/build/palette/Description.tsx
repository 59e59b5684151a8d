// What a kind computes, below the list: its equation and the meaning of its parameters.

import { Tex } from "../../widgets/Tex";
import type { Kind, TemplateView } from "../../protocol";
import { TemplatePicture } from "./Sketch";

const LINES = 2;
const MOST = 5;

export function Description({ kind }: { kind: Kind }) {
  const meanings = kind.parameters
    .map((form) => form.meaning || form.name.replaceAll("_", " "))
    .filter((meaning, i, all) => all.indexOf(meaning) === i);
  return (
    <div className="chooser-description">
      {kind.equation.slice(0, LINES).map((line) => (
        <div className="chooser-equation" key={line}>
          <Tex source={line} />
        </div>
      ))}
      {meanings.length > 0 && (
        <p className="dim chooser-meanings" title={meanings.join(", ")}>
          {meanings.slice(0, MOST).join(", ")}
          {meanings.length > MOST && ", …"}
        </p>
      )}
    </div>
  );
}

// A model that is added whole: its picture and its first sentence.
export function TemplateDescription({ template }: { template: TemplateView }) {
  return (
    <div className="chooser-description across">
      <TemplatePicture key={template.name} template={template} className="chooser-picture" />
      <p className="dim grow chooser-meanings">{template.sentence}</p>
    </div>
  );
}
