# SPDX-License-Identifier: MIT
# Globs the part folders and writes the registry: nobody keeps a list of techniques by hand.
function(gn_registry output sources_out tests_out)
  set(declarations "")
  set(entries "")
  set(count 0)
  set(sources "")
  set(tests "")
  foreach(stage light placement map lookup direct visibility)
    file(GLOB folders CONFIGURE_DEPENDS LIST_DIRECTORIES true ${CMAKE_SOURCE_DIR}/shadow/${stage}/*)
    foreach(folder ${folders})
      if(NOT IS_DIRECTORY ${folder})
        continue()
      endif()
      get_filename_component(id ${folder} NAME)
      if(NOT id MATCHES "^[a-z][a-z0-9_]*$")
        message(FATAL_ERROR "${folder}: a part's folder is lower-case letters, digits and '_'")
      endif()
      file(GLOB part_sources CONFIGURE_DEPENDS ${folder}/*.cpp)
      if(NOT EXISTS ${folder}/${id}.cpp)
        continue()
      endif()
      foreach(source ${part_sources})
        if(source MATCHES "_test\\.cpp$")
          list(APPEND tests ${source})
        else()
          list(APPEND sources ${source})
        endif()
      endforeach()
      string(APPEND declarations "const Part& ${stage}_${id}();\n")
      string(APPEND entries "        &parts::${stage}_${id}(),\n")
      math(EXPR count "${count} + 1")
    endforeach()
  endforeach()
  file(GENERATE OUTPUT ${output} CONTENT
"// Generated from the folders shadow/<stage>/<id>/.
#include \"shadow/recipe/part.h\"

#include <array>

namespace gn {
namespace parts {
${declarations}}  // namespace parts

std::span<const Part* const> all_parts() {
    static const std::array<const Part*, ${count}> registry{
${entries}    };
    return registry;
}

}  // namespace gn
")
  set(${sources_out} ${sources} PARENT_SCOPE)
  set(${tests_out} ${tests} PARENT_SCOPE)
endfunction()
