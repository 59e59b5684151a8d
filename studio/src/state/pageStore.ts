// A store of what the page holds for one session: another session gets a new, empty object.

import { create, type StoreApi, type UseBoundStore } from "zustand";
import { useStudio } from "../server/store";

export function pageStore<T extends object>(empty: () => T): UseBoundStore<StoreApi<T>> {
  const store = create<T>(empty);
  useStudio.subscribe(({ session }, before) => {
    if (session !== before.session) {
      store.setState(empty(), true);
    }
  });
  return store;
}
