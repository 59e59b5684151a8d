# Two words do everything: `make demo` and `make test`. The plain commands behind them stand in README.md.
PYTHON ?= python3
BIN := .venv/bin
ifeq ($(OS),Windows_NT)
  PYTHON := python
  BIN := .venv/Scripts
endif

.PHONY: demo test lint types studio docs schema bench clean

demo: .venv/installed
	$(BIN)/python -m deodar demo saliency

test: .venv/installed-test lint types studio
	$(BIN)/python -m pytest -n 2 --dist loadfile
	$(BIN)/python studio/build.py check test browser

lint: .venv/installed-test
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check .

types: .venv/installed-test
	$(BIN)/python -m pyright

# the page of the studio, unless it is there already
studio: .venv/installed-test
	$(BIN)/python studio/build.py build

docs: .venv/installed-docs
	$(BIN)/python docs/build.py

schema: .venv/installed
	$(BIN)/python -m deodar.model.schema

bench: .venv/installed
	$(BIN)/python benchmarks/run.py

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
