# reposed: virtual rotary-drum tests. `make help` lists the targets.

PACKAGES := gcc make git pkg-config curl ca-certificates libmicrohttpd-dev libjansson-dev libsqlite3-dev libhdf5-dev
TEST_PACKAGES := libcmocka-dev python3-pytest python3-requests python3-h5py python3-vtk9 python3-jsonschema \
                 python3-yaml python3-numpy python3-matplotlib python3-selenium chromium chromium-driver
PYTHON := /usr/bin/python3
BUILD := build
# The processor's own instructions: the program is built where it runs. MARCH=x86-64-v3 for another machine.
MARCH := native
CC := gcc
OPT := -O2
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef -Wvla $(if $(CI),-Werror)
HARDENING := -D_FORTIFY_SOURCE=2 -fstack-protector-strong
CFLAGS := -std=c17 -g $(OPT) $(WARNINGS) -MMD -MP $(SANITIZE)
LDFLAGS := $(SANITIZE)

# Contraction off: an expression has the same bits wherever the compiler inlines it.
CORE_FLAGS := -O3 -march=$(MARCH) -ffp-contract=off -fno-math-errno -fno-trapping-math -fopenmp -Iinclude -Icore
API_FLAGS := -D_GNU_SOURCE $(HARDENING) -Iinclude -Iapi
WORKER_FLAGS = -D_GNU_SOURCE $(HARDENING) -Iinclude -Iapi -Iserver/worker $(shell pkg-config --cflags hdf5-serial)
DAEMON_FLAGS := -D_GNU_SOURCE $(HARDENING) -pthread -Iinclude -Iapi -Iserver/daemon

CORE := $(patsubst %.c,$(BUILD)/%.o,$(wildcard core/*.c))
API := $(patsubst %.c,$(BUILD)/%.o,$(wildcard api/*.c))
WORKER := $(patsubst %.c,$(BUILD)/%.o,$(wildcard server/worker/*.c))
DAEMON := $(patsubst %.c,$(BUILD)/%.o,$(wildcard server/daemon/*.c))
UNIT_TESTS := $(patsubst tests/unit/%.c,$(BUILD)/tests/unit/%,$(wildcard tests/unit/test_*.c))

all: $(BUILD)/repose $(BUILD)/reposed ## build both programs

$(BUILD)/core/%.o: core/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(CORE_FLAGS) -c $< -o $@
$(BUILD)/api/%.o: api/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(API_FLAGS) -c $< -o $@
$(BUILD)/server/worker/%.o: server/worker/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(WORKER_FLAGS) -c $< -o $@
$(BUILD)/server/daemon/%.o: server/daemon/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(DAEMON_FLAGS) -c $< -o $@

$(BUILD)/libdem.a: $(CORE)
	@rm -f $@ && ar rcs $@ $^
$(BUILD)/libapi.a: $(API)
	@rm -f $@ && ar rcs $@ $^
$(BUILD)/repose: $(WORKER) $(BUILD)/libapi.a $(BUILD)/libdem.a
	$(CC) $(LDFLAGS) -fopenmp $^ -o $@ $(shell pkg-config --libs hdf5-serial) -ljansson -lm
$(BUILD)/reposed: $(DAEMON) $(BUILD)/libapi.a
	$(CC) $(LDFLAGS) -pthread $^ -o $@ -lmicrohttpd -ljansson -lsqlite3 -lm
$(BUILD)/tests/bench/%: tests/bench/%.c $(BUILD)/libdem.a
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) -D_GNU_SOURCE -Iinclude $< $(BUILD)/libdem.a -fopenmp -lm -o $@
# Unit tests see the insides they test: core tests link the core, api tests the api, daemon tests the daemon's objects.
$(BUILD)/tests/unit/%: tests/unit/%.c $(BUILD)/libdem.a $(BUILD)/libapi.a $(filter-out $(BUILD)/server/daemon/main.o,$(DAEMON))
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) -D_GNU_SOURCE -Iinclude -Icore -Iapi -Iserver/daemon $< $(filter-out $(BUILD)/server/daemon/main.o,$(DAEMON)) \
	  $(BUILD)/libapi.a $(BUILD)/libdem.a $(LDFLAGS) -fopenmp -pthread -lcmocka -lmicrohttpd -ljansson -lsqlite3 -lm -o $@
-include $(wildcard $(BUILD)/*/*.d $(BUILD)/*/*/*.d)
