# SPDX-License-Identifier: BSD-3-Clause
#
# Writes a C++ file that holds the texts of files, in the order given:
#
#   cmake -DOUTPUT=builtin_tables.cpp -DHEADER=spectral/curve_loader.h -DFUNCTION=builtin_tables
#         -DTYPE=BuiltinTable -DNAME=NAME_WLE "-DFILES=a.csv;b.csv" -P EmbedTexts.cmake
#
# makes  std::span<const TYPE> FUNCTION(),  each a name and a text. NAME says what of a file's path
# is its name, in the words of CMake's get_filename_component.

foreach(argument OUTPUT HEADER FUNCTION TYPE NAME FILES)
  if(NOT ${argument})
    message(FATAL_ERROR "EmbedTexts.cmake: give -D${argument}=")
  endif()
endforeach()

set(code "// Written by cmake/EmbedTexts.cmake.\n")
string(APPEND code "#include \"${HEADER}\"\n\n#include <array>\n\n")
string(APPEND code "namespace aphotic {\n\nnamespace {\n\n")
list(LENGTH FILES count)
string(APPEND code "constexpr std::array<${TYPE}, ${count}> kTexts{{\n")
foreach(file IN LISTS FILES)
  get_filename_component(name "${file}" ${NAME})
  file(READ "${file}" text)
  string(FIND "${text}" ")text\"" delimiter)
  if(NOT delimiter EQUAL -1)
    message(FATAL_ERROR "EmbedTexts.cmake: ${file} holds the delimiter )text\"")
  endif()
  string(APPEND code "    {\"${name}\", R\"text(${text})text\"},\n")
endforeach()
string(APPEND code "}};\n\n}  // namespace\n\n")
string(APPEND code "std::span<const ${TYPE}> ${FUNCTION}() { return kTexts; }\n\n")
string(APPEND code "}  // namespace aphotic\n")
file(WRITE "${OUTPUT}" "${code}")
