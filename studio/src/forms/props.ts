// What each form gets: the declaration of a parameter, its path below the element, and its value. A form that
// holds others finds them here, so that it imports none that may hold it.

import { type ComponentType, createContext } from "react";

import type { ParameterForm } from "../protocol";

export type FormProps = { form: ParameterForm; path: string; value: unknown };

export type FormTable = Readonly<Record<ParameterForm["form"], ComponentType<FormProps>>>;

export const Forms = createContext<FormTable | null>(null);
