// The level of detail of one box. A box that comes into view while the canvas is moved shows its name alone
// until the canvas rests: ports and live pictures of hundreds of boxes would interrupt the movement.

import { useEffect, useState } from "react";
import { type DetailLevel, useLook, useMoving } from "./zoom";

export function useDetail(): DetailLevel {
  const level = useLook((look) => look.level);
  const [late, setLate] = useState(() => useMoving.getState().moving);
  useEffect(() => {
    if (!late) {
      return;
    }
    const check = () => {
      if (!useMoving.getState().moving) {
        setLate(false);
      }
    };
    check();
    return useMoving.subscribe(check);
  }, [late]);
  return late ? "dot" : level;
}
