# reposed: virtual rotary-drum tests. `make help` lists the targets.

PACKAGES := gcc make git pkg-config curl ca-certificates libmicrohttpd-dev libjansson-dev libsqlite3-dev libhdf5-dev zlib1g-dev libyaml-dev libseccomp-dev libcurl4-openssl-dev \
            nettle-dev liblapacke-dev
TEST_PACKAGES := libcmocka-dev python3-pytest python3-pytest-xdist python3-requests python3-h5py python3-vtk9 python3-jsonschema \
                 python3-yaml python3-numpy python3-matplotlib python3-selenium chromium chromium-driver fonts-dejavu-core python3-owslib
TORTURE_PACKAGES := slurmctld slurmd slurm-client munge
REPORT_PACKAGES := python3-requests python3-h5py python3-numpy python3-matplotlib
PEER_PACKAGES := lammps liggghts
DEB_PACKAGES := dpkg-dev
LINT_PACKAGES := clang-format clang-tidy cppcheck
FUZZ_PACKAGES := clang libclang-rt-dev

, := ,
PYTHON := /usr/bin/python3
BUILD := build
DATA := data
PORT := 8080
PREFIX := /usr/local
DESTDIR :=
TORTURE := tests/service
SECONDS := 60
FUZZ := $(patsubst tests/fuzz/fuzz_%.c,%,$(wildcard tests/fuzz/fuzz_*.c))
FUZZ_CC := clang
CC := gcc
OPT := -O2
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef -Wvla $(if $(CI),-Werror)
HARDENING := $(if $(SANITIZE),,-D_FORTIFY_SOURCE=2) -fstack-protector-strong
CFLAGS := -std=c17 -g $(OPT) $(WARNINGS) -MMD -MP $(SANITIZE)
LDFLAGS := $(SANITIZE)

# Contraction off: an expression has the same bits wherever the compiler inlines it.
CORE_FLAGS := -ffp-contract=off -fno-math-errno -fno-trapping-math -fopenmp -Wno-psabi
# The core is compiled once for each set of instructions, and for each in both precisions: single-avx512, double-plain, ...
# repose is single-plain, which any x86-64 runs, and hands over to the program for the processor it is on.
VARIANTS := $(foreach p,single double,$(foreach i,avx512 avx2 plain,$(p)-$(i)))
avx512_FLAGS := -O3 -march=x86-64-v4
avx2_FLAGS := -O3 -march=x86-64-v3
plain_FLAGS := -O2
isa = $(lastword $(subst -, ,$(1)))
variant_flags = $($(call isa,$(1))_FLAGS) $(if $(filter double-%,$(1)),-DDEM_DOUBLE)
# What this machine can run: tests and benchmarks are built for the best of it. ISA=avx2: for another.
CPU_FLAGS := $(shell grep -m 1 '^flags' /proc/cpuinfo)
ISAS := $(if $(filter avx512vl,$(CPU_FLAGS)),avx512) $(if $(filter avx2,$(CPU_FLAGS)),avx2) plain
ISA := $(firstword $(ISAS))
VARIANT := $(if $(DOUBLE),double,single)-$(ISA)
RUNNABLE := $(foreach i,$(ISAS),$(filter %-$(i),$(VARIANTS)))
API_FLAGS := -D_GNU_SOURCE $(HARDENING)
# An expression of the planner has the same bits however the compiler inlines it, as in the core.
PLAN_FLAGS := -D_GNU_SOURCE -ffp-contract=off $(HARDENING)
LAPACK_LIBS := -llapacke
WORKER_FLAGS = -D_GNU_SOURCE $(HARDENING) $(HDF5_CFLAGS)
DAEMON_FLAGS := -D_GNU_SOURCE $(HARDENING) -pthread

