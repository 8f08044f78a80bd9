# SPDX-License-Identifier: BSD-3-Clause
#
# CTest reads this when it starts, for each test program: adds its suites as FOLDER/Suite. A program
# that cannot so much as list them is a test that fails, and not a build that does.
execute_process(COMMAND ${program} --gtest_list_tests
                OUTPUT_VARIABLE listed ERROR_QUIET RESULT_VARIABLE status)
string(REGEX MATCHALL "\n[^ \n]+\\." suites "${listed}")
if(NOT status EQUAL 0)
    set(suites "")
    get_filename_component(name ${program} NAME)
    add_test(${folder}/${name} ${program} --gtest_list_tests)
    set_tests_properties(${folder}/${name} PROPERTIES ${properties})
endif()
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "\n(.+)\\." "\\1" suite "${suite}")
    add_test(${folder}/${suite} ${program} "--gtest_filter=${suite}.*")
    set_tests_properties(${folder}/${suite} PROPERTIES ${properties})
endforeach()
