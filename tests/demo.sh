#!/bin/sh
# The demo: a daemon on a free port with a fresh data folder, the paper's drum posted with curl, the answer.
set -eu
build=${1:-build}
data=$build/demo
if [ -e "$data/lock" ] && ! flock -n "$data/lock" true; then
  echo "a daemon is at work on $data, which the demo would remove: stop that daemon first" >&2
  exit 1
fi
rm -rf "$data"
mkdir -p "$data"
"$build/reposed" serve --port 0 --data "$data" --port-file "$data/port" >"$data/daemon.log" 2>&1 &
daemon=$!
trap 'kill $daemon 2>/dev/null; wait $daemon 2>/dev/null || true' EXIT INT TERM
for _ in $(seq 100); do [ -s "$data/port" ] && break; sleep 0.05; done
[ -s "$data/port" ] || { cat "$data/daemon.log"; exit 1; }
url=http://127.0.0.1:$(cat "$data/port")

member() { sed -n "s/.*\"$1\": *\"\{0,1\}\([^\",}]*\).*/\1/p" | head -n 1; }
terminal() { [ -t 1 ]; }

echo "\$ curl --json @api/examples/drum.json $url/processes/drum/execution"
job=$(curl -sS --json @api/examples/drum.json "$url/processes/drum/execution" | tr -d '\n' | member jobID)
[ -n "$job" ] || { echo "the daemon did not take the job"; cat "$data/daemon.log"; exit 1; }
echo "  12.6 cm drum, half full of 3.78 mm spheres, friction 0.1, pi/2 rad/s: job $job"

turn=0
while :; do
  status=$(curl -sS "$url/jobs/$job?wait=1" | tr -d '\n')
  state=$(printf '%s' "$status" | member status)
  percent=$(printf '%s' "$status" | member progress)
  eta=$(printf '%s' "$status" | member eta_seconds)
  percent=${percent%.*}
  filled=$(printf '%*s' $((${percent:-0} * 40 / 100)) '' | tr ' ' '#')
  line=$(printf '  [%-40s] %3s %%  %s' "$filled" "${percent:-0}" "${eta:+about ${eta%.*} s left}")
  if terminal; then printf '\r%-79s' "$line"; elif [ $((turn % 10)) = 0 ]; then echo "$line"; fi
  turn=$((turn + 1))
  case $state in accepted | running) ;; *) break ;; esac
done
terminal && printf '\r%-79s\r' ''
if [ "$state" != successful ]; then
  echo "the job $state:"
  curl -sS "$url/jobs/$job"
  exit 1
fi

ask() { curl -sS -G --data-urlencode "sql=$1" --data-urlencode format=csv "$url/query" | tail -n 1 | tr -d '\r"'; }
IFS=, read -r angle error minimum maximum regime overlap wall speed <<ANSWER
$(ask "select printf('%.1f', angle_deg), printf('%.1f', standard_error_deg), printf('%.1f', minimum_deg),
  printf('%.1f', maximum_deg), regime, printf('%.2f', 100 * maximum_overlap), printf('%.0f', wall_seconds),
  printf('%.0f', particle_steps_per_second / 1e6) from run_summary where id = '$job'")
ANSWER
cat <<TEXT

  angle of repose   $angle +- $error degrees (frames from $minimum to $maximum)      Walton & Braun 1993: 23
  regime            $regime
  largest overlap   $overlap % of a diameter
  took              $wall s, $speed million particle-steps/s

Look further (start it again on this folder with: make serve DATA=$data):
  the page          $url/
  a query           curl -G --data-urlencode "sql=select friction, angle_deg from run_summary" $url/query
  the snapshots     $data/jobs/$job/snapshots.hdf.series opens in ParaView
TEXT
if terminal; then
  printf '\nThe daemon runs until you press Enter. '
  read -r _ || true
fi
