# SPDX-License-Identifier: MIT
# One executable a suite: a process starts once, the driver's compiled shaders are shared. Every suite is also a line of
# suites.txt in the build folder, which is what tools/run_tests reads: its name, where it is tested and its program.
#
# Where an optimised and a sanitized build are both tested, what reads bytes is tested in the sanitized one alone. The target
# `tested` is what a build needs for that.
enable_testing()
set(gn_suites "")
add_custom_target(tested)
if(GNOMON_SANITIZE)
  set(gn_tested_here sanitized)
else()
  set(gn_tested_here optimised)
endif()

# gn_suite(name SOURCES ... LINK ... [TESTED optimised|sanitized] [PRECOMPILED kind]): nothing when there are no sources;
# without TESTED it is tested in both.
function(gn_suite name)
  cmake_parse_arguments(arg "" "PRECOMPILED;TESTED" "SOURCES;LINK" ${ARGN})
  if(NOT arg_SOURCES)
    return()
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK} gn_printers gn_suite_options GTest::gtest_main)
  # Reading an absent figure ends the suite, it does not compare rubbish.
  target_compile_definitions(${name} PRIVATE _GLIBCXX_ASSERTIONS)
  if(NOT arg_PRECOMPILED)
    set(arg_PRECOMPILED SUITE)
  endif()
  gn_precompiled(${name} ${arg_PRECOMPILED})
  gn_together(${name})
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT 900 ENVIRONMENT "${gn_test_environment}")
  if(NOT arg_TESTED)
    set(arg_TESTED everywhere)
  endif()
  if(arg_TESTED MATCHES "^(everywhere|${gn_tested_here})$")
    add_dependencies(tested ${name})
  endif()
  set(gn_suites "${gn_suites}${name} ${arg_TESTED} $<TARGET_FILE:${name}>\n" PARENT_SCOPE)
endfunction()

set(gn_test_environment
    MESA_SHADER_CACHE_DIR=${CMAKE_BINARY_DIR}/../test-caches/driver-128
    GNOMON_CACHE=${CMAKE_BINARY_DIR}/../test-caches/gnomon
    GALLIVM_PERF=nopt
    LP_NATIVE_VECTOR_WIDTH=128
    ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1:quarantine_size_mb=16
    LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/leaks.supp:print_suppressions=0
    UBSAN_OPTIONS=print_stacktrace=1)

add_library(gn_printers STATIC tests/printers.cpp)
target_link_libraries(gn_printers PRIVATE gn_options GTest::gtest)
target_include_directories(gn_printers PRIVATE ${CMAKE_SOURCE_DIR})

