// The component of each form. A new form of the protocol without a component is an error of the compiler.

import { ArrayForm } from "./ArrayForm";
import { AxesForm } from "./AxesForm";
import { AxisForm } from "./AxisForm";
import { FlagForm } from "./FlagForm";
import { NumberForm } from "./NumberForm";
import { NumbersForm } from "./NumbersForm";
import { PairsForm } from "./PairsForm";
import { PartForm } from "./PartForm";
import { PartsForm } from "./PartsForm";
import { PerAxisForm } from "./PerAxisForm";
import type { FormTable } from "./props";
import { TextForm } from "./TextForm";
import { TextsForm } from "./TextsForm";
import { ValueForm } from "./ValueForm";

export const FORMS: FormTable = {
  array: ArrayForm,
  axes: AxesForm,
  axis: AxisForm,
  flag: FlagForm,
  integer: NumberForm,
  number: NumberForm,
  numbers: NumbersForm,
  pairs: PairsForm,
  part: PartForm,
  parts: PartsForm,
  per_axis: PerAxisForm,
  text: TextForm,
  texts: TextsForm,
  value: ValueForm,
};
