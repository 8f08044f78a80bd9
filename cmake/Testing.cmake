# aphotic_tests(LABEL folder/name ...)
#
# Builds tests/folder/name_test.cpp ... into one test program a folder, folder_LABEL_tests, and gives
# its suites to CTest as folder/Suite, under a label. A suite is one process: to start one for each of
# two thousand cases took longer than most of them, and what a suite shares, a plan or a rendered survey,
# was made anew for each. A case that fails is named at the end of its suite's output. The labels:
#
#   unit    no other program needed; milliseconds each. Under the name unit_that_computes it gets the
#           same label and is optimised, see below
#   povray  runs POV-Ray for a few pixels
#   cli     runs the command as a user would
#   campaign  random rigs: a few in CI, hundreds in the night (tests/support/effort.h)
#   night   what CI has no time for: POV-Ray's images, whole fits, programs such as a browser or Snakemake.
#           Built with APHOTIC_NIGHT alone. Under the name night_that_waits, for POV-Ray, it gets the same label and
#           weighs half; under the name night_that_computes the same label, and is optimised
#
# POV-Ray takes two thirds of a second for a few pixels, most of it asleep. So scripts/test gives CTest
# four processors for each core: what computes weighs four, what waits two, renders of few pixels one.
#
# A file's tests stand in a namespace of its name, aphotic::name_test: in a unity build the unnamed
# namespaces of all files are one.
option(APHOTIC_NIGHT "Build the tests of scripts/night as well" OFF)

# All of the label, for builds that have time for no other.
add_custom_target(unit_tests)

function(aphotic_tests label)
    set(program ${label})
    # Half of the time to build tests went into making those fast that run for an instant. What they
    # test is as optimised as it is shipped; but for what a test and a library both make of other
    # people's templates, of which the linker takes the test's. So tests that follow much light through
    # Eigen are a program of their own, optimised too.
    set(optimisation -O0)
    set(limits TIMEOUT 1800)  # for what hangs: with sanitizers on a busy machine some take 300
    set(weight 4)
    if(label STREQUAL "unit_that_computes")
        set(label unit)
        set(optimisation -O2)
    elseif(label STREQUAL "campaign")
        set(optimisation -O2)
        list(APPEND limits COST 100)  # first, so that none is left over at the end
    elseif(label STREQUAL "povray")
        set(weight 1)
        list(APPEND limits COST 50)  # early, to wait while others compute
    elseif(label MATCHES "^night")
        if(NOT APHOTIC_NIGHT)
            return()
        endif()
        set(limits TIMEOUT 7200 COST 100)
        if(label STREQUAL "night_that_waits")
            set(weight 2)
        elseif(label STREQUAL "night_that_computes")
            set(optimisation -O2)
        endif()
        set(label night)
    endif()

    set(folders ${ARGN})
    list(TRANSFORM folders REPLACE "/.*" "")
    list(REMOVE_DUPLICATES folders)
    foreach(folder IN LISTS folders)
        set(sources ${ARGN})
        list(FILTER sources INCLUDE REGEX "^${folder}/")
        list(TRANSFORM sources APPEND _test.cpp)
        set(target ${folder}_${program}_tests)

        add_executable(${target} ${sources})
        target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}
                                                     ${PROJECT_SOURCE_DIR}/tests)
        target_compile_options(${target} PRIVATE ${optimisation})
        aphotic_precompile(${target} tests_${optimisation})
        target_compile_definitions(${target} PRIVATE
            APHOTIC_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
            APHOTIC_COMMAND="$<TARGET_FILE:aphotic>")
        target_link_libraries(${target} PRIVATE
            aphotic::survey aphotic::validation aphotic::plugin
            fmt::fmt nlohmann_json::nlohmann_json OpenEXR::OpenEXR PkgConfig::cairo
            GTest::gtest_main
            aphotic_sanitizers aphotic_warnings)
        if(label STREQUAL "unit")
            add_dependencies(unit_tests ${target})
            add_dependencies(${target} aphotic_any_image)
        else()
            add_dependencies(${target} aphotic)
        endif()

        # What CTest reads when it starts.
        set(suites ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
        file(GENERATE OUTPUT ${suites} CONTENT "set(program [[$<TARGET_FILE:${target}>]])
set(folder ${folder})
set(properties LABELS ${label} PROCESSORS ${weight} ${limits})
include([[${PROJECT_SOURCE_DIR}/cmake/Suites.cmake]])
")
        set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites})
    endforeach()
endfunction()
