// Whether the gallery covers an open document.

import { create } from "zustand";

type View = { gallery: boolean };

export const useView = create<View>(() => ({ gallery: false }));
