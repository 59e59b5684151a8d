import { smoke } from "./smoke";
import { launchWebkit } from "./webkit";

smoke("WebKit", launchWebkit);
