#!/bin/sh
# What `make bench` measures: bench.sh BUILD FLAGS. Beds of all kinds in interleaved windows, a million spheres by
# themselves for their memory, and the demo: how long it takes and which share of a run makes the bed and measures.
set -eu
build=${1:-build}
flags=${2:-}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

"$build/tests/bench/bench_table" >"$out/table"
"$build/tests/bench/bench_table" 1000000 >"$out/million"

# Nothing is installed or compiled within the time of the demo: both are done by now.
seconds() { date +%s.%N; }
figure() { # NAME UNIT VALUES...: minimum, median, maximum of an odd number of values
  name=$1 unit=$2
  shift 2
  printf '%s\n' "$@" | sort -g | awk -v n="$name" -v u="$unit" '{v[NR] = $1} END {
    printf "{\"figure\": \"%s\", \"unit\": \"%s\", \"minimum\": %.5g, \"median\": %.5g, \"maximum\": %.5g}\n", n, u, v[1], v[(NR + 1) / 2], v[NR]}'
}
part() { tr -d '\n' <"$1" | sed -n "s/.*\"part\": *\"$2\", *\"seconds\": *[^,]*, *\"share\": *\([0-9.e-]*\).*/\1/p"; }
demos='' beds='' measures=''
for round in 1 2 3; do
  begin=$(seconds)
  sh tests/demo.sh "$build" </dev/null >/dev/null
  demos="$demos $(awk -v a="$begin" -v b="$(seconds)" 'BEGIN {print b - a}')"
  "$build/repose" run api/examples/drum.json --out "$out/run$round" --profile >/dev/null 2>&1
  beds="$beds $(part "$out/run$round/profile.json" "making the bed")"
  measures="$measures $(part "$out/run$round/profile.json" measures)"
done
{
  # shellcheck disable=SC2086
  figure "make demo" s $demos
  # shellcheck disable=SC2086
  figure "share of making the bed, demo" "of the run" $beds
  # shellcheck disable=SC2086
  figure "share of measuring, demo" "of the run" $measures
  "${PYTHON:-/usr/bin/python3}" tests/bench/bench_pool.py "$build"
} >"$out/demo"

"${PYTHON:-/usr/bin/python3}" tests/bench/report.py tests/bench/results --compiler "$("${CC:-gcc}" --version | head -n 1)" \
  --flags "$flags" --table "$out/table" --million "$out/million" --demo "$out/demo"
