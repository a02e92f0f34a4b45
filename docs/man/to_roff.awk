# A page of docs/man as man(1) reads it. Usage: awk -v version=0.1.0 -f to_roff.awk PAGE.1.md
# Knows what the pages use: headings, paragraphs, lists, tables of two columns, blocks of code, and `--help` between its marks.

function escaped(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  return text
}

function bold(text) { return "\\fB" escaped(text) "\\fR" }

# Code in bold, links by their text.
function inline(text,   result, start, inner) {
  while (match(text, /\[[^]]*\]\([^)]*\)/)) {
    inner = substr(text, RSTART + 1, index(substr(text, RSTART), "]") - 2)
    text = substr(text, 1, RSTART - 1) inner substr(text, RSTART + RLENGTH)
  }
  gsub(/\*\*/, "", text)
  while (match(text, /`[^`]*`/)) {
    start = substr(text, 1, RSTART - 1)
    inner = substr(text, RSTART + 1, RLENGTH - 2)
    gsub(/\\/, "\\e", start)
    result = result start bold(inner)
    text = substr(text, RSTART + RLENGTH)
  }
  gsub(/\\/, "\\e", text)
  return result text
}

# A line of text is no request to roff.
function put(text) { print (text ~ /^[.']/ ? "\\&" : "") text }

function put_option(line,   name, help) {
  name = line
  help = ""
  if (match(line, /[^ ]  +[^ ]/)) {
    name = substr(line, 1, RSTART)
    help = substr(line, RSTART + RLENGTH - 1)
  }
  print ".TP"
  put(bold(name))
  if (help != "") put(escaped(help))
}

function put_help(line) {
  if (line ~ /^Usage:/ || line == title || line == "") return
  if (line ~ /^[^ ].*:$/) print ".SS " substr(line, 1, length(line) - 1)
  else if (line ~ /^  [^ ]/) put_option(substr(line, 3))
  else { sub(/^ +/, "", line); put(escaped(line)) }
}

function put_row(line,   cells) {
  if (line ~ /^\|[-| ]*$/) return
  split(line, cells, /\|/)
  gsub(/^ +| +$/, "", cells[2])
  gsub(/^ +| +$/, "", cells[3])
  if (cells[3] == "") return
  print ".TP"
  put(inline(cells[2]))
  put(inline(cells[3]))
}

function put_line(line) {
  if (line ~ /^#+ /) {
    sub(/^#+ /, "", line)
    print ".SH " toupper(line)
    fresh = 1
  } else if (line == "") {
    fresh = 0
    wants_paragraph = 1
    return
  } else if (line ~ /^- /) {
    print ".IP \\(bu 2"
    put(inline(substr(line, 3)))
  } else if (line ~ /^\|/) {
    put_row(line)
  } else {
    if (wants_paragraph && !fresh) print ".PP"
    sub(/^ +/, "", line)
    put(inline(line))
    fresh = 0
  }
  wants_paragraph = 0
}

{ lines[NR] = $0 }
$0 == "<!-- --help -->" { help_at = NR }

END {
  tool = substr(lines[1], 3)
  sub(/\(.*/, "", tool)
  print ".TH " toupper(tool) " 1 \"\" \"priormap " version "\" \"priormap\""
  for (first = 2; lines[first] == ""; ++first) {}
  purpose = lines[first]
  sub(/\.$/, "", purpose)
  print ".SH NAME\n" tool " \\- " inline(purpose)
  title = lines[help_at + 2]
  usage = lines[help_at + 3]
  sub(/^Usage: /, "", usage)
  print ".SH SYNOPSIS"
  put(bold(usage))
  for (i = first + 1; i <= NR; ++i) {
    if (lines[i] ~ /^<!--/) in_help = lines[i] == "<!-- --help -->"
    else if (lines[i] ~ /^```/ && in_help) continue
    else if (in_help) put_help(lines[i])
    else if (lines[i] ~ /^```/) { in_code = !in_code; print in_code ? ".PP\n.nf\n.RS" : ".RE\n.fi"; wants_paragraph = 0 }
    else if (in_code) put(escaped(lines[i]))
    else put_line(lines[i])
  }
}
