"""The part of MATLAB that launchers are written in: statements, expressions, loops, functions."""

from __future__ import annotations

import math

import pytest

from deodar_interop.importers.cosivina.launchers.launcher import plain
from tests.deodar_interop.importers.cosivina.scripts import built, values


def labels(text):
    """Return the labels that a script gives, and what is reported."""
    sim, lost = built("sim = Simulator();\n" + text)
    return list(sim.elements), lost


@pytest.mark.parametrize(
    ("written", "number"),
    [
        ("1/4*100", 25),
        ("-2^2", -4),
        ("2^-1", 0.5),
        ("2*3+4-1", 9),
        ("round(2.5) + round(-2.5)", 0),
        ("floor(7/2) + ceil(7/2) + fix(-1.5)", 6),
        ("[1, 2, 3]", [1, 2, 3]),
        ("[1 -2]", [1, -2]),
        ("[1 - 2]", -1),
        ("[1 , -2\n 3, 4]", [[1, -2], [3, 4]]),
        ("[1 2; 3 4]'", [[1, 3], [2, 4]]),
        ("[1 2 3]'", [[1], [2], [3]]),
        ("(1:3)'", [[1], [2], [3]]),
        ("1:2:7", [1, 3, 5, 7]),
        ("3:-1:1", [3, 2, 1]),
        ("5:1", []),
        ("0:0.1:0.3", pytest.approx([0, 0.1, 0.2, 0.3])),
        ("[zeros(1, 2), 5*ones(1, 2)]", [0, 0, 5, 5]),
        ("[[1 2]; [3 4]]*[1; 1]", [[3], [7]]),
        ("[1 2 3] .* [2 2 2]", [2, 4, 6]),
        ("1.*[1 2]", [1, 2]),
        ("1e2 + .5", 100.5),
        ("true + ~false", 2),
        ("3 > 2 && 1 ~= 1", 0),
        ("~isempty([]) || 4 == 4", 1),
        ("mod(-1, 5) + rem(-1, 5)", 3),
        ("max([3 9 4]) + min(2, 7)", 11),
        ("sum([1 2; 3 4])", [4, 6]),
        ("sum([1 2; 3 4], 2)", [[3], [7]]),
        ("numel(1:10) + length([1 2 3]) + size([1 2; 3 4], 1)", 15),
        ("size(zeros(3, 5))", [3, 5]),
        ("linspace(0, 1, 3)", [0, 0.5, 1]),
        ("repmat([1 2], [1, 2])", [1, 2, 1, 2]),
        ("numel(repmat([1 2], 1, -1))", 0),
        ("inf", "_Inf_"),
        ("[1, inf]", [1, "_Inf_"]),
        ("pi", math.pi),
        ("'it''s'", "it's"),
        ('"two words"', "two words"),
        ("['field ' num2str(3)]", "field 3"),
        ("['a', 'b' 'c']", "abc"),
        ("num2str(0.25)", "0.25"),
        ("num2str(pi)", "3.1416"),
        ("num2str(-1234.5678)", "-1234.5678"),
        ("num2str(7, '%03d')", "007"),
        ("sprintf('%s %d: %0.2f%%', 'u', 3, 1/3)", "u 3: 0.33%"),
        ("sprintf('%d,', [1 2 3])", "1,2,3,"),
        ("int2str(2.6)", "3"),
        ("strcat('a ', 'b')", "ab"),
        ("upper('ab')", "AB"),
        ("strrep('u -> u', 'u', 'w')", "w -> w"),
        ("strjoin({'a', 'b'}, '+')", "a+b"),
        ("strjoin({'a', 'b'})", "a b"),
        ("{'a', 3}", ["a", 3]),
        ("{'a' 'b'\n'c' 'd'}", ["a", "b", "c", "d"]),
        ("cellstr([repmat('u', [3, 1]), num2str((1:3)')])", ["u1", "u2", "u3"]),
        ("strcat({'u', 'v'}, '1')", ["u1", "v1"]),
        ("num2cell([1 2])", [1, 2]),
        ("strcmp('a', 'a') + strcmp('a', 'b')", 1),
        ("ismember('b', {'a', 'b'})", 1),
        ("gauss(1:3, 2, 0)", [0, 1, 0]),
        ("gauss(1:3, 2, 1)", pytest.approx([math.exp(-0.5), 1, math.exp(-0.5)])),
        ("norm([3 4]) + diff([1 5])", 9),
        ("diag([2 3])", [[2, 0], [0, 3]]),
        ("4 - 3 - 1", 0),
        ("(2 + 3)' * 2", 10),
    ],
)
def test_expressions_have_the_values_of_matlab(written, number):
    (evaluated,) = values(f"x = {written};", "x")
    assert evaluated == number


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("x = [4 5 6]; x = x(2);", 5),
        ("x = [4 5 6]; x = x(end);", 6),
        ("x = [4 5 6]; x = x(end-1:end);", [5, 6]),
        ("x = [1 2; 3 4]; x = x(2, :);", [3, 4]),
        ("x = [1 2; 3 4]; x = x(:, 1);", [[1], [3]]),
        ("x = [1 2; 3 4]; x = x(:)';", [1, 3, 2, 4]),
        ("x = zeros(2, 3, 4); x = size(x(:, :, 1));", [2, 3]),
        ("x = [1 5 9]; x = x(x > 3);", [5, 9]),
        ("c = {'a', 'b'}; x = c{2};", "b"),
        ("c = {{1, 2}, 3}; x = c{1}{2};", 2),
        ("x(3) = 7;", [0, 0, 7]),
        ("x = 1:3; x(2) = 9; x(end+1) = 4;", [1, 9, 3, 4]),
        ("x = zeros(2); x(2, :) = [5 6];", [[0, 0], [5, 6]]),
        ("x = {}; x{end+1} = 'a'; x{end+1} = 'b';", ["a", "b"]),
        ("p.size = 4; p.sub.tau = 3; x = p.size * p.sub.tau;", 12),
        ("p = struct('a', 1, 'b', 'c'); x = p.b;", "c"),
        ("s = 'u -> v'; x = s(1);", "u"),
        ("[x, y] = size(ones(3, 7)); x = y;", 7),
        ("[a, b, c, d] = size(ones(3, 7)); x = [c d];", [1, 1]),
        ("x = 0; for i = 1:4, x = x + i; end", 10),
        ("x = 0; for i = [3 5; 1 1]; x = x + i(1); end", 8),
        ("x = ''; for s = {'a', 'b'}; x = [x s{1}]; end", "ab"),
        ("x = 0; for i = 1:9\n if i > 3, break; end\n x = i;\nend", 3),
        ("x = 0; for i = 1:4\n if mod(i, 2) == 1\n continue\n end\n x = x + i;\nend", 6),
        ("mode = 2;\nif mode == 1\n x = 1;\nelseif mode == 2\n x = 2;\nelse\n x = 3;\nend", 2),
        ("switch 'b'\n case {'a', 'b'}\n x = 1;\n otherwise\n x = 2;\nend", 1),
        ("switch 3\n case 1\n x = 1;\n case 2\n x = 2;\n otherwise\n x = 4;\nend", 4),
        ("if ~exist('q', 'var'), q = 5; end\nx = q;", 5),
        ("x = twice(4);\nfunction y = twice(a)\n y = 2*a;\nend", 8),
        ("try\n x = 3;\ncatch e\n x = 4;\nend", 3),
        ("x = 1; % y = 2;\n%{\nx = 5;\n%}\ny = x;", 1),
        ("x = 1 + ... and more\n  2;", 3),
        ("x = [1, ... first\n 2];", [1, 2]),
        ("x = {'a', ... % first\n 'b'};", ["a", "b"]),
        ("clear all; close all\nclc, x = 2;", 2),
        ("x = 3, y = 'a''b';", 3),
        ("a.b = [1 2 3]; x = a.b(2);", 2),
        ("a = [1 2 3]'; x = a';", [1, 2, 3]),
        ("x = 'a%b';", "a%b"),
        ("x = {'first', 'second'}; x{2} = 'another';", ["first", "another"]),
        ("x = {'a', 'b', 'c'}; x(2:3) = {'word'};", ["a", "word", "word"]),
        ("x = 'word'; k = true(1, 4); k([2 4]) = false; x = x(k);", "wr"),
        ("k = [1 2 3] > 1; k(2) = 0; x = [4 5 6]; x = x(k);", 6),
        ("x = [4 5 6]; x(2) = [];", [4, 6]),
        ("x = {'a', 'b', 'c'}; x(strcmp(x, 'b')) = [];", ["a", "c"]),
        ("x = [1 2; 3 4; 5 6]; x(2, :) = [];", [[1, 2], [5, 6]]),
        ("x = 0; while x < 5\n x = x + 2;\nend", 6),
        ("x = 0; while true\n x = x + 1;\n if x == 3, break; end\nend", 3),
        ("x = strncmp('sum u', {'sum', 'su', 'sumx'}, 3);", [1, 0, 1]),
        ("x = strfind('u1 -> u1', 'u1');", [1, 7]),
        ("x = find([0 1 1], 1);", 2),
        ("rand('state', 3); x = 1;", 1),
    ],
)
def test_statements_give_variables_the_values_of_matlab(text, number):
    (evaluated,) = values(text, "x")
    assert evaluated == number


