"""What holds a number of cedar: the same for links of parameters and for actions of experiments."""

from __future__ import annotations

import pytest

from deodar.model.document import Document
from deodar_interop.importers.cedar import file, translate
from deodar_interop.importers.cedar.held import TrialParameters, held
from deodar_interop.importers.cedar.parameter_links import linked
from tests.deodar_interop.importers.cedar.models import Many, Model, gauss

DIRECT = "cedar.aux.DirectParameterLink"


def parts(model):
    """Return the steps of a file by path, and the entries of its document by path."""
    root = file.parse(model.text().encode()).root
    entries = translate.read(model.text().encode(), "file.json").model.document.entries
    return {step.path: step for step in root.all_steps()}, {entry.names: entry for entry in entries}


def synapse(**options):
    """Return a file with a field and a connection from it."""
    m = Model()
    m.field("u", (12,), time_scale="0.08 s", global_inhibition=-0.3)
    m.field("node", (), lateral_kernels=Many([gauss(1e-10, [3.0])]))
    m.add("SynapticConnection", "step", {"static gain": {"Synapse Weight": -0.7}, **options})
    m.wire("u.sigmoided activation", "step.matrix")
    return m


@pytest.mark.parametrize(
    ("name", "parameter", "leaf", "sign", "number"),
    [
        ("u", "time scale", "tau", 1, 80),
        ("u", "global inhibition", "global_inhibition", -1, -0.3),
        ("step", "static gain.Synapse Weight", "factor", 1, -0.7),
    ],
)
def test_a_parameter_holds_the_number_with_its_unit_and_sign(name, parameter, leaf, sign, number):
    steps, entries = parts(synapse())
    found = held(steps[name,], entries[name,], parameter)
    assert found is not None
    assert (found.leaf, found.sign, found.value) == (leaf, sign, pytest.approx(number))


def test_a_kernel_without_a_common_cutoff_has_a_reach_on_each_axis():
    m = Model()
    m.field("u", (12, 60), lateral_kernels=Many([gauss(1.0, [0.45, 10.0])]))
    (kernel,) = parts(m)[1]["u",].element.kernel
    assert (kernel.cutoff, kernel.least) == (0, (1, 25))


@pytest.mark.parametrize(
    ("name", "parameter"),
    [
        ("u", "name"),
        ("u", "lateral kernels[0].amplitude"),
        # only the centre of the kernel of a node acts, however small it is
        ("node", "lateral kernels[0].amplitude"),
    ],
)
def test_links_and_experiments_do_not_change_what_is_another_number_here(name, parameter):
    steps, entries = parts(synapse())
    assert held(steps[name,], entries[name,], parameter) is None
    action = {"element path": name, "parameter path": parameter, "parameter value": "1"}
    assert TrialParameters(steps, entries).find(action) is None
    group = file.CedarGroup((), steps={step.path[-1]: step for step in steps.values()})
    ends = {"source element": name, "target element": "u", "target parameter": "resting level"}
    group.links.append({"type": DIRECT, "source parameter": parameter, **ends})
    _, (line,) = linked(Document("links", tuple(entries.values())), group, entries)
    assert (line.verdict, line.why) == ("dropped", "its source has no counterpart here")


def test_the_weight_of_a_connection_that_is_projected_too_is_not_a_parameter_of_its_last_element():
    mapping = {"enabled": True, "dimension mapping": {0: 4294967295}, "output dimensionality": 0}
    steps, entries = parts(synapse(projection=mapping))
    assert held(steps["step",], entries["step",], "static gain.Synapse Weight") is None
