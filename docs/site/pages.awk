#!/usr/bin/awk -f
# Doxygen reads our pages through this. It gives headings the names that links use, joins links that
# are broken over two lines, and makes those of the doors branches of the tree. It drops links to sources,
# and doubles the backquotes of code, in which a ' would end the code.

# The name of a heading in links, as GitHub makes it, after the name of the page.
function anchor(page, heading) {
  heading = tolower(heading)
  gsub(/[^a-z0-9 _-]/, "", heading)
  gsub(/ /, "-", heading)
  return page "_" heading
}
# The line with links to headings, page.md#name or #name, as Doxygen's references.
function with_references(line,    before, link, page) {
  before = ""
  while (match(line, /\]\([A-Za-z0-9_.\/-]*#[a-z0-9_-]+\)/)) {
    link = substr(line, RSTART + 2, RLENGTH - 3)
    page = this_page
    if (link !~ /^#/) {
      page = link
      sub(/\.md#.*/, "", page)
      sub(/.*\//, "", page)
    }
    sub(/.*#/, "", link)
    before = before substr(line, 1, RSTART + 1) "@ref " page "_" link ")"
    line = substr(line, RSTART + RLENGTH)
  }
  return before line
}
# The line without links to sources and scenes, which are no pages.
function without_sources(line,    before, link) {
  before = ""
  while (match(line, /\[[^][]*\]\(\.\.\/[^()]*\.(hpp|cpp|toml|csv|py)\)/)) {
    link = substr(line, RSTART + 1, RLENGTH - 1)
    sub(/\]\(.*/, "", link)
    before = before substr(line, 1, RSTART - 1) link
    line = substr(line, RSTART + RLENGTH)
  }
  return before line
}
# The door behind which the tree of the site shows a page.
function door(link) {
  if (link ~ /(^|\/)(learn|do|lookup|understand)\.md$/) return "index"
  if (link ~ /tutorials\//) return "learn"
  if (link ~ /howto\//) return "do"
  if (link ~ /(scene_files|programs|questions|conventions|glossary|installation|limits)\.md$/) return "lookup"
  return "understand"
}
# Doxygen's name of a page, from a link beside docs/site.
function name_of(link) {
  sub(/\.md$/, "", link)
  if (!sub(/^\.\.\/\.\.\//, "", link) && !sub(/^\.\.\//, "docs/", link)) link = "docs/site/" link
  gsub(/\//, "_", link)
  return "md_" link
}
# The line with the first link to each page behind this door as a branch of the tree.
function with_branches(line,    before, link, text) {
  before = ""
  while (match(line, /\[[^][]+\]\([A-Za-z0-9_.\/-]+\.md\)/)) {
    link = text = substr(line, RSTART, RLENGTH)
    sub(/.*\]\(/, "", link)
    sub(/\)$/, "", link)
    sub(/^\[/, "", text)
    sub(/\]\(.*/, "", text)
    gsub(/"/, "\\\"", text)
    before = before substr(line, 1, RSTART - 1)
    if (door(link) == this_page && !branched[this_page, link]++)
      before = before "@subpage " name_of(link) " \"" text "\""
    else
      before = before substr(line, RSTART, RLENGTH)
    line = substr(line, RSTART + RLENGTH)
  }
  return before line
}
function write(line) {
  line = without_sources(line)
  gsub(/\]\(\.\.\/site\/pictures\//, "](pictures/", line)
  if (FILENAME ~ /site\/(index|learn|do|lookup|understand)\.md$/) line = with_branches(line)
  gsub(/`[^`]+`/, "`&`", line)
  print with_references(line)
}
FNR == 1 {
  this_page = FILENAME
  sub(/\.md$/, "", this_page)
  sub(/.*\//, "", this_page)
}
# Formulas are TeX, which script/formulas sets.
/^```math$/ { formula = 1; print "@htmlonly<pre class=\"formula\">"; next }
formula && /^```$/ { formula = 0; print "</pre>@endhtmlonly"; next }
formula { gsub(/&/, "\\&amp;"); gsub(/</, "\\&lt;"); gsub(/>/, "\\&gt;"); print; next }
/^```/ { fenced = !fenced; print; next }
fenced || /^    / { print; next }
/^##+ / {
  heading = $0
  sub(/^#+ +/, "", heading)
  write($0 " {#" anchor(this_page, heading) "}")
  next
}
{
  held = held == "" ? $0 : held " " $0
  if (held ~ /\[[^][]*$/ || held ~ /\]\([^()]*$/) next
  write(held)
  held = ""
}
END { if (held != "") write(held) }