def test_elements_are_made_in_loops_with_built_labels():
    evaluated, lost = labels(
        "for i = 1 : 2\n  n = num2str(i);\n  sim.addElement(NeuralField(['u' n], 10));\n"
        "  for j = 1:2\n    sim.addElement(BoostStimulus(sprintf('b%d%d', i, j), j), [], [], ['u' n]);\n"
        "  end\nend\n"
    )
    assert evaluated == ["u1", "b11", "b12", "u2", "b21", "b22"] and not lost


def test_functions_may_lack_their_end():
    evaluated, lost = labels(
        "addNode(sim, 'u');\nfunction addNode(s, name)\n s.addElement(NeuralField(name, both(2)));\n"
        "function y = both(x)\n y = [x, x];\n"
    )
    assert evaluated == ["u"] and not lost


def test_methods_may_be_called_as_functions():
    sim, lost = built(
        "s = Simulator;\naddElement(s, NeuralField('u', 5));\naddElement(s, SumInputs('v', 5), 'u');\n"
    )
    assert sim.elements["v"].inputs == [("u", "output")] and not lost


def test_inputs_and_targets_are_connected_with_their_components():
    sim, lost = built(
        "sim = Simulator();\nsim.addElement(NeuralField('u', [4 5]));\nsim.addElement(NeuralField('v', 5));\n"
        "sim.addElement(SumAllDimensions('s', [4 5]), 'u', [], {'v', 'v'}, {'verticalSum', ''});\n"
        "sim.addElement(SumInputs('t', 5), {'v', 'u'}, {[], 'h'});\n"
        "sim.addConnection({'s'}, {'verticalSum'}, 't');\n"
    )
    assert not lost
    assert sim.elements["s"].inputs == [("u", "output")]
    assert sim.elements["v"].inputs == [("s", "verticalSum"), ("s", "fullSum")]
    assert sim.elements["t"].inputs == [("v", "output"), ("u", "h"), ("s", "verticalSum")]


