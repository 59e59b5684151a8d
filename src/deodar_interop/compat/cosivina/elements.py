"""The element classes of the Python port: labels, parameters in its order, inputs. They compute nothing."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from deodar.errors import ParameterError, UnknownName, did_you_mean
from deodar_interop.importers.cosivina.constructors import CONSTRUCTORS, components


class Element:
    """An element of a simulator.

    Class attributes:
        PARAMETERS: parameters and their defaults, in the order in which the class is called.
        ARGUMENTS: names of arguments that differ from those of their parameters.
        defaultOutputComponent: component that is read where none is named.
    """

    PARAMETERS: ClassVar[Mapping[str, Any]] = {}
    ARGUMENTS: ClassVar[Mapping[str, str]] = {}
    defaultOutputComponent: ClassVar[str] = "output"

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "PARAMETERS" not in vars(cls):  # those of the class of this name in files
            cls.PARAMETERS = CONSTRUCTORS.get(cls.__name__, {})  # pyright: ignore[reportConstantRedefinition]
        kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
        named = [
            inspect.Parameter(cls.ARGUMENTS.get(name, name), kind, default=value)
            for name, value in cls.PARAMETERS.items()
        ]
        cls.__signature__ = inspect.Signature([inspect.Parameter("label", kind), *named])

    def __init__(self, label: str, *values: Any, **named: Any) -> None:
        kind = type(self).__name__
        arguments = {self.ARGUMENTS.get(name, name): name for name in self.PARAMETERS}
        if len(values) > len(arguments):
            raise ParameterError(f"{kind} takes a label and {len(arguments)} values, not {len(values)}")
        given = dict(zip(arguments, values, strict=False))
        for name, value in named.items():
            if name not in arguments or name in given:
                what = f"has two values for {name!r}" if name in given else f"has no argument {name!r}"
                raise UnknownName(f"{kind} {what}", fix=did_you_mean(name, list(arguments)))
            given[name] = value
        self.label = label
        self.inputElementLabels: list[str] = []
        self.inputComponents: list[str] = []
        for argument, name in arguments.items():
            setattr(self, name, given.get(argument, self.PARAMETERS[name]))

    @property
    def kind(self) -> str:
        """The class as files name it."""
        return type(self).__name__

    @property
    def nInputs(self) -> int:
        """The number of inputs."""
        return len(self.inputElementLabels)

    @property
    def values(self) -> dict[str, Any]:
        """The parameters by name."""
        return {name: getattr(self, name) for name in self.parameterList()}

    def addInput(self, inputElementLabel: str, inputComponent: str) -> None:
        """Add an input."""
        self.inputElementLabels.append(inputElementLabel)
        self.inputComponents.append(inputComponent)

    def isParameter(self, name: str) -> bool:
        """Return whether the element has a parameter of that name."""
        return name in self.parameterList()

    def isComponent(self, name: str) -> bool:
        """Return whether the element has a component of that name."""
        return name in components(self.kind)

    def parameterList(self) -> list[str]:
        """Return the names of the parameters."""
        return list(self.PARAMETERS)


class FileElement(Element):
    """An element of a file, of a class that the Python port lacks, with the parameters of the file."""

    def __init__(self, label: str, kind: str, values: Mapping[str, Any]) -> None:
        super().__init__(label)
        self._kind = kind
        self._names = list(values)
        for name, value in values.items():
            setattr(self, name, value)

    @property
    def kind(self) -> str:
        """The class as files name it."""
        return self._kind

    def parameterList(self) -> list[str]:
        """Return the names of the parameters."""
        return self._names


class NeuralField(Element):
    """A dynamic neural field with the logistic sigmoid."""


class GaussStimulus1D(Element):
    """A Gaussian stimulus on a row."""


class GaussStimulus2D(Element):
    """A Gaussian stimulus on a plane."""


class BoostStimulus(Element):
    """A number."""


class CustomStimulus(Element):
    """A stimulus of any shape; it has the size of its pattern."""

    ARGUMENTS = {"pattern": "stimulusPattern"}

    @property
    def size(self) -> tuple[int, int]:
        """The size of the pattern; one of one dimension is a row."""
        shape = np.atleast_2d(np.asarray(self.stimulusPattern)).shape
        return shape[0], shape[1]

    @property
    def stimulusPattern(self) -> Any:
        """The pattern."""
        return getattr(self, "pattern", None)

    def parameterList(self) -> list[str]:
        """Return the names of the parameters."""
        return ["size", "pattern"]


class GaussKernel1D(Element):
    """A convolution of a row with a Gaussian."""


class GaussKernel2D(Element):
    """A convolution of a plane with a Gaussian."""


class MexicanHatKernel1D(Element):
    """A convolution of a row with a difference of Gaussians."""


class MexicanHatKernel2D(Element):
    """A convolution of a plane with a difference of Gaussians."""


class LateralInteractions1D(Element):
    """A convolution of a row with a difference of Gaussians, and a constant."""


class LateralInteractions2D(Element):
    """A convolution of a plane with a difference of Gaussians, and a constant."""


class KernelFFT(Element):
    """A convolution with a difference of Gaussians over the whole input, and a constant."""


class SumInputs(Element):
    """The sum of all inputs."""


class SumDimension(Element):
    """The sum of the input over one dimension or more."""

    PARAMETERS = {**CONSTRUCTORS["SumDimension"], "dimensionOrder": (1, 2)}
    ARGUMENTS = {"size": "outputSize"}


class SumAllDimensions(Element):
    """The sums of a plane along each dimension, and the full sum."""

    ARGUMENTS = {"size": "inputSize"}
    defaultOutputComponent = "fullSum"


class ScaleInput(Element):
    """The input times a factor."""


class NormalNoise(Element):
    """White noise; deodar draws it, so NumPy's random state has no effect."""


class PointwiseProduct(Element):
    """The product of two inputs."""


class Transpose(Element):
    """The transposed input; the size is that of the output."""


class ExpandDimension2D(Element):
    """A row or a column, repeated along the other dimension of a plane."""

    ARGUMENTS = {"size": "outputSize"}


CLASSES: dict[str, type[Element]] = {
    cls.__name__: cls for cls in Element.__subclasses__() if cls is not FileElement
}
"""The classes by name."""
