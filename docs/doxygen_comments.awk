# The comments of the C headers as Doxygen takes them: one behind code documents what stands before it, and
# the first is about the file. What needs no comment in a header gets its text here: a macro that initialises
# the structure before it, `next` where this version has no extension, and the types of functions.
FILENAME ~ /\.dox$/ { print; next }
/^\/\* ---/ { print ""; next }  # the title of a section documents nothing
/^#define VOY_[A-Z_]+_INIT/ && last ~ /^} Voy/ {
  $0 = "/** Initialises a " substr(last, 3, length(last) - 3) ". */ " $0
}
/^  (const )?void\* next;$/ { $0 = $0 " /**< NULL: this version has no extension of the structure */" }
/^typedef .*PFN_voy/ {
  match($0, /PFN_voy[A-Za-z]+/)
  $0 = "/** The type of " substr($0, RSTART + 4, RLENGTH - 4) ". */ " $0
}
{
  last = $0
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
