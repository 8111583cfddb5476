# The commands of the project. `make run` and `make test` install what is missing (Debian 12, apt).
JOBS ?= $(shell nproc)
# SINCE=<commit> lets `make lint` look only at what changed since then.
SINCE ?=
# PEER=<stock grblHAL simulator> lets `make bench` measure that too.
PEER ?=
# How long `make test` runs each fuzz target.
KERF_FUZZ_SECONDS ?= 20

.PHONY: run serve screens build test campaign conformance bench bench-analysis bench-stream bench-daemon docs \
  tidy format lint clean

# A part of about four minutes, cut by the built-in virtual grblHAL ten times as fast.
run: build
	build/kerf run examples/coaster.nc --machine "virtual:grblhal?speed=10"

# The web page on a virtual grblHAL, with the same part loaded.
serve: build
	build/kerf serve --program examples/coaster.nc

build:
	tools/install_dependencies.sh run
	test -f build/release/build.ninja || cmake --preset release -DKERF_TESTS=OFF
	cmake --build --preset release --target kerf -j $(JOBS)

# Everything: what is shipped with all its tests, then the core again under the sanitizers with a short run of each
# fuzz target.
test:
	tools/install_dependencies.sh test
	cmake --preset release -DKERF_TESTS=ON
	cmake --build --preset release -j $(JOBS)
	ctest --preset release
	cmake --preset asan -DKERF_FUZZ_SECONDS=$(KERF_FUZZ_SECONDS)
	cmake --build --preset asan -j $(JOBS)
	ctest --preset asan

# RUNS jobs with faults by chance in virtual time, from seed SEED on, in JOBS processes (src/simulation/campaign.hpp).
# What fails says its seed; `build/release/tests/campaign/campaign --replay SEED` tells it in full.
RUNS ?= 10000
SEED ?= 1
campaign:
	tools/install_dependencies.sh test
	cmake --preset release -DKERF_TESTS=ON
	cmake --build --preset release --target campaign -j $(JOBS)
	build/release/tests/campaign/campaign --runs $(RUNS) --seed $(SEED) --jobs $(JOBS)

# HOURS hours of clean jobs without a false alarm, and DAMAGED jobs with a damaged byte that are noticed, on each
# firmware (src/simulation/conformance.hpp), from seed SEED on. `conformance_hours --seed N` runs one again.
HOURS ?= 100
DAMAGED ?= 130
conformance:
	tools/install_dependencies.sh test
	cmake --preset release -DKERF_TESTS=ON
	cmake --build --preset release --target conformance_hours -j $(JOBS)
	build/release/tests/conformance_hours --hours $(HOURS) --damaged $(DAMAGED) --from-seed $(SEED)

# How fast Kerf plans and simulates (bench/README.md). The simulator listens on every interface, so it gets a network of
# its own.
BENCH = build/release/bench/speed --kerf build/kerf examples/coaster.nc
bench: build
	cmake --build --preset release --target speed -j $(JOBS)
ifeq ($(PEER),)
	$(BENCH)
else
	unshare --map-root-user --net sh -c 'ip link set lo up && exec $(BENCH) --peer $(PEER)'
endif

# How fast programs of MEGABYTES are opened, understood and drawn, on one thread (bench/README.md). They are held in
# memory whole.
MEGABYTES ?= 10,100
ROUNDS ?= 3
bench-analysis: build
	cmake --build --preset release --target analysis --target toolpath -j $(JOBS)
	build/release/bench/analysis --rounds $(ROUNDS) --megabytes $(MEGABYTES)
	build/release/bench/toolpath

# How fast Kerf streams, beside the least program that can (bench/README.md). ONLY=speed, wire, hold or memory for
# a part.
ONLY ?= all
bench-stream: build
	cmake --build --preset release --target stream --target least_counter --target session_cost -j $(JOBS)
	build/release/bench/session_cost
	build/release/bench/stream --kerf build/kerf --floor build/release/bench/least_counter --only $(ONLY)

# What the daemon costs: at rest, and with twenty machines at work on one core (bench/README.md).
bench-daemon: build
	KERF=build/kerf python3 -B bench/daemon.py

# The tables of docs/protocol, from the code.
docs: build
	cmake --build --preset release --target vocabulary -j $(JOBS)
	build/release/tools/vocabulary/vocabulary docs/protocol/tables

# The pictures of the page in docs/screens, taken in a browser.
screens: build
	KERF=$(CURDIR)/build/kerf KERF_SCREENS=$(CURDIR)/docs/screens \
	  tools/in_web.sh ../tests/browser/run.sh ../build/screens screens

# The rules of docs/architecture.md, in a second.
tidy:
	tools/tidy.py

format:
	tools/format.sh

# The form of every file and clang-tidy over every source.
lint:
	tools/install_dependencies.sh lint
	tools/format.sh --check
	cmake --preset asan -B build/lint -DKERF_EDGES=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
	tools/clang_tidy.sh build/lint $(SINCE)

clean:
	rm -rf build
