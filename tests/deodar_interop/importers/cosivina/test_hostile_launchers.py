"""Broken and hostile launchers: one clear error or a report, in bounded time."""

from __future__ import annotations

import random
import sys
import time
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.model.kept_presets import kept_presets
from deodar_interop.importers import cosivina
from deodar_interop.importers.cosivina import read
from deodar_interop.importers.cosivina.launchers import evaluate
from deodar_interop.importers.cosivina.launchers.launcher import is_launcher
from tests.deodar_interop.importers import hostile
from tests.deodar_interop.importers.cosivina.scripts import PAIR, built, imported, launcher, parameters

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks"))
import mutations

CONTROLS = (
    "ParameterSlider('h', {'line', 'watcher'}, {'h', 'h'}, [-10, 0], '%0.1f', 1, 'resting level')",
    "ParameterSwitchButton('go', 'cue left', 'amplitude', 0, 6)",
    "ParameterDropdownSelector('place', 'cue left', 'position', [10, 20], {'a', 'b'}, 2)",
    "PresetSelector('Select', gui, '', {'calm.json'}, {'calm'})",
    "GlobalControlButton('Pause', gui, 'pauseSimulation', true, false, false)",
)
LOOP = "for i = 1:3\n  sim.addElement(NeuralField(['u' num2str(i)], 5), [], [], 'watcher');\nend\n"
WHOLE = launcher(*CONTROLS, model=PAIR + LOOP)


def tried(text, beside=lambda _: None):
    """Read a launcher; return None after its one error."""
    return hostile.tried("cosivina", text, beside=beside)


def test_mutations_of_a_launcher_open_or_are_refused():
    rng, good = random.Random(11), 0
    for _ in range(150):
        content = mutations.scrambled(WHOLE.encode(), rng)
        if is_launcher(content):
            good += tried(content) is not None
    assert good > 20


def test_mutations_of_the_words_of_a_launcher_open_or_are_refused():
    rng, good = random.Random(5), 0
    words = [
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        "'",
        ";",
        ",",
        "...",
        "\n",
        "end",
        "for",
        "if",
        "%",
        "'u'",
        "3",
        "sim.",
    ]
    for _ in range(250):
        text = WHOLE
        for _ in range(rng.randint(1, 5)):
            at, length = rng.randrange(len(text)), rng.choice([0, 1, 3, 20])
            text = text[:at] + rng.choice(words) + text[at + length :]
        good += tried(text) is not None
    assert good > 150


def test_every_beginning_of_a_launcher_opens_or_is_refused():
    beginnings = [WHOLE[:end] for end in range(1, len(WHOLE), 29)]
    opened = [tried(text) is not None for text in beginnings if is_launcher(text.encode())]
    assert len(opened) > len(beginnings) - 5 and sum(opened) > 30 and not all(opened)


@pytest.mark.parametrize(
    "text",
    [
        "for i = 1:1000000\n  x = i * 2;\nend\n",
        "for i = 1:1000\n for j = 1:1000\n  x = [1 2 3];\n end\nend\n",
        "x = 'a'; for i = 1:100\n  x = [x x];\nend\n",
        "x = {}; for i = 1:100\n  x = {x, x};\nend\n",
        "x = ones(1000); for i = 1:5000\n  x = x * x;\nend\n",
        "x = zeros(1, 100000); for i = 1:100000\n  x(i) = i;\nend\n",
        "function f(x)\n f(x); f(x); f(x);\nend\nf(1);\n",
        "x = " + "(" * 5000 + "1" + ")" * 5000 + ";\n",
        "x = " + "[" * 5000 + "]" * 5000 + ";\n",
        "x = " + "1 + " * 20000 + "1;\n",
        "x = " + "-" * 20000 + "1;\n",
        "x = a" + "'" * 20001 + ";\n",
        "x = a" + ".b" * 20000 + ";\n",
        "x = [" + "1, " * 50000 + "1];\n",
        "[\n" * 3000,
        "'" * 50001 + "\n",
        "%{\n" * 20000,
        "x = 1;" * 30000,
        "if 1\n" * 30 + "end\n" * 30,
        "for i = 1:3\n" * 12 + "x = 1;\n" + "end\n" * 12,
        "x = sprintf('%s', repmat('abc', 1, 600000));\n",
        "x = sprintf(repmat('%5d', 1, 9000), 1:90000);\n",
        "x = 10^400 + 0/0; y = 1:x; z = zeros(x);\n",
    ],
    ids=lambda text: text[:24],
)
def test_scripts_that_would_take_forever_end_soon(text):
    start = time.process_time()
    done = tried(PAIR + text + launcher(*CONTROLS, model=""))
    assert time.process_time() - start < 20
    assert done is None or "line" in done.model


