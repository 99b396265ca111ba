# SPDX-License-Identifier: MIT
# cmake -DROOT=... -DOUTPUT=... -P cmake/stamp.cmake: one number of all files that composed shaders may include, for folders
# of baked shaders, which must not meet a library of other ones.
cmake_minimum_required(VERSION 3.25)
set(globs "")
foreach(folder base gpu shadow)
  list(APPEND globs ${ROOT}/${folder}/*.glsl ${ROOT}/${folder}/*.h)
endforeach()
file(GLOB_RECURSE files RELATIVE ${ROOT} ${globs})
list(SORT files)
set(all "")
foreach(file ${files})
  file(SHA256 ${ROOT}/${file} sum)
  string(APPEND all "${file} ${sum}\n")
endforeach()
string(SHA256 stamp "${all}")
string(SUBSTRING ${stamp} 0 16 stamp)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Generated from the files that shaders include.
#include \"gpu/baked_shaders.h\"

std::string gn::library_stamp() {
    return \"@VERSION@-@stamp@\";
}
" @ONLY)
