# What `cmake --install` puts where: the program with its shell completion, and the library with its
# headers and the package by which another project's find_package(mirrorball) finds it. That it works
# is proved by tests/package.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/mirrorball)

install(TARGETS mirrorball EXPORT mirrorball-targets)
install(DIRECTORY include/mirrorball DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT mirrorball-targets FILE mirrorballTargets.cmake
    NAMESPACE mirrorball:: DESTINATION ${package_folder})
if(MIRRORBALL_BUILD_RENDERER)
    # Components of the package, so that who wants none of them needs none of what they use.
    foreach(component scene gl viewer)
        set_target_properties(mirrorball_${component} PROPERTIES EXPORT_NAME ${component})
        install(TARGETS mirrorball_${component} EXPORT mirrorball-${component}-targets)
        install(EXPORT mirrorball-${component}-targets FILE mirrorball-${component}Targets.cmake
            NAMESPACE mirrorball:: DESTINATION ${package_folder})
    endforeach()
endif()

configure_package_config_file(cmake/mirrorballConfig.cmake.in mirrorballConfig.cmake
    INSTALL_DESTINATION ${package_folder})
# Until 1.0 every minor version may change the interface.
write_basic_package_version_file(mirrorballConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
    ${PROJECT_BINARY_DIR}/mirrorballConfig.cmake
    ${PROJECT_BINARY_DIR}/mirrorballConfigVersion.cmake
    DESTINATION ${package_folder})

if(MIRRORBALL_BUILD_PROGRAM)
    # bash looks here for a file by the program's name. The program prints it.
    set(completion ${PROJECT_BINARY_DIR}/completion/mirrorball)
    add_custom_command(OUTPUT ${completion}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/completion
        COMMAND mirrorball_program completion bash > ${completion}
        DEPENDS mirrorball_program VERBATIM)
    add_custom_target(mirrorball_completion ALL DEPENDS ${completion})
    install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endif()
# The page for browsers where `make web` has built it, for `serve` and for the reports of `bake`.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/build/web/page
    DESTINATION ${CMAKE_INSTALL_DATADIR}/mirrorball OPTIONAL)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
