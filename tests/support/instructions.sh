#!/usr/bin/env bash
# Counts with callgrind the instructions of each form of a piece of work, and compares two forms.
# Without valgrind it prints that and returns 77.
#
# Usage: instructions.sh <program> <function> <form> <other form> <limit> [--table <form>...]
#
# The program runs every "<case>: <form>" a thousand times in functions of these names. Callgrind
# writes a dump of that name after each. --table writes the counts of some forms as a Markdown table
# without a verdict.
set -euo pipefail

if ! command -v valgrind >/dev/null; then
  echo 'skipped: valgrind is not installed'
  exit 77
fi
program=$(realpath "$1")
function=$2
form=$3
other=$4
limit=$5
table=$(IFS='|' && printf '%s' "${*:7}")

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
valgrind --tool=callgrind --collect-atstart=no --toggle-collect="*$function<*" \
  --callgrind-out-file="$folder/dump" "$program" >"$folder/log" 2>&1 || {
  cat "$folder/log"
  exit 1
}

# Every dump: its description ends with "<case>: <form>", its totals are those of 1000 calls. Sorted
# by the order in which they were written.
find "$folder" -name 'dump.*' | sort -t. -k"$(awk -F. '{ print NF }' <<<"$folder/dump.1")" -n |
  xargs awk -v limit="$limit" -v form="$form" -v other="$other" -v table="$table" '
    /^desc: Trigger: Client Request: / {
      name = $0
      sub(/^desc: Trigger: Client Request: /, "", name)
      this = name
      sub(/^.*: /, "", this)
      work = substr(name, 1, length(name) - length(this) - 2)
      if (!(work in seen)) { seen[work] = 1; order[++works] = work }
    }
    /^(totals|summary): / { count[work, this] = $2 / 1000 }
    END {
      if (works == 0) { print "callgrind has written nothing"; exit 1 }
      columns = split(table, column, "|")
      if (columns) {
        line = "| work |"
        rule = "|---|"
        for (k = 1; k <= columns; ++k) { line = line " " column[k] " |"; rule = rule "---|" }
        print line " " form " / " other " |"
        print rule "---|"
      }
      for (i = 1; i <= works; ++i) {
        work = order[i]
        ours = count[work, form]
        theirs = count[work, other]
        known = ours > 0 && theirs > 0
        if (columns) {
          line = "| " work " |"
          for (k = 1; k <= columns; ++k) {
            n = count[work, column[k]]
            line = line " " (n ? sprintf("%.0f", n) : "-") " |"
          }
          print line " " (known ? sprintf("%.2f", ours / theirs) : "-") " |"
        } else if (known) {
          bad = ours / theirs > limit
          printf "%s %-54s %6.1f, %s %6.1f: %.3f\n", bad ? "FAILED" : "      ", work, ours, other, theirs, ours / theirs
          if (bad) failed = 1
          ++judged
        }
      }
      if (!columns && !judged) { print "nothing to judge"; failed = 1 }
      exit failed
    }'
