# aphotic_precompile(TARGET SET)
#
# Other people's headers, of which most files include some, are parsed once for all targets of a SET,
# whose compiler flags are alike: two thirds of the time to compile went into reading them again.
# None of ours: a change to one would compile everything anew. Nor in shared libraries, each of which has a
# macro of its own.
option(APHOTIC_PRECOMPILE "Parse other people's headers once for all files" OFF)

set(libraries_headers <Eigen/Core> <fmt/format.h> <nlohmann/json.hpp>
    <algorithm> <chrono> <filesystem> <fstream> <functional> <map> <optional> <random> <span> <sstream>
    <string> <string_view> <variant> <vector>)
set(commands_headers <CLI/CLI.hpp> ${libraries_headers})
set(tests_headers <gtest/gtest.h> ${libraries_headers})

function(aphotic_precompile target set)
    if(NOT APHOTIC_PRECOMPILE OR BUILD_SHARED_LIBS)
        return()
    endif()
    get_property(first GLOBAL PROPERTY aphotic_first_of_${set})
    if(first)
        target_precompile_headers(${target} REUSE_FROM ${first})
        return()
    endif()
    set_property(GLOBAL PROPERTY aphotic_first_of_${set} ${target})
    string(REGEX REPLACE "_.*" "" headers ${set})
    target_precompile_headers(${target} PRIVATE ${${headers}_headers})
endfunction()
