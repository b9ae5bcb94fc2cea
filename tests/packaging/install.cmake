# Installs the tree, moves what was installed, and builds a project outside the tree against it.
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

file(REMOVE_RECURSE "${WORK}")
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}/first")
file(RENAME "${WORK}/first" "${WORK}/moved")  # no path of the build or of the first prefix may be needed

# Every header that is installed finds the headers that it includes.
file(GLOB_RECURSE headers RELATIVE "${WORK}/moved/include" "${WORK}/moved/include/*.hpp")
if(NOT headers)
  message(FATAL_ERROR "no header was installed")
endif()
foreach(header IN LISTS headers)
  file(STRINGS "${WORK}/moved/include/${header}" includes REGEX "^#include \"")
  foreach(line IN LISTS includes)
    string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
    if(NOT EXISTS "${WORK}/moved/include/${included}")
      message(FATAL_ERROR "${header} is installed and includes ${included}, which is not")
    endif()
  endforeach()
  # How a view keeps its image is free to change.
  file(READ "${WORK}/moved/include/${header}" text)
  foreach(word "[Pp]yramid" "// [^\n]*Internal\\.")
    if(text MATCHES "${word}")
      message(FATAL_ERROR "${header} is installed and says '${CMAKE_MATCH_0}'")
    endif()
  endforeach()
endforeach()

build_and_run_consumer("${WORK}/moved")

# A program asks for the minor version it was written for; another one is not taken for it.
file(WRITE "${WORK}/version/CMakeLists.txt"
  "cmake_minimum_required(VERSION 3.22)\nproject(version LANGUAGES CXX)\nfind_package(depthgrid 0.2 REQUIRED)\n")
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${WORK}/version" -B "${WORK}/version/build" -G Ninja
  "-DCMAKE_PREFIX_PATH=${WORK}/moved" RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0)
  message(FATAL_ERROR "a project that asks for depthgrid 0.2 was given ${VERSION}")
endif()
require_match("${output}" "depthgridConfig.cmake, version: ${VERSION}" "refusal of version 0.2")