# The rooms: what is compiled in a folder sees the headers of these folders and no others, so that a layer which reaches
# up does not compile. Each line may name the line of a folder below.
core/rules_SEES := include
core/numbers_SEES := include core/numbers
core/bodies_SEES := $(core/numbers_SEES) core/bodies
core/walls_SEES := $(core/bodies_SEES) core/walls
core/contacts_SEES := $(core/walls_SEES) core/contacts
core/scene_SEES := $(core/contacts_SEES) core/scene
core/measures_SEES := $(core/scene_SEES) core/measures
core_SEES := $(core/measures_SEES)
api/text_SEES := include api/text
api/spec_SEES := $(api/text_SEES) api/spec
api/process/scene_SEES := $(api/spec_SEES) api/process/scene
api/process/granule_SEES := $(api/process/scene_SEES) api/process/granule
api/process/drum_SEES := $(api/process/scene_SEES) api/process/drum
api/process/fill_SEES := $(api/process/scene_SEES) api/process/fill
api/process/heap_SEES := $(api/process/scene_SEES) api/process/heap
api/process/orifice_SEES := $(api/process/scene_SEES) api/process/orifice
PROCESSES := $(wildcard api/process/*)
api/process_SEES := $(api/spec_SEES) $(filter-out %.c,$(PROCESSES))
api/study_SEES := $(api/spec_SEES) api/study
api/plan_SEES := $(api/spec_SEES) api/plan
api/store_SEES := $(api/study_SEES) api/plan api/store
api/http_SEES := $(api/store_SEES) api/http
server/daemon/base_SEES := $(api/http_SEES) server/daemon/base
server/daemon/store_SEES := $(server/daemon/base_SEES) server/daemon/store
server/daemon/queue_SEES := $(server/daemon/store_SEES) server/daemon/queue
server/daemon/http_SEES := $(server/daemon/queue_SEES) server/daemon/http
server/daemon/slurm_SEES := $(server/daemon/queue_SEES) server/daemon/slurm
server/daemon_SEES := $(server/daemon/http_SEES) server/daemon/slurm
server/worker/files_SEES := $(api/process_SEES) server/worker/files
server/worker/confine_SEES := server/worker/files server/worker/confine
server/worker/run_SEES := $(sort $(api/process_SEES) $(api/study_SEES) $(api/plan_SEES)) server/worker/files server/worker/run
server/worker_SEES := $(server/worker/run_SEES) server/worker/confine
server/plan/numbers_SEES := server/plan/numbers
server/plan_SEES := $(api/spec_SEES) api/plan server/worker/confine server/plan/numbers server/plan server/plan/answer
server/plan/answer_SEES := $(server/plan_SEES)
# $(call sees,FILE): the -I list of a file, which is its folder's. Tests see everything that they are linked with.
sees = $(addprefix -I,$($(patsubst %/,%,$(dir $(1)))_SEES))
API_SEES := $(addprefix -I,$(sort $(api/process_SEES) $(api/plan_SEES) $(api/http_SEES)))

# Asked for when something is compiled, not when this file is read: `make help` needs no pkg-config.
HDF5_CFLAGS = $(shell pkg-config --cflags hdf5-serial)
HDF5_LIBS = $(shell pkg-config --libs hdf5-serial)

RULES_SOURCES := $(wildcard core/rules/*.c)
CORE_SOURCES := $(filter-out $(RULES_SOURCES),$(wildcard core/*.c core/*/*.c))
RULES := $(BUILD)/librules.a
DEM := $(BUILD)/core/$(VARIANT)/libdem.a
API := $(patsubst %.c,$(BUILD)/%.o,$(wildcard api/*/*.c api/*/*/*.c))
WORKER := $(patsubst %.c,$(BUILD)/%.o,$(wildcard server/worker/*.c server/worker/*/*.c))
DAEMON := $(patsubst %.c,$(BUILD)/%.o,$(wildcard server/daemon/*.c server/daemon/*/*.c))
DAEMON_PARTS := $(filter-out $(BUILD)/server/daemon/main.o,$(DAEMON))
PLAN := $(patsubst %.c,$(BUILD)/%.o,$(wildcard server/plan/*.c server/plan/*/*.c))
PHYSICS := $(patsubst tests/physics/%.c,%,$(wildcard tests/physics/*.c))
# What differs from variant to variant, once for each that this machine can run.
KERNEL_TESTS = $(foreach v,$(filter-out $(VARIANT),$(RUNNABLE)),$(patsubst %,$(BUILD)/tests/unit/core/%-$(v),test_contact_forces test_two_bodies test_cell_grid))
# ROOMS="api daemon": of these alone; LEFT_OUT: but for these.
UNIT_TESTS = $(filter-out $(addprefix %/,$(LEFT_OUT)),$(patsubst %.c,$(BUILD)/%,$(wildcard $(foreach r,$(or $(ROOMS),*),tests/unit/$(r)/test_*.c))))

programs: $(BUILD)/repose $(patsubst %,$(BUILD)/repose-%,$(filter-out single-plain,$(VARIANTS))) $(BUILD)/repose-plan $(BUILD)/reposed ## build both programs with what is installed
all: packages ## install what is missing and build both programs
	@$(MAKE) --no-print-directory programs
.DEFAULT_GOAL := all

# As many compilers at once as there are processors, unless -j says otherwise; several targets one after the other.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc)
ifneq ($(word 2,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif
endif
# A line a file, or with V=1 the whole commands.
SAY = $(if $(V),@:,@printf '%-7s %s\n')
QUIET := $(if $(V),,@)

# $(call core,VARIANT): its objects, its library and its program.
define core
$(BUILD)/core/$(1)/%.o: core/%.c Makefile
	@mkdir -p $$(@D)
	$(SAY) compile "$$< for $(1)"
	$(QUIET)$(CC) $(CFLAGS) $(CORE_FLAGS) $(call variant_flags,$(1)) $$(call sees,$$<) -c $$< -o $$@
$(BUILD)/core/$(1)/libdem.a: $(patsubst core/%.c,$(BUILD)/core/$(1)/%.o,$(CORE_SOURCES))
	@rm -f $$@ && ar rcs $$@ $$^
$(BUILD)/repose$(if $(filter-out single-plain,$(1)),-$(1)): $(WORKER) $(BUILD)/commit.o $(BUILD)/libapi.a $(BUILD)/core/$(1)/libdem.a $(RULES)
	$(SAY) link $$@
	$(QUIET)$(CC) $(LDFLAGS) -fopenmp $$^ -o $$@ $$(HDF5_LIBS) -lz -lnettle -ljansson -lseccomp -lm
endef
$(foreach v,$(VARIANTS),$(eval $(call core,$(v))))
# The rules, which the core and the daemon have in common, are compiled once, for any processor.
$(BUILD)/core/rules/%.o: core/rules/%.c Makefile
	@mkdir -p $(@D)
	$(SAY) compile $<
	$(QUIET)$(CC) $(CFLAGS) $(CORE_FLAGS) $(call sees,$<) -c $< -o $@
$(RULES): $(patsubst %.c,$(BUILD)/%.o,$(RULES_SOURCES))
	@rm -f $@ && ar rcs $@ $^
$(BUILD)/api/%.o: api/%.c Makefile
	@mkdir -p $(@D)
	$(SAY) compile $<
	$(QUIET)$(CC) $(CFLAGS) $(API_FLAGS) $(call sees,$<) -c $< -o $@
$(BUILD)/server/worker/%.o: server/worker/%.c Makefile
	@mkdir -p $(@D)
	$(SAY) compile $<
	$(QUIET)$(CC) $(CFLAGS) $(WORKER_FLAGS) $(call sees,$<) -c $< -o $@
$(BUILD)/server/plan/%.o: server/plan/%.c Makefile
	@mkdir -p $(@D)
	$(SAY) compile $<
	$(QUIET)$(CC) $(CFLAGS) $(PLAN_FLAGS) $(call sees,$<) -c $< -o $@
# walks over arrays
$(BUILD)/server/daemon/store/job_index_%.o: CFLAGS += -O3
$(BUILD)/server/daemon/%.o: server/daemon/%.c Makefile
	@mkdir -p $(@D)
	$(SAY) compile $<
	$(QUIET)$(CC) $(CFLAGS) $(DAEMON_FLAGS) $(call sees,$<) -c $< -o $@

$(BUILD)/libapi.a: $(API)
	@rm -f $@ && ar rcs $@ $^
$(BUILD)/reposed: $(DAEMON) $(BUILD)/commit.o $(BUILD)/libapi.a $(RULES)
	$(SAY) link $@
	$(QUIET)$(CC) $(LDFLAGS) -pthread $^ -o $@ -lmicrohttpd -ljansson -lsqlite3 -lyaml -lz -lnettle -lm
# What plans calibrations: the one program that links linear algebra.
$(BUILD)/repose-plan: $(PLAN) $(patsubst %,$(BUILD)/server/worker/confine/confine_%.o,calls files) $(BUILD)/commit.o $(BUILD)/libapi.a $(RULES)
	$(SAY) link $@
	$(QUIET)$(CC) $(LDFLAGS) $^ -o $@ $(LAPACK_LIBS) -lnettle -ljansson -lseccomp -lm
# The commit that programs were made from, for --version; COMMIT=... where the sources are no clone.
COMMIT = $(shell [ ! -e .git ] || git describe --always --dirty --abbrev=12 --exclude '*' 2>/dev/null)
$(BUILD)/commit.c: FORCE
	@mkdir -p $(@D)
	@line='const char reposed_commit[] = "$(if $(COMMIT), (commit $(COMMIT)))";'; echo "$$line" | cmp -s - $@ || echo "$$line" >$@
$(BUILD)/commit.o: $(BUILD)/commit.c
	$(QUIET)$(CC) $(CFLAGS) -include api/text/version.h -c $< -o $@
# Changes when ISA or DOUBLE does, so that what is built for one is not taken for the other.
$(BUILD)/variant: FORCE
	@mkdir -p $(@D)
	@echo $(VARIANT) | cmp -s - $@ || echo $(VARIANT) >$@
FORCE:
$(BUILD)/tests/bench/%: tests/bench/%.c tests/bench/bed.h $(BUILD)/libapi.a $(DEM) $(RULES) $(BUILD)/variant
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(call variant_flags,$(VARIANT)) -Wno-psabi $(addprefix -I,$(core_SEES)) $(API_SEES) $< $(BUILD)/libapi.a $(DEM) $(RULES) \
	  $(LDFLAGS) -fopenmp -ljansson -lm -o $@
# Unit tests see the insides of what they test, and are linked with that alone.
$(BUILD)/libdaemon.a: $(DAEMON_PARTS)
	@rm -f $@ && ar rcs $@ $^
$(BUILD)/tests/unit/core/%: tests/unit/core/%.c $(DEM) $(RULES) $(BUILD)/variant
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(call variant_flags,$(VARIANT)) -Wno-psabi $(addprefix -I,$(core_SEES)) -Itests/unit $< \
	  $(DEM) $(RULES) $(LDFLAGS) -fopenmp -lcmocka -lm -o $@
# The allocations of the core go through the test, which lets one fail.
$(BUILD)/tests/unit/core/test_allocations: LDFLAGS += $(patsubst %,-Wl$(,)--wrap=%,malloc calloc realloc aligned_alloc free)
$(BUILD)/tests/unit/api/%: tests/unit/api/%.c $(BUILD)/libapi.a $(RULES)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(API_SEES) -Itests/unit $< $(BUILD)/libapi.a $(RULES) $(LDFLAGS) -lcmocka -ljansson -lnettle -lm -o $@
$(BUILD)/libworker.a: $(filter-out $(BUILD)/server/worker/main.o,$(WORKER))
	@rm -f $@ && ar rcs $@ $^
$(BUILD)/tests/unit/worker/%: tests/unit/worker/%.c $(BUILD)/libworker.a $(BUILD)/libapi.a $(BUILD)/core/single-plain/libdem.a $(RULES)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(addprefix -I,$(server/worker_SEES)) -Itests/unit $< $(BUILD)/libworker.a $(BUILD)/libapi.a \
	  $(BUILD)/core/single-plain/libdem.a $(RULES) $(LDFLAGS) -fopenmp -lcmocka $(HDF5_LIBS) -lz -lnettle -ljansson -lseccomp -lm -o $@
$(BUILD)/libplan.a: $(filter-out $(BUILD)/server/plan/main.o,$(PLAN))
	@rm -f $@ && ar rcs $@ $^
$(BUILD)/tests/unit/plan/%: tests/unit/plan/%.c $(BUILD)/libplan.a $(BUILD)/libapi.a $(RULES)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(addprefix -I,$(server/plan_SEES)) -Itests/unit $< $(BUILD)/libplan.a $(BUILD)/libapi.a $(RULES) \
	  $(LDFLAGS) -lcmocka $(LAPACK_LIBS) -lnettle -ljansson -lm -o $@
$(BUILD)/tests/unit/daemon/%: tests/unit/daemon/%.c $(BUILD)/libdaemon.a $(BUILD)/libapi.a $(RULES)
	@mkdir -p $(@D)
	$(SAY) link $@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(API_SEES) $(addprefix -I,$(server/daemon_SEES)) -Itests/unit $< $(BUILD)/libdaemon.a \
	  $(BUILD)/libapi.a $(RULES) $(LDFLAGS) -pthread -lcmocka -lmicrohttpd -ljansson -lsqlite3 -lyaml -lz -lnettle -lm -o $@
# Fuzzers are linked with what they read alone: those of the worker's files with the core, those of what comes in with the daemon.
FUZZ_HEADERS := $(wildcard tests/fuzz/*.h)
WORKER_FILES := $(filter $(BUILD)/server/worker/files/%,$(WORKER))
# $(call fuzz,FOLDERS OF HEADERS,OBJECTS,LIBRARIES)
fuzz_link = $(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(API_SEES) $(1) $< $(2) $(BUILD)/libapi.a $(RULES) -fsanitize=fuzzer $(LDFLAGS) $(3) -ljansson -lm -o $@
$(BUILD)/fuzz_%: tests/fuzz/fuzz_%.c $(FUZZ_HEADERS) $(BUILD)/libapi.a $(RULES)
	$(SAY) link $@
	$(call fuzz_link)
$(BUILD)/fuzz_checkpoint $(BUILD)/fuzz_start: $(BUILD)/fuzz_%: tests/fuzz/fuzz_%.c $(FUZZ_HEADERS) $(WORKER_FILES) $(BUILD)/libapi.a $(RULES) $(DEM)
	$(SAY) link $@
	$(call fuzz_link,$(HDF5_CFLAGS) $(addprefix -I,$(server/worker/files_SEES)),$(WORKER_FILES) $(DEM),-lgomp $(HDF5_LIBS) -lz -lnettle)
$(BUILD)/fuzz_events $(BUILD)/fuzz_request $(BUILD)/fuzz_result: $(BUILD)/fuzz_%: tests/fuzz/fuzz_%.c $(FUZZ_HEADERS) $(DAEMON_PARTS) $(BUILD)/libapi.a $(RULES)
	$(SAY) link $@
	$(call fuzz_link,$(addprefix -I,$(server/daemon_SEES)),$(DAEMON_PARTS),-pthread -lmicrohttpd -lsqlite3 -lyaml -lz -lnettle)
# Programs that drive the core's own step for the physics tests, which compare what they print.
# $(call variant_tests,VARIANT): those, and the unit tests of what differs from variant to variant.
define variant_tests
$(BUILD)/tests/$(1)/%: tests/physics/%.c $(BUILD)/core/$(1)/libdem.a $(RULES)
	@mkdir -p $$(@D)
	$(SAY) link $$@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(call variant_flags,$(1)) -Wno-psabi $(addprefix -I,$(core_SEES)) -Itests/unit $$< \
	  $(BUILD)/core/$(1)/libdem.a $(RULES) $(LDFLAGS) -fopenmp -lcmocka -lm -o $$@
$(BUILD)/tests/unit/core/%-$(1): tests/unit/core/%.c $(BUILD)/core/$(1)/libdem.a $(RULES)
	@mkdir -p $$(@D)
	$(SAY) link $$@
	$(QUIET)$(CC) $(CFLAGS) -D_GNU_SOURCE $(call variant_flags,$(1)) -Wno-psabi $(addprefix -I,$(core_SEES)) -Itests/unit $$< \
	  $(BUILD)/core/$(1)/libdem.a $(RULES) $(LDFLAGS) -fopenmp -lcmocka -lm -o $$@
endef
$(foreach v,$(VARIANTS),$(eval $(call variant_tests,$(v))))

demo: all ## the paper's drum from curl to an angle of repose, with nothing prepared
	@sh tests/demo.sh $(BUILD)

serve: all ## the daemon in the foreground: PORT=8080 DATA=data
	@$(BUILD)/reposed serve --port $(PORT) --data "$(DATA)"

screenshots: test-packages programs ## README's pictures of the page, web/pictures, made anew from real runs
	@REPOSED_BUILD=$(BUILD) $(PYTHON) tests/screenshots.py web/pictures

test: test-packages ## unit, short physics and service tests; closes with a line that counts them
	@$(MAKE) --no-print-directory check programs $(UNIT_TESTS) $(KERNEL_TESTS) physics-programs
	@PYTHON=$(PYTHON) sh tests/run.sh $(BUILD)

unit: test-packages ## unit tests by the best instructions of this machine; TEST=test_wave: one of them
	@$(MAKE) --no-print-directory $(WANTED_TESTS)
	@sh tests/run.sh $(BUILD) unit $(WANTED_TESTS)
WANTED_TESTS = $(if $(TEST),$(or $(filter %/$(TEST),$(UNIT_TESTS)),$(error there is no unit test $(TEST))),$(UNIT_TESTS))

physics: test-packages ## verification, a quarter of an hour: tests/physics/RESULTS.md; LONG=1: all of it, an hour more
	@$(MAKE) --no-print-directory physics-programs
	@$(if $(LONG),rm -f tests/physics/RESULTS.md)
	@REPOSED_BUILD=$(BUILD) $(PYTHON) -m pytest -q -p no:cacheprovider $(if $(LONG),,-m "not long and not torture") tests/physics --results tests/physics/RESULTS.md
# In both precisions by the best instructions of this machine; the hash of states by all of them.
physics-programs: programs $(foreach v,single-$(ISA) double-$(ISA),$(patsubst %,$(BUILD)/tests/$(v)/%,$(PHYSICS))) \
  $(patsubst %,$(BUILD)/tests/%/state_hash,$(RUNNABLE))
	@rm -rf $(BUILD)/tests/single $(BUILD)/tests/double
	@ln -s single-$(ISA) $(BUILD)/tests/single && ln -s double-$(ISA) $(BUILD)/tests/double

torture: test-packages torture-packages ## faults for minutes: damaged files, the n-th call that fails, hostile queries; TORTURE=tests/service/FILE.py: some
	@$(MAKE) --no-print-directory programs
	@REPOSED_BUILD=$(BUILD) $(PYTHON) -m pytest -q -p no:cacheprovider -m torture $(TORTURE)

# What sanitizers look at: one build of the core, with AVX2 where this machine has it, or else gcc takes vectors apart into numbers,
# each with its own checks. Of the debugger only lines, which is what a finding tells: for the rest gcc takes four times as long.
CHECKED_CORE := ISA=plain plain_FLAGS="-O1 -g1 $(if $(filter avx2,$(ISAS)),-march=x86-64-v3)"

# The core is gcc's in any case, so that it is checked, but does not lead the fuzzers.
FUZZ_CHECKS := -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
FUZZ_MAKE = $(MAKE) --no-print-directory BUILD=$(BUILD)/fuzz $(CHECKED_CORE)
fuzz: packages ## hostile bytes for all that reads some, SECONDS=60 for each, under the sanitizers; FUZZ="request start": some
	$(call install,$(FUZZ_PACKAGES),the compiler that fuzzers need)
	@$(MAKE) --no-print-directory $(BUILD)/repose
	$(if $(filter checkpoint start,$(FUZZ)),+@$(FUZZ_MAKE) SANITIZE="$(FUZZ_CHECKS)" $(BUILD)/fuzz/core/single-plain/libdem.a)
	+@$(FUZZ_MAKE) CC="$(FUZZ_CC)" WARNINGS=-Wall SANITIZE="$(FUZZ_CHECKS) -fsanitize=float-cast-overflow,fuzzer-no-link" \
	  $(addprefix $(BUILD)/fuzz/fuzz_,$(FUZZ))
	@sh tests/fuzz/run.sh $(BUILD) $(SECONDS) $(FUZZ)

reproduce: report-packages ## the whole paper, run again: api/studies/REPORT.md; STUDIES="table1 figure3": some of it
	@$(MAKE) --no-print-directory programs
	@$(PYTHON) tests/reproduce $(STUDIES) --build $(BUILD) --data "$(DATA)/reproduce"

# What is where: server/package/install.sh.
install: programs ## programs, page, documents, man pages, completion and service into PREFIX=/usr/local, below DESTDIR=
	@sh server/package/install.sh $(BUILD) "$(DESTDIR)" "$(PREFIX)"

deb: programs ## a package for Debian, build/reposed_VERSION_ARCHITECTURE.deb
	$(call install,$(DEB_PACKAGES),what packages are made with)
	@sh server/package/deb.sh $(BUILD)

check: programs ## the layers: the core needs nothing but libc, libm and OpenMP
	@sh tests/check_layers.sh $(BUILD)

bench: all ## how fast we are, on all kinds of beds, beside the last record: tests/bench/results/; ISA=avx2: by those instructions
	@$(MAKE) --no-print-directory $(BUILD)/tests/bench/bench_table
	@CC=$(CC) PYTHON=$(PYTHON) sh tests/bench/bench.sh $(BUILD) "$(CORE_FLAGS) $(call variant_flags,$(VARIANT))"

bench-peers: all ## the same drum by LAMMPS and LIGGGHTS beside ours, taking turns
	$(call install,$(PEER_PACKAGES),the other codes to compare with)
	@$(MAKE) --no-print-directory $(BUILD)/tests/bench/bench_peers
	@$(PYTHON) tests/bench/bench_peers.py $(BUILD) >$(BUILD)/peers.ndjson
	@$(PYTHON) tests/bench/report.py tests/bench/results --compiler "$(shell $(CC) --version | head -n 1)" --flags "$(CORE_FLAGS) $(call variant_flags,$(VARIANT))" \
	  --peers $(BUILD)/peers.ndjson

bench-service: all ## how fast the daemon answers among many jobs: JOBS=100000
	@$(PYTHON) tests/bench/bench_service.py $(BUILD) $(JOBS)

# Left out: what fails allocations itself, by a wrapper of its own, and runs that take minutes then and call nothing that others do
# not.
asan: test-packages ## unit tests under the address and undefined-behavior sanitizers, in build/asan
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/asan $(CHECKED_CORE) SANITIZE="-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer" \
	  LEFT_OUT="test_allocations test_cluster test_cluster_runs test_container_runs test_energy test_neighbor_list test_piles" unit

# The core's threads are OpenMP's, whose barriers the sanitizer does not see: it would call every step a race. Left out: what holds
# a time that the sanitizer multiplies.
tsan: test-packages ## unit tests of api, daemon and worker under the thread sanitizer, in build/tsan
	@$(MAKE) --no-print-directory BUILD=$(BUILD)/tsan $(CHECKED_CORE) SANITIZE="-fsanitize=thread" ROOMS="api daemon worker" LEFT_OUT=test_start_overlap unit

openapi: programs ## write the schemas of inputs and results, from the rows of both, into api/openapi.yaml
	@$(BUILD)/reposed openapi api/openapi.yaml

format: lint-packages ## clang-format over all C
	@git ls-files '*.c' '*.h' | xargs clang-format -i

format-check: lint-packages ## fails where clang-format would change something
	@git ls-files '*.c' '*.h' | xargs clang-format --dry-run -Werror

# Of each file as it is compiled for any processor: what make would say to the compiler, had nothing been built.
# clang knows the levels of processors that variant.c asks for only from its version 17 on.
# What cppcheck has wrong: `aside` is written by the call that it is handed to (neighbor_pick.c), and a vector of four doubles
# is also an array of them (squared_distance in container.h); memory that is handed on in a struct's member is freed by whoever
# has the struct (tar_stream.c, scene_run.c).
lint: lint-packages ## clang-tidy and cppcheck
	@rm -rf $(BUILD)/lint && mkdir -p $(BUILD)/lint
	@$(MAKE) -n V=1 BUILD=$(BUILD)/lint/objects $(BUILD)/lint/objects/repose $(BUILD)/lint/objects/repose-plan $(BUILD)/lint/objects/reposed | \
	  sed -n 's|^\(.* -c \([^ ]*\) -o .*\)$$|{"directory": "$(CURDIR)", "file": "\2", "command": "\1"},|p' | \
	  sed '1s/^/[/; $$s/,$$/]/' >$(BUILD)/lint/compile_commands.json
	@printf '%s\n' $(RULES_SOURCES) $(CORE_SOURCES) $(wildcard api/*/*.c api/*/*/*.c server/*/*.c server/*/*/*.c) | \
	  xargs -P $(shell nproc) -n 8 clang-tidy --quiet --warnings-as-errors='*' \
	  --extra-arg='-D__builtin_cpu_supports(level)=1' -p $(BUILD)/lint 2>$(BUILD)/lint/log || { cat $(BUILD)/lint/log; false; }
	@cppcheck --quiet -j $(shell nproc) --enable=warning,performance,portability --error-exitcode=1 \
	  --suppress=unknownMacro --suppress=invalidPointerCast --suppress=ctuArrayIndex \
	  --suppress=memleak:api/http/tar_stream.c --suppress=memleak:server/worker/run/scene_run.c --suppress=memleak:server/worker/run/tracing.c \
	  --suppress=legacyUninitvar:core/contacts/neighbor_pick.c --suppress=objectIndex:core/walls/container.h \
	  $(addprefix -I,$(core_SEES) $(server/daemon_SEES)) $(API_SEES) -Iserver/worker/files -Iserver/worker/run $(addprefix -I,$(server/plan_SEES)) core api server

clean: ## remove what was built, and data folders in it; not while a daemon is at work on one of these
	@for lock in $$(find $(BUILD) -maxdepth 4 -type f -name lock 2>/dev/null); do \
	  flock -n $$lock true || { echo "a daemon is at work on $${lock%/lock}, which would be removed: stop that daemon first" >&2; exit 1; }; \
	done
	rm -rf $(BUILD)

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(firstword $(MAKEFILE_LIST)) | sed -E 's/:[^#]*## /\t/' | expand -t 15

# $(call install,PACKAGES,WHAT FOR): by apt-get, with sudo when not root, only what is missing; says so beforehand.
define install
	@missing=$$(for p in $(1); do dpkg-query -W -f='$${Status}' $$p 2>/dev/null | grep -q 'ok installed' || echo $$p; done); \
	if [ -n "$$missing" ]; then \
	  echo "installing by apt-get, $(2):" $$missing; \
	  as=; [ "$$(id -u)" = 0 ] || as=sudo; \
	  $$as apt-get update -qq && $$as env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $$missing >/dev/null; \
	fi
endef
packages:
	$(call install,$(PACKAGES),what the programs are built with)
test-packages: packages
	$(call install,$(TEST_PACKAGES),what the tests need)
# A cluster on this machine; its services are for the tests to start, and not for the machine.
torture-packages:
	$(call install,$(TORTURE_PACKAGES),what tests of faults need)
report-packages: packages
	$(call install,$(REPORT_PACKAGES),what the report needs)
lint-packages: packages
	$(call install,$(LINT_PACKAGES),formatters and linters)

# Every target of the list above, and those that it leaves out.
.PHONY: FORCE packages test-packages torture-packages report-packages lint-packages physics-programs \
  $(shell sed -n 's/^\([a-z-]*\):.*##.*/\1/p' $(firstword $(MAKEFILE_LIST)))
.SECONDARY:
-include $(wildcard $(BUILD)/*/*.d $(BUILD)/*/*/*.d $(BUILD)/*/*/*/*.d $(BUILD)/*/*/*/*/*.d)
