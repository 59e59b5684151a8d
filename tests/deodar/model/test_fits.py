"""What a port can be connected with agrees with the problems of the connected document."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DeodarError, UnknownName
from deodar.model import building, edit, find, fits
from deodar.model.building import Around
from deodar.model.check import problems
from deodar.model.document import Document, Entry
from deodar.model.model import Model
from deodar.model.resolve import misfit
from deodar.numerics.axes import Axes

EXAMPLES = Path(__file__).parents[3] / "examples"
X, Y, HALF = (
    dd.Axis("x", 0, 100, samples=101),
    dd.Axis("y", 0, 100, samples=51),
    dd.Axis("x", 0, 50, samples=51),
)
HUE, SUM = dd.Axis("hue", 0, 360, samples=36, periodic=True), dd.Axis("sum", 0, 200, samples=151)


def test_axes_fit_only_if_each_of_the_same_name_does() -> None:
    assert misfit((X, Y), (X, dd.Axis("y", 0, 50, samples=51))) == "bounds, unit or periodicity of 'y' differ"
    assert misfit((X, Y), (Y, X)) == ""


def name(axis: dd.Axis) -> str:
    return axis.name


def connected(doc: Document, source: Entry, port: str, fit: fits.Fit) -> bool:
    """Return whether a connection is accepted and brings no new problem."""
    try:
        new = edit.connect(doc, source, port, doc.by_id()[fit.element], fit.port)
    except DeodarError:
        return False
    return not [p for p in problems(new) if p not in problems(doc)]


def every_port(doc: Document) -> Iterator[tuple[Entry, str]]:
    for e in doc.entries:
        for port in find.outputs(e):
            yield e, port


@pytest.mark.parametrize("example", ["binding", "saliency", "selection", "serial_order", "remapping"])
def test_a_port_fits_where_the_connected_document_has_no_new_problem(example: str) -> None:
    doc = dd.load(EXAMPLES / f"{example}.json").document
    judged = [
        (fit, connected(doc, e, port, fit))
        for e, port in list(every_port(doc))[::-3]
        for fit in fits.fits(doc, e.id, port)[0]
    ]
    assert [fit for fit, fine in judged if fit.fits != fine] == []
    assert {fit.fits for fit, _ in judged} == {True, False}
    assert all(fit.reason for fit, _ in judged if not fit.fits)


def test_a_state_beside_a_direct_output_does_not_fit_the_inputs_that_give_its_axes() -> None:
    model = Model("loop")
    weights = model.add(dd.Hebbian([X], name="weights"))
    model.add(dd.Field("u", [X])) >> weights
    doc = model.document
    entry = next(e for e in doc.entries if e.path == "weights")
    loops = [fit for fit in fits.fits(doc, entry.id, "weights")[0] if fit.element == entry.id]
    assert "input" in [fit.port for fit in loops]
    for fit in loops:
        assert fit.fits == connected(doc, entry, "weights", fit)


def test_sources_of_an_input_agree_with_targets_of_an_output() -> None:
    doc, judged = dd.load(EXAMPLES / "binding.json").document, 0
    for target in doc.entries[::4]:
        for port in target.element.ports():
            for source in fits.fits(doc, target.id, port)[0]:
                back = fits.fits(doc, source.element, source.port)[0]
                fit = next(f for f in back if (f.element, f.port) == (target.id, port))
                assert (fit.fits, fit.reason, fit.offers) == (source.fits, source.reason, source.offers)
                judged += 1
    assert judged > 50


@pytest.mark.parametrize(
    ("axes", "want", "kind", "values"),
    [
        ((X,), (dd.Axis("d", 0, 100, samples=51),), "Project", {"axes": ["d"], "rename": {"x": "d"}}),
        ((X,), (HALF,), "Resample", {"axes": ["x"]}),
        ((X,), (HUE,), "Weights", {"axes": ["hue"]}),
        ((X, Y), (SUM,), "DiagonalSum", {"axes": ["sum"]}),
        ((SUM,), (X, Y), "DiagonalExpansion", {"axes": ["x", "y"]}),
        ((X,), (), "PeakPosition", {}),
    ],
)
def test_the_first_offer_keeps_positions(
    axes: Axes, want: Axes, kind: str, values: dict[str, object]
) -> None:
    first = fits.offers(axes, want, name)[0]
    assert (first.kind, dict(first.values), first.note) == (kind, values, "")


def test_every_offer_makes_a_document_without_problems() -> None:
    for want in ((dd.Axis("d", 0, 100, samples=51),), (HALF,), (HUE,), (X, HUE)):
        model = Model("m")
        u = model.add(dd.Field("u", [X]))
        v = model.add(dd.Field("v", list(want)))
        fit = next(f for f in fits.fits(model.document, u.id, "")[0] if f.element == v.id)
        assert fit.fits == (want == (X, HUE))
        for offer in fit.offers:
            around = Around(source=(u.id, "output"), target=(v.id, "input"))
            doc, _ = building.add(model.document, offer.kind, offer.values, around=around)
            assert problems(doc) == [], offer


def test_an_offer_that_loses_positions_says_so_and_comes_last() -> None:
    *_, last = fits.offers((X,), (HUE,), name)
    assert last.kind == "Project" and "integral over x" in last.note


def test_a_connection_that_changes_values_says_how() -> None:
    model = Model("m")
    u = model.add(dd.Field("u", [X, Y]))
    v = model.add(dd.Field("v", [X]))
    n = model.add(dd.Field("n"))
    w = model.add(dd.Field("w", [dd.Axis("x", 0, 100, samples=51)]))
    reasons = {f.element: f.reason for f in fits.fits(model.document, u.id, "activation")[0]}
    assert reasons[v.id] == "the integral over y" and reasons[n.id] == "the integral over x, y"
    reasons = {f.element: f.reason for f in fits.fits(model.document, v.id, "output")[0]}
    assert reasons[u.id] == "the same value everywhere along y"
    assert reasons[w.id] == "101 samples of x become 51"


def test_a_loop_without_a_state_is_refused() -> None:
    model = Model("m")
    u = model.add(dd.Field("u", [X]))
    a, b = model.add(dd.Gain(name="a")), model.add(dd.Gain(name="b"))
    u >> a >> b >> u
    by_element = {f.element: f for f in fits.fits(model.document, b.id, "output")[0]}
    assert "loop without a state" in by_element[a.id].reason and "loop" in by_element[b.id].reason
    assert by_element[u.id].reason == "they are connected already"


def test_a_connection_that_does_not_fit_offers_couplings_in_its_place() -> None:
    model = Model("m")
    u, v = model.add(dd.Field("u", [X])), model.add(dd.Field("v", [dd.Axis("x", 0, 50, samples=51)]))
    u >> v >> u
    (fit,) = (f for f in fits.fits(model.document, u.id, "output")[0] if f.element == v.id)
    assert fit.reason == "they are connected already" and not fit.fits
    assert "Resample" in {offer.kind for offer in fit.offers}


def test_unconnected_couplings_fit_everything() -> None:
    model = Model("m")
    u = model.add(dd.Field("u", [X]))
    g = model.add(dd.Gain(name="g"))
    by_element = {f.element: f for f in fits.fits(model.document, u.id, "")[0]}
    assert by_element[g.id].fits
    assert {f.element: f.fits for f in fits.fits(model.document, g.id, "output")[0]}[u.id]


@pytest.mark.parametrize("axes", [(), (X,), (X, Y), (HUE,)])
def test_kinds_that_fit_make_documents_whose_new_connection_has_no_problem(axes: Axes) -> None:
    model = Model("m")
    u = model.add(dd.Field("u", list(axes)))
    after, before = fits.fits(model.document, u.id, "output")[1], fits.fits(model.document, u.id, "input")[1]
    assert {"Field", "Gain"} <= {k.kind for k in after} and {"Field", "Boost"} <= {k.kind for k in before}
    for kinds, source in ((after, True), (before, False)):
        for k in kinds:
            end = (u.id, "")
            around = Around(source=end) if source else Around(target=end)
            doc, (new,) = building.add(model.document, k.kind, {}, around=around)
            misfits = [p for p in problems(doc) if "does not fit" in p.what]
            assert misfits == [], (k, doc.by_id()[new])


def test_an_unknown_element_or_port_is_an_error() -> None:
    doc = edit.add(Document("m"), dd.Field("u", [X]))[0]
    with pytest.raises(UnknownName):
        fits.fits(doc, "00000000", "")
    with pytest.raises(UnknownName, match="no port"):
        fits.fits(doc, doc.entries[0].id, "outptu")
