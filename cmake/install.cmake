# SPDX-License-Identifier: MIT
# What an embedding renderer gets: the command, the libraries, the headers and the portable shader functions.
include(GNUInstallDirs)
install(TARGETS gnomon RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS gn_base gn_gpu gn_scene gn_metrics gn_reference gn_shadow ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY base gpu shadow reference DESTINATION include/gnomon
        FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl")
install(DIRECTORY recipes base shadow DESTINATION share/gnomon
        FILES_MATCHING PATTERN "*.toml" PATTERN "*.h" PATTERN "*.glsl" PATTERN "*.md")
install(DIRECTORY apps/report DESTINATION share/gnomon/apps OPTIONAL
        FILES_MATCHING PATTERN "*.html" PATTERN "*.css" PATTERN "*.js")
