#!/bin/sh
# Runs the tests and closes with "N passed, N failed": run.sh BUILD, or of unit tests alone: run.sh BUILD unit [PROGRAM ...]
build=${1:-build}
only=$2
[ $# -gt 2 ] && shift 2 || set --
passed=0
failed=0
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

# Unit tests, as many programs at once as there are processors; then what each of them said, in order.
programs=${*:-$(ls "$build"/tests/unit/*/test_* | grep -v '\.d$')}
printf '%s\n' $programs | LOGS=$logs xargs -P "$(nproc)" -I{} sh -c '"$1" >"$LOGS/${1##*/}" 2>&1; echo $? >"$LOGS/${1##*/}.code"' sh {}
for program in $programs; do
  log=$logs/$(basename "$program")
  ok=$(grep -c '^\[       OK \]' "$log")
  printf '%-44s %s passed\n' "$(basename "$program")" "$ok"
  if [ "$(cat "$log.code")" -ne 0 ]; then
    cat "$log"
    bad=$(grep -E '^\[  FAILED  \] [a-z_0-9]+$' "$log" | sort -u | wc -l)
    [ "$bad" -gt 0 ] || bad=1
    failed=$((failed + bad))
  fi
  passed=$((passed + ok))
done

# suite FOLDER PROCESSES: what pytest says goes to the caller and is kept.
suite() {
  REPOSED_BUILD=$build "${PYTHON:-python3}" -m pytest -q -p no:cacheprovider -n "$2" -m "not long and not minutes and not torture" \
    "tests/$1" 2>&1 | tee "$logs/$1"
}

# Tests of the service mostly wait: several of them at once, and those of physics take what they leave of the processors.
if [ "$only" != unit ]; then
  suite physics 0 >"$logs/physics.said" &
  suite service $(($(nproc) * 2))
  wait
  cat "$logs/physics.said"
  for folder in physics service; do
    last=$(grep -E '[0-9]+ (passed|failed|error)' "$logs/$folder" | tail -n 1)
    count() { printf '%s' "$last" | grep -oE "[0-9]+ $1" | grep -oE '[0-9]+' || echo 0; }
    passed=$((passed + $(count passed)))
    failed=$((failed + $(count failed) + $(count error)))
    [ -n "$last" ] || failed=$((failed + 1))
  done
fi

echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
