# Two commands do everything: `make demo` and `make test`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: demo test check wheel bench bench-long figures docs soak fuzz mutants clean

$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check -e '.[dev]'
	touch $@

# without what only tests and checks need, which takes several times as long to get
$(VENV)/plain: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check -e .
	touch $@

demo: $(VENV)/plain
	$(BIN)/morfax run samples/cam.png -o demo

# on every core; worksteal keeps the tests of a file together as long as both have work, so fixtures are made once
test: $(VENV)/installed
	$(BIN)/pytest -n auto --dist worksteal

check: $(VENV)/installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# the wheel, in dist/, with compiled kernels: nothing is compiled where it is installed (x86-64, this Python's version).
# For several Pythons in one wheel call it once for each: make wheel PYTHON=python3.12 VENV=.venv312
wheel: $(VENV)/installed
	$(BIN)/python -m morfax.motion.wheel_kernels
	rm -rf build
	$(BIN)/python -m build --wheel

bench: $(VENV)/installed
	$(BIN)/python -m benchmarks

# large sheets, plates of many holes and batches: half an hour, 3 GB of disk
bench-long: $(VENV)/installed
	$(BIN)/python -m benchmarks large
	$(BIN)/python -m benchmarks holes
	$(BIN)/python -m benchmarks batch

figures: $(VENV)/installed
	$(BIN)/python -m docs.figures

$(VENV)/documented: $(VENV)/installed
	$(BIN)/pip install --quiet --disable-pip-version-check -e '.[docs]'
	touch $@

# the site of the documentation, in site/; any warning is an error
docs: $(VENV)/documented
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

# the tests of trust at full length: every pair of wear, ten thousand dropouts, tapes of three and six hours; 12 GB, about an hour.
# Then the table of attacks, TAPES of each kind on every core: 100 000 in all, some hours
TAPES ?= 1137
JOBS ?= $(shell nproc)
soak: $(VENV)/installed
	MORFAX_SOAK=1 $(BIN)/pytest tests/player/test_worn.py tests/player/test_long.py tests/console/test_killed.py -s
	$(BIN)/python -m tests.player.attacks $(TAPES) 0 $(JOBS)
	$(BIN)/python -m benchmarks dropouts 1000

# one wrong line at a time into a room, and whether its tests notice: ROOM=player/gcode SAMPLE=60 (0: all of them)
ROOM ?= player/gcode
SAMPLE ?= 0
SEED ?= 1
mutants: $(VENV)/installed
	$(BIN)/python -m tests.mutants $(ROOM) --sample $(SAMPLE) --seed $(SEED)

# broken files and tapes until something breaks: SECONDS for each reader of text, then RUNS=1000000 tapes
SECONDS ?= 60
RUNS ?= 1000000
fuzz: $(VENV)/installed
	$(BIN)/pip install --quiet --disable-pip-version-check -e '.[fuzz]'
	$(BIN)/python -m fuzz.readers $(SECONDS)
	$(BIN)/python -m fuzz.tapes -runs=$(RUNS) -timeout=2 -rss_limit_mb=1024 -max_len=4096

clean:
	rm -rf $(VENV) demo site dist
