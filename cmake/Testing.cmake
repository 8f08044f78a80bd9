# aphotic_tests(LABEL folder/name ...)
#
# Builds tests/folder/name_test.cpp ... into one test program a folder, folder_LABEL_tests, and gives
# its tests to CTest as folder/Suite.Case, under a label:
#
#   unit    no other program needed; milliseconds each. Under the name unit_that_computes it gets the
#           same label and is optimised, see below
#   povray  runs POV-Ray. Under the name povray_of_few_pixels it gets the same label and weighs half
#   cli     runs the command as a user would
#   slow    hundreds of plans or interruptions, or a program beyond POV-Ray, such as a browser
#
# Under the names unit_as_one and slow_as_one the program is one test to CTest, folder/all_LABEL, which
# would else start it anew for each: for tests that share what takes long, a plan or a rendered survey.
#
# A test weighs two of CTest's processors, one where it mostly waits: POV-Ray spends two thirds of a
# second on a few pixels, asleep. So scripts/test gives CTest twice as many as there are cores.
#
# A file's tests stand in a namespace of its name, aphotic::name_test: in a unity build the unnamed
# namespaces of all files are one.
include(GoogleTest)

function(aphotic_tests label)
    set(program ${label})
    # Half of the time to build tests went into making those fast that run for an instant. What they
    # test is as optimised as it is shipped; but for what a test and a library both make of other
    # people's templates, of which the linker takes the test's. So tests that follow much light through
    # Eigen are a program of their own, optimised too.
    set(optimisation -O0)
    set(limits TIMEOUT 300 PROCESSORS 2)  # for what hangs: with sanitizers on a busy machine some take 120
    string(REGEX REPLACE "_as_one$" "" label ${label})
    if(label STREQUAL "unit_that_computes")
        set(label unit)
        set(optimisation -O2)
    elseif(label STREQUAL "povray")
        set(limits TIMEOUT 600 PROCESSORS 2)
    elseif(label STREQUAL "povray_of_few_pixels")
        set(label povray)
        set(limits TIMEOUT 600)
    elseif(label STREQUAL "slow" OR program MATCHES "_as_one$")
        # First, so that none is left over at the end. The table of extremes takes 260 s beside others.
        set(limits TIMEOUT 1200 PROCESSORS 2 COST 100)
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
        target_compile_definitions(${target} PRIVATE
            APHOTIC_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
            APHOTIC_COMMAND="$<TARGET_FILE:aphotic>")
        target_link_libraries(${target} PRIVATE
            aphotic::survey aphotic::validation aphotic::plugin
            fmt::fmt nlohmann_json::nlohmann_json OpenEXR::OpenEXR PkgConfig::cairo
            GTest::gtest_main
            aphotic_sanitizers aphotic_warnings)
        add_dependencies(${target} aphotic)

        if(program MATCHES "_as_one$")
            add_test(NAME ${folder}/all_${label} COMMAND ${target})
            set_tests_properties(${folder}/all_${label} PROPERTIES LABELS ${label} ${limits})
            continue()
        endif()
        # Discovered when CTest starts, so that a test program that crashes fails as a test
        # and not as a build.
        gtest_discover_tests(${target}
            DISCOVERY_MODE PRE_TEST
            TEST_PREFIX ${folder}/
            PROPERTIES LABELS ${label} ${limits})
    endforeach()
endfunction()
