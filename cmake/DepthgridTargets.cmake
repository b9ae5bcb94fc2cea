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

# Shared and static libraries are compiled alike, so that a compiler cache serves both.
# depthgrid_add_library(core SOURCES a.cpp HEADERS a.hpp PUBLIC Eigen3::Eigen PRIVATE PNG::PNG)
function(depthgrid_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  add_library(depthgrid_${name} ${ARG_SOURCES})
  add_library(depthgrid::${name} ALIAS depthgrid_${name})
  set_target_properties(depthgrid_${name} PROPERTIES
    EXPORT_NAME ${name} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "")
  target_compile_features(depthgrid_${name} PUBLIC cxx_std_20)
  target_include_directories(depthgrid_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(depthgrid_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  depthgrid_compile_options(depthgrid_${name})
  set_property(GLOBAL APPEND PROPERTY DEPTHGRID_LIBRARIES depthgrid_${name})
  foreach(header IN LISTS ARG_HEADERS)
    get_filename_component(folder "${header}" DIRECTORY)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/depthgrid/${name}/${folder} COMPONENT dev)
  endforeach()
endfunction()

# depthgrid_add_test(core_camera SOURCES camera_test.cpp LIBRARIES depthgrid::core LABELS threads)
function(depthgrid_add_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_link_libraries(${name}_test PRIVATE ${ARG_LIBRARIES} GTest::gtest GTest::gmock GTest::gtest_main)
  target_include_directories(${name}_test PRIVATE "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/tests")
  depthgrid_compile_options(${name}_test)
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
