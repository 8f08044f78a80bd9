# For the whole tree, since instrumented and plain objects in one program report faults that
# are none. A finding ends the program, so that no test passes over it.
# Every program of ours links to aphotic_sanitizers, which names the findings that are not ours, and
# the programs in which the leak sanitizer crashes.
add_library(aphotic_sanitizers INTERFACE)

if(APHOTIC_SANITIZE)
    add_compile_options(-fsanitize=${APHOTIC_SANITIZE} -fno-sanitize-recover=all
                        -fno-omit-frame-pointer)
    add_link_options(-fsanitize=${APHOTIC_SANITIZE})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        add_compile_options(
            -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/ignored_by_sanitizers.txt)
    endif()

    if(APHOTIC_SANITIZE STREQUAL "thread")
        add_library(aphotic_known_findings OBJECT cmake/uninstrumented.cpp)
    else()
        add_library(aphotic_known_findings OBJECT cmake/leak_check.cpp)
    endif()
    target_sources(aphotic_sanitizers INTERFACE $<TARGET_OBJECTS:aphotic_known_findings>)
endif()
