# SPDX-License-Identifier: MIT
# Two commands matter, and each does all set-up on a fresh Debian 12 machine:
#
#     make demo    compares the shipped recipes on the courtyard and writes a report to look at
#     make test    builds and runs every test; the last line is the count
#
# make measure runs what is too long for either, in some hours: mutants, sweeps, all with sanitizers, tables, pictures.
# The others: build, debug, bench, install, bundle, pictures, docs, format, tidy, clean.
.DEFAULT_GOAL := build
.PHONY: packages build debug demo test measure bench install bundle pictures docs format tidy clean

JOBS ?= $(shell nproc)
PREFIX ?= /usr/local
RELEASE := build/release
GNOMON := $(RELEASE)/gnomon
# Drivers compile shaders on their first use; these caches make the second run fast.
CACHES = MESA_SHADER_CACHE_DIR=$(CURDIR)/$(RELEASE)/mesa-cache GNOMON_CACHE=$(CURDIR)/$(RELEASE)/gnomon-cache
DEMO := -r soft -r pcf -r hard -r volumes --samples 128 --size 640x360

packages:
	@tools/install_packages

build: packages
	@cmake --preset release --log-level=WARNING
	@cmake --build $(RELEASE) -j $(JOBS) --target gnomon

debug: packages
	@cmake --preset debug --log-level=WARNING
	@cmake --build build/debug -j $(JOBS)

demo: build
	@$(CACHES) $(GNOMON) compare courtyard $(DEMO) -o build/report
	@echo "report: $(CURDIR)/build/report/index.html"

test: packages
	@rm -f build/count.txt
	@cmake --preset release --log-level=WARNING
	@cmake --build $(RELEASE) -j $(JOBS) --target tested
	@cmake --preset asan --log-level=WARNING
	@cmake --build build/asan -j $(JOBS) --target tested
	@tools/run_tests --build $(RELEASE) --build build/asan --layout --format --tidy --embed --report --bundle --slowest 20 \
	    --count build/count.txt

measure: packages
	@cmake --preset release --log-level=WARNING
	@cmake --build $(RELEASE) -j $(JOBS)
	@tools/measure --build $(RELEASE)

bench: build
	@cmake --build $(RELEASE) -j $(JOBS) --target performance_ratios
	@$(CACHES) $(RELEASE)/performance_ratios

install: packages
	@cmake --preset release --log-level=WARNING
	@cmake --build $(RELEASE) -j $(JOBS)
	@cmake --install $(RELEASE) --prefix $(PREFIX)

bundle: build
	@tools/bundle --build $(RELEASE) --output build/gnomon-bundle --try

pictures: build
	@tools/install_packages python3-matplotlib
	@$(CACHES) tools/make_pictures $(GNOMON) docs/pictures
	@for curves in docs/curves/*.json; do \
	    tools/draw_curves $$curves docs/pictures/$$(basename $$curves .json).svg || exit 1; done

docs: build
	@tools/make_catalogue $(GNOMON) build/catalogue.md

format:
	@tools/check_format --fix

tidy: packages
	@cmake --preset release --log-level=WARNING
	@tools/check_tidy base gpu shadow reference scenes apps

clean:
	@rm -rf build
