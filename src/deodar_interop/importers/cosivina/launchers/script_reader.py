"""The reading of a script: its assignments and calls build simulators and windows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import PureWindowsPath
from typing import Any, cast

import numpy as np

from deodar.errors import DeodarError
from deodar.importers._beside import Beside, is_plain
from deodar.importers.report import Line
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.constructors import CONSTRUCTORS
from deodar_interop.importers.cosivina.launchers import blocks, builders, matlab_values
from deodar_interop.importers.cosivina.launchers.builders import SIMULATOR_METHODS, WINDOW_METHODS, known
from deodar_interop.importers.cosivina.launchers.evaluate import FAILURES, Budget, Evaluator, Exhausted
from deodar_interop.importers.cosivina.launchers.expressions import NotRead, expression
from deodar_interop.importers.cosivina.launchers.matlab_functions import FUNCTIONS, RANDOM
from deodar_interop.importers.cosivina.launchers.objects import (
    BuiltElement,
    BuiltSimulator,
    BuiltWindow,
    ClassCall,
    MissingValue,
)
from deodar_interop.importers.cosivina.launchers.tokens import Token
from deodar_interop.importers.cosivina.launchers.tree import (
    Attempt,
    IndexNode,
    Jump,
    MemberNode,
    NameNode,
    Plain,
    ScriptBody,
    ScriptChoice,
    ScriptFunction,
    ScriptLoop,
    ScriptNode,
    ScriptRepetition,
    ScriptStep,
    Switch,
    Unread,
)

QUIET = frozenset(
    (
        *("addpath", "clc", "clear", "clearvars", "close", "disp", "display", "drawnow", "figure", "format"),
        *("fprintf", "hold", "more", "pause", "rng", "tic", "toc", "warning"),
    )
)
"""Functions that change nothing of a model, wherever they are called."""

BUILDING = frozenset(("addElement", "addConnection", "addControl", "Simulator", "StandardGUI"))
"""Calls that build a model."""

RUNNING = frozenset(("step", "run", "stepWithTimer", "runWithTimer"))
"""Methods that run a model."""

MOST_REPEATED = 5000
"""Most rounds of a `while` loop."""

DEEPEST_CALL = 8
"""Largest depth of functions and scripts that call one another."""

MOST_LINES = 500
"""Most reports of statements that are not read."""


class _Jumped(Exception):
    """Raised by `break`, `continue` and `return`."""


class ScriptReader:
    """The state of the reading of a script.

    Args:
        beside: reads files of the script's folder.

    Attributes:
        line: the line of the present statement.
        lines: report lines so far.
        simulators, windows: what was built, in its order.
    """

    def __init__(self, beside: Beside) -> None:
        self.beside = beside
        self.line = 0
        self.lines: list[Line] = []
        self.simulators: list[BuiltSimulator] = []
        self.windows: list[BuiltWindow] = []
        self._budget = Budget()
        self._functions: dict[str, ScriptFunction] = {}
        self._file = ""
        self._depth = 0
        self._reported: set[tuple[str, int, str]] = set()
        self._files: dict[str, file.Simulator] = {}
        self._scripts: dict[str, blocks.Script | None] = {}

    def read(self, text: str) -> None:
        """Read a script.

        Raises:
            DocumentError: the script is too long or nested too deeply.
        """
        script = blocks.script(text)
        self._functions.update(script.functions)
        scope: dict[str, Any] = {}
        try:
            if not script.body and script.functions:
                self._call_function(next(iter(script.functions.values())), [])
            else:
                self._body(script.body, scope)
        except _Jumped:
            pass
        except Exhausted as error:
            self.say(f"the script takes {error}; the rest of it is not read")

    def say(self, why: str) -> None:
        """Report that something of the present statement is not read."""
        key = (self._file, self.line, why)
        if key not in self._reported and len(self._reported) < MOST_LINES:
            self._reported.add(key)
            where = f"line {self.line}" + (f" of {self._file}" if self._file else "")
            self.lines.append(Line("", "statement", where, "dropped", why))

    # --------------------------------------------------------------------------------------------- statements

    def _body(self, body: ScriptBody, scope: dict[str, Any]) -> None:
        for step in body:
            self._budget.step()
            self.line = step.line
            try:
                self._step(step, scope)
            except NotRead as error:
                self.say(str(error))

    def _step(self, step: ScriptStep, scope: dict[str, Any]) -> None:
        match step:
            case Plain():
                self._plain(step.tokens, scope)
            case ScriptLoop():
                self._loop(step, scope)
            case ScriptRepetition():
                self._repeat(step, scope)
            case ScriptChoice():
                self._choose(step, scope)
            case Switch():
                self._switch(step, scope)
            case Attempt():
                self._body(step.body, scope)
            case Jump():
                raise _Jumped(step.word)
            case Unread():
                self.say(step.why)

    def _plain(self, tokens: tuple[Token, ...], scope: dict[str, Any]) -> None:
        first = tokens[0]
        if _is_command(tokens, scope):
            if first.value not in QUIET:
                raise NotRead(f"the command {first.value!r} is not read")
            return
        split = _assignment(tokens)
        if split is None:
            node = expression(tokens)
            called = _called(node)
            if called in QUIET | RANDOM and called not in scope:  # a seed, for example
                return
            self._evaluator(scope).value(node) if not self._is_script(node, scope) else None
            return
        self._assign(tokens[:split], tokens[split + 1 :], scope)

    def _evaluator(self, scope: dict[str, Any]) -> Evaluator:
        return Evaluator(scope, self, self._budget)

    def _is_script(self, node: ScriptNode, scope: dict[str, Any]) -> bool:
        """Read the script of a file beside this one, if the statement is its name."""
        name = _called(node)
        if not name or name in scope or name in FUNCTIONS or isinstance(node, MemberNode):
            return False
        if name in self._functions or (isinstance(node, IndexNode) and node.arguments):
            return False
        script = self._script_beside(name)
        if script is None or not script.body:
            return False
        self._inside(name, lambda: self._body(script.body, scope))
        return True

    def _script_beside(self, name: str) -> blocks.Script | None:
        """Return the script of a file NAME.m beside this one; its functions can be called from now on."""
        if name in self._scripts:
            return self._scripts[name]
        self._scripts[name] = None
        try:
            content = self.beside(f"{name}.m") if is_plain(f"{name}.m") else None
        except DeodarError:
            return None  # no folder, or a file that cannot be read
        if content is None:
            return None
        try:
            script = blocks.script(decoded(content))
        except DeodarError as error:
            raise NotRead(f"{name}.m {error.problems[0].what}") from None
        for function in script.functions.values():
            self._functions.setdefault(function.name, function)
        self._scripts[name] = script
        return script

    def _inside(self, name: str, run: Callable[[], None]) -> None:
        """Read something of another file; what is reported names it."""
        if self._depth >= DEEPEST_CALL:
            raise NotRead(f"scripts and functions call one another more than {DEEPEST_CALL} deep")
        outer, line = self._file, self.line
        self._file, self._depth = f"{name}.m", self._depth + 1
        try:
            run()
        except _Jumped:
            pass
        finally:
            self._file, self.line, self._depth = outer, line, self._depth - 1

    # -------------------------------------------------------------------------------------------- assignments

    def _assign(self, left: tuple[Token, ...], right: tuple[Token, ...], scope: dict[str, Any]) -> None:
        if left and left[0].value == "[" and left[-1].value == "]":
            names = [t.value for t in left[1:-1] if t.form == "name"]
            try:
                values = self._several(right, scope, len(names))
            except NotRead as error:
                scope.update({name: MissingValue(str(error)) for name in names})
                raise
            scope.update(zip(names, values, strict=False))
            return
        target = expression(left)
        try:
            value = self._evaluator(scope).value(expression(right))
        except NotRead as error:
            name = _root(target)
            if isinstance(target, NameNode) or (isinstance(target, IndexNode) and name not in scope):
                scope[name] = MissingValue(
                    f"{name!r} is not known: {error}" if "is not known" not in str(error) else str(error)
                )
            raise
        if value is None:
            raise NotRead("the call has no result")
        self._put(target, value, scope)

    def _several(self, tokens: tuple[Token, ...], scope: dict[str, Any], count: int) -> list[Any]:
        """Return the results of a function with several ones."""
        node = expression(tokens)
        if isinstance(node, IndexNode) and isinstance(node.target, NameNode):
            name = node.target.name
            if name == "deal" and name not in scope:
                values = self._evaluator(scope).arguments(node.arguments)
                return values * count if len(values) == 1 else values
            if name == "size" and name not in scope and len(node.arguments) == 1:
                size = self._evaluator(scope).value(node)
                sizes = [matlab_values.number(v) for v in size.reshape(-1)]
                return sizes[:count] + [matlab_values.number(1)] * (count - len(sizes))
            function = self._function(name)
            if function is not None and name not in scope:
                return self._call_function(function, self._evaluator(scope).arguments(node.arguments))
        raise NotRead("a function with several results is not read")

    def _put(self, target: ScriptNode, value: Any, scope: dict[str, Any]) -> None:
        """Give a value to a variable, an entry of an array, a field of a structure or a property."""
        if isinstance(target, NameNode):
            scope[target.name] = value
            return
        if isinstance(target, MemberNode):
            holder = self._holder(target.target, scope)
            if isinstance(holder, dict):
                cast("dict[str, Any]", holder)[target.name] = value
            else:
                self._set_property(holder, target.name, value)
            return
        if isinstance(target, IndexNode):
            old = self._old(target.target, scope)
            if old is not None and not isinstance(old, np.ndarray):
                raise NotRead(f"{matlab_values.described(old)} has no entries")
            if target.braces:
                value = matlab_values.cells([value])
                old = np.empty((0, 0), dtype=object) if old is None else old
            if not isinstance(value, np.ndarray):
                raise NotRead("an entry of an array is a number, a text or a cell")
            evaluator = self._evaluator(scope)
            indices = evaluator.indices(np.zeros((0, 0)) if old is None else old, target.arguments)
            try:
                if old is not None and not target.braces and value.shape == (0, 0):
                    new = matlab_values.without(old, indices)
                else:
                    new = matlab_values.put_at(old, indices, value)
            except FAILURES as error:
                raise NotRead(f"it cannot be computed ({error})") from None
            self._put(target.target, self._budget.made(new), scope)
            return
        raise NotRead("nothing that can have a value is on the left")

    def _old(self, node: ScriptNode, scope: dict[str, Any]) -> Any:
        """Return the present value of a variable or a field, or None."""
        if isinstance(node, NameNode):
            return scope.get(node.name)
        if isinstance(node, MemberNode):
            holder = self._holder(node.target, scope)
            if isinstance(holder, dict):
                return cast("dict[str, Any]", holder).get(node.name)
        return self._evaluator(scope).value(node)

    def _holder(self, node: ScriptNode, scope: dict[str, Any]) -> Any:
        """Return the structure or the object of a member; a new structure is made for an unknown name."""
        if isinstance(node, NameNode) and node.name not in scope:
            scope[node.name] = dict[str, Any]()
        if isinstance(node, MemberNode):
            holder = self._holder(node.target, scope)
            if isinstance(holder, dict):
                return cast("dict[str, Any]", holder).setdefault(node.name, dict[str, Any]())
        return self._evaluator(scope).value(node)

    def _set_property(self, holder: Any, name: str, value: Any) -> None:
        if isinstance(holder, BuiltSimulator):
            if name == "deltaT":
                holder.step = matlab_values.real(value)
            elif name == "tZero":
                holder.start = matlab_values.real(value)
            elif name != "t":
                raise NotRead(f"the property {name!r} of a simulator is not read")
        elif isinstance(holder, BuiltElement):
            builders.set_parameter(self, holder, name, value)
        elif not isinstance(holder, BuiltWindow):
            raise NotRead(f"the property {name!r} of {matlab_values.described(holder)} is not read")

    # ------------------------------------------------------------------------------------------------- blocks

    def _loop(self, loop: ScriptLoop, scope: dict[str, Any]) -> None:
        if _runs(loop.body) and not self._builds(loop.body, scope):
            raise NotRead("the loop runs the simulation")
        head = loop.head
        if len(head) > 2 and head[0].value == "(" and head[-1].value == ")":
            head = head[1:-1]
        if len(head) < 3 or head[0].form != "name" or head[1].value != "=":
            raise NotRead("a loop needs a variable and its values")
        values = self._evaluator(scope).value(expression(head[2:]))
        if not isinstance(values, np.ndarray):
            raise NotRead("a loop goes through the columns of an array")
        count = int(np.prod(values.shape[1:])) if values.size else 0
        for k in range(count):
            self._budget.step()
            column = values.reshape(values.shape[0], -1)[:, k : k + 1]
            scope[head[0].value] = column
            try:
                self._body(loop.body, scope)
            except _Jumped as jump:
                if str(jump) == "break":
                    return
                if str(jump) == "return":
                    raise

    def _repeat(self, loop: ScriptRepetition, scope: dict[str, Any]) -> None:
        names = {t.value for t in (*loop.condition, *_words(loop.body)) if t.form == "name"}
        if any(isinstance(scope.get(name), (BuiltSimulator, BuiltWindow)) for name in names):
            raise NotRead("the loop runs the simulation")
        condition = expression(loop.condition)
        for _ in range(MOST_REPEATED):
            self._budget.step()
            if not matlab_values.is_true(self._evaluator(scope).value(condition)):
                return
            try:
                self._body(loop.body, scope)
            except _Jumped as jump:
                if str(jump) == "break":
                    return
                if str(jump) == "return":
                    raise
            self.line = loop.line
        raise NotRead(f"the loop does not end within {MOST_REPEATED} rounds")

    def _builds(self, body: ScriptBody, scope: dict[str, Any]) -> bool:
        """Return whether statements build a model, or are names of scripts that may."""
        for step in _steps(body):
            if isinstance(step, Plain):
                first = step.tokens[0].value
                if any(t.value in BUILDING for t in step.tokens):
                    return True
                if len(step.tokens) == 1 and first not in QUIET | RANDOM and first not in scope:
                    return first not in FUNCTIONS
        return False

    def _choose(self, choice: ScriptChoice, scope: dict[str, Any]) -> None:
        for condition, body in choice.branches:
            if condition:
                try:
                    holds = matlab_values.is_true(self._evaluator(scope).value(expression(condition)))
                except NotRead as error:
                    raise NotRead(f"whether its condition holds is not known ({error})") from None
                if not holds:
                    continue
            self._body(body, scope)
            return

    def _switch(self, switch: Switch, scope: dict[str, Any]) -> None:
        try:
            subject = self._evaluator(scope).value(expression(switch.subject))
        except NotRead as error:
            raise NotRead(f"which case it is is not known ({error})") from None
        for case, body in switch.cases:
            if not case or self._is_case(subject, self._evaluator(scope).value(expression(case))):
                self._body(body, scope)
                return

    def _is_case(self, subject: Any, case: Any) -> bool:
        options = list(case.reshape(-1)) if matlab_values.is_cells(case) else [case]
        return any(
            np.array_equal(subject, option)
            if matlab_values.is_text(subject) == matlab_values.is_text(option)
            else False
            for option in options
        )

    # --------------------------------------------------------------------------------------- calls of objects

    def call(self, name: str, arguments: Sequence[Any]) -> Any:
        """Return the value of a function that is not one of MATLAB's: of the script, a class, a method."""
        first = arguments[0] if arguments else None
        if isinstance(first, (BuiltSimulator, BuiltWindow, BuiltElement)) and self._has_method(first, name):
            return self.method(first, name, arguments[1:])
        if name == "Simulator":
            built = builders.simulator(self, arguments)
            self.simulators.append(built)
            return built
        if name == "StandardGUI":
            gui = builders.window(self, arguments)
            self.windows.append(gui)
            return gui
        if name == "struct":
            return self._structure(arguments)
        if name in CONSTRUCTORS:
            return ClassCall(name, tuple(arguments), self.line)
        function = self._function(name)
        if function is not None:
            returned = self._call_function(function, arguments)
            return returned[0] if returned else None
        if name[:1].isupper():
            return ClassCall(name, tuple(arguments), self.line)
        if name in QUIET:
            return None
        raise NotRead(f"{name!r} is neither a variable nor a function that is read")

    def _structure(self, arguments: Sequence[Any]) -> dict[str, Any]:
        names = [matlab_values.string(known(name)) for name in arguments[::2]]
        return dict(zip(names, arguments[1::2], strict=False))

    def _function(self, name: str) -> ScriptFunction | None:
        """Return a function of the script, or of a file beside it."""
        if name not in self._functions and name not in CONSTRUCTORS and not name[:1].isupper():
            self._script_beside(name)
        return self._functions.get(name)

    def _call_function(self, function: ScriptFunction, arguments: Sequence[Any]) -> list[Any]:
        """Return the results of a function of the script."""
        scope: dict[str, Any] = {
            name: MissingValue(f"the argument {name!r} of {function.name} is not known")
            for name in function.arguments
        }
        scope.update(zip(function.arguments, arguments, strict=False))
        scope["nargin"] = matlab_values.number(len(arguments))
        self._inside(function.name, lambda: self._body(function.body, scope))
        unset = MissingValue(f"{function.name} does not give it")
        return [scope.get(name, unset) for name in function.results]

    def _has_method(self, target: Any, name: str) -> bool:
        methods = SIMULATOR_METHODS if isinstance(target, BuiltSimulator) else WINDOW_METHODS
        return name in methods or name in builders.QUIET

    def method(self, target: Any, name: str, arguments: Sequence[Any]) -> Any:
        """Return the value of a method of an object."""
        self._budget.step()
        if isinstance(target, BuiltSimulator):
            if name in SIMULATOR_METHODS:
                return SIMULATOR_METHODS[name](self, target, arguments)
        elif isinstance(target, BuiltWindow):
            if name in WINDOW_METHODS:
                return WINDOW_METHODS[name](self, target, arguments)
            if name == "run" and len(arguments) > 2:
                builders.connect(self, target, arguments[2:])
        if isinstance(target, (BuiltSimulator, BuiltWindow)) and name in builders.QUIET:
            return None
        kinds = {BuiltSimulator: "a simulator", BuiltWindow: "a window", BuiltElement: "an element"}
        raise NotRead(f"the method {name!r} of {kinds.get(type(target), 'an object')} is not read")

    def member(self, target: Any, name: str) -> Any:
        """Return a property of an object, or the value of a method without arguments."""
        if isinstance(target, BuiltElement):
            return builders.value_of(target, name)
        if isinstance(target, BuiltSimulator):
            match name:
                case "deltaT":
                    return matlab_values.number(target.step)
                case "tZero" | "t":
                    return matlab_values.number(target.start)
                case "nElements":
                    return matlab_values.number(len(target.elements))
                case "elementLabels":
                    return matlab_values.cells([matlab_values.text(label) for label in target.elements])
                case _:
                    pass
        return self.method(target, name, ())

    # -------------------------------------------------------------------------------------------------- files

    def file(self, name: str) -> file.Simulator:
        """Return the simulator of a file beside the script.

        Raises:
            NotRead: there is no such file, or it cannot be read.
        """
        plain = PureWindowsPath(name).name
        if plain not in self._files:
            self._files[plain] = self._parsed(name, plain)
        return self._files[plain]

    def _parsed(self, name: str, plain: str) -> file.Simulator:
        steps = name.replace("\\", "/").split("/")
        if ".." in steps or steps[0] == "" or ":" in name or not is_plain(plain):
            raise NotRead(f"the file {name!r} is in another folder, which is not read")
        try:
            content = self.beside(plain)
        except DeodarError as error:
            raise NotRead(error.problems[0].what) from None
        if content is None:
            raise NotRead(f"the folder of the script has no file {plain!r}")
        try:
            return file.parse(content)
        except DeodarError as error:
            raise NotRead(f"{plain} {error.problems[0].what}") from None


