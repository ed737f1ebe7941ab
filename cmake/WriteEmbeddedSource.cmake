# Writes OUTPUT, a C++ source with the bytes of FILES (separated by |) and, in NAMESPACE, the
# function FUNCTION that finds them by name. String literals compile much faster than lists of numbers.
string(REPLACE "|" ";" files "${FILES}")
set(source "#include <string_view>\n\nnamespace ${NAMESPACE} {\n\n")
set(lookup "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME)
  string(MAKE_C_IDENTIFIER ${name} symbol)
  file(READ ${file} hex HEX)
  string(LENGTH "${hex}" digits)
  math(EXPR size "${digits} / 2")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" literal "${hex}")
  string(APPEND source "static const char ${symbol}[] = \"${literal}\";\n")
  string(APPEND lookup "  if (name == \"${name}\") return {${symbol}, ${size}};\n")
endforeach()
string(APPEND source "\nstd::string_view ${FUNCTION}(std::string_view name);\n"
  "std::string_view ${FUNCTION}(std::string_view name) {\n${lookup}  return {};\n}\n\n"
  "}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUTPUT} "${source}")
