"""A map of regimes: its labels, how it was measured, and its file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar import codec
from deodar.analysis.maps.labels import WORDS
from deodar.analysis.maps.request import MapRequest
from deodar.analysis.saved import SavedAnalysis
from deodar.codec import JsonObject
from deodar.compiler import device as devices
from deodar.errors import RecordError
from deodar.model import find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.summary import Summarised, Summary

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class RegimeMap(Summarised, SavedAnalysis):
    """What a field does with its input, in each cell of a grid over two parameters.

    Attributes:
        parameters: paths of both parameters.
        values: values of each.
        labels: one byte for each cell, (values of the first, values of the second): an index of `words`.
        computed: whether each cell was computed, or filled because all its neighbours agree.
        at: values of the parameters in the model itself.
        about: how it was measured: `field`, `strength`, `sigma`, `center`, `places` of two inputs, `limit`,
            `dt`, `precision`, `inputs` that were kept.
        provenance: the document, and the versions and the machine that made the map.
    """

    KIND = "regime_map"
    PHRASE = "a map of regimes"

    parameters: tuple[str, str]
    values: tuple[np.ndarray, np.ndarray]
    labels: np.ndarray
    computed: np.ndarray
    at: tuple[float, float]
    about: Mapping[str, Any]
    provenance: Mapping[str, Any]

    @classmethod
    def of(cls, model: Model, request: MapRequest, labels: np.ndarray, computed: np.ndarray) -> RegimeMap:
        """Return the result of a request."""
        # start-up time: this brings xarray
        from deodar.recording import provenance

        isolated, doc = request.isolated, model.document
        settings: dict[str, Any] = {
            "field": isolated.path,
            "strength": request.strength,
            "sigma": list(isolated.sigma),
            "center": list(isolated.center),
            "places": [[at] for at in request.places],
            "limit": request.limit,
            "tolerance": request.tolerance,
            "dt": isolated.session.dt,
            "precision": isolated.session.precision,
            "inputs": list(isolated.background),
        }
        made_by = provenance.made_by(devices.find(), isolated.session.precision)
        stored_provenance = {**provenance.stored(doc), "made_by": made_by}
        first, second = (float(np.ravel(find.value(doc, path))[0]) for path in request.paths)
        return cls(
            request.paths, request.values, labels, computed, (first, second), settings, stored_provenance
        )

    @property
    def document(self) -> Document:
        """The document that was mapped."""
        # start-up time: this brings xarray
        from deodar.recording import provenance

        return provenance.document(self.provenance)

    @property
    def words(self) -> np.ndarray:
        """The regime of each cell in words."""
        return np.array(WORDS)[self.labels]

    @property
    def shares(self) -> dict[str, float]:
        """The share of each label that occurs, the most frequent first."""
        counts = np.bincount(self.labels.ravel(), minlength=len(WORDS))
        order = [int(k) for k in np.argsort(-counts, kind="stable") if counts[k]]
        return {WORDS[k]: float(counts[k] / counts.sum()) for k in order}

    def word(self, first: float, second: float) -> str:
        """Return the regime of the cell nearest to two values of the parameters."""
        i, j = (int(np.abs(v - x).argmin()) for v, x in zip(self.values, (first, second), strict=True))
        return WORDS[int(self.labels[i, j])]

    def data(self) -> JsonObject:
        """Return the map as plain data, for JSON."""
        return {
            "parameters": list(self.parameters),
            "values": [values.tolist() for values in self.values],
            "at": list(self.at),
            "words": list(WORDS),
            "labels": self.labels.tolist(),
            "shares": dict(self.shares),
            "computed": int(self.computed.sum()),
            **dict(self.about),
        }

    def dataset(self) -> xarray.Dataset:
        """Return the map as a Dataset, with labels as flags of the CF conventions."""
        # start-up time: this brings xarray
        import xarray

        from deodar.recording.provenance import KEY

        meanings = " ".join(word.replace(" ", "_") for word in WORDS)
        flags = {"flag_values": list(range(len(WORDS))), "flag_meanings": meanings}
        name = {"long_name": f"regime of {self.about['field']}"}
        settings = {**self.about, "at": list(self.at), "words": list(WORDS)}
        return xarray.Dataset(
            {
                self.KIND: (self.parameters, self.labels, name | flags),
                "computed": (self.parameters, self.computed),
            },
            dict(zip(self.parameters, self.values, strict=True)),
            {KEY: codec.line({**self.provenance, self.KIND: settings})},
        )

    @classmethod
    def of_record(cls, record: xarray.Dataset, provenance: Mapping[str, Any]) -> RegimeMap:
        stored_provenance, settings = dict(provenance), dict(provenance[cls.KIND])
        del stored_provenance[cls.KIND]
        first, second = (str(name) for name in record[cls.KIND].dims)
        if settings.pop("words") != list(WORDS):
            raise RecordError("has labels of another version of deodar")
        at = settings.pop("at")
        values = record[first].values, record[second].values
        for name, points in zip((first, second), values, strict=True):
            if not np.isfinite(points).all():
                raise RecordError(f"is damaged: the values of {name} are not all finite numbers")
        return cls(
            (first, second),
            values,
            record[cls.KIND].values,
            record["computed"].values,
            (at[0], at[1]),
            settings,
            stored_provenance,
        )

    def _summary(self) -> Summary:
        (a, b), (n, m) = self.parameters, self.labels.shape
        shares = [(f"{share:6.1%}", word) for word, share in self.shares.items()]
        return Summary(f"RegimeMap of {self.about['field']}: {n} x {m} cells over {a} and {b}", shares)
