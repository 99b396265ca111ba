# SPDX-License-Identifier: MIT
# What nearly every source includes of the standard library and of others is parsed once a build: gn_precompiled(target)
# for libraries, gn_precompiled(target COMMAND) for the command, gn_precompiled(target TESTS) for suites. Only headers
# that never change here stand in the lists, so that editing one of ours rebuilds what includes it and nothing else;
# headers_alone keeps every header honest without them.
option(GNOMON_PRECOMPILED "Precompile the headers of others" ON)

set(gn_precompiled_headers
    <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <numeric> <optional> <random> <set>
    <span> <string> <string_view> <vector> <fmt/format.h> <glm/glm.hpp> <glm/gtc/matrix_transform.hpp>
    <vulkan/vulkan.h>)

# One empty library owns each precompiled header; the others must compile with the same options to use it.
function(gn_precompile name options)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/${name}.cpp CONTENT "// Owns the precompiled header.\n")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE ${options} fmt::fmt Vulkan::Vulkan)
  target_precompile_headers(${name} PRIVATE ${gn_precompiled_headers} ${ARGN})
endfunction()

if(GNOMON_PRECOMPILED)
  gn_precompile(gn_precompiled_libraries gn_options)
  gn_precompile(gn_precompiled_command gn_command_options)
  # Named without the folder of this checkout, so that a compiler cache serves all checkouts of a machine.
  gn_precompile(gn_precompiled_suites gn_options <gtest/gtest.h> <tests/printers.h>)
  target_include_directories(gn_precompiled_suites PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(gn_precompiled_suites PRIVATE GTest::gtest)
  target_compile_definitions(gn_precompiled_suites PRIVATE _GLIBCXX_ASSERTIONS)
endif()

function(gn_precompiled target)
  set(owner_TESTS suites)
  set(owner_COMMAND command)
  set(owner_ libraries)
  if(GNOMON_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM gn_precompiled_${owner_${ARGN}})
  endif()
endfunction()
