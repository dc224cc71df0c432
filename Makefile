# Two commands: `make test` and `make demo`. Each sets up what it needs on a machine with Python and make.
VENV ?= .venv
# The first of these that is there and is Python 3.11 or later.
PYTHON ?= $(shell for name in python3.11 python3 python3.12 python3.13 python3.14; do \
	$$name -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$name && break; done)
BIN := $(VENV)/bin
READY := $(VENV)/.ready
JOBS ?= 2

.PHONY: test long alone demo docs man fresh browser evidence evidence-check generated findings interop solvers release mutants fuzz lint unit format clean

test: lint unit

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --strict src
	$(BIN)/lint-imports

unit: $(READY)
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal --maxfail 5 -q -rs -m "not long"

# The tests that take long (tests/lengthy.txt), which make test leaves out; CI runs both.
long: $(READY)
	ROADPROOF_EXAMPLES=full $(BIN)/python -m pytest -n $(JOBS) --dist worksteal --maxfail 5 -q -rs -m long

# The core in a tree of its own, without extensions and with its own packages: it proves, searches and checks.
alone: $(READY)
	rm -rf out/alone
	mkdir -p out
	PYTHONPATH=tests $(BIN)/python -m core.alone --tests out/alone

# Proofs, drives, a matrix, an evaluated recording, and one page about all of it; at most 3 minutes.
DEMO := out/demo
demo: $(READY)
	$(BIN)/roadproof show 4
	rm -rf $(DEMO)
	$(BIN)/roadproof prove --out $(DEMO)/proofs
	$(BIN)/roadproof witness --all --no-pictures --out $(DEMO)/drives
	$(BIN)/roadproof overlap --among 1-8 --no-pictures --out $(DEMO)/overlap
	$(BIN)/roadproof simulate --recordings 1 --seconds 60 --seed 7 --out $(DEMO)/recordings
	$(BIN)/roadproof evaluate $(DEMO)/recordings --no-pictures --out $(DEMO)/evaluation
	$(BIN)/roadproof report $(DEMO)/proofs $(DEMO)/drives $(DEMO)/overlap $(DEMO)/evaluation \
		--title 'roadproof: 162 claims, 24 drives, a matrix and a recording' --out $(DEMO)/demo.html
	@echo "Open $(CURDIR)/$(DEMO)/demo.html in a browser; it needs no network."

# The documentation site, in out/site: open out/site/index.html in a browser; it needs no network.
docs: $(READY)
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build
	$(BIN)/roadproof atlas --out out/site/atlas

# The answers that come with roadproof, computed and written to proofs/known; ARGS='--only overlap' computes some.
evidence: $(READY)
	PYTHONPATH=tests $(BIN)/python -m shipping $(ARGS)

# All of them computed again and compared with those that are there.
evidence-check: $(READY)
	PYTHONPATH=tests $(BIN)/python -m shipping --check $(ARGS)

# All files that are made from the source, again: schemas, keyword arguments, tables and drawings of documents, and
# with coqc the extracted program. ARGS=--check compares only; the table of them is tests/documents/generated.py.
generated: $(READY)
	PYTHONPATH=tests $(BIN)/python -m documents.generated $(ARGS)

# Every command of the README, typed into the login shell of a user who has nothing but a fresh clone.
fresh: $(READY)
	PYTHONPATH=tests $(BIN)/python -m fresh

# Manual pages, in out/man: man -l out/man/man1/roadproof.1, or MANPATH=$PWD/out/man: man roadproof-witness.
man: $(READY)
	PYTHONPATH=tests $(BIN)/python -m documents.man out/man/man1

# The studio in a real browser: Debian's Chromium (apt-get install chromium fonts-dejavu-core), or CHROMIUM=/path/to/it.
browser: $(READY)
	ROADPROOF_BROWSER=1 $(BIN)/python -m pytest -q -rs tests/extensions/pages/studio/test_browser.py tests/extensions/pages/studio/test_first_impression.py tests/extensions/pages/studio/test_shown.py tests/extensions/pages/report tests/extensions/pages/atlas $(ARGS)

# Every figure of the documents again; ARGS=--update puts the pages right, --only PATTERN asks for less.
findings: $(READY)
	PYTHONPATH=tests $(BIN)/python -m findings $(ARGS)

# Exported drives, put to clients that nobody here wrote (docs/how-to/interop.md); environments under out/interop.
interop: $(READY)
	PYTHONPATH=tests $(BIN)/python -m extensions.exchange.interop $(ARGS)

# Searches of all scenarios as files, put to the solvers that are installed; ARGS='--solver z3 --every 3' asks less. It
# keeps tests/extensions/encoding/runs.csv; then make generated counts docs/data/solvers.csv.
solvers: $(READY)
	PYTHONPATH=tests nice $(BIN)/python -m extensions.encoding.solver_runs $(ARGS)

# The wheel and the source archive in out/release, installed into every Python that is found; ARGS=--lowest too.
release: $(READY)
	$(BIN)/python -m pip install --quiet 'build>=1.2,<2' 'cyclonedx-bom>=5,<8'
	PYTHONPATH=tests $(BIN)/python -m installing $(ARGS)

# Small faults in the source, each tried against the tests that run its line (docs/explanation/tests.md); hours, taken
# up again where it stopped. ARGS='--only semantics/exact/ --most 20' asks for less.
mutants: $(READY)
	PYTHONPATH=tests ROADPROOF_EXAMPLES=full $(BIN)/python -m mutants record --jobs $(JOBS)
	PYTHONPATH=tests nice $(BIN)/python -m mutants run --jobs $(JOBS) $(ARGS)
	PYTHONPATH=tests $(BIN)/python -m mutants report
	PYTHONPATH=tests $(BIN)/python -m tally

# Random formulas and traces through every reader; ARGS='--reader held --pairs 20000 --seed 7'.
fuzz: $(READY)
	PYTHONPATH=tests nice $(BIN)/python -m fuzz --keep $(ARGS)
	PYTHONPATH=tests $(BIN)/python -m tally

format: $(READY)
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

$(READY): pyproject.toml
	@test -x $(BIN)/python || test -n "$(PYTHON)" || \
		{ echo "no Python 3.11 or later was found: install one, or name it: make PYTHON=/path/to/python3" >&2; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --disable-pip-version-check --editable '.[all,dev]'
	touch $@

clean:
	rm -rf $(VENV) out dist build
