# What people and the continuous integration call. `make` alone lists it.
#
# Python tools live in .venv, made from the first python3 >= 3.10 found. A file there stands for
# each thing that is installed, so that nothing is installed twice and everything is rebuilt when
# its sources change. Python sources need no rebuilding: the package is installed in editable form.

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.NOTPARALLEL:
.PHONY: help report report-peers test check bench count needs accuracy peers peers-check docs package test-deep test-full clean

BIN := .venv/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check install --quiet
DEVELOP := env -u CONDA_PREFIX VIRTUAL_ENV="$(CURDIR)/.venv" $(BIN)/maturin develop --release --quiet
SOURCES := Cargo.toml Cargo.lock pyproject.toml rust/binding/Cargo.toml $(shell find rust -name '*.rs')

PYTHON ?= $(shell for python in python3 python3.14 python3.13 python3.12 python3.11 python3.10; do \
	$$python -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 10))' 2>/dev/null \
	&& echo $$python && break; done)

export CARGO_TARGET_DIR ?= $(CURDIR)/target
export MPLBACKEND := agg

help: ## List what can be made
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-10s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

report: .venv/installed ## Measure error against run time, and write report/
	$(BIN)/culbuto report --output report

# The same cases on every machine, so that a change passes or fails by what it changes; test-deep draws new ones each time.
test: export PROPTEST_RNG_SEED ?= 1
test: check docs package ## Every check and every test
	cargo test --workspace --locked
	$(BIN)/pytest

check: .venv/tools ## Formatting, lints and types
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/stubtest culbuto

bench: ## Measure speed
	cargo bench --workspace --locked

count: ## Count instructions a step (needs valgrind)
	cargo build --release --example instructions --locked
	$(PYTHON) benches/count.py $(CARGO_TARGET_DIR)/release/examples/instructions

accuracy: report ## The report, and the tables of docs/accuracy.md from it
	$(BIN)/python benches/accuracy.py docs/accuracy.json docs/accuracy.md report/rows.json

needs: .venv/installed ## Count what scenes and features cost, for the report's page (needs valgrind; five minutes)
	cargo build --release --example instructions --locked
	$(BIN)/python benches/needs.py $(CARGO_TARGET_DIR)/release/examples/instructions python/culbuto/report/counted.json

# A package of its own, built apart; its own .cargo/config.toml says how Box2D is compiled.
PEERS := $(CURDIR)/target/peers
PEERS_CARGO := cd benches/peers && CARGO_TARGET_DIR=$(PEERS)$(if $(NATIVE),/native RUSTFLAGS="-C target-cpu=native")
PEERS_BUILD := --release --locked $(if $(NATIVE),--features avx2)
ROUNDS ?= 5

peers: $(PEERS)/venv/installed ## Race other engines: SCENES="tumbler washer" ENGINES=culbuto,box2d ROUNDS=5 STEPS=100 NATIVE=1 PAGE=docs/peers.md
	$(PEERS_CARGO) cargo run $(PEERS_BUILD) -- $(SCENES) --rounds $(ROUNDS) $(if $(STEPS),--steps $(STEPS)) \
		$(if $(ENGINES),--engines $(ENGINES)) --python $(PEERS)/venv/bin/python \
		--json $(PEERS)/race.json $(if $(PAGE),--page $(abspath $(PAGE)))

report-peers: .venv/installed $(PEERS)/venv/installed ## The report with other engines on the same axes
	mkdir -p report
	$(PEERS_CARGO) cargo run $(PEERS_BUILD) -- --study --python $(PEERS)/venv/bin/python --json $(CURDIR)/report/peers.json
	$(BIN)/culbuto report --output report --peers report/peers.json

peers-check: $(PEERS)/venv/installed ## Formatting, lints and tests of benches/peers
	$(PEERS_CARGO) cargo fmt --check
	$(PEERS_CARGO) cargo clippy --no-deps --all-targets $(PEERS_BUILD) -- -D warnings
	$(PEERS_CARGO) PEERS_PYTHON=$(PEERS)/venv/bin/python cargo test $(PEERS_BUILD)

$(PEERS)/venv/installed:
	rm -rf $(@D) && mkdir -p $(PEERS)
	$(PYTHON) -m venv $(@D)
	$(@D)/bin/python -m pip --disable-pip-version-check install --quiet "pymunk==7.3.*"
	$(@D)/bin/python -m pip --disable-pip-version-check install --quiet "box2d==2.3.*" \
		|| echo "box2d does not install on this Python and is left out" >&2
	touch $@

docs: ## Documentation of the crate, in target/doc
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

PACKAGE := target/package
package: .venv/tools ## Source distribution, a wheel from it, and that wheel in an empty environment
	rm -rf $(PACKAGE) && mkdir -p $(PACKAGE)
	$(BIN)/maturin sdist --out $(PACKAGE)
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python -m pip wheel --quiet --no-deps --no-build-isolation \
		--wheel-dir $(PACKAGE) $(PACKAGE)/culbuto-*.tar.gz
	$(BIN)/python -m venv $(PACKAGE)/venv
	$(PACKAGE)/venv/bin/python -m pip --disable-pip-version-check install --quiet $(PACKAGE)/culbuto-*.whl
	cd $(PACKAGE) && venv/bin/culbuto --version

test-deep: .venv/tools ## The property tests with many more cases (tens of minutes)
	PROPTEST_CASES=10000 cargo test --release --workspace --locked
	CULBUTO_PROFILE=deep $(BIN)/pytest --numprocesses auto

test-full: ## The scenes that take minutes, and docs/full-runs.md from them (half an hour)
	cargo build --release --example full-runs --locked
	$(CARGO_TARGET_DIR)/release/examples/full-runs > docs/full-runs.md

clean: ## Remove everything that was made
	rm -rf .venv target report dist
	find python tests -name __pycache__ -prune -exec rm -rf {} +
	rm -rf .mypy_cache .ruff_cache .pytest_cache .hypothesis python/culbuto/_native.*so

.venv/created:
	@test -n "$(PYTHON)" || { echo "Python >= 3.10 with venv is needed (on Debian and Ubuntu: apt install python3-venv)" >&2; exit 1; }
	rm -rf .venv
	$(PYTHON) -m venv .venv
	$(PIP) --upgrade pip
	touch $@

.venv/installed: .venv/created $(SOURCES)
	$(PIP) "maturin>=1.16,<2"
	$(DEVELOP) --extras plot
	touch $@

.venv/tools: pyproject.toml | .venv/installed
	$(DEVELOP) --extras plot,test --group dev
	touch $@
