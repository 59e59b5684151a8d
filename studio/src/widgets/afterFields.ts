// What closes a popover with fields: the end of a press outside, so that the field that was left has taken
// its text; and only of a press that began outside too, so that text can be selected past the edge.

import { useEffect, useState } from "react";

const EVENTS = ["mouseup"];

export function useAfterFields() {
  const [isOutside, setOutside] = useState(true);
  useEffect(() => {
    const press = ({ target }: Event) =>
      setOutside(!(target instanceof Element && target.closest(".mantine-Popover-dropdown") !== null));
    document.addEventListener("mousedown", press, true);
    return () => document.removeEventListener("mousedown", press, true);
  }, []);
  return { clickOutsideEvents: EVENTS, closeOnClickOutside: isOutside };
}
