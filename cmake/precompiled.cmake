# SPDX-License-Identifier: MIT
# What nearly every source includes is parsed once a build: gn_precompiled(target KIND), where KIND is LIBRARY, FRAME (what
# sees a frame), EVALUATION, COMMAND, SUITE or FRAME_SUITE. Most stand in the lists because they never change here. The few
# headers of ours are included, by way of others, by nearly every source of their kind, so that editing them rebuilds all of
# it anyway; headers_alone keeps every header honest without the lists.
option(GNOMON_PRECOMPILED "Precompile the headers of others" ON)

set(gn_precompiled_headers
    <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <numeric> <optional> <random> <set>
    <span> <string> <string_view> <vector> <fmt/format.h> <glm/glm.hpp> <glm/gtc/matrix_transform.hpp>
    <vulkan/vulkan.h>)

# One empty library owns each precompiled header; the others must compile with the same options to use it.
function(gn_precompile kind options)
  set(name gn_precompiled_${kind})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/${name}.cpp CONTENT "// Owns the precompiled header.\n")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE ${options} fmt::fmt Vulkan::Vulkan)
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_precompile_headers(${name} PRIVATE ${gn_precompiled_headers} ${ARGN})
endfunction()

if(GNOMON_PRECOMPILED)
  # Ours are named without the folder of this checkout, so that a compiler cache serves all checkouts of a machine.
  gn_precompile(LIBRARY gn_options)
  gn_precompile(FRAME gn_options <shadow/frame/frame.h>)
  gn_precompile(EVALUATION gn_command_options <nlohmann/json.hpp>)
  gn_precompile(COMMAND gn_command_options <nlohmann/json.hpp> <spdlog/spdlog.h> <shadow/frame/frame.h>)
  gn_precompile(SUITE gn_suite_options <gtest/gtest.h> <tests/printers.h>)
  gn_precompile(FRAME_SUITE gn_suite_options <gtest/gtest.h> <tests/printers.h> <tests/rig.h>)
  target_link_libraries(gn_precompiled_COMMAND PRIVATE spdlog::spdlog)
  foreach(kind SUITE FRAME_SUITE)
    target_link_libraries(gn_precompiled_${kind} PRIVATE GTest::gtest)
    target_compile_definitions(gn_precompiled_${kind} PRIVATE _GLIBCXX_ASSERTIONS)
  endforeach()
endif()

function(gn_precompiled target kind)
  if(GNOMON_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM gn_precompiled_${kind})
  endif()
endfunction()
