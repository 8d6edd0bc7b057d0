#!/usr/bin/awk -f
# The blocks of a page as a shell script: ```sh is commands, ```python a program, and ```toml a file
# whose name is in its first line, "# NAME.toml". With -v expected=sh: the ```text blocks instead, with
# -v expected=cpp those after a program in C++.
/^```/ {
  kind = kind == "" ? substr($0, 4) : ""
  if (open != "") print open
  open = ""
  first = 1
  if (kind ~ /^(cpp|sh|python)$/) last = kind
  next
}
expected { if (kind == "text" && (last == "cpp") == (expected == "cpp")) print; next }
kind == "sh" { print }
kind == "python" && first { print "python3 - <<'END_OF_PROGRAM'"; open = "END_OF_PROGRAM" }
kind == "toml" && first && /^# [a-z0-9_]+\.toml/ { print "cat >" $2 " <<'END_OF_FILE'"; open = "END_OF_FILE" }
kind == "python" || (kind == "toml" && open != "") { print }
{ first = 0 }
