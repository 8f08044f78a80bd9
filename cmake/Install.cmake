# cmake --install: the command, the libraries with a CMake package, scenes, manual.
# Each library installs itself and its headers (Library.cmake).
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/aphotic)

install(TARGETS aphotic)
install(EXPORT aphotic
    NAMESPACE aphotic::
    FILE aphoticTargets.cmake
    DESTINATION ${package_dir})
configure_package_config_file(cmake/aphoticConfig.cmake.in aphoticConfig.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(aphoticConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES
        ${PROJECT_BINARY_DIR}/aphoticConfig.cmake
        ${PROJECT_BINARY_DIR}/aphoticConfigVersion.cmake
    DESTINATION ${package_dir})

install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/aphotic/scenes)
install(DIRECTORY plugin/include/ DESTINATION ${CMAKE_INSTALL_DATADIR}/aphotic/include)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
    FILES_MATCHING PATTERN *.md PATTERN *.csv PATTERN *.svg PATTERN *.png PATTERN *.jpg)
install(DIRECTORY workflow config DESTINATION ${CMAKE_INSTALL_DATADIR}/aphotic)

# The command says itself what a shell and man should know of it. The names are those that each shell looks for.
set(completions ${PROJECT_BINARY_DIR}/completions)
foreach(completion
        bash:bash-completion/completions/aphotic
        zsh:zsh/site-functions/_aphotic
        fish:fish/vendor_completions.d/aphotic.fish)
    string(REGEX MATCH "^([a-z]+):(.*)/([^/]+)$" _ ${completion})
    set(script ${completions}/${CMAKE_MATCH_3}.${CMAKE_MATCH_1})
    set(name ${CMAKE_MATCH_3})
    set(folder ${CMAKE_MATCH_2})
    add_custom_command(OUTPUT ${script}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${completions}
        COMMAND aphotic --completion ${CMAKE_MATCH_1} > ${script}
        DEPENDS aphotic
        VERBATIM)
    list(APPEND completion_scripts ${script})
    install(FILES ${script} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder} RENAME ${name})
endforeach()
set(man_page ${PROJECT_BINARY_DIR}/aphotic.1)
add_custom_command(OUTPUT ${man_page}
    COMMAND aphotic --man-page > ${man_page}
    DEPENDS aphotic
    VERBATIM)
install(FILES ${man_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
add_custom_target(aphotic_completions ALL DEPENDS ${completion_scripts} ${man_page})
