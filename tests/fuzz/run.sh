#!/bin/sh
# Runs the fuzzers, as many at once as there are processors: run.sh BUILD SECONDS NAME .... Each tells how many inputs it has
# tried. What one of them finds is kept in BUILD/fuzz/findings, and the exit code is 1 then; BUILD/fuzz/fuzz_NAME FILE tries one
# input again. Inputs that reached something new are kept in BUILD/fuzz/corpus, where the next run begins.
# SEED=1: the same inputs each time, as far as the machine gets, and none kept; otherwise others.
set -u
here=$(pwd)
build=$here/$1 seconds=$2
shift 2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM
mkdir -p "$build/fuzz/findings"

# What a worker leaves of a small run is what its files are to look like.
if ! "$build/repose" run "$here/tests/fuzz/corpus/specification/small_drum.json" --out "$scratch/run" >"$scratch/log" 2>&1; then
  cat "$scratch/log"
  exit 1
fi
# Names of members and words: those of the tables.
grep -ohE '"[a-z_0-9/-]+"' "$here"/api/process/*/*.c "$here"/api/spec/*.c "$here"/api/study/*.c "$here"/api/http/route_table.c | sort -u >"$scratch/words"

printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} sh "$here/tests/fuzz/run_one.sh" "$here" "$build" "$scratch" "$seconds" {} || exit 1
