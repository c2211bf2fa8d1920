# Short names for the usual jobs. Each installs the packages that it misses
# (scripts/install-packages.sh), configures, builds and runs; none ever asks a question.

.DEFAULT_GOAL := build
.PHONY: build demo gallery test web web-test bench gpu-test asan tsan fuzz format install clean help

PREFIX ?= /usr/local
INPUT ?= builtin:sunset
DEMO ?= demo
# More options for CMake: make CONFIGURE=-DCMAKE_CXX_COMPILER=clang++
CONFIGURE ?=
# The same for the page; and `make test WEB=no` leaves it out.
WEB_CONFIGURE ?=
WEB ?= yes
PROGRAM := build/release/mirrorball

help:  ## list the jobs
	@sed -n 's/^\([a-z-]*\):.*## /    make \1@/p' $(MAKEFILE_LIST) | awk -F@ '{ printf "%-18s %s\n", $$1, $$2 }'

build:  ## build the library, the program and the tests (Release, in build/release)
	@scripts/install-packages.sh build test
	@cmake --preset release $(CONFIGURE)
	@cmake --build --preset release

demo:  ## bake the built-in sunset into ./demo and say where its page is
	@scripts/install-packages.sh build test
	@cmake --preset release $(CONFIGURE)
	@cmake --build --preset release --target mirrorball_program
	$(PROGRAM) bake $(INPUT) -o $(DEMO)
	@printf '\nOpen this page in a browser:  %s\n' '$(abspath $(DEMO))/index.html'
	@printf 'Bake a panorama of your own:  %s bake FILE.hdr -o DIR\n' '$(PROGRAM)'

gallery:  ## make the pictures of docs/gallery again, by the commands in its README
	@scripts/install-packages.sh build test
	@cmake --preset release $(CONFIGURE)
	@cmake --build --preset release --target mirrorball_program
	@scripts/gallery.sh build/release

test: build  ## build everything and run all tests; the page's too where its packages are installed
ifeq ($(WEB),no)
	@ctest --preset release -E '^web$$'
else
	@missing=$$(scripts/install-packages.sh --missing web | paste -sd ' '); \
	if [ -z "$$missing" ]; then $(MAKE) web; \
	else printf 'The page for browsers is not tested: the packages %s are missing (make web installs them)\n' "$$missing"; fi
	@ctest --preset release
endif

web:  ## build the page for browsers: a folder of static files, build/web/page
	@scripts/install-packages.sh build web
	@cmake --preset web $(WEB_CONFIGURE)
	@cmake --build --preset web
	@printf '\nThe page is in %s; to see it:  %s serve\n' '$(abspath build/web/page)' '$(PROGRAM)'

web-test: web  ## test the page in Chromium, against the program's pictures
	@scripts/install-packages.sh test
	@cmake --preset release
	@cmake --build --preset release --target mirrorball_program
	@MIRRORBALL_WEB_REQUIRED=1 scripts/web-test.sh build/web $(PROGRAM)

bench:  ## build and run the benchmarks
	@scripts/install-packages.sh build test bench
	@cmake --preset release $(CONFIGURE) -DMIRRORBALL_BUILD_BENCHMARKS=ON
	@cmake --build --preset release
	@build/release/mirrorball_benchmarks --benchmark_repetitions=5 --benchmark_report_aggregates_only=true

gpu-test:  ## run the renderer's tests and time its frames on the graphics card that EGL finds
	@scripts/install-packages.sh build test bench
	@cmake --preset release $(CONFIGURE) -DMIRRORBALL_BUILD_BENCHMARKS=ON
	@cmake --build --preset release --target mirrorball_gl_tests mirrorball_render_benchmarks
	@build/release/tests/gl/mirrorball_gl_tests
	@build/release/mirrorball_render_benchmarks --benchmark_counters_tabular=true \
	    --benchmark_out=build/release/frame-times.json --benchmark_out_format=json
	@printf '\nThe same as JSON: build/release/frame-times.json\n'

asan:  ## build and run the tests under the address and undefined-behaviour sanitizers
	@scripts/install-packages.sh build test
	@cmake --preset asan $(CONFIGURE)
	@cmake --build --preset asan
	@ctest --preset asan -E '^web$$'

tsan:  ## build and run the tests under the thread sanitizer
	@scripts/install-packages.sh build test
	@cmake --preset tsan $(CONFIGURE)
	@cmake --build --preset tsan
	@ctest --preset tsan -E '^web$$'

fuzz:  ## feed each decoder malformed files for a bounded number of runs
	@scripts/install-packages.sh build test fuzz
	@scripts/fuzz.sh

format:  ## lay out all sources by .clang-format
	@scripts/install-packages.sh format
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

install: build  ## install the program, the library and its CMake package under PREFIX
	@cmake --install build/release --prefix '$(PREFIX)'

clean:  ## remove everything that was built
	@rm -rf build
