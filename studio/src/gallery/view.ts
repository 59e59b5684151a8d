// Whether the gallery covers an open document.

import { create } from "zustand";

type GalleryView = { gallery: boolean };

export const useView = create<GalleryView>(() => ({ gallery: false }));
