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
    def of(cls, data: xarray.Dataset) -> Self:
        """Return a Dataset as one of this kind; arrays that are not read yet stay so."""
        variables: dict[Any, Any] = {name: data.variables[name] for name in data.data_vars}
        made = cls(variables, data.coords, data.attrs)
        made.encoding = data.encoding
        made.set_close(data.close)
        return made

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


def _span(data: xarray.Dataset, name: Any) -> str:
    """Return the range and the length of a dimension."""
    n = data.sizes[name]
    if not n or name not in data.coords or data[name].dtype.kind not in "fiu":
        return counted(n, "value")
    values, unit = data[name].values, data[name].attrs.get("units", "")
    return f"{values[0]:.6g} to {values[-1]:.6g}{f' {unit}' if unit else ''}, {counted(n, 'value')}"
