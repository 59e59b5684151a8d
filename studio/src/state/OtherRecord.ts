// Whether the plots inside show the record that the open one is compared with.

import { createContext } from "react";

export const OtherRecord = createContext(false);
