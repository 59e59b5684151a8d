# Two words do everything: `make demo` and `make test`. The plain commands behind them stand in README.md.
PYTHON ?= python3
BIN := .venv/bin
ifeq ($(OS),Windows_NT)
  PYTHON := python
  BIN := .venv/Scripts
endif

# files over two processes, in the order that tests/conftest.py gives them
SPREAD := -n 2 --dist loadfile --no-loadscope-reorder

# what `make whole` runs and `make test` leaves out: tests that cost much time
LONG := yes
ifeq ($(LONG),no)
  SHORT := and not long
endif

.PHONY: demo test test-core whole quick optimised browser fast lint types studio page docs generate bench native lowest lock audit clean

demo: .venv/installed
	$(BIN)/python -m deodar demo saliency

test: .venv/installed-test
	$(MAKE) LONG=no whole

# everything
whole: .venv/installed-test
	$(MAKE) -j 2 lint types page
	VITEST_MAX_WORKERS=1 $(MAKE) -j 2 quick browser
	$(MAKE) optimised

# tests whose programs are compiled in a quicker way than deodar does, and those that need optimised programs; those
# of the engine with the packages beside it hidden
REST := tests --ignore tests/deodar

quick: .venv/installed-test
	$(BIN)/python tools/engine_alone.py $(SPREAD) --durations 20 -m "not default_program $(SHORT)"
	$(BIN)/python -m pytest $(SPREAD) --durations 20 -m "not default_program $(SHORT)" $(REST)

optimised: .venv/installed-test
	$(BIN)/python tools/engine_alone.py $(SPREAD) --durations 10 -m "default_program $(SHORT)" --default-programs
	$(BIN)/python -m pytest $(SPREAD) --durations 10 -m "default_program $(SHORT)" --default-programs $(REST)

# for those who work on the engine: its tests alone, without those that take long
test-core: .venv/installed-test
	$(BIN)/python tools/engine_alone.py $(SPREAD) -m "not default_program and not long" tests/deodar tests/contracts

# the page in Chromium, and in Firefox and WebKit where they are installed: tests that wait for half of their
# time, so `make test` runs them beside others; one file at a time there, because pytest uses two cores too
browser: studio
	$(BIN)/python studio/build.py $(if $(SHORT),short,browser) firefox webkit

# a verdict in about a minute
fast: .venv/installed-test
	$(BIN)/python -m pytest $(SPREAD) -m fast

# Python by ruff and by the limits of tools/measure.py, the page by prettier and biome
lint: .venv/installed-test
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check .
	$(BIN)/python tools/measure.py
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
