#!/bin/sh
# Runs the tests and closes with "N passed, N failed": run.sh BUILD [unit]
build=${1:-build}
passed=0
failed=0
log=$(mktemp)
trap 'rm -f "$log"' EXIT

for program in "$build"/tests/unit/test_*; do
  case $program in *.d) continue ;; esac
  "$program" >"$log" 2>&1
  code=$?
  ok=$(grep -c '^\[       OK \]' "$log")
  bad=$(grep -c '^\[  FAILED  \] .*[a-z]' "$log")
  printf '%-44s %s passed\n' "$(basename "$program")" "$ok"
  if [ $code -ne 0 ]; then
    cat "$log"
    [ "$bad" -gt 0 ] || bad=1
    bad=$(grep -cE '^\[  FAILED  \] test|^\[  FAILED  \] [a-z_]+$' "$log" | awk -v b="$bad" '{print ((b > $1 && $1 > 0) ? $1 : b)}')
    failed=$((failed + bad))
  fi
  passed=$((passed + ok))
done

if [ "$2" != unit ]; then
  for folder in tests/physics tests/service; do
    REPOSED_BUILD=$build "${PYTHON:-python3}" -m pytest -q -p no:cacheprovider -m "not long and not minutes and not torture" "$folder" | tee "$log"
    last=$(grep -E '[0-9]+ (passed|failed|error)' "$log" | tail -n 1)
    count() { printf '%s' "$last" | grep -oE "[0-9]+ $1" | grep -oE '[0-9]+' || echo 0; }
    passed=$((passed + $(count passed)))
    failed=$((failed + $(count failed) + $(count error)))
    [ -n "$last" ] || failed=$((failed + 1))
  done
fi

echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