def test_the_rest_of_a_script_that_takes_too_many_operations_is_not_read(monkeypatch):
    monkeypatch.setattr(evaluate, "MOST_STEPS", 3000)
    sim, lost = built(
        PAIR + "for i = 1:1000000\n  x = i * 2;\nend\nsim.addElement(NeuralField('late', 3));\n"
    )
    assert "line" in sim.elements and "late" not in sim.elements
    assert any("operations; the rest of it is not read" in line for line in lost)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("if 1\n" * 60 + "end\n" * 60, "nested deeper than 40"),
        ("x = 1;\n" * 200_000, "more than 400000 words"),
        ("sim = Simulator();\n" + " " * 5_000_000, "at most 4 million"),
        ("sim = Simulator();\n\x00\x01\x02", "builds no simulator"),
        ("sim = Simulator();\nsim.addElement(NeuralField('u', 3)", "builds no simulator"),
    ],
    ids=["blocks", "words", "characters", "bytes", "cut"],
)
def test_scripts_that_are_no_launchers_are_one_error(text, says):
    with pytest.raises(DocumentError) as caught:
        read(("sim = Simulator();\n" + text).encode(), "x.m")
    assert says in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("line", [b"\n", b" \n", b"x = 1;\n", b"from\n", b"import", b"def f(", b"gui . "])
def test_the_format_of_a_long_file_is_recognised_soon(line):
    content = line * (6_000_000 // len(line))
    start = time.process_time()
    assert not is_launcher(content) and not cosivina.sniff(content)
    with pytest.raises(DocumentError):
        read(content, "x.m")
    assert time.process_time() - start < 10


def test_a_launcher_of_100_megabytes_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "large.m"
    with path.open("wb") as file:
        file.write(b"sim = Simulator();\n")
        file.truncate(100 * 2**20)
    with pytest.raises(DocumentError, match="100 MiB"):
        dd.load(path)


def test_scripts_that_call_one_another_end(tmp_path):
    (tmp_path / "one.m").write_text("two;\n")
    (tmp_path / "two.m").write_text("one;\n")
    done = imported(PAIR + "one;\n", tmp_path)
    assert any("call one another more than 8 deep" in line.why for line in done.report.lines)


@pytest.mark.parametrize(
    "name", ["../secret", "/tmp/secret", "sub/secret", "secret.json/../../x", "", "\\\\host\\x"]
)
def test_files_outside_the_folder_are_not_read(name, tmp_path):
    (tmp_path / "in").mkdir()
    for place in (tmp_path, tmp_path / "in"):
        (place / "other.json").write_bytes(parameters(built(PAIR)[0]))
    (tmp_path / "secret.json").write_bytes(parameters(built(PAIR)[0]))
    done = imported(PAIR + f"sim.loadSettings('{name}.json');\n", tmp_path / "in")
    assert any(line.part == "statement" and line.verdict == "dropped" for line in done.report.lines)


def test_a_link_out_of_the_folder_is_not_followed(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "secret.json").write_bytes(parameters(built(PAIR)[0]))
    (tmp_path / "in" / "calm.json").symlink_to(tmp_path / "secret.json")
    done = imported(launcher(CONTROLS[3]), tmp_path / "in")
    assert not kept_presets(done.model.document)
    assert any("is a link to another folder" in line.why for line in done.report.lines)


@pytest.mark.parametrize("content", [b"", b"{", b"[1, 2]", b"\xff\xfe", b'{"simulator": {"elements": []}}'])
def test_damaged_parameter_files_are_reported(content, tmp_path):
    (tmp_path / "calm.json").write_bytes(content)
    done = imported(launcher(CONTROLS[3], CONTROLS[1]), tmp_path)
    assert [p.group for p in kept_presets(done.model.document)] == ["go", "go"]
    assert any(line.part == "preset" and line.verdict == "dropped" for line in done.report.lines)


def test_parameter_files_with_other_values_than_numbers_are_reported(tmp_path):
    sim, _ = built(PAIR)
    sim.elements["line"].values.update(tau="fast", size=(3, 7, 9))
    sim.elements["cues"].kind = "SumOutputs"
    (tmp_path / "calm.json").write_bytes(parameters(sim))
    done = imported(launcher(CONTROLS[3]), tmp_path)
    (line,) = [line for line in done.report.lines if line.part == "preset"]
    assert line.verdict == "approximated" and "'cues' is not in the model" in line.why


def test_labels_of_controls_may_be_any_text():
    done = imported(
        launcher(
            "ParameterSlider('line', {'cue left', 'cue right'}, {'amplitude', 'amplitude'}, [0, 8])",
            "ParameterSlider('', 'line', 'h', [-9, 0])",
            "ParameterSlider('line.tau', {'line', 'line'}, {'tau', 'tau'}, [1, 90])",
            "ParameterSwitchButton('../x', 'watcher', 'h', -5, -1)",
        )
    )
    assert len(done.model.document.layout["pins"]) == 4  # type: ignore[arg-type]
    assert [k.name for k in done.model.document.parameters] == ["line 2"]
    dd.Model(document=done.model.document).to_json()
