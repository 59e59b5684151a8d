"""Scripts for cosivina's Python port run with another import line, and agree with the plain simulator."""

from __future__ import annotations

import inspect
import json
import warnings

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DocumentError, ModelError, ParameterError, RunWarning, UnknownName
from deodar_interop.compat import cosivina
from deodar_interop.compat.cosivina import *  # noqa: F403
from deodar_interop.compat.cosivina import (
    BoostStimulus,
    CustomStimulus,
    GaussKernel1D,
    GaussStimulus1D,
    GaussStimulus2D,
    KernelFFT,
    LateralInteractions1D,
    NeuralField,
    NormalNoise,
    ScaleInput,
    Simulator,
    SumAllDimensions,
    SumDimension,
    SumInputs,
    Transpose,
    options,
)
from deodar_interop.compat.cosivina.elements import CLASSES
from tests.deodar_interop.exporters.cosivina.files import elements
from tests.deodar_interop.importers.cosivina.files import SAMPLES, element, text
from tests.deodar_interop.importers.cosivina.oracle import Sim


def coupling(ftr=30, spt=40):
    """Two rows coupled to a plane, as scripts write it."""
    sim = Simulator()
    wide, exc, inh = (ftr, spt), 5, 10
    for k, share in ((1, 1 / 4), (2, 3 / 4)):
        at = round(share * ftr), round(share * spt)
        sim.addElement(GaussStimulus2D(f"stimulus v{k}", wide, exc, exc, 0, *at, 0, 1))
    for name, n in (("s", spt), ("f", ftr)):
        for k, share in ((1, 1 / 4), (2, 3 / 4)):
            sim.addElement(GaussStimulus1D(f"stimulus {name}{k}", (1, n), exc, 0, round(share * n), True))
        sim.addElement(SumInputs(f"stimulus sum {name}", (1, n)), [f"stimulus {name}1", f"stimulus {name}2"])
    sim.addElement(NeuralField("field v", wide, 20, -5, 4), ["stimulus v1", "stimulus v2"])
    sim.addElement(NeuralField("field s", (1, spt), 20, -5, 4), "stimulus sum s")
    sim.addElement(NeuralField("field f", (1, ftr), 20, -5, 4), "stimulus sum f")
    kernel = KernelFFT("v -> v", wide, [exc, exc], 0, [inh, inh], 0, 0, [True, True])
    sim.addElement(kernel, "field v", "output", "field v")
    sim.addElement(SumAllDimensions("sum v", wide), "field v", "output")
    for name, n in (("s", spt), ("f", ftr)):
        lateral = LateralInteractions1D(f"{name} -> {name}", (1, n), exc, 0, inh, 0, 0, True)
        sim.addElement(lateral, f"field {name}", "output", f"field {name}")
    sim.addElement(GaussKernel1D("v -> s", (1, spt), exc, 0, True), "sum v", "verticalSum", "field s")
    sim.addElement(GaussKernel1D("v -> f", (1, ftr), exc, 0, True), "sum v", "horizontalSum", "field f")
    sim.addElement(GaussKernel1D("s -> v", (1, spt), exc, 0, True), "field s", "output", "field v")
    sim.addElement(GaussKernel1D("f -> v", (1, ftr), exc, 0, True), "field f", "output")
    sim.addElement(Transpose("transpose f -> v", (ftr, 1)), "f -> v", "output", "field v")
    for name, size in (("s", (1, spt)), ("f", (1, ftr)), ("v", wide)):
        sim.addElement(NormalNoise(f"noise {name}", size, 0), [], [], f"field {name}")
    return sim


