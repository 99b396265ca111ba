# SPDX-License-Identifier: MIT
# A folder's sources compile as one, eight at most: reading precompiled headers and instantiating what their inline
# functions use costs more than most sources themselves. Names in unnamed namespaces are therefore unique within a folder.
# Without the option, as in the debug build, every source compiles alone and must include what it uses.
option(GNOMON_BY_FOLDER "Compile the sources of a folder as one" ON)

# gn_by_folder(target): every folder but those named after EXCEPT, relative to the root.
function(gn_by_folder target)
  cmake_parse_arguments(arg "" "" "EXCEPT" ${ARGN})
  if(NOT GNOMON_BY_FOLDER)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${CMAKE_SOURCE_DIR})
    if(folder IN_LIST arg_EXCEPT)
      continue()
    endif()
    string(MAKE_C_IDENTIFIER ${folder} group)
    math(EXPR count_${group} "0${count_${group}} + 1")
    math(EXPR piece "${count_${group}} / 8")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${piece})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
