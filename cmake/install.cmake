# SPDX-License-Identifier: MIT
# What an embedding renderer gets: the command, the libraries behind find_package(gnomon), the headers, and the recipes
# and portable shader functions that the libraries read at run time.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS gnomon RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS gn_base gn_gpu gn_scene gn_metrics gn_reference gn_shadow EXPORT gnomon-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY base gpu shadow reference DESTINATION include/gnomon
        FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl")

# Targets are gnomon::gn_shadow and so on; the config finds again what they link.
set(gn_config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)
install(EXPORT gnomon-targets NAMESPACE gnomon:: DESTINATION ${gn_config_folder})
configure_package_config_file(cmake/gnomon-config.cmake.in ${CMAKE_BINARY_DIR}/gnomon-config.cmake
                              INSTALL_DESTINATION ${gn_config_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/gnomon-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/gnomon-config.cmake ${CMAKE_BINARY_DIR}/gnomon-config-version.cmake
        DESTINATION ${gn_config_folder})

# The same shape as the source tree, so that include paths and recipe names mean the same in both.
install(DIRECTORY recipes scenes base gpu shadow DESTINATION share/gnomon COMPONENT data
        FILES_MATCHING PATTERN "*.toml" PATTERN "*.h" PATTERN "*.glsl" PATTERN "*.comp" PATTERN "*.frag" PATTERN "*.vert"
        PATTERN "*.geom" PATTERN "*.md")
install(DIRECTORY apps DESTINATION share/gnomon COMPONENT data
        FILES_MATCHING PATTERN "*.html" PATTERN "*.css" PATTERN "*.js" PATTERN "*.json")
install(FILES LICENSE DESTINATION share/gnomon COMPONENT data)