def test_parameters_are_changed_after_an_element_was_added():
    sim, lost = built(
        "sim = Simulator('tZero', 3);\nsim.deltaT = 0.5;\nsim.addElement(NeuralField('u', 5));\n"
        "sim.addElement(NeuralField('v', 5));\nsim.setElementParameters({'u', 'v'}, {'h', 'tau'}, {-3, 7});\n"
        "sim.setElementParameters('u', 'beta', 9);\ne = sim.getElement('v');\ne.h = -1;\n"
        "sim.setElementParameters('v', {'beta', 'h'}, [2, sim.getElementParameter('u', 'h')]);\n"
    )
    assert not lost and (sim.step, sim.start) == (0.5, 3)
    evaluated = [[plain(sim.elements[e].values[p]) for p in ("tau", "h", "beta")] for e in "uv"]
    assert evaluated == [[10, -3, 9], [7, -3, 2]]


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ("MemoryTrace('m', 9, 50)", {"size": [1, 9], "tauBuild": 50, "tauDecay": 50, "threshold": 0.5}),
        ("CustomStimulus('m', [1 2 3])", {"pattern": [1, 2, 3], "size": [1, 3]}),
        (
            "TimedCustomStimulus('m', 2, [5, inf])",
            {"stimulusPattern": 2, "onTimes": [5, "_Inf_"], "size": [1, 1]},
        ),
        ("WeightMatrix('m', [1 2; 3 4; 5 6])", {"weights": [[1, 2], [3, 4], [5, 6]], "size": [3, 2]}),
        ("DiagonalSum('m', 6, 1)", {"inputSize": [6, 6], "amplitude": 1}),
        ("DiagonalExpansion('m', 7)", {"inputSize": [1, 7], "amplitude": 0}),
        ("ShiftInput('m', 5, 2)", {"shiftValue": [0, 2], "amplitude": 0, "circular": 0, "fillValue": 0}),
        (
            "SumDimension('m', [1 2], [1 1], -1)",
            {"sumDimensions": [1, 2], "dimensionOrder": [1, 2], "amplitude": -1},
        ),
        ("ExpandDimension('m', 8, [4 8], 2)", {"inputSize": [1, 8], "dimensionMapping": [1, 2]}),
        ("ExpandDimension('m', 8, [8 4], 1)", {"dimensionMapping": [2, 1]}),
        (
            "KernelFFT('m', [4 6], [2 3], 5)",
            {"sigmaExc": [[2], [3]], "sigmaInh": [[1], [1]], "circular": [[1], [1]]},
        ),
        ("KernelFFT('m', 9, 2)", {"sigmaExc": 2, "circular": 1}),
        ("Convolution('m', 9, false, true)", {"flipInputs": 2, "shape": "same"}),
        ("Interpolation1D('m', 1:0.5:3)", {"size": [1, 5], "method": "linear"}),
        ("CustomStimulusSequence('m', [1 2; 3 4])", {"stimulusSize": [1, 2], "startTimes": [1, 2]}),
        ("TimedGaussStimulus1D('m', 9, 1, 2, 3, [0 5; 8 9])", {"onTimes": [[0, 5], [8, 9]], "circular": 1}),
        ("Whatever('m', [3 4], 7)", {"size": [3, 4]}),
    ],
)
def test_constructors_derive_the_parameters_that_cosivina_derives(call, expected):
    sim, _ = built(f"sim = Simulator();\nsim.addElement({call});\n")
    evaluated = {name: plain(number) for name, number in sim.elements["m"].values.items()}
    assert {name: evaluated[name] for name in expected} == expected


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("x = someFunction(3);", "line 2: dropped, 'someFunction' is neither a variable nor a function"),
        ("x = rand(3);", "line 2: dropped, rand differs from run to run"),
        ("x = 'open;", "line 2: dropped, a text has no closing quote"),
        ("x = (3;", "line 2: dropped, its parentheses are not closed on the line"),
        ("x = 3);", "line 2: dropped, ')' closes nothing"),
        ("x = [1 2", "line 2: dropped, a ']' is missing"),
        ("x = ;", "line 2: dropped, it is not complete"),
        ("x = 3 +;", "line 2: dropped, it is not complete"),
        ("x = [1 2; 3];", "line 2: dropped, it cannot be computed"),
        ("x = [1 2]; y = x(3);", "line 2: dropped, an index is not a whole number from 1 to 2"),
        ("x = {1}; y = x{2};", "line 2: dropped, an index is not a whole number from 1 to 1"),
        ("f = @(x) x + 1;", "line 2: dropped, functions without a name are not read"),
        ("[a, b] = max([1 2]);", "line 2: dropped, a function with several results is not read"),
        ("end", "line 2: dropped, 'end' belongs to no block"),
        ("parfor\nend", "line 2: dropped, a loop needs a variable and its values"),
        ("for i = q\n y = 1;\nend", "line 2: dropped, 'q' is neither a variable nor a function"),
        ("while true\n y = 1;\nend", "line 2: dropped, the loop does not end within 5000 rounds"),
        ("while sim.t < 9\n sim.step();\nend", "line 2: dropped, the loop runs the simulation"),
        (
            "for i = 1:3\n sim.step();\n sim.setElementParameters('u', 'h', i);\nend",
            "the loop runs the simulation",
        ),
        ("q = @(x) 1; while q\n y = 1;\nend", "line 2: dropped, 'q' is not known"),
        ("if someThing\n y = 1;\nend", "line 2: dropped, whether its condition holds is not known"),
        ("switch someThing\n case 1\n y = 1;\nend", "line 2: dropped, which case it is is not known"),
        ("y = sim.getComponent('u', 'output');", "line 2: dropped, the method 'getComponent' of a simulator"),
        ("hold_on tight", "line 2: dropped, the command 'hold_on' is not read"),
        ("x = 1; #", "line 2: dropped, '#' has no meaning in a script"),
        (
            "sim.addElement(NeuralField('u', 3), 'v');",
            "u: connection v: dropped, line 2: no element has the label",
        ),
        ("sim.addElement(NeuralField('u', 3), [], [], 'v');", "u: connection v: dropped, line 2"),
        ("sim.addElement(NeuralField('', 3));", "line 2: dropped, the label of an element is empty"),
        ("sim.addElement(NeuralField(3, 3));", "line 2: dropped, a text is expected, not 3"),
        ("sim.addElement(3);", "line 2: dropped, an element is expected, not 3"),
        ("sim.addElement();", "line 2: dropped, an element is expected, not 0 numbers"),
        ("sim.addConnection('u', 'output', 'v');", "line 2: dropped, no element has the label 'v'"),
        ("sim.setElementParameters('u', 'h', 3);", "line 2: dropped, no element has the label 'u'"),
        ("zeros(1e6, 1e6);", "line 2: dropped, an array of more than 2000000 entries is not read"),
        ("x = 1:1e9;", "line 2: dropped, an array of more than 2000000 entries is not read"),
        ("x = repmat('a', 1e5, 1e5);", "line 2: dropped, an array of more than 2000000 entries is not read"),
        ("x = sprintf('%999999999d', 1);", "line 2"),
        ("x.y.z(3).w = 4;", "line 2"),
    ],
)
def test_what_is_not_read_is_reported_with_its_line(text, why):
    sim, lost = built(f"sim = Simulator();\n{text}\nsim.addElement(NeuralField('last', 4));\n")
    if why == "line 2":
        assert len(lost) <= 1
    else:
        assert any(why in line for line in lost), lost
    assert "last" in sim.elements


def test_a_value_that_is_not_known_is_named_where_it_is_used():
    sim, lost = built(
        "sim = Simulator();\nn = readSize(3);\nh = rand;\nsim.addElement(NeuralField('u', n, 20, h));\n"
    )
    assert sim.elements["u"].values["size"] == (1, 1) and sim.elements["u"].values["h"] == -5.0
    assert any(
        "u: parameter size: approximated, line 4: 'n' is not known: 'readSize' is neither" in line
        for line in lost
    )
    assert any("u: parameter h: approximated" in line and "its default is used" in line for line in lost)


def test_a_component_that_a_class_lacks_is_reported():
    _, lost = built(
        "sim = Simulator();\nsim.addElement(NeuralField('u', 3));\n"
        "sim.addElement(SumInputs('v', 3), 'u', 'outputs');\n"
    )
    assert any("'u' is a NeuralField without a component 'outputs'" in line for line in lost)


def test_reports_of_a_loop_are_given_once():
    _, lost = built("sim = Simulator();\nfor i = 1:50\n q(3);\nend\n")
    assert len(lost) == 1
