#!/usr/bin/awk -f
# Doxygen reads our headers through this. In their comments an indented line is a formula, which
# stays as it is, and "Source : .." up to the next empty line is a paragraph with a title. A comment
# before the namespace is the file's.
/^namespace / { inside = 1 }
/^\/\/\/ / && !inside && !of_file {
  print "/// @file"
  of_file = 1
}
match($0, /^ *\/\/\/ [A-Z][a-z]+ *: /) {
  split(substr($0, RSTART, RLENGTH), word, " ")
  sub(/:$/, "", word[2])
  print substr($0, 1, index($0, "///") + 2) " @par " word[2]
  print substr($0, 1, index($0, "///") + 3) substr($0, RLENGTH + 1)
  titled = 1
  next
}
/^ *\/\/\/  / {
  sub(/\/\/\/ +/, titled ? "/// " : "&    ")
  print
  next
}
{ titled = 0; print }
