#!/bin/sh
# One fuzzer of those that run.sh starts, in a folder of its own: run_one.sh SOURCES BUILD SCRATCH SECONDS NAME. The scratch
# folder has run/, what a worker has left, and words. Each has a copy of run/, since a changed file may lead into it.
set -u
here=$1 build=$2 run=$3/run words=$3/words folder=$3/$5 seconds=$4 fuzzer=$5
mkdir "$folder" "$folder/seeds" && cd "$folder" && cp -r "$run" run || exit 1

case $fuzzer in
  specification) cp "$here"/api/examples/*.json seeds ;;
  study) cp "$here"/api/studies/*.json seeds ;;
  events) { printf '\200'; cat run/events.ndjson; } >seeds/run ;;
  result) cp run/result.json seeds ;;
esac
cp "$here/tests/fuzz/corpus/$fuzzer"/* seeds 2>/dev/null
[ -n "$(ls seeds)" ] || { echo "there are no seeds for $fuzzer"; exit 1; }
corpus=$folder/found
[ -n "${SEED:-}" ] || corpus=$build/fuzz/corpus/$fuzzer
mkdir -p "$corpus"

# HDF5 asks for as much memory as a file says before it looks whether so much is there; nobody else may.
case $fuzzer in checkpoint | start) most_memory=2147483647 ;; *) most_memory=500 ;; esac
export ASAN_OPTIONS=allocator_may_return_null=1 OMP_NUM_THREADS=1
"$build/fuzz/fuzz_$fuzzer" -max_total_time="$seconds" -seed="${SEED:-0}" -timeout=20 -rss_limit_mb=1500 -malloc_limit_mb=$most_memory \
  -close_fd_mask=3 -print_final_stats=1 -dict="$words" -artifact_prefix="$build/fuzz/findings/$fuzzer-" "$corpus" seeds >log 2>&1
code=$?
count=$(sed -n 's/^stat::number_of_executed_units: *//p' log | tail -n 1)
edges=$(grep -oE 'cov: [0-9]+' log | tail -n 1)
{
  printf '%-14s %9s executions  %s\n' "$fuzzer" "${count:-0}" "${edges:-}"
  [ $code -eq 0 ] && [ "${count:-0}" -gt 0 ] || grep -vE '^#[0-9]+\s|NEW_FUNC' log | tail -n 60
} >told
cat told
[ $code -eq 0 ] && [ "${count:-0}" -gt 0 ]
