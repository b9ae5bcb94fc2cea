#!/usr/bin/env bash
# A run of bare_debian.sh that is killed leaves nothing mounted, no process and no file of the system that it made.
# Usage: bare_debian_killed.sh PACKAGES CACHE
set -euo pipefail
packages=$1 cache=$2
output=$(mktemp)
trap 'rm -f "$output"' EXIT
mounted() { grep -lsF " $cache/root " /proc/[0-9]*/mountinfo || true; }
fail() {
  echo "bare_debian_killed: $*" >&2
  exit 1
}

"$(dirname "$0")/bare_debian.sh" "$packages" "$cache" >"$output" 2>&1 &
run=$!
until grep -q '^== installing the command' "$output"; do
  kill -0 "$run" 2>/dev/null || {
    grep '^skipped: ' "$output" && exit 0
    fail "it ended by itself:"$'\n'"$(tail -n 20 "$output")"
  }
  sleep 0.1
done
[[ -n $(mounted) ]] || fail "nothing is mounted while it runs: this test sees nothing"
kill -KILL "$run"
wait "$run" 2>/dev/null || true
for ((k = 0; k < 100; ++k)); do
  [[ -n $(mounted) ]] || break
  sleep 0.1
done
[[ -z $(mounted) ]] || fail "10 s later processes still have the system mounted: $(mounted)"
[[ -z $(ls -A "$cache/root") ]] || fail "$cache/root holds $(ls -A "$cache/root")"
flock --nonblock "$cache/lock" true || fail "$cache is still locked"
echo "nothing is left of a killed run"
