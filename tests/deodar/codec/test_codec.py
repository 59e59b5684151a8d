"""JSON: written text keeps its bytes, and text that breaks the rules is refused."""

from __future__ import annotations

import ast
import lzma
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from deodar import codec
from deodar.errors import DocumentError, OutputError
from deodar.importers import examples
from tests.house.source import MODULES, ROOT, module, tree

ROWS = sorted((ROOT / "evidence").rglob("*.jsonl.xz"))


def test_no_other_module_imports_json() -> None:
    found = {
        module(path)
        for path in MODULES
        for node in ast.walk(tree(path))
        if (isinstance(node, ast.Import) and any(alias.name == "json" for alias in node.names))
        or (isinstance(node, ast.ImportFrom) and node.module == "json")
    }
    # messages of the child that reads files of others have marks in their objects
    assert found == {"codec", "guarded.channel"}


@pytest.mark.parametrize("name", examples.names())
def test_an_example_document_is_written_with_the_bytes_that_it_has(name: str) -> None:
    content = examples.file(name).read_bytes()
    assert (codec.text(codec.read(content)) + "\n").encode() == content


@pytest.mark.parametrize("path", ROWS, ids=lambda path: path.parent.name)
def test_kept_rows_are_written_with_the_bytes_that_they_have(path: Path) -> None:
    with lzma.open(path, "rt", encoding="utf-8") as file:
        lines = [line for _, line in zip(range(50), file, strict=False)]
    assert [codec.line(codec.parse(line), ascii=True) + "\n" for line in lines] == lines
    assert len(lines) == 50


@pytest.mark.parametrize("value", [0.1, 1e300, 5e-324, -0.0, 1 / 3, 2**53 + 1, "ü\u2028", [], {}, None, True])
def test_a_value_is_read_as_it_was_written(value: object) -> None:
    for written in (codec.text([value]), codec.line([value]), codec.line([value], ascii=True)):
        assert repr(codec.read(written)) == repr([value])


def test_numpy_values_are_written_as_numbers_and_lists() -> None:
    data = {"n": np.int64(3), "x": np.float32(0.5), "a": np.arange(4.0).reshape(2, 2), "t": (1, 2)}
    assert codec.line(data) == '{"n": 3, "x": 0.5, "a": [[0.0, 1.0], [2.0, 3.0]], "t": [1, 2]}'


def test_a_value_without_a_json_form_is_an_error_unless_a_function_converts_it() -> None:
    with pytest.raises(TypeError, match="object has no form in JSON"):
        codec.text({"x": object()})
    assert codec.line([Path("a")], other=str) == '["a"]'


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, np.float64("nan"), np.array([1, math.nan])])
def test_a_number_that_is_not_finite_is_refused_with_its_place(value: object) -> None:
    with pytest.raises(OutputError, match=r"layout\.boxes\.1.*the number (nan|inf|-inf) cannot be written"):
        codec.text({"layout": {"boxes": [0.0, value]}}, finite=True)


def test_a_number_that_is_not_finite_is_written_where_it_is_allowed() -> None:
    assert codec.line([math.nan, math.inf]) == "[NaN, Infinity]"
    assert math.isnan(codec.parse("[NaN]")[0])


def test_keys_keep_their_order_unless_they_are_sorted() -> None:
    assert codec.line({"b": 1, "a": 2}) == '{"b": 1, "a": 2}'
    assert codec.line({"b": 1, "a": 2}, sort=True) == '{"a": 2, "b": 1}'


def test_all_duplicate_keys_are_reported() -> None:
    with pytest.raises(DocumentError) as caught:
        codec.read('{"a": {"x": 1, "x": 2}, "a": {"y": 1, "y": 1, "y": 3}}')
    assert [(p.where, p.what) for p in caught.value.problems] == [
        ("", "the key 'a' occurs twice"),
        ("a", "the key 'y' occurs 3 times"),
    ]


def test_a_hundred_repeated_keys_are_listed() -> None:
    inside = ", ".join(f'"k{k}": 1, "k{k}": 2' for k in range(codec.MOST_REPEATED + 1))
    with pytest.raises(DocumentError) as caught:
        codec.read(f'{{"a": {{{inside}}}}}')
    assert [p.what for p in caught.value.problems] == [
        f"the key 'k{k}' occurs twice" for k in range(codec.MOST_REPEATED)
    ]


@pytest.mark.parametrize(
    ("reading", "most"), [(codec.read, codec.MOST_REPEATED), (codec.foreign, codec.MOST_AMBIGUOUS)]
)
def test_objects_with_repeated_keys_are_counted_while_they_are_read(
    reading: Callable[[bytes], object], most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(codec, "repeated", None)
    with pytest.raises(DocumentError, match=f"keys that occur twice in more than {most:,} objects"):
        reading(b"[" + b'{"a":1,"a":2},' * most + b'{"a":1,"a":2}]')


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
def test_half_a_character_is_refused_in_every_encoding(encoding: str) -> None:
    assert codec.read('["\\ud83d\\ude00"]'.encode(encoding)) == ["\U0001f600"]
    for text in ('["\\ud83d"]', '["\\uDE00"]'):
        with pytest.raises(DocumentError, match="half a character"):
            codec.read(text.encode(encoding))
    with pytest.raises(DocumentError, match="half a character"):
        codec.read('["\ud83d"]')


def test_a_mistake_is_reported_with_line_and_column() -> None:
    with pytest.raises(DocumentError, match="in line 2, column 5"):
        codec.read('{"a": 1,\n    }')


@pytest.mark.parametrize(
    "read", [codec.read, lambda text: codec.foreign(text.encode())], ids=["read", "foreign"]
)
def test_the_depth_of_nesting_is_limited(read: object) -> None:
    assert callable(read)
    read("[" * codec.DEEPEST + "]" * codec.DEEPEST)
    with pytest.raises(DocumentError, match="nested deeper than 64 levels"):
        read("[" * (codec.DEEPEST + 1) + "]" * (codec.DEEPEST + 1))


def test_a_file_of_deodar_that_is_nested_too_deeply_is_a_value_error() -> None:
    with pytest.raises(ValueError, match="nested too deeply"):
        codec.parse("[" * 200_000)


def test_files_of_other_tools_may_break_the_json_standard() -> None:
    data = codec.foreign(b'\xef\xbb\xbf{"a": "x\ty", "b": NaN, "a": 2}')
    assert data["a"] == 2 and math.isnan(data["b"])
    assert [found.values for found in codec.repeated(data)] == [("x\ty", 2)]
    assert codec.foreign('{"a": "ä"}'.encode("latin-1")) == {"a": "ä"}


@pytest.mark.parametrize("reading", [codec.read, codec.foreign])
def test_a_text_of_too_many_values_is_refused_before_it_is_parsed(
    reading: Callable[[bytes], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(codec, "MOST_VALUES", 100)
    assert reading(b"[" + b"{}," * 40 + b"{}]") == [{}] * 41
    monkeypatch.setattr(codec.json, "loads", None)
    monkeypatch.setattr(codec.json, "JSONDecoder", None)
    for entry in (b"{}", b"[]", b"1"):
        with pytest.raises(DocumentError, match=r"holds about .* values; at most 100 are read"):
            reading(b"[" + (entry + b",") * 120 + entry + b"]")


def test_a_reader_may_state_a_smaller_number_of_values() -> None:
    assert codec.read(b"[1, 2]", most=2) == [1, 2]
    with pytest.raises(DocumentError, match=r"holds about 3 values; at most 2 are read"):
        codec.read(b"[1, 2, 3]", most=2)
