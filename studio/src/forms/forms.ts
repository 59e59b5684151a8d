// The component of each form. A new form of the protocol without a component is an error of the compiler.

import { ArrayForm } from "./ArrayForm";
import { AxesForm, AxisForm } from "./AxesForm";
import { FlagForm } from "./FlagForm";
import { NumberForm, NumbersForm, PerAxisForm } from "./numberForms";
import { PartForm, PartsForm } from "./partForms";
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
