// Whether the gallery stands before a document that is open.

import { create } from "zustand";

type View = { gallery: boolean };

export const useView = create<View>(() => ({ gallery: false }));
