"""`dd.draw`: the content of a picture of an architecture, and its files."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.couplings.arithmetic import Product
from deodar.couplings.convolutions import Convolve, Interaction
from deodar.couplings.hebbian import Hebbian
from deodar.couplings.weights import Weights
from deodar.elements.populations import RateNode
from deodar.elements.stimuli import Boost, Pattern
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import DeodarError, ModelError, OutputExists
from deodar.model import edit
from deodar.model.sketch import caption, sketch
from deodar.numerics.kernels.custom import Custom
from deodar.numerics.kernels.separable import MexicanHat

X = dd.Axis("x", 0, 20, samples=21, unit="deg")
SVG = "{http://www.w3.org/2000/svg}"


def texts(diagram):
    return [t.text for t in ET.fromstring(diagram.svg).iter(f"{SVG}text")]


def wires(model):
    by = {box.id: box.name for box in sketch(model.document).items}
    return [(by[w.source], by[w.target], w.sign, w.captions) for w in sketch(model.document).wires]


def pair():
    model = dd.Model("pair")
    a, b = (model.add(dd.Field(name, [X])) for name in "ab")
    return model, a, b


def test_couplings_of_a_connection_are_written_on_it_and_give_its_sign():
    model, a, b = pair()
    a >> dd.Gain(-2.0) >> b
    b >> dd.Gain(-2.0) >> Convolve([dd.Gaussian(-1.0, 3.0)]) >> a
    a >> Convolve([MexicanHat()]) >> a
    assert wires(model) == [
        ("a", "b", "-", ("× −2",)),
        ("b", "a", "+", ("× −2", "gaussian kernel")),
        ("a", "a", "±", ("mexican hat kernel",)),
    ]
    assert [i.name for i in sketch(model.document).items] == ["a", "b"]


def test_a_coupling_with_several_inputs_or_outputs_is_a_box_and_keeps_the_sign():
    model, a, b = pair()
    model.add(RateNode("c"))
    split = model.add(dd.Gain(-1.0, name="split"))
    a >> split
    split >> b
    split >> model["c"]
    product = model.add(Product(name="and"))
    b >> product
    assert wires(model) == [
        ("a", "split", "+", ()),
        ("split", "b", "-", ()),
        ("split", "c", "-", ()),
        ("b", "and", "+", ()),
    ]
    assert {i.name: i.form for i in sketch(model.document).items} == {
        "a": "field",
        "b": "field",
        "c": "node",
        "split": "coupling",
        "and": "coupling",
    }


def test_a_loop_of_couplings_alone_is_drawn():
    model = dd.Model("ring")
    one, two = model.add(dd.Gain(1.0, name="one")), model.add(dd.Gain(1.0, name="two"))
    one >> two
    two >> one
    assert len(sketch(model.document).items) == 2
    assert {(w[0], w[1]) for w in wires(model)} == {("one", "two"), ("two", "one")}
    dd.draw(model)


@pytest.mark.parametrize(
    ("element", "sign"),
    [
        (dd.Gain(0.0), "+"),
        (dd.Gain(-0.5), "-"),
        (Weights(np.eye(21), [X]), "+"),
        (Weights(-np.eye(21), [X]), "-"),
        (Weights(np.eye(21) - 0.1, [X]), "±"),
        (Convolve([dd.Gaussian(1.0, 3.0), dd.Gaussian(-0.5, 6.0)]), "±"),
        (Convolve([Custom([-1.0, -2.0, -1.0], amplitude=-1.0)]), "+"),
        (Interaction([dd.Gaussian(1.0, 3.0)], 0.5), "±"),
        (Boost("b", [X], -3.0), "-"),
        (Pattern("p", [X], -np.ones(21)), "-"),
        (dd.GaussianStimulus("g", [X], amplitude=2.0), "+"),
        (Hebbian([X], name="h"), "+"),
    ],
    ids=lambda v: v if isinstance(v, str) else type(v).__name__,
)
def test_polarity_is_the_sign_of_the_parameters(element, sign):
    assert element.polarity() == sign


def test_interactions_of_a_field_with_itself_are_loops():
    kernel = [dd.Gaussian(2.0, 3.0)]
    assert dict(dd.Field("u", [X], kernel=kernel, global_inhibition=0.3).recurrence()) == {
        "kernel": "+",
        "global inhibition": "-",
    }
    assert dict(dd.Field("u", [X], kernel=[*kernel, dd.Gaussian(-1.0, 6.0)]).recurrence()) == {"kernel": "±"}
    assert dict(dd.Field("u", []).recurrence()) == {} and dict(
        RateNode("n", self_excitation=2.0).recurrence()
    ) == {"self-excitation": "+"}
    model = dd.Model("m")
    model.add(dd.Field("u", [X], kernel=kernel, global_inhibition=0.3))
    assert texts(dd.draw(model)) == ["u", "x: 0 … 20 deg", "excitation", "inhibition"]
    assert texts(dd.draw(model, legend=False)) == ["u", "x: 0 … 20 deg"]


def test_a_picture_names_axes_groups_templates_ports_sensors_and_motors():
    model = dd.Model("all")
    ring = dd.Axis("phi", -180, 180, 36, periodic=True, unit="deg")
    u = model.add(dd.Field("u", [ring]), group="arm.reach", ticks=3)
    model.add(Sensor("eye", [ring])) >> u
    u["activation"] >> dd.Project([]) >> model.add(Motor("wheel"))
    part = dd.Model("part")
    part.add(dd.Field("v"))
    model.insert(part, "left", link=True)
    drawn = texts(dd.draw(model))
    assert {
        "u",
        "phi: −180 … 180 deg, periodic",
        "every 3 steps",
        "arm",
        "reach",
        "eye",
        "wheel",
        "activation",
    } <= set(drawn)
    assert "left (linked to part)" in drawn and "project integral" in drawn
    forms = {i.name: i.form for i in sketch(model.document).items}
    assert forms == {"u": "field", "eye": "sensor", "wheel": "motor", "v": "node"}


def test_a_stimulus_omits_the_axes_of_its_target_and_has_no_sign_towards_a_product():
    model, a, _ = pair()
    model.add(dd.GaussianStimulus("s", [X], amplitude=-1.0)) >> a
    code = model.add(Product(name="and"))
    model.add(Boost("place", [X], -3.0)) >> code
    assert texts(dd.draw(model)).count("x: 0 … 20 deg") == 3, (
        "the two fields, and the boost whose target has no axes of its own"
    )
    assert wires(model) == [("s", "a", "-", ()), ("place", "and", "+", ())]


def test_names_may_contain_any_text():
    name = '<script>alert("x")</script> & ]]> \' \x07'
    model = dd.Model(name)
    u = model.add(dd.Field(name, [dd.Axis(name, 0, 1, 3, unit="<b>")]), group="<i>")
    u >> dd.Gain(2.0, name="</text><script>") >> u
    for content in (dd.draw(model).svg, model._repr_html_()):
        assert (
            "<script>" not in content
            and "<i>" not in content
            and "<b>" not in content.replace("<b>Model", "")
        )
    root = ET.fromstring(dd.draw(model).svg)
    assert any("alert" in (t.text or "") for t in root.iter(f"{SVG}title"))
    assert {e.tag.removeprefix(SVG) for e in root.iter()} == {"svg", "title", "g", "path", "text"}


def test_a_model_with_problems_and_an_empty_one_are_drawn():
    model, a, _ = pair()
    a >> model.add(dd.Field("other", [dd.Axis("y", 0, 1, 3)]))
    assert model.check() and "other" in texts(dd.draw(model))
    assert dd.draw(dd.Model("empty")).size[0] > 0
    with pytest.raises(ModelError, match="expected a Model, got 5"):
        dd.draw(5)  # type: ignore[arg-type]


def test_the_studio_layout_is_used():
    model, _, _ = pair()
    ids = {e.names[-1]: e.id for e in model.document.entries}
    placed = edit.arrange(
        model.document, {"boxes": {ids["a"]: {"x": 400, "y": 0}, ids["b"]: {"x": 0, "y": 200}}}
    )
    assert sketch(placed).places == {ids["a"]: (400.0, 0.0), ids["b"]: (0.0, 200.0)}
    broken = edit.arrange(
        model.document, {"boxes": {ids["a"]: {"x": "far", "y": 0}, ids["b"]: 3, "gone": {"x": 0, "y": 0}}}
    )
    assert sketch(broken).places == {}


def test_a_notebook_shows_the_picture():
    model, a, b = pair()
    a >> b
    assert dd.draw(model)._repr_svg_() == dd.draw(model).svg
    page = model._repr_html_()
    assert dd.draw(model, legend=False).inside(10**6) in page and "<summary>2 elements</summary>" in page
    assert dd.draw(model).inside(100) == "", "too large"
    assert repr(dd.draw(model)).startswith("<Diagram of 'pair', ")


def test_pictures_are_saved_as_svg_pdf_and_png(tmp_path):
    model, a, b = pair()
    a >> dd.Gain(2) >> b
    drawing = dd.draw(model)
    for name in ("a.svg", "a.pdf", "a.PNG"):
        drawing.save(tmp_path / name)
        drawing.save(tmp_path / f"again-{name}", width=3.5)
    assert (tmp_path / "a.svg").read_text(encoding="utf-8") == drawing.svg == dd.draw(model).svg
    assert ET.parse(tmp_path / "again-a.svg").getroot().get("width") == "252pt"
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    with Image.open(tmp_path / "again-a.PNG") as picture:
        assert picture.size[0] == 1050
        assert len(set(picture.convert("L").resize((60, 20)).tobytes())) > 20, "something is drawn"
    assert drawing.figure(7.0).get_size_inches() == pytest.approx(
        [7.0, 7.0 * drawing.size[1] / drawing.size[0]]
    )
    with pytest.raises(OutputExists):
        drawing.save(tmp_path / "a.svg")
    drawing.save(tmp_path / "a.svg", force=True)
    for name, options, problem in (
        ("a.gif", {}, "no format of pictures"),
        ("b.svg", {"width": 0}, "width is 0 inches"),
    ):
        with pytest.raises(DeodarError, match=problem):
            drawing.save(tmp_path / name, **options)
        assert not (tmp_path / name).exists()


def test_captions_are_short():
    from deodar.couplings.convolutions import Shift

    assert caption(Shift((2.0, -1.5))) == "shift 2, −1.5" and caption(dd.Project([X])) == "project integral"
