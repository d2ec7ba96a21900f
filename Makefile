# make demo : install into .venv and run the main job on the real cable (report in out/demo)
# make test : install into .venv with the test tools and run the tests
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin

.PHONY: help install demo test lint types imports benchmarks gallery clean

help:
	@echo "make demo        install and run the main job on the real cable; the report is out/demo/report.html"
	@echo "make test        install and run the tests"
	@echo "make install     only make .venv with helicable in .venv/bin"
	@echo "make lint types imports   the checks that run beside the tests"
	@echo "make benchmarks  time and memory of mesh, cell and rod"
	@echo "make gallery     draw docs/gallery.md and its pictures again"

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "helicable needs Python 3.11 or newer; $(PYTHON) is `$(PYTHON) --version 2>&1`. Try: make PYTHON=python3.12 $(MAKECMDGOALS)"; exit 1; }
	@$(PYTHON) -m venv $(VENV) || \
		{ rm -rf $(VENV); echo "Python's venv module is missing; on Debian or Ubuntu install it with: apt-get install python3-venv"; exit 1; }

$(VENV)/.installed: pyproject.toml | $(BIN)/python
	@echo "Installing helicable and what it needs into $(VENV) (about a minute) ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable .
	@touch $@

$(VENV)/.test-tools: pyproject.toml | $(BIN)/python
	@echo "Installing helicable and the test tools into $(VENV) (about a minute) ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable '.[test]'
	@touch $@ $(VENV)/.installed

install: $(VENV)/.installed

demo: install
	@$(BIN)/python -c 'from geometry.gmsh_session import check_installation as check; check()'
	@$(BIN)/helicable demo --out out/demo

test: $(VENV)/.test-tools
	@$(BIN)/python -c 'from geometry.gmsh_session import check_installation as check; check()'
	@$(BIN)/python -m beam.precompile || true
	@OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 --dist loadfile

lint: $(VENV)/.test-tools
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .

types: $(VENV)/.test-tools
	@$(BIN)/pyright --pythonpath $(BIN)/python

imports: $(VENV)/.test-tools
	@$(BIN)/lint-imports

benchmarks: install
	@$(BIN)/python -m benchmarks

gallery: install
	@$(BIN)/python -m benchmarks.gallery

clean:
	rm -rf $(VENV) out build dist *.egg-info
