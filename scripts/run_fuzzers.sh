#!/usr/bin/env bash
# Runs every fuzzer of a build at the same time: run_fuzzers.sh PROGRAMS SEEDS SECONDS OUT [JOBS]
#   PROGRAMS  the folder of fuzz_NAME and fuzzers.txt
#   SEEDS     the folder of corpus/ and NAME.dict: tests/fuzz
#   OUT       gets NAME/ (the corpus, which a later run goes on with), NAME.log, NAME.finding-*, and a
#             line for each in summary.txt
# A fuzzer that finds something goes on with what is left of its time. Exit 1 if one has, or ran nothing.
set -euo pipefail
[ $# -ge 4 ] || { sed -n '2,7s/^# //p' "$0" >&2; exit 2; }
tmp=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")")
trap 'rm -rf "$tmp"' EXIT
programs=$(cd "$1" && pwd) seeds=$(cd "$2" && pwd) seconds=$3 jobs=${5:-$(nproc)}
mkdir -p "$4"
out=$(cd "$4" && pwd)

# What is not given back at once counts as memory, so little of it.
export ASAN_OPTIONS=quarantine_size_mb=16:detect_leaks=1:${ASAN_OPTIONS:-}
export UBSAN_OPTIONS=print_stacktrace=1

# Limits: one allocation, and all, in megabytes, AddressSanitizer's own included; seconds an input.
# tests/fuzz/memory_limit.h has the exact one.
limits=(-malloc_limit_mb=128 -rss_limit_mb=1024 -timeout=20 -report_slow_units=20)

run_one() {
  local name=$1 folders=() folder options=() start=$SECONDS left
  shift
  for folder in "$@"; do folders+=("$seeds/corpus/$folder"); done
  [ ! -f "$seeds/$name.dict" ] || options+=("-dict=$seeds/$name.dict")
  mkdir -p "$out/$name" "$tmp/$name"
  rm -f "$out/$name".finding-*
  : >"$out/$name.log"
  while left=$((seconds - (SECONDS - start))) && [ "$left" -gt 0 ]; do
    TMPDIR=$tmp/$name "$programs/fuzz_$name" -max_total_time="$left" "${limits[@]}" "${options[@]}" -print_final_stats=1 \
      -artifact_prefix="$out/$name.finding-" "$out/$name" "${folders[@]}" >>"$out/$name.log" 2>&1 && break
    [ "$(find "$out" -maxdepth 1 -name "$name.finding-*" | wc -l)" -lt 10 ] || break
    sleep 1  # one that does not start, does not fill the disk
  done
  summary "$name"
}

summary() {
  awk -v name="$1" -v findings="$(find "$out" -maxdepth 1 -name "$1.finding-*" | wc -l)" \
    -v corpus="$(find "$out/$1" -type f | wc -l)" '
    /^#[0-9]/ { for (i = 2; i < NF; ++i) { if ($i == "cov:") edges = $(i + 1); if ($i == "ft:") features = $(i + 1) } }
    /^stat::number_of_executed_units:/ { executions += $2 }
    /^stat::peak_rss_mb:/ { if ($2 > rss) rss = $2 }
    END { printf "%-8s %10d executions %6d edges %6d features %3d findings %5d new inputs %5d MB\n",
          name, executions, edges, features, findings, corpus, rss }' "$out/$1.log" >"$out/$1.summary"
}

while read -r -a line; do
  while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
  run_one "${line[@]}" &
done <"$programs/fuzzers.txt"
wait
cat "$out"/*.summary | tee "$out/summary.txt"
awk '$2 == 0 { print "run_fuzzers.sh: " $1 ": ran no input; see its log"; none = 1 } END { exit none }' "$out/summary.txt" >&2
[ -z "$(find "$out" -maxdepth 1 -name '*.finding-*' -print -quit)" ]
