# Debian's own checker has nothing to say of the packages but what cmake/debian/*.lintian-overrides names with reasons.
cmake_policy(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

find_program(lintian lintian)
if(NOT lintian)
  message("skipped: no lintian here; scripts/install-packages package installs it")
  return()
endif()
# Its spelling of binaries reads machine code as words, and finds some by chance.
function(check packages)
  execute_process(COMMAND "${lintian}" --allow-root --fail-on error,warning,info --display-info --no-cfg
      --suppress-tags spelling-error-in-binary ${packages}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  set(result "${result}" PARENT_SCOPE)
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(GLOB packages "${PACKAGES}/*.deb")
list(LENGTH packages count)
if(NOT count EQUAL 3)
  message(FATAL_ERROR "${count} packages in ${PACKAGES}, not 3")
endif()
check("${packages}")
if(NOT result EQUAL 0)
  message(FATAL_ERROR "lintian (${result}):\n${output}")
endif()

# It does see what is wrong: the document package without its copyright file.
file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
file(GLOB package "${PACKAGES}/depthgrid-doc_*.deb")
run(dpkg-deb --raw-extract "${package}" "${WORK}/bad")
file(REMOVE "${WORK}/bad/usr/share/doc/depthgrid-doc/copyright")
run(dpkg-deb --root-owner-group --build "${WORK}/bad" "${WORK}/bad.deb")
check("${WORK}/bad.deb")
if(result EQUAL 0 OR NOT output MATCHES "no-copyright-file")
  message(FATAL_ERROR "lintian (${result}) passes a package without a copyright file:\n${output}")
endif()
