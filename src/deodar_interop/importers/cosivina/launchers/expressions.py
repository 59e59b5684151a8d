"""The parser of expressions."""

from __future__ import annotations

from deodar_interop.importers.cosivina.launchers.tokens import Token
from deodar_interop.importers.cosivina.launchers.tree import (
    BinaryNode,
    IndexNode,
    ListNode,
    MemberNode,
    NameNode,
    NumberNode,
    RangeNode,
    ScriptNode,
    TextNode,
    UnaryNode,
    WholeNode,
)

DEEPEST_EXPRESSION = 40
"""Largest depth of brackets inside brackets."""

MOST_OPERATORS = 200
"""Most operators of one expression between brackets."""

PRECEDENCE = {
    **{"||": 1, "&&": 2, "|": 3, "&": 4},
    **dict.fromkeys(("==", "~=", "!=", "<", "<=", ">", ">="), 5),
    **{"+": 7, "-": 7},
    **dict.fromkeys(("*", "/", "\\", ".*", "./", ".\\"), 8),
    **{"^": 10, ".^": 10},
}
"""How strongly operators between two operands bind. A range binds with 6, a sign with 9."""

RANGE, SIGN = 6, 9


class NotRead(ValueError):
    """Raised for an expression or a statement that is not read; the message is the reason."""


def expression(tokens: tuple[Token, ...]) -> ScriptNode:
    """Return the expression that the words are.

    Raises:
        NotRead: they are none, or one that is not read.
    """
    parser = _ExpressionParser(tokens)
    node = parser.binary(0)
    if parser.at < len(tokens):
        raise NotRead(f"{tokens[parser.at].value!r} is not expected there")
    return node


class _ExpressionParser:
    """The state of the parsing of one expression."""

    def __init__(self, tokens: tuple[Token, ...]) -> None:
        self.tokens = tokens
        self.at = 0
        self.depth = 0
        self.listing = [False]  # whether space separates, by brackets
        self.operators = [0]

    # -------------------------------------------------------------------------------------------------- words

    def peek(self) -> Token | None:
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def sees(self, operator: str) -> bool:
        """Return whether an operator is next."""
        token = self.peek()
        return token is not None and token.form == "operator" and token.value == operator

    def expect(self, operator: str) -> None:
        if not self.sees(operator):
            token = self.peek()
            raise NotRead(f"{operator!r} is missing" + (f" before {token.value!r}" if token else ""))
        self.at += 1

    def count(self) -> None:
        """Count an operator of the expression between the innermost brackets."""
        self.operators[-1] += 1
        if self.operators[-1] > MOST_OPERATORS:
            raise NotRead(f"it has more than {MOST_OPERATORS} operators")

    def enter(self, listing: bool) -> None:
        self.depth += 1
        if self.depth > DEEPEST_EXPRESSION:
            raise NotRead(f"its brackets are nested deeper than {DEEPEST_EXPRESSION}")
        self.listing.append(listing)
        self.operators.append(0)

    def leave(self) -> None:
        self.depth -= 1
        self.listing.pop()
        self.operators.pop()

    # -------------------------------------------------------------------------------------------- expressions

    def binary(self, least: int) -> ScriptNode:
        """Return an expression whose operators bind at least this strongly."""
        operand = self.unary()
        while (token := self.peek()) is not None and token.form == "operator":
            if token.value == ":" and least <= RANGE:
                operand = self.range(operand)
                continue
            strength = PRECEDENCE.get(token.value)
            if strength is None or strength < least or self.separates(token):
                break
            self.count()
            self.at += 1
            operand = BinaryNode(token.value, operand, self.binary(strength + 1))
        return operand

    def separates(self, token: Token) -> bool:
        """Return whether a sign begins the next entry of a list: `[1 -2]`."""
        return self.listing[-1] and token.value in ("+", "-") and token.apart and token.leans

    def range(self, first: ScriptNode) -> ScriptNode:
        """Return a range, whose first colon is next."""
        self.count()
        self.at += 1
        second = self.binary(RANGE + 1)
        if self.sees(":"):
            self.at += 1
            return RangeNode(first, second, self.binary(RANGE + 1))
        return RangeNode(first, None, second)

    def unary(self) -> ScriptNode:
        token = self.peek()
        if token is not None and token.form == "operator" and token.value in ("-", "+", "~", "!"):
            self.count()
            self.at += 1
            return UnaryNode("~" if token.value == "!" else token.value, self.binary(SIGN))
        return self.postfix()

    def postfix(self) -> ScriptNode:
        """Return an operand with its indices, members and transpositions."""
        node = self.primary()
        while (token := self.peek()) is not None and token.form == "operator":
            if self.listing[-1] and token.apart:
                break
            if token.value in ("(", "{"):
                self.count()
                node = IndexNode(node, token.value == "{", self.arguments(token.value))
            elif token.value == ".":
                self.count()
                self.at += 1
                name = self.peek()
                if name is None or name.form != "name":
                    raise NotRead("a member needs a name")
                self.at += 1
                node = MemberNode(node, name.value)
            elif token.value in ("'", ".'"):
                self.count()
                self.at += 1
                node = UnaryNode("'", node)
            else:
                break
        return node

    def arguments(self, opening: str) -> tuple[ScriptNode, ...]:
        """Return what is in parentheses or braces behind an operand."""
        closing = ")" if opening == "(" else "}"
        self.expect(opening)
        self.enter(False)
        nodes: list[ScriptNode] = []
        while not self.sees(closing):
            if nodes:
                self.expect(",")
            after = self.tokens[self.at + 1].value if self.at + 1 < len(self.tokens) else ""
            if self.sees(":") and after in (",", closing):
                self.at += 1
                nodes.append(WholeNode())
            else:
                nodes.append(self.binary(0))
        self.expect(closing)
        self.leave()
        return tuple(nodes)

    def primary(self) -> ScriptNode:
        token = self.peek()
        if token is None:
            raise NotRead("it is not complete")
        self.at += 1
        if token.form == "number":
            return NumberNode(float(token.value))
        if token.form == "text":
            return TextNode(token.value)
        if token.form == "name":
            return NameNode(token.value)
        if token.value == "(":
            self.enter(False)
            node = self.binary(0)
            self.expect(")")
            self.leave()
            return node
        if token.value in ("[", "{"):
            return self.list(token.value == "{")
        if token.value == "@":
            raise NotRead("functions without a name are not read")
        raise NotRead(f"{token.value!r} is not expected there")

    def list(self, cells: bool) -> ScriptNode:
        """Return a matrix or a cell array, whose opening bracket was taken."""
        closing = "}" if cells else "]"
        self.enter(True)
        rows: list[tuple[ScriptNode, ...]] = []
        row: list[ScriptNode] = []
        while not self.sees(closing):
            token = self.peek()
            if token is None:
                raise NotRead(f"{closing!r} is missing")
            if token.form == "row" or token.value == ";":
                self.at += 1
                if row:
                    rows.append(tuple(row))
                row = []
            elif token.form == "operator" and token.value == ",":
                self.at += 1
            else:
                row.append(self.binary(0))
        self.expect(closing)
        self.leave()
        if row:
            rows.append(tuple(row))
        return ListNode(cells, tuple(rows))
