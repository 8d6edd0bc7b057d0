#!/usr/bin/awk -f
# Makes a page of the manual, roff, from a program's --help.
#
#   simulate --help | awk -f man.awk -v name=kreisel-simulate -v about="..." -v version=1.0.0

# The text with the characters escaped that have a meaning in roff.
function roff(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  sub(/^[.']/, "\\\\\\&&", text)
  return text
}
BEGIN {
  printf ".TH %s 1 \"\" \"kreisel %s\" \"kreisel\"\n", toupper(name), version
  print ".SH NAME\n" name " \\- " roff(about)
}
/^Usage: / {
  sub(/^Usage: /, "")
  print ".SH SYNOPSIS\n" roff($0) "\n.SH DESCRIPTION\n" description
  has_usage = 1
  next
}
!has_usage { description = description roff($0) "\n"; next }
/^[^ ].*:$/ { sub(/:$/, ""); print ".SH " toupper(roff($0)); next }
/^  [^ ]/ {  # an option and its text
  sub(/^ +/, "")
  at = match($0, /  +/)
  print ".TP\n.B " roff(at ? substr($0, 1, at - 1) : $0)
  if (at) print roff(substr($0, at + RLENGTH))
  next
}
/[^ ]/ { sub(/^ +/, ""); print roff($0) }
END {
  print ".SH SEE ALSO\n.BR kreisel (1),\n.BR kreisel\\-simulate (1),\n.BR kreisel\\-analyze (1),"
  print ".BR kreisel\\-ensemble (1),\n.BR kreisel\\-deviation (1)\n.PP"
  print "Keys of scene files: /usr/share/doc/kreisel/docs/scene_files.md"
}
