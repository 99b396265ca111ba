# SPDX-License-Identifier: MIT
# What an embedding renderer gets: the command, the libraries behind find_package(gnomon), the headers, and the recipes
# and portable shader functions that the libraries read at run time.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS gnomon RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY base gpu shadow reference DESTINATION include/gnomon
        FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl")

# Two sets of targets: gnomon::embed with what it stands on, which link Vulkan and fmt and nothing else, and all the rest.
# The config finds again what they link.
set(gn_config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)
set_target_properties(gn_embed PROPERTIES EXPORT_NAME embed)
install(TARGETS gn_base gn_gpu gn_scene_data gn_embed EXPORT gnomon-embed-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS gn_images gn_compiler gn_scene gn_metrics gn_reference gn_shadow EXPORT gnomon-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(set gnomon-embed-targets gnomon-targets)
  install(EXPORT ${set} NAMESPACE gnomon:: DESTINATION ${gn_config_folder})
endforeach()
configure_package_config_file(cmake/gnomon-config.cmake.in ${CMAKE_BINARY_DIR}/gnomon-config.cmake
                              INSTALL_DESTINATION ${gn_config_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/gnomon-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/gnomon-config.cmake ${CMAKE_BINARY_DIR}/gnomon-config-version.cmake
        DESTINATION ${gn_config_folder})

# The same shape as the source tree, so that include paths and recipe names mean the same in both.
install(DIRECTORY recipes sweeps scenes base gpu shadow DESTINATION share/gnomon COMPONENT data
        FILES_MATCHING PATTERN "*.toml" PATTERN "*.h" PATTERN "*.glsl" PATTERN "*.comp" PATTERN "*.frag" PATTERN "*.vert"
        PATTERN "*.geom" PATTERN "*.md")
install(DIRECTORY apps DESTINATION share/gnomon COMPONENT data
        FILES_MATCHING PATTERN "*.html" PATTERN "*.css" PATTERN "*.js" PATTERN "*.json")
install(FILES LICENSE DESTINATION share/gnomon COMPONENT data)
