# The house's comments, as Doxygen reads them: a comment of its own documents what follows, one behind code documents that
# code, the first one documents the file. Used by Doxyfile.in alone; headers stay plain C.
function documented(text) { sub(/\/\* /, "/** ", text); return text }
NR == 1 && /^\/\* / { print "/** @file"; print " *"; $0 = " * " substr($0, 4); first = 1 }
/^[ \t]*\/\* / { print documented($0); next }
/[^ \t].*\/\* / && !first { sub(/\/\* /, "/**< "); print; next }
{ first = 0; print }
