# The short commands. Each does all of its own set-up on a fresh Debian 12; `make help` lists them.
.DEFAULT_GOAL := help
.NOTPARALLEL:
.PHONY: help render test quick dev asan tsan fuzz docs coverage format clean packages peers release python wheel asan-slice fuzz-slice gpu-bundle blender-addon

JOBS ?= $(shell tools/count_jobs.sh)
FUZZ_SECONDS ?= 60
FUZZ_FILES ?= 2000
RELIEF := build/release/bin/relief
SOURCES = $(shell git ls-files --cached --others --exclude-standard '*.cpp' '*.h')

help:
	@echo 'make render    build, and render the sample scene "pumpkin" to out/pumpkin.png'
	@echo 'make test      build, and run all tests'
	@echo 'make quick     build, and run the tests that take seconds: for each step of a change'
	@echo 'make python    the Python module in an environment of its own: build/python/bin/python'
	@echo 'make wheel     a wheel of it that brings its libraries: out/wheels'
	@echo 'make peers     tests against Blender, Mitsuba and others, fetched from the Python package index (0.6 GB the first time)'
	@echo 'make dev       optimised build with internal checks, all tests'
	@echo 'make asan      all tests under the address and undefined-behaviour sanitizers'
	@echo 'make tsan      all tests under the thread sanitizer'
	@echo 'make fuzz      every fuzzer for FUZZ_SECONDS (60) seconds, with sanitizers; then FUZZ_FILES (2000) mutated files'
	@echo 'make coverage  line coverage of the tests: build/coverage/report.txt'
	@echo 'make gpu-bundle  tests and measurements for a bare GPU machine: out/relief-gpu-bundle'
	@echo 'make blender-addon  the extension for Blender with its wheel: out/relief_blender-VERSION.zip'
	@echo 'make docs        the documentation as a site: build/docs'
	@echo 'make format    clang-format over all sources'
	@echo 'make clean     remove build/ (pictures in out/ stay)'
	@echo 'make packages  install the Debian packages of tools/packages.txt that are missing'
	@echo 'JOBS=N sets how many compilers and tests run at once (here $(JOBS)).'

packages:
	@tools/install_packages.sh

# configure_and_build(PRESET, TARGETS, OPTIONS)
define configure_and_build
	cmake --preset $(1) $(3)
	cmake --build --preset $(1) -j $(JOBS) $(if $(2),--target $(2))
endef

# A new build folder begins with the instruction set of this machine alone; `make test` adds the others.
render: packages
	$(call configure_and_build,release,relief,$(if $(wildcard build/release/CMakeCache.txt),,-DRELIEF_ISAS=native))
	@mkdir -p out
	@test -f out/pumpkin/scene.json || $(RELIEF) scene pumpkin -o out/pumpkin
	$(RELIEF) render out/pumpkin/scene.json -o out/pumpkin.png
	@echo "The picture is $(abspath out/pumpkin.png)"

release: packages
	$(call configure_and_build,release,,-DRELIEF_ISAS=all $$(tools/make_python_build.sh build/python-build))

python: packages
	tools/install_python.sh build/python

wheel: packages
	tools/make_wheel.sh build/python-build out/wheels

test: release
	ctest --preset release -j $(JOBS)

quick: packages
	$(call configure_and_build,release,relief relief-bench quick_tests)
	ctest --preset quick -j $(JOBS)

# The modules that hold the arithmetic, without file readers: what continuous integration can afford.
asan-slice: packages
	$(call configure_and_build,asan-slice,core_tests)
	ctest --preset asan-slice -j $(JOBS)

# Three seconds of each fuzzer, without sanitizers, and a minute of mutated files through the command.
fuzz-slice: packages
	$(call configure_and_build,release,fuzzers,-DRELIEF_FUZZ=ON)
	ctest --preset release -R '^fuzz' -j $(JOBS)
	cmake --preset release -DRELIEF_FUZZ=OFF

peers: packages
	-@tools/install_packages.sh tools/peer_packages.txt
	$(call configure_and_build,release,peers)
	ctest --preset peers

dev: packages
	$(call configure_and_build,dev)
	ctest --preset dev -j $(JOBS)

asan: packages
	$(call configure_and_build,asan-ubsan)
	ctest --preset asan-ubsan -j $(JOBS)

tsan: packages
	$(call configure_and_build,tsan)
	ctest --preset tsan -j $(JOBS)

fuzz: packages
	$(call configure_and_build,fuzz,fuzzers)
	tools/run_fuzzers.sh build/fuzz $(FUZZ_SECONDS)
	$(call configure_and_build,release,relief)
	fuzz/command/fuzz_command.py $(RELIEF) --count $(FUZZ_FILES) --keep build/fuzz/command

docs: packages
	tools/make_docs.sh

coverage: packages
	$(call configure_and_build,coverage)
	tools/report_coverage.sh build/coverage $(JOBS)

gpu-bundle: packages
	$(call configure_and_build,release,relief-gpu vulkan_tests)
	tools/make_gpu_bundle.sh build/release out/relief-gpu-bundle

blender-addon: wheel
	python3 blender/make_addon.py out/wheels/relief-*.whl -o out

format: packages
	clang-format -i $(SOURCES)

clean:
	rm -rf build
