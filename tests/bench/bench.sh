#!/bin/sh
# Particle-steps per second of the core: the paper's drum at several sizes, one and two threads.
build=${1:-build}
for run in "1500 3.78 1" "2500 3.78 1" "3000 3 1" "24000 3 1" "2500 3.78 2" "24000 3 2"; do
  # shellcheck disable=SC2086
  "$build/tests/bench/bench_drum" $run 0.1 1.5707963 5
done
