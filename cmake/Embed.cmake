# SPDX-License-Identifier: BSD-3-Clause
#
# Texts that travel inside a library, so that the command needs no file beside it.
#
#   aphotic_embed(TARGET HEADER <header> FUNCTION <function> TYPE <type>
#                 NAMED_BY <NAME or NAME_WLE> FILES <file>...)
#
# adds to TARGET  std::span<const TYPE> FUNCTION(),  which HEADER declares: a name and a text for
# each file, in the order given. NAMED_BY says what of a file's path is its name, in the words of CMake's
# get_filename_component. A file that changes is embedded anew by the next build.
function(aphotic_embed target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "HEADER;FUNCTION;TYPE;NAMED_BY" "FILES")
    set(texts "")
    foreach(file IN LISTS arg_FILES)
        cmake_path(ABSOLUTE_PATH file)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
        get_filename_component(name "${file}" ${arg_NAMED_BY})
        file(READ "${file}" text)
        if(text MATCHES "[)]text\"")
            message(FATAL_ERROR "aphotic_embed: ${file} holds the delimiter )text\"")
        endif()
        string(APPEND texts "    {\"${name}\", R\"text(${text})text\"},\n")
    endforeach()
    list(LENGTH arg_FILES count)
    set(code "// Written by cmake/Embed.cmake.
#include \"${arg_HEADER}\"

#include <array>

namespace aphotic {

std::span<const ${arg_TYPE}> ${arg_FUNCTION}() {
    static constexpr std::array<${arg_TYPE}, ${count}> kTexts{{
${texts}}};
    return kTexts;
}

}  // namespace aphotic")
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${arg_FUNCTION}.cpp)
    file(CONFIGURE OUTPUT "${output}" CONTENT "@code@\n" @ONLY)  # writes only what has changed
    target_sources(${target} PRIVATE "${output}")
endfunction()
