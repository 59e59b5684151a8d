"""Run a file of NIR in norse: `python norse_process.py FILE.nir INPUTS.npz OUT.npz`.

deodar runs this script in a process of its own, with any Python in which norse is installed; it imports
nothing of deodar. INPUTS holds `inputs` (steps x copies x values), `step` (s) and `every` (steps in a
window); OUT receives `sums`, windows x copies x values of the Output.
"""

# pyright: basic, reportMissingImports=false

from __future__ import annotations

import sys

sys.path.pop(0)  # the folder of this script has modules of deodar, with names that others may have too

import numpy as np


def main(file: str, inputs_file: str, out: str) -> None:
    """Run the file and write the sums."""
    # this process alone has them
    import nir
    import norse.torch
    import torch

    torch.set_num_threads(1)
    data = np.load(inputs_file)
    net = norse.torch.from_nir(nir.read(file), dt=float(data["step"]), ignore_warnings=True)
    inputs, every = torch.from_numpy(data["inputs"]), int(data["every"])
    state, sums, total = None, [], 0
    with torch.no_grad():
        for t in range(len(inputs)):
            *found, state = net(inputs[t], state)
            total = total + sum(found)
            if (t + 1) % every == 0:
                sums.append(np.asarray(total))
                total = 0
    np.savez(out, sums=np.stack(sums))


if __name__ == "__main__":
    main(*sys.argv[1:4])
