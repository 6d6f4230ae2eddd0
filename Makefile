# The commands of the collection; `make` alone lists them.

asked := $(PYTHON)
PYTHON ?= $(shell for python in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$python && break; done)
python := .venv/bin/python

cores = $(shell $(python) -c "import os; print(os.cpu_count() or 1)")
# One process more, where tests wait: for a browser, or for the end of a submission.
more = $(shell $(python) -c "import os; print(1 + (os.cpu_count() or 1))")

# A backend meant for other programs would keep the figures out of the notebooks.
unexport MPLBACKEND
# Each of the fifty kernels of the tests would compile the library again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help lab fresh edit test test-site test-grading test-exercises test-all test-alone bench book pdf pictures grade execute address version

help: ## list the commands
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-14s %s\n", $$1, $$2 }' Makefile

lab: .venv/ready ## open the start page in JupyterLab, in a copy of the notebooks that is yours
	$(python) -m loopbook lab

fresh: .venv/ready ## put a fresh notebook into your copy and keep yours beside it: make fresh CHAPTER=10
	$(python) -m loopbook fresh $(CHAPTER)

edit: .venv/ready ## open the stored notebooks themselves in JupyterLab, to change the collection
	$(python) -m jupyterlab --config jupyter_lab_config.py

test: .venv/ready ## prove the library, the ledger and every cell of every chapter
	$(python) -m pytest -n $(cores)

test-site: .venv/ready ## prove the site: its pages, in a browser, with Python in them, and on paper
	$(python) -m pytest -n $(more) tests/site

test-grading: .venv/ready ## prove the grader: jail, judge, reports, attacks, a term
	$(python) -m pytest -n $(more) tests/exercisegrader tests/books_grading

test-exercises: .venv/ready ## prove every exercise, and every cell of the solutions, also with the numbers of other students
	$(python) -m pytest -n $(more) solutions tests/exercises

test-all: .venv/ready ## prove everything with all variants and all draws, as once a week
	LOOPBOOK_ALL=1 $(python) -m pytest -n $(more) -o bookledger_mutation=true tests lib chapters solutions README.md

test-alone: ## make each package, install it in an empty environment and prove it there, as once a week
	$(PYTHON) tests/repository/alone.py

bench: .venv/ready ## measure what the collection costs beside what it stands on
	$(python) tests/bench.py
	$(python) tests/control_engineering/bench_deadtime.py
	$(python) tests/books_grading/bench_grading.py
	$(python) tests/site/bench_book.py

book: .venv/ready ## make the site of the collection, build/book/index.html; OFFLINE=1 puts Python into it as well
	$(python) docs build/book

pdf: book ## make the whole book as a PDF beside the site, build/book/loopbook.pdf (needs Chromium)
	$(python) docs/pdf build/book

pictures: .venv/ready ## make the README's pictures again
	$(python) docs/pictures.py

grade: .venv/ready ## live through the term of the example course: release, collect, grade, mend, grade again
	$(python) examples/course/term.py

execute: .venv/ready ## run every notebook again, store its outputs, record the lessons that changed and write ERRATA.md
	$(python) -m loopbook execute
	$(python) docs/lessons
	$(python) -m loopbook ledger

address: ## write the address of the repository wherever it stands: make address ADDRESS=https://github.com/OWNER/NAME
	$(PYTHON) tests/repository/release.py address $(ADDRESS)

version: ## write a version, with today as its day, wherever it stands: make version VERSION=0.2.0
	$(PYTHON) tests/repository/release.py version $(VERSION)

# The stamp holds the folder it was made in, because an editable install does not survive a move, and the Python it was
# made with, because whoever names another one wants that.
ifneq ($(shell sed -n 1p .venv/ready 2>/dev/null),$(CURDIR))
.PHONY: .venv/ready
endif
ifneq ($(filter-out $(shell sed -n 2p .venv/ready 2>/dev/null),$(asked)),)
.PHONY: .venv/ready
endif
.venv/ready: environment.txt $(wildcard lib/*/pyproject.toml)
	@test -n "$(PYTHON)" || { echo "loopbook needs Python 3.11 or newer; name one with: make PYTHON=/path/to/python3"; exit 1; }
	$(PYTHON) -m venv $(if $(asked),--clear) .venv
	$(python) -m pip install --quiet --disable-pip-version-check --requirement environment.txt
	@printf '%s\n' "$(CURDIR)" "$(PYTHON)" > $@
