// The component of each form. A new form of the protocol without a component is an error of the compiler.

import { ArrayForm } from "./ArrayForm";
import { AxesForm, AxisForm } from "./AxesForm";
import { FlagForm } from "./FlagForm";
import { NumberForm } from "./NumberRow";
import { NumbersForm } from "./NumbersForm";
import { PartForm } from "./PartForm";
import { PartsForm } from "./PartsForm";
import { PerAxisForm } from "./PerAxisForm";
import type { FormTable } from "./props";
import { PairsForm, TextForm, TextsForm, ValueForm } from "./textForms";

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
