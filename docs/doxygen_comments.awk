# The comments of the C headers as Doxygen takes them: one behind code documents what stands before it, and
# the first is about the file.
FILENAME ~ /\.dox$/ { print; next }
{
  at = index($0, "/* ")
  if (at > 0 && !inside) {
    before = substr($0, 1, at - 1)
    mark = before ~ /[^ \t]/ ? "/**< " : "/** "
    if (FNR == 1) mark = "/** @file\n * "
    $0 = before mark substr($0, at + 3)
  }
  rest = $0
  while (match(rest, /\/\*|\*\//)) {
    inside = substr(rest, RSTART, 2) == "/*"
    rest = substr(rest, RSTART + 2)
  }
  print
}
