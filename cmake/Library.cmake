# aphotic_library(NAME SOURCES a.cpp ... HEADERS b.h ...)
#
# The library of the folder NAME: target aphotic_NAME, known to all others as aphotic::NAME. The
# header beside a source, a.h, is understood; HEADERS are those that have none.
# Headers are included by their path from the root, "NAME/a.h", here and once installed.
include(GNUInstallDirs)

function(aphotic_library name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;HEADERS")
    set(target aphotic_${name})
    foreach(source IN LISTS arg_SOURCES)
        cmake_path(REPLACE_EXTENSION source h OUTPUT_VARIABLE header)
        if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${header})
            list(APPEND arg_HEADERS ${header})
        endif()
    endforeach()
    list(REMOVE_DUPLICATES arg_HEADERS)

    add_library(${target} ${arg_SOURCES})
    add_library(aphotic::${name} ALIAS ${target})
    target_sources(${target} PUBLIC
        FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${arg_HEADERS})
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:aphotic_warnings>)
    aphotic_precompile(${target} libraries)
    set_target_properties(${target} PROPERTIES
        EXPORT_NAME ${name}
        INSTALL_RPATH $ORIGIN
        VERSION ${PROJECT_VERSION}
        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})  # before 1.0, minors break

    install(TARGETS ${target} EXPORT aphotic
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aphotic)
endfunction()
