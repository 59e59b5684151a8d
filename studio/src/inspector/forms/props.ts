// What each form gets: the declaration of a parameter, its path below the element, and its value.

import type { ParameterForm } from "../../protocol";

export type FormProps = { form: ParameterForm; path: string; value: unknown };
