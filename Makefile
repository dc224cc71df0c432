# Two commands: `make test` and `make demo`. Each sets up what it needs on a machine with Python 3.11 and make.
VENV ?= .venv
PYTHON ?= python3.11
BIN := $(VENV)/bin
READY := $(VENV)/.ready
JOBS ?= 2

.PHONY: test demo lint unit format clean

test: lint unit

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --strict src
	$(BIN)/lint-imports

unit: $(READY)
	$(BIN)/python -m pytest -n $(JOBS) -q -rs

demo: $(READY)
	$(BIN)/roadproof show 4
	rm -rf out/proofs
	$(BIN)/roadproof prove --out out/proofs
	$(BIN)/roadproof check out/proofs

format: $(READY)
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

$(READY): pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[all,dev]'
	touch $@

clean:
	rm -rf $(VENV) out dist build
