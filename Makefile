# Needs only make and Python 3.11 or newer; everything else goes into .venv.
#
#   make demo     draw samples and a mesh, texture an image and the mesh, say where the pictures are
#   make test     every check and every test (what .ci/run calls)
#   make bench    picture and speed tables into benchmarks/results
#   make gallery  the pictures of the README and the docs
#   make format   put the code into its form

SHELL := /bin/sh
PYTHON ?= $(shell command -v python3 || command -v python)
BIN := .venv/bin
OUT ?= demo-output

# Packages whose shapes are checked at run time in tests (never the kernels: their annotations are the compiler's).
CHECKED := texloom.mesh,texloom.io,texloom.metrics,texloom.demo,texloom.sources,texloom.draws,texloom.points,texloom.sketch

.PHONY: demo test lint types unit bench gallery format pin clean
.DEFAULT_GOAL := demo

demo: .venv/ready
	$(BIN)/texloom demo -o $(OUT)

test: lint types unit

lint: .venv/ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports

types: .venv/ready-dev
	$(BIN)/pyright

unit: .venv/ready-dev
	$(BIN)/python -m pytest -n 2 -p tests.typecheck --jaxtyping-packages=$(CHECKED),tests.typecheck.checked

bench: .venv/ready-bench
	$(BIN)/python -m benchmarks

gallery: .venv/ready
	$(BIN)/python -m examples

format: .venv/ready-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

pin: .venv/ready-dev .venv/ready-bench
	{ head -n 1 constraints.txt; $(BIN)/pip freeze --exclude-editable | grep '=='; } > .venv/constraints.txt
	mv .venv/constraints.txt constraints.txt

clean:
	rm -rf .venv $(OUT)

# Stamps: a second run has nothing to install.
.venv/made:
	@test -n "$(PYTHON)" || { echo "make: no python3 or python found: install Python 3.11 or newer" >&2; exit 1; }
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "make: $(PYTHON) is $$("$(PYTHON)" -V 2>&1): Python 3.11 or newer is needed (make PYTHON=...)" >&2; exit 1; }
	@"$(PYTHON)" -c 'import venv, ensurepip' 2>/dev/null || \
	  { echo "make: $(PYTHON) lacks venv or ensurepip: install the python3-venv package of your system" >&2; exit 1; }
	@echo "texloom: setting up .venv (once; a few minutes)"
	"$(PYTHON)" -m venv .venv
	@touch $@

.venv/ready: .venv/made pyproject.toml constraints.txt
	$(BIN)/python -m pip install -q --disable-pip-version-check -c constraints.txt -e .
	@touch $@

.venv/ready-%: .venv/made pyproject.toml constraints.txt
	$(BIN)/python -m pip install -q --disable-pip-version-check -c constraints.txt -e '.[$*]'
	@touch $@ .venv/ready
