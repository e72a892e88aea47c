#!/bin/sh
# The layers hold: the core needs nothing but libc, libm and OpenMP; the daemon links neither the core nor HDF5; the
# worker neither libmicrohttpd nor SQLite; the planner alone links linear algebra. Reads the symbols, not the sources.
build=${1:-build}
undefined=$(nm -u "$build"/core/*/libdem.a | awk '$1 == "U" {print $2}' | sort -u)
defined=$(nm --defined-only "$build"/core/*/libdem.a | awk 'NF == 3 {print $3}' | sort -u)
rules=$(nm --defined-only "$build/librules.a" | awk 'NF == 3 {print $3}' | sort -u)
of_rules=$(nm -u "$build/librules.a" | awk '$1 == "U" {print $2}' | sort -u | grep -xF "$defined")
outside=$(printf '%s\n' "$undefined" | grep -vxF "$defined" | grep -vxF "$rules" | grep -vE '^(GOMP_|omp_)' |
  grep -vxE '__(asan|ubsan|tsan|stack_chk|sanitizer|popcount)_?.*|_GLOBAL_OFFSET_TABLE_' |
  grep -vxE 'acos|atan2?|cbrt|ceil|cos|exp|floor|fmaf?|fmaxf?|fminf?|hypot|ilogb|log|pow|remainder|rint|sin|sincos|sqrt|tan|trunc' |
  grep -vxE 'aligned_alloc|madvise|mallopt|malloc|calloc|realloc|free|memcpy|memmove|memset|memcmp|qsort|strcmp|sched_yield|__assert_fail')
printed=$(printf '%s\n' "$undefined" | grep -xE 'f?printf|puts|fopen|open|read|write|exit|abort|time|clock_gettime|socket')
status=0
if [ -n "$outside$printed" ]; then
  echo "core reaches outside its layer:" $outside $printed
  status=1
fi
of_core=$(nm -u "$build/libapi.a" | awk '$1 == "U" {print $2}' | sort -u | grep -xF "$defined")
[ -n "$of_rules" ] && { echo "the rules need the core:" $of_rules; status=1; }
[ -n "$of_core" ] && { echo "the api needs the core:" $of_core; status=1; }
ldd "$build/reposed" | grep -E 'hdf5|gomp' && { echo "reposed links what only a worker may"; status=1; }
nm "$build/reposed" | grep -E ' T dem_scene_' && { echo "reposed links the core"; status=1; }
ldd "$build/repose" | grep -E 'microhttpd|sqlite' && { echo "repose links what only the daemon may"; status=1; }
for program in reposed repose; do
  ldd "$build/$program" | grep -E 'lapack|blas' && { echo "$program links what only the planner may"; status=1; }
done
if [ -e "$build/repose-plan" ]; then
  ldd "$build/repose-plan" | grep -E 'hdf5|gomp|microhttpd|sqlite' && { echo "repose-plan links what it does not need"; status=1; }
fi
[ $status = 0 ] && echo "layers hold"
exit $status
