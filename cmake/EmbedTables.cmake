# SPDX-License-Identifier: BSD-3-Clause
#
# Writes a C++ file that holds the built-in tables, in the order given.
#
#   cmake -DOUTPUT=builtin_tables.cpp "-DTABLES=a.csv;b.csv" -P EmbedTables.cmake
#
# A table's name is its file's name without ".csv".

if(NOT OUTPUT OR NOT TABLES)
  message(FATAL_ERROR "EmbedTables.cmake: give -DOUTPUT=FILE.cpp and -DTABLES=LIST")
endif()

set(code "// Written by cmake/EmbedTables.cmake from spectral/data/*.csv.\n")
string(APPEND code "#include \"spectral/builtin.h\"\n\n#include <array>\n\n")
string(APPEND code "namespace aphotic {\n\nnamespace {\n\n")
list(LENGTH TABLES count)
string(APPEND code "constexpr std::array<BuiltinTable, ${count}> kTables{{\n")
foreach(table IN LISTS TABLES)
  get_filename_component(name "${table}" NAME_WLE)
  file(READ "${table}" csv)
  string(FIND "${csv}" ")csv\"" delimiter)
  if(NOT delimiter EQUAL -1)
    message(FATAL_ERROR "EmbedTables.cmake: ${table} holds the delimiter )csv\"")
  endif()
  string(APPEND code "    {\"${name}\", R\"csv(${csv})csv\"},\n")
endforeach()
string(APPEND code "}};\n\n}  // namespace\n\n")
string(APPEND code "std::span<const BuiltinTable> builtin_tables() { return kTables; }\n\n")
string(APPEND code "}  // namespace aphotic\n")
file(WRITE "${OUTPUT}" "${code}")