STRENGTHS = {
    ("stimulus v1", "amplitude"): 5,
    ("stimulus s1", "amplitude"): 6,
    ("stimulus s2", "amplitude"): 6.5,
    ("stimulus f1", "amplitude"): 3,
    ("v -> v", "amplitudeExc"): 20,
    ("v -> v", "amplitudeInh"): 10,
    ("v -> v", "amplitudeGlobal"): -0.01,
    ("s -> s", "amplitudeExc"): 15,
    ("s -> s", "amplitudeInh"): 8,
    ("s -> s", "amplitudeGlobal"): -0.3,
    ("f -> f", "amplitudeExc"): 10,
    ("v -> s", "amplitude"): 0.4,
    ("v -> f", "amplitude"): 0.3,
    ("s -> v", "amplitude"): 4,
    ("f -> v", "amplitude"): 3,
}


def three_layers():
    """Two excitatory fields and an inhibitory one, as scripts write it."""
    size = (1, 90)
    sim = Simulator(deltaT=1.0)
    sim.addElement(GaussStimulus1D("stimulus 1", size, 5, 6, round(1 / 4 * size[1]), True, False))
    sim.addElement(GaussStimulus1D("stimulus 2", size, 5, 5, round(3 / 4 * size[1]), True, False))
    sim.addElement(SumInputs("stimulus sum", size), ["stimulus 1", "stimulus 2"])
    sim.addElement(ScaleInput("stimulus scale w", size, 0.5), "stimulus sum")
    sim.addElement(NeuralField("field u", size, 20, -5, 4), "stimulus sum")
    sim.addElement(NeuralField("field v", size, 5, -5, 4))
    sim.addElement(NeuralField("field w", size, 20, -4, 4), "stimulus scale w")
    for a, b, width, amplitude in (
        ("u", "u", 5, 15),
        ("u", "v", 5, 12),
        ("u", "w", 5, 8),
        ("w", "w", 5, 14),
        ("w", "v", 5, 5),
    ):
        kernel = GaussKernel1D(f"{a} -> {b}", size, width, amplitude, True, True)
        sim.addElement(kernel, f"field {a}", "output", f"field {b}")
    sim.addElement(GaussKernel1D("v -> u (local)", size, 10, -10, True, True), "field v", "output", "field u")
    sim.addElement(SumDimension("sum v", np.array([2]), (1, 1), 1), "field v", "output")
    sim.addElement(ScaleInput("v -> u (global)", size, -0.1), "sum v", "output", "field u")
    sim.addElement(ScaleInput("v -> w (global)", size, -0.2), "sum v", "output", "field w")
    sim.addElement(NormalNoise("noise u", size, 0))
    sim.addElement(GaussKernel1D("noise kernel u", size, 0, 2, True, True), "noise u", "output", "field u")
    return sim


def plain_of(sim, tmp_path):
    """Return the plain simulator of the saved settings."""
    sim.saveSettings(tmp_path / "settings.json")
    content = (tmp_path / "settings.json").read_bytes()
    parts = [
        (
            a,
            k,
            p | {key: np.ravel(p[key]) for key in ("sigmaExc", "sigmaInh", "circular") if k == "KernelFFT"},
            i,
        )
        for a, k, p, i in elements(content)
    ]
    return Sim(parts, sim.deltaT, sim.tZero)


def same(sim, plain):
    """Return the largest difference in all components of all elements."""
    far = 0.0
    for label in sim.elementLabels:
        for name, expected in plain.out[label].items():
            if name == "h" or not sim.getElement(label).isComponent(name):
                continue
            component = sim.getComponent(label, name)
            # the plain simulator keeps a number where a size expands it
            assert expected.shape in (component.shape, (1, 1))
            far = max(far, float(abs(component - expected).max()))
    return far


@pytest.mark.parametrize("make", [coupling, three_layers])
def test_a_script_of_the_port_gives_every_component_of_the_plain_simulator(make, tmp_path):
    sim = make()
    if make is coupling:
        labels, names = zip(*STRENGTHS, strict=True)
        sim.setElementParameters(list(labels), list(names), list(STRENGTHS.values()))
    plain = plain_of(sim, tmp_path)
    assert not options.useNumba
    sim.init()
    assert same(sim, plain) < 1e-9
    for _ in range(5):
        sim.step()
        plain.step()
        assert same(sim, plain) < 1e-9
    sim.run(120)
    while plain.t < 120:
        plain.step()
    assert sim.t == 120 and same(sim, plain) < 1e-9
    fields = [label for label in sim.elementLabels if label.startswith("field")]
    assert max(np.ptp(sim.getComponent(f, "activation")) for f in fields) > 5
    sim.run(3, True)
    assert sim.t == 3


