# Two words do everything: `make demo` and `make test`. The plain commands behind them stand in docs/install.md.
PYTHON ?= python3
BIN := .venv/bin
ifeq ($(OS),Windows_NT)
  PYTHON := python
  BIN := .venv/Scripts
endif

.PHONY: demo test whole rest verdict others test-core fast smoke browser lint types page studio docs generate mutants bench native lowest lock audit clean

demo: .venv/installed
	$(BIN)/python -m deodar demo

# the verdict that one waits for: the longest first, what waits for a browser beside it
test: .venv/installed-test
	$(MAKE) -j 3 types verdict lint page smoke

# everything: the verdict, then the others and new examples of properties
whole:
	$(MAKE) test
	$(MAKE) rest

rest: .venv/installed-test
	VITEST_MAX_WORKERS=1 $(MAKE) -j 2 others browser

# the tests that notice most for their time, chosen by tests/verdict.py
verdict: .venv/installed-test
	$(BIN)/python tools/suite.py verdict

# all others, and new examples of properties
others: .venv/installed-test
	$(BIN)/python tools/suite.py rest --durations 20 --require-durations --hypothesis-profile new
	$(BIN)/python tools/mutate.py show --short

# for those who work on the engine: its part of the verdict
test-core: .venv/installed-test
	$(BIN)/python tools/suite.py core

# the page in Chromium: every view once; then the other files, and the page in Firefox and WebKit where they are
# installed. These tests wait for half of their time, so they run beside others, one file at a time there
smoke: studio
	$(BIN)/python studio/build.py smoke

browser: studio
	$(BIN)/python studio/build.py browser firefox webkit

# a verdict in about a minute
fast: .venv/installed-test
	$(BIN)/python tools/suite.py fast

# Python by ruff and by the limits of tools/measure.py and tools/names.py, the page by prettier and biome
lint: .venv/installed-test
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check .
	$(BIN)/python tools/measure.py
	$(BIN)/python tools/names.py
	$(BIN)/python studio/build.py lint

types: .venv/installed-test
	$(BIN)/python -m pyright

# the page of the studio, unless it is there already
studio: .venv/installed-test
	$(BIN)/python studio/build.py build

# its types, and its tests without a browser
page: studio
	$(BIN)/python studio/build.py check test

docs: .venv/installed-docs
	$(BIN)/python docs/build.py

# every file that follows from the code, after a kind, a command or a message was added or changed
generate: .venv/installed-test
	$(BIN)/python tools/generate.py

# do the tests notice what was changed since a revision? make mutants CHANGED=HEAD~3
mutants: .venv/installed-test
	$(BIN)/python tools/mutate.py changed $(CHANGED)

bench: .venv/installed
	$(BIN)/python benchmarks/run.py

# the compiled kernels, and their tests; needs a C++ compiler
native: .venv/installed-test
	$(BIN)/python -m pip install -q ./native
	$(BIN)/python -m pytest native/tests

# the lower bounds of dependencies, in an environment of its own
lowest:
	.ci/lowest

# the versions of Python packages that are known to work together
lock: .venv/installed
	$(BIN)/python -m pip install -q uv
	$(BIN)/python -m uv pip compile --quiet --upgrade --universal --generate-hashes --all-extras --custom-compile-command "make lock" pyproject.toml -o requirements.lock

# known vulnerabilities, where a registry answers
audit: .venv/installed-test
	$(BIN)/python -m pip install -q pip-audit
	$(BIN)/python .ci/audit.py

clean:
	$(PYTHON) -c "import shutil; [shutil.rmtree(p, ignore_errors=True) for p in ('.venv', 'site', 'dist')]"

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install -q -e .
	@$(BIN)/python -c "open('.venv/installed', 'w').close()"

.venv/installed-test: .venv/installed
	$(BIN)/python -m pip install -q -e ".[test]"
	@$(BIN)/python -c "open('.venv/installed-test', 'w').close()"

.venv/installed-docs: .venv/installed
	$(BIN)/python -m pip install -q -e ".[docs]"
	@$(BIN)/python -c "open('.venv/installed-docs', 'w').close()"