file(GLOB base_tests CONFIGURE_DEPENDS base/*_test.cpp)
gn_suite(base_tests SOURCES ${base_tests} LINK gn_images TESTED sanitized)
file(GLOB gpu_tests CONFIGURE_DEPENDS gpu/*_test.cpp)
gn_suite(gpu_tests SOURCES ${gpu_tests} LINK gn_compiler TESTED sanitized)
file(GLOB_RECURSE scene_tests CONFIGURE_DEPENDS shadow/scene/*_test.cpp)
if(GNOMON_SANITIZE AND NOT GNOMON_SANITIZE_ALL)
  list(APPEND scene_tests ${CMAKE_SOURCE_DIR}/tests/real_scenes_test.cpp)  # the largest of which only the optimised build loads
endif()
gn_suite(scene_tests SOURCES ${scene_tests} LINK gn_scene TESTED sanitized)
file(GLOB reference_tests CONFIGURE_DEPENDS reference/*_test.cpp scenes/*_test.cpp)
gn_suite(reference_tests SOURCES ${reference_tests} LINK gn_reference)
file(GLOB metrics_tests CONFIGURE_DEPENDS shadow/metrics/*_test.cpp)
gn_suite(metrics_tests SOURCES ${metrics_tests} LINK gn_metrics)
# What tests of the frame share.
file(GLOB rig_sources CONFIGURE_DEPENDS tests/*.cpp)
list(FILTER rig_sources EXCLUDE REGEX "_test\\.cpp$|printers\\.cpp$")
add_library(gn_rig STATIC ${rig_sources})
target_link_libraries(gn_rig PUBLIC gn_shadow gn_reference gn_metrics GTest::gtest PRIVATE gn_suite_options)
target_compile_definitions(gn_rig PRIVATE _GLIBCXX_ASSERTIONS)
gn_precompiled(gn_rig FRAME_SUITE)
gn_together(gn_rig)
# The laws of parts are figures, which sanitizers do not look at: with them one suite draws every recipe, and those of what
# lives over frames and beyond the boundary run, but for three that compare what the others draw. make measure runs all.
if(GNOMON_SANITIZE AND NOT GNOMON_SANITIZE_ALL)
  set(shadow_test_globs tests/parameter_sweep_test.cpp tests/vulkan_calls_test.cpp)
  set(tested_folders shadow/frame shadow/embed shadow/recipe shadow/geometry)
  set(part_tests "")
else()
  set(shadow_test_globs tests/*_test.cpp)
  set(tested_folders ${shadow_folders})
endif()
foreach(folder ${tested_folders})
  list(APPEND shadow_test_globs ${folder}/*_test.cpp)
endforeach()
file(GLOB shadow_tests CONFIGURE_DEPENDS ${shadow_test_globs})
if(GNOMON_SANITIZE AND NOT GNOMON_SANITIZE_ALL)
  list(FILTER shadow_tests EXCLUDE REGEX "/(baked|drawn|features)_test\\.cpp$")
endif()
gn_suite(part_tests SOURCES ${shadow_tests} ${part_tests} LINK gn_rig PRECOMPILED FRAME_SUITE)
file(GLOB evaluation_tests CONFIGURE_DEPENDS apps/evaluation/*_test.cpp)
gn_suite(evaluation_tests SOURCES ${evaluation_tests} LINK gn_evaluation TESTED sanitized)
# The command is tested from outside, so that the suite of one build tests the commands of all (tools/run_tests).
file(GLOB_RECURSE app_tests CONFIGURE_DEPENDS apps/*_test.cpp)
file(GLOB view_tests CONFIGURE_DEPENDS apps/view/*_test.cpp)
list(REMOVE_ITEM app_tests ${evaluation_tests} ${view_tests})
gn_suite(app_tests SOURCES ${app_tests} LINK gn_images gn_evaluation PkgConfig::HTTPLIB TESTED optimised)
add_dependencies(app_tests gnomon)
add_dependencies(tested gnomon)
target_compile_definitions(app_tests PRIVATE GNOMON_EXECUTABLE="$<TARGET_FILE:gnomon>" GNOMON_SOURCE="${CMAKE_SOURCE_DIR}")
# The viewer is tested from inside, by hands on its panel; once in a window, where there is a display server for tests.
list(APPEND view_tests ${CMAKE_SOURCE_DIR}/apps/subprocess_test.cpp)
gn_suite(view_tests SOURCES ${view_tests} LINK gn_command TESTED optimised)
add_dependencies(view_tests gnomon)
target_compile_definitions(view_tests PRIVATE GNOMON_EXECUTABLE="$<TARGET_FILE:gnomon>")
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/suites.txt CONTENT "${gn_suites}")

add_test(NAME layout_tests COMMAND python3 ${CMAKE_SOURCE_DIR}/tests/layout_test.py)
add_test(NAME format COMMAND ${CMAKE_SOURCE_DIR}/tools/check_format)

# Every header compiles alone and twice: one source each, compiled but never linked. A quarter of what a build compiles, so
# that make measure does it.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} base/*.h gpu/*.h shadow/*.h reference/*.h
     scenes/*.h apps/*.h tests/*.h)
set(header_sources "")
foreach(header ${headers})
  string(MAKE_C_IDENTIFIER ${header} name)
  set(source ${CMAKE_BINARY_DIR}/headers/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"@header@\"\n#include \"@header@\"  // twice: its guard works\n" @ONLY)
  list(APPEND header_sources ${source})
endforeach()
add_library(headers_alone OBJECT EXCLUDE_FROM_ALL ${header_sources})
target_include_directories(headers_alone PRIVATE ${CMAKE_SOURCE_DIR})
target_link_libraries(headers_alone PRIVATE gn_options Vulkan::Vulkan fmt::fmt)
target_compile_options(headers_alone PRIVATE -O0)

# Ratios for docs/performance.md; run by hand, never by the tests.
file(GLOB performance_sources CONFIGURE_DEPENDS tests/performance/*.cpp)
add_executable(performance_ratios EXCLUDE_FROM_ALL ${performance_sources})
target_link_libraries(performance_ratios PRIVATE gn_shadow gn_options)
