#!/usr/bin/env bash
# run_fuzzers.sh fails where a target ran no input, whatever the target's own exit code.
set -euo pipefail
script=$(cd "$(dirname "$0")/../.." && pwd)/scripts/run_fuzzers.sh
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
mkdir -p "$tmp/programs" "$tmp/seeds/corpus/some"

# target NAME LINE EXIT: a program that says LINE and exits so.
target() {
  printf '#!/bin/sh\necho "%s"\nexit %d\n' "$2" "$3" >"$tmp/programs/fuzz_$1"
  chmod +x "$tmp/programs/fuzz_$1"
}
run() { "$script" "$tmp/programs" "$tmp/seeds" 1 "$tmp/out" >"$tmp/said" 2>&1; }
fail() { echo "$1" >&2; cat "$tmp/said" >&2; exit 1; }

target sound 'stat::number_of_executed_units: 7' 0
echo "sound some" >"$tmp/programs/fuzzers.txt"
run || fail "a target that ran inputs fails"

for code in 0 1; do
  target idle 'nothing' "$code"
  printf 'sound some\nidle some\n' >"$tmp/programs/fuzzers.txt"
  ! run || fail "a target that ran nothing passes"
  grep -q 'idle: ran no input' "$tmp/said" || fail "a target that ran nothing is not named"
done

rm -rf "$tmp/out"
: >"$tmp/programs/fuzzers.txt"
! run || fail "no target passes"