@pytest.mark.parametrize(
    "path", [p for p in SAMPLES if p.with_suffix(".npz").exists()][:3], ids=lambda p: p.stem
)
def test_published_settings_run_from_their_file(path):
    with np.load(path.with_suffix(".npz")) as z:
        reference = {tuple(key.split("|")): z[key] for key in z}
    sim = Simulator(file=path)
    sim.run(20, True)
    compared = 0
    for (label, step), expected in reference.items():
        if step == "20":
            assert (
                abs(
                    sim.getComponent(label, "activation")
                    - expected.reshape(sim.getElementParameter(label, "size"))
                ).max()
                < 1e-9
            )
            compared += 1
    assert compared


def test_a_script_that_loads_published_settings_gives_the_activations_of_the_port():
    path = next(p for p in SAMPLES if "Coupling" in p.stem)
    sim = coupling(100, 100)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim.loadSettings(path)
    with np.load(path.with_suffix(".npz")) as z:
        reference = {tuple(key.split("|")): z[key] for key in z}
    for step in (1, 5, 20):
        sim.run(step)
        for label in ("field v", "field s", "field f"):
            assert abs(sim.getComponent(label, "activation") - reference[label, str(step)]).max() < 1e-9


def test_parameters_change_while_it_runs_and_states_stay(tmp_path):
    sim = three_layers()
    plain = plain_of(sim, tmp_path)
    sim.run(30)
    before = sim.getComponent("field u", "activation")
    sim.setElementParameters("field u", ["h", "tau"], [-3.0, 10.0])
    assert sim.t == 30 and np.array_equal(sim.getComponent("field u", "activation"), before)
    assert sim.getElementParameter("field u", "h") == -3
    sim.run(60)
    for _ in range(30):
        plain.step()
    next(p for label, _, p, _ in plain.elements if label == "field u").update(h=-3.0, tau=10.0)
    for _ in range(30):
        plain.step()
    assert same(sim, plain) < 1e-9
    sim.setElementParameters("stimulus 1", "amplitude", 2.5)
    assert sim.getComponent("stimulus 1", "output").max() == pytest.approx(2.5)


def test_elements_are_closed_only_on_request(monkeypatch):
    closed = []
    monkeypatch.setattr(Simulator, "close", lambda sim: closed.append(sim))
    sim = Simulator()
    sim.run(0)
    assert closed == []
    sim.run(0, closeWhenFinished=True)
    assert closed == [sim]


def test_settings_are_loaded_by_label_and_class_without_sizes(tmp_path):
    parts = [
        element("field u", "NeuralField", {"size": [1, 7], "tau": 33, "h": -2, "beta": 1}),
        element("field v", "ScaleInput", {"size": [1, 90], "amplitude": 3}),
        element("elsewhere", "BoostStimulus", {"amplitude": 3}),
    ]
    (tmp_path / "preset.json").write_text(text(parts, dt=2))
    sim = three_layers()
    with pytest.warns(RunWarning) as said:
        assert sim.loadSettings(tmp_path / "preset.json")
    assert "elsewhere" in str(said[0].message) and "field v" in str(said[0].message)
    assert sim.deltaT == 2 and sim.getElementParameter("field u", "tau") == 33
    assert sim.getElementParameter("field u", "size") == (1, 90)
    sim.run(4)
    assert sim.t == 4


