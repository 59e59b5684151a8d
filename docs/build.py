"""Build the manual: the reference from the code, the pictures from the code on the pages, then the site.

python docs/build.py             everything; the site is written to site/
python docs/build.py --pages     only what is committed: reference and pictures
python docs/build.py --pages spa the pictures of that page alone
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import pages
import reference


def pictures(only: Sequence[str] = ()) -> None:
    """Run every page that shows pictures, or only some by their names, and keep those it shows."""
    kept = pages.DOCS / "pictures"
    kept.mkdir(exist_ok=True)
    for page in pages.pages():
        shown = set(pages.pictures(page))
        if not shown or (only and page.stem not in only):
            continue
        sys.stderr.write(f"running {page.relative_to(pages.ROOT)}\n")
        with tempfile.TemporaryDirectory() as name, pages.quiet():
            folder = Path(name)
            pages.run(page, folder)
            for made in pages.drawn(folder):
                if made.name in shown:
                    shutil.copyfile(made, kept / made.name)


def site() -> int:
    """The site, by zensical."""
    environment = {
        **os.environ,
        # the folder of mathml.py
        "PYTHONPATH": os.pathsep.join(filter(None, [str(pages.DOCS), os.environ.get("PYTHONPATH")])),
    }
    return subprocess.run(
        [sys.executable, "-m", "zensical", "build", "--clean", "--strict"],
        cwd=pages.ROOT,
        env=environment,
        check=False,
    ).returncode


def main() -> int:
    """Status of the site's build."""
    reference.write()
    pictures([word for word in sys.argv[1:] if not word.startswith("-")])
    return 0 if "--pages" in sys.argv[1:] else site()


if __name__ == "__main__":
    sys.exit(main())
