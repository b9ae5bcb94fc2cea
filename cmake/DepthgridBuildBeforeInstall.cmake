# cmake --install and cpack build what they need and what is missing or mixed. Not every tree has built everything:
# scripts/demo builds the command, scripts/test NAME what one test needs, and each may have made some libraries newer
# than others. The stamp of depthgrid_installed says when all of them were last built together.
set(depthgrid_before_install "${CMAKE_CURRENT_BINARY_DIR}/build_before_install-$<CONFIG>.cmake")
set(depthgrid_installed_stamp "${CMAKE_CURRENT_BINARY_DIR}/depthgrid_installed.stamp")
if(NOT SKBUILD)  # a Python package has the module alone
  install(SCRIPT "${depthgrid_before_install}" ALL_COMPONENTS)
endif()

# depthgrid_build_before_install(TARGETS library... command FILES made while building...): all that an installation copies
# out of the build. Makes the target depthgrid_installed, a part of a whole build.
function(depthgrid_build_before_install)
  cmake_parse_arguments(ARG "" "" "TARGETS;FILES" ${ARGN})
  add_custom_command(OUTPUT "${depthgrid_installed_stamp}"
    COMMAND "${CMAKE_COMMAND}" -E touch "${depthgrid_installed_stamp}"
    DEPENDS ${ARG_TARGETS} ${ARG_FILES} COMMENT "Everything that is installed is built" VERBATIM)
  set(all "")
  if(PROJECT_IS_TOP_LEVEL AND NOT DEPTHGRID_SANITIZE AND NOT DEPTHGRID_COVERAGE)
    set(all ALL)
  endif()
  add_custom_target(depthgrid_installed ${all} DEPENDS "${depthgrid_installed_stamp}")

  set(files "")
  foreach(file IN LISTS ARG_FILES)
    string(APPEND files " \"${file}\"")
  endforeach()
  foreach(target IN LISTS ARG_TARGETS)
    string(APPEND files " \"$<TARGET_FILE:${target}>\"")
  endforeach()
  file(READ "${PROJECT_SOURCE_DIR}/cmake/build_before_install.cmake.in" script)
  string(CONFIGURE "${script}" script @ONLY)
  file(GENERATE OUTPUT "${depthgrid_before_install}" CONTENT "${script}")
endfunction()