def test_saved_settings_build_the_same_simulator(tmp_path):
    sim = three_layers()
    sim.saveSettings(tmp_path / "a.json")
    reopened = Simulator(file=tmp_path / "a.json")
    struct = Simulator(struct=json.loads((tmp_path / "a.json").read_text())["simulator"])
    for s in (sim, reopened, struct):
        s.run(20)
    for s in (reopened, struct):
        assert s.elementLabels == sim.elementLabels and s.nElements == 18
        assert np.array_equal(
            s.getComponent("field w", "activation"), sim.getComponent("field w", "activation")
        )
    assert dd.load(tmp_path / "a.json")["field u"].tau == 20


def test_a_pattern_and_a_number_are_stimuli():
    sim = Simulator()
    sim.addElement(CustomStimulus("p", np.arange(4.0)))
    sim.addElement(BoostStimulus("b", 2))
    sim.addElement(NeuralField("u", (1, 4), 10, 0, 4), ["p", "b"])
    sim.run(1000)
    assert np.allclose(sim.getComponent("u", "activation"), [[2, 3, 4, 5]], atol=1e-9)
    assert sim.getElementParameter("p", "size") == (1, 4)


def test_noise_differs_between_initializations_and_is_the_same_for_a_seed():
    def drawn(seed, count):
        sim = Simulator(seed=seed)
        sim.addElement(NormalNoise("n", (1, 50), 2.0))
        sim.addElement(NeuralField("u", (1, 50)), "n")
        for _ in range(count):
            sim.run(10, True)
        return sim.getComponent("u", "activation")

    assert np.array_equal(drawn(3, 1), drawn(3, 1))
    assert not np.array_equal(drawn(3, 1), drawn(3, 2)) and np.array_equal(drawn(3, 2), drawn(4, 1))


def test_components_are_saved_for_matlab_and_read_again(tmp_path):
    sim = three_layers()
    sim.run(10)
    sim.saveComponentsToMat(tmp_path / "results.mat")
    found = dd.load_mat(tmp_path / "results.mat", '"field u".activation')
    assert np.array_equal(found, sim.getComponent("field u", "activation")[0])


def test_mistakes_say_what_and_where():
    sim = three_layers()
    with pytest.raises(ModelError, match="used already"):
        sim.addElement(NeuralField("field u"))
    with pytest.raises(UnknownName, match="no element has the label 'field U'"):
        sim.addElement(ScaleInput("s", (1, 90), 1), "field U")
    with pytest.raises(UnknownName, match="no component 'outputs'"):
        sim.addConnection("field u", "outputs", "field v")
    with pytest.raises(UnknownName, match="no parameter 'H'"):
        sim.setElementParameters("field u", "H", 3)
    with pytest.raises(ParameterError, match="cannot be changed"):
        sim.setElementParameters("field u", "size", (1, 2))
    with pytest.raises(ParameterError, match="2 names and 1 values"):
        sim.setElementParameters("field u", ["h", "tau"], [1])
    with pytest.raises(ParameterError, match="takes a label and 4 values"):
        NeuralField("u", (1, 1), 1, 2, 3, 4)
    with pytest.raises(UnknownName, match="no argument 'taus'"):
        NeuralField("u", taus=3)
    with pytest.raises(ParameterError, match="changeable"):
        sim.loadSettings("x.json", "some")
    with pytest.raises(DocumentError, match="cannot be read"):
        sim.loadSettings("missing.json")


def test_an_element_without_a_counterpart_is_a_warning(tmp_path):
    (tmp_path / "a.json").write_text(
        text([element("c", "CameraGrabber", {"size": [3, 4], "deviceNumber": 0})])
    )
    sim = Simulator(file=tmp_path / "a.json")
    with pytest.warns(RunWarning, match="reads a camera"):
        sim.init()


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_every_class_is_in_the_namespace_and_is_translated_with_its_defaults(name):
    cls = getattr(cosivina, name)
    assert cls.__doc__ and next(iter(inspect.signature(cls).parameters)) == "label"
    sim = Simulator()
    sim.addElement(cls("it", np.ones((2, 3))) if name == "CustomStimulus" else cls("it"))
    assert all(line.part == "connection" for line in sim.report.losses)
    assert set(cosivina.__all__) >= set(CLASSES) and len(CLASSES) == 20
