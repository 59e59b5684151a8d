"""Write the names of the plots of the studio's page, which plots of packages cannot take.

    python tools/own_plots.py      also a step of tools/generate.py

Each file `studio/src/plots/kinds/NAME.plot.ts` declares a plot.
"""

from __future__ import annotations

import packages

KINDS = packages.ROOT / "studio" / "src" / "plots" / "kinds"
ENDING = ".plot.ts"
FILE = packages.SRC / "deodar_studio" / "catalogue" / "own_plots.txt"


def names() -> str:
    """Return the text of the file: one name in each line."""
    return "".join(f"{path.name.removesuffix(ENDING)}\n" for path in sorted(KINDS.glob(f"*{ENDING}")))


if __name__ == "__main__":
    FILE.write_text(names(), encoding="utf-8", newline="\n")
