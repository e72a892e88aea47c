#!/bin/sh
# Runs the fuzzers one after the other: run.sh BUILD SECONDS NAME .... Each tells how many inputs it has tried. What one of
# them finds is kept in BUILD/fuzz/findings, and the exit code is 1 then; BUILD/fuzz/fuzz_NAME FILE tries one input again.
# SEED=1: the same inputs each time, as far as the machine gets; otherwise others.
set -u
here=$(pwd)
build=$here/$1 seconds=$2
shift 2
findings=$build/fuzz/findings
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$findings"

# What a worker leaves of a small run is what its files are to look like.
run=$scratch/run
if ! "$build/repose" run "$here/tests/fuzz/corpus/specification/small_drum.json" --out "$run" >"$scratch/log" 2>&1; then
  cat "$scratch/log"
  exit 1
fi
seeds() {
  mkdir "$scratch/seeds"
  case $1 in
    specification) cp "$here"/api/examples/*.json "$scratch/seeds" ;;
    study) cp "$here"/api/studies/*.json "$scratch/seeds" ;;
    events) { printf '\200'; cat "$run/events.ndjson"; } >"$scratch/seeds/run" ;;
    result) cp "$run/result.json" "$scratch/seeds" ;;
    checkpoint) cp "$run/checkpoint.hdf" "$scratch/seeds" ;;
    start) cp "$run/checkpoint.hdf" "$run/snapshots/000000.hdf" "$scratch/seeds" ;;
  esac
  cp "$here/tests/fuzz/corpus/$1"/* "$scratch/seeds" 2>/dev/null
  [ -n "$(ls "$scratch/seeds")" ]
}
# Names of members and words: those of the tables.
grep -ohE '"[a-z_0-9/-]+"' "$here"/api/process/*/*.c "$here"/api/spec/*.c "$here"/api/study/*.c "$here"/api/http/route_table.c | sort -u >"$scratch/words"

# HDF5 asks for as much memory as a file says before it looks whether so much is there; nobody else may.
most_memory() {
  case $1 in checkpoint | start) echo 2147483647 ;; *) echo 500 ;; esac
}
export ASAN_OPTIONS=allocator_may_return_null=1 OMP_NUM_THREADS=1

failed=0
for fuzzer; do
  seeds "$fuzzer" || { echo "there are no seeds for $fuzzer"; exit 1; }
  (cd "$scratch" && "$build/fuzz/fuzz_$fuzzer" -max_total_time="$seconds" -seed="${SEED:-0}" -timeout=20 -rss_limit_mb=1500 -malloc_limit_mb="$(most_memory "$fuzzer")" -close_fd_mask=3 \
    -print_final_stats=1 -dict="$scratch/words" -artifact_prefix="$findings/$fuzzer-" seeds) >"$scratch/log" 2>&1
  code=$?
  count=$(sed -n 's/^stat::number_of_executed_units: *//p' "$scratch/log" | tail -n 1)
  edges=$(grep -oE 'cov: [0-9]+' "$scratch/log" | tail -n 1)
  printf '%-14s %9s executions  %s\n' "$fuzzer" "${count:-0}" "${edges:-}"
  if [ $code -ne 0 ] || [ "${count:-0}" -eq 0 ]; then
    failed=1
    grep -vE '^#[0-9]+\s|NEW_FUNC' "$scratch/log" | tail -n 60
  fi
  rm -rf "$scratch/seeds" "$scratch/data"
done
exit $failed