def _steps(body: ScriptBody) -> Iterator[ScriptStep]:
    """Yield steps and all that are inside them."""
    for step in body:
        yield step
        match step:
            case ScriptLoop() | ScriptRepetition() | Attempt():
                yield from _steps(step.body)
            case ScriptChoice(_, branches) | Switch(_, _, branches):
                for _, inner in branches:
                    yield from _steps(inner)
            case _:
                pass


def _words(body: ScriptBody) -> Iterator[Token]:
    """Yield the words of statements."""
    for step in _steps(body):
        if isinstance(step, Plain):
            yield from step.tokens


def _runs(body: ScriptBody) -> bool:
    """Return whether statements run a simulation: they call a method such as `step`."""
    return any(
        isinstance(step, Plain)
        and any(
            a.value == "." and b.value in RUNNING for a, b in zip(step.tokens, step.tokens[1:], strict=False)
        )
        for step in _steps(body)
    )


def decoded(content: bytes) -> str:
    """Return the text of a script; other bytes than UTF-8 are read as Latin-1, as old files have them."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _assignment(tokens: tuple[Token, ...]) -> int | None:
    """Return the place of the equals sign of an assignment."""
    depth = 0
    for k, token in enumerate(tokens):
        if token.form == "operator":
            depth += (token.value in "([{") - (token.value in ")]}")
            if token.value == "=" and depth == 0:
                return k
    return None


def _is_command(tokens: tuple[Token, ...], scope: dict[str, Any]) -> bool:
    """Return whether a statement is a command with words behind it: `close all`."""
    if len(tokens) < 2 or tokens[0].form != "name" or tokens[0].value in scope:
        return False
    second = tokens[1]
    return second.apart and (
        second.form in ("name", "text", "number") or (second.value == "-" and second.leans)
    )


def _called(node: ScriptNode) -> str:
    """Return the name of the function that an expression calls, or ""."""
    if isinstance(node, IndexNode):
        node = node.target
    return node.name if isinstance(node, NameNode) else ""


def _root(node: ScriptNode) -> str:
    """Return the name of the variable that a target belongs to, or ""."""
    while isinstance(node, (IndexNode, MemberNode)):
        node = node.target
    return node.name if isinstance(node, NameNode) else ""
