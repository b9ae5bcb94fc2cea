# Helpers that every folder uses, so that all targets are built the same way.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

function(depthgrid_compile_options target)
  # No contraction: the same expression must give the same bits at every place that evaluates it.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Wold-style-cast -ffp-contract=off
    $<$<BOOL:${DEPTHGRID_WARNINGS_AS_ERRORS}>:-Werror>)
  # g++ 12 sees an overlapping copy inside std::string where there is none ("a" + std::to_string(n), GCC bug 105329).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  # Joined sources look like headers, whose classes should not hold types of unnamed namespaces.
  if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# Tables of addresses are written once, before the program begins, and are read-only then.
function(depthgrid_link_options target)
  if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
    target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now)
  endif()
endfunction()

# What Debian compiles and links its packages with, for the parts that read what others wrote. The rooms of the query path do
# without the guards of the stack: their functions are short, called millions of times a second, and see checked input.
function(depthgrid_harden target)
  if(DEPTHGRID_SANITIZE OR DEPTHGRID_COVERAGE)
    return()
  endif()
  target_compile_options(${target} PRIVATE -fstack-protector-strong
    "$<$<NOT:$<CONFIG:Debug>>:SHELL:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>")
endfunction()

# A program's flags change nothing that the library computes: see keep_own_functions.cmake, and for shared libraries the
# linker's option. Where the linker is not GNU's, or sees no functions yet (-flto), they stay as they are.
execute_process(COMMAND "${CMAKE_LINKER}" --version OUTPUT_VARIABLE depthgrid_linker ERROR_QUIET)
function(depthgrid_keep_own_functions target)
  if(NOT depthgrid_linker MATCHES "^GNU ld" OR DEPTHGRID_SANITIZE OR DEPTHGRID_COVERAGE
      OR CMAKE_INTERPROCEDURAL_OPTIMIZATION OR CMAKE_CXX_FLAGS MATCHES "-flto")
    return()
  endif()
  if(BUILD_SHARED_LIBS)
    target_link_options(${target} PRIVATE -Wl,-Bsymbolic-functions)
  else()
    add_custom_command(TARGET ${target} POST_BUILD
      COMMAND "${CMAKE_COMMAND}" "-DLIBRARY=$<TARGET_FILE:${target}>" "-DLINKER=${CMAKE_LINKER}" "-DNM=${CMAKE_NM}"
        "-DOBJCOPY=${CMAKE_OBJCOPY}" "-DAR=${CMAKE_AR}" -P "${PROJECT_SOURCE_DIR}/cmake/keep_own_functions.cmake"
      VERBATIM)
  endif()
endfunction()

# Shared and static libraries are compiled alike, so that a compiler cache serves both.
# depthgrid_add_library(core SOURCES a.cpp HEADERS a.hpp PUBLIC Eigen3::Eigen PRIVATE PNG::PNG)
function(depthgrid_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  add_library(depthgrid_${name} ${ARG_SOURCES})
  add_library(depthgrid::${name} ALIAS depthgrid_${name})
  set_target_properties(depthgrid_${name} PROPERTIES
    # Shared ones find each other wherever they are installed; a program's own path is not theirs.
    INSTALL_RPATH "$ORIGIN"
    EXPORT_NAME ${name} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "")
  target_compile_features(depthgrid_${name} PUBLIC cxx_std_20)
  target_include_directories(depthgrid_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(depthgrid_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  depthgrid_compile_options(depthgrid_${name})
  depthgrid_link_options(depthgrid_${name})
  depthgrid_keep_own_functions(depthgrid_${name})
  set_property(GLOBAL APPEND PROPERTY DEPTHGRID_LIBRARIES depthgrid_${name})
  foreach(header IN LISTS ARG_HEADERS)
    get_filename_component(folder "${header}" DIRECTORY)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/depthgrid/${name}/${folder} COMPONENT dev)
  endforeach()
endfunction()

# Headers that most tests begin with, compiled once: a third of a test's time. Not with a compiler cache, which has no use for
# them; so a test that lacks an include is found there. A test with options of its own reads the headers' text instead.
set(CMAKE_PCH_WARN_INVALID OFF)
function(depthgrid_reuse_test_headers target)
  # What tests compute themselves is little beside what the libraries and the oracles compute, which are optimised in full.
  # Nor is undefined behaviour looked for there, which doubles the compiler's time.
  set(options $<$<CONFIG:Release>:-O1>)
  if(DEPTHGRID_SANITIZE)
    list(APPEND options -fno-sanitize=undefined)
  endif()
  target_compile_options(${target} PRIVATE ${options})
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  if(NOT TARGET depthgrid_test_headers)
    file(WRITE "${PROJECT_BINARY_DIR}/test_headers.cpp" "")
    add_library(depthgrid_test_headers OBJECT EXCLUDE_FROM_ALL "${PROJECT_BINARY_DIR}/test_headers.cpp")
    target_link_libraries(depthgrid_test_headers PRIVATE depthgrid::core GTest::gtest GTest::gmock)
    target_precompile_headers(depthgrid_test_headers PRIVATE <gmock/gmock.h> <gtest/gtest.h> <Eigen/Geometry> <algorithm>
      <array> <cmath> <functional> <limits> <random> <sstream> <string> <vector>)
    depthgrid_compile_options(depthgrid_test_headers)
    target_compile_options(depthgrid_test_headers PRIVATE ${options})
  endif()
  target_link_libraries(${target} PRIVATE depthgrid::core)  # the same definitions
  # With them g++ 12 sees an endless copy inside std::string where there is none ("a" + text + "b"), under both names.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-array-bounds)
  endif()
  target_precompile_headers(${target} REUSE_FROM depthgrid_test_headers)
endfunction()

# depthgrid_add_test(core_camera SOURCES camera_test.cpp LIBRARIES depthgrid::core LABELS threads)
function(depthgrid_add_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_link_libraries(${name}_test PRIVATE ${ARG_LIBRARIES} GTest::gtest GTest::gmock GTest::gtest_main)
  target_include_directories(${name}_test PRIVATE "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/tests")
  depthgrid_compile_options(${name}_test)
  depthgrid_reuse_test_headers(${name}_test)
  add_test(NAME ${name} COMMAND ${name}_test WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600)
  if("threads" IN_LIST ARG_LABELS)
    # One target for the thread sanitizer, which has no use for the other tests.
    if(NOT TARGET depthgrid_thread_tests)
      add_custom_target(depthgrid_thread_tests)
    endif()
    add_dependencies(depthgrid_thread_tests ${name}_test)
  endif()
endfunction()
