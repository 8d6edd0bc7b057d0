#!/usr/bin/env bash
# Counts the instructions of every right-hand side with callgrind and holds the pruned ones against
# those by hand. Without valgrind it says so and returns 77.
#
# Usage: pruning_cost.sh <program pruning_count> [--table]
#
# --table writes the counts as a Markdown table and judges nothing.
set -euo pipefail

if ! command -v valgrind >/dev/null; then
  echo 'skipped: valgrind is not installed'
  exit 77
fi
program=$(realpath "$1")
mode=${2:-}
limit=1.05

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
valgrind --tool=callgrind --collect-atstart=no --toggle-collect='*pruning::call<*' \
  --callgrind-out-file="$folder/dump" "$program" >"$folder/log" 2>&1 || {
  cat "$folder/log"
  exit 1
}

# Every dump: its description ends with "<case>: <form>", its totals are those of 1000 calls. In the
# order in which they were written.
find "$folder" -name 'dump.*' | sort -t. -k"$(awk -F. '{ print NF }' <<<"$folder/dump.1")" -n |
  xargs awk -v limit="$limit" -v mode="$mode" '
    /^desc: Trigger: Client Request: / {
      name = $0
      sub(/^desc: Trigger: Client Request: /, "", name)
      form = name
      sub(/^.*: /, "", form)
      scene = substr(name, 1, length(name) - length(form) - 2)
      if (!(scene in seen)) { seen[scene] = 1; order[++scenes] = scene }
    }
    /^(totals|summary): / { count[scene, form] = $2 / 1000 }
    END {
      if (scenes == 0) { print "callgrind has written nothing"; exit 1 }
      if (mode == "--table") {
        print "| scene | general | pruned | by hand | pruned / by hand |"
        print "|---|---|---|---|---|"
      }
      for (i = 1; i <= scenes; ++i) {
        scene = order[i]
        pruned = count[scene, "pruned"]
        hand = count[scene, "by hand"]
        if (!(pruned > 0 && hand > 0)) { print scene ": not counted"; failed = 1; continue }
        ratio = pruned / hand
        if (mode == "--table")
          printf "| %s | %.0f | %.0f | %.0f | %.2f |\n", scene, count[scene, "general"], pruned, hand, ratio
        else {
          bad = ratio > limit
          printf "%s %-54s %6.1f, by hand %6.1f: %.3f\n", bad ? "FAILED" : "      ", scene, pruned, hand, ratio
          if (bad) failed = 1
        }
      }
      exit failed
    }'
