#!/usr/bin/awk -f
# Doxygen reads our pages through this: to it a ' ends a code span, unless the span has two
# backquotes on each side.
/^```/ { fenced = !fenced }
!fenced && !/^```/ { gsub(/`[^`]+`/, "`&`") }
{ print }
