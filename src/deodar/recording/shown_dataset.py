"""A Dataset that shows itself in a few lines in a notebook, without all of its attributes."""

from __future__ import annotations

from typing import Any, Self

import xarray

from deodar.summary import Summary, counted


class ShownDataset(xarray.Dataset):
    """A Dataset whose lines in a notebook are its dimensions and variables.

    xarray writes 20 kB of style and every attribute, the whole document among them, into each output.
    """

    __slots__ = ()

    @classmethod
    def of(cls, record: xarray.Dataset) -> Self:
        """Return a Dataset as one of this kind; arrays that are not read yet stay so."""
        variables: dict[Any, Any] = {name: record.variables[name] for name in record.data_vars}
        shown_record = cls(variables, record.coords, record.attrs)
        shown_record.encoding = record.encoding
        shown_record.set_close(record.close)
        return shown_record

    def _summary(self) -> Summary:
        rows = [(str(name), _span(self, name)) for name in self.sizes]
        rows += [
            (str(name), " x ".join(map(str, variable.dims)) or f"{variable.values:.6g}")
            for name, variable in self.data_vars.items()
        ]
        title = f"Record {str(self.attrs.get('title', ''))!r}: {counted(len(self.data_vars), 'variable')}"
        return Summary(title, rows)

    def _repr_html_(self) -> str:
        return self._summary().html()


def _span(record: xarray.Dataset, name: Any) -> str:
    """Return the range and the length of a dimension."""
    n = record.sizes[name]
    if not n or name not in record.coords or record[name].dtype.kind not in "fiu":
        return counted(n, "value")
    values, unit = record[name].values, record[name].attrs.get("units", "")
    return f"{values[0]:.6g} to {values[-1]:.6g}{f' {unit}' if unit else ''}, {counted(n, 'value')}"
