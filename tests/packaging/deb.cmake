# cpack makes a Debian package with the command, the libraries, the headers and computed dependencies.
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
get_filename_component(cmake_folder "${CMAKE_COMMAND}" DIRECTORY)
run("${cmake_folder}/cpack" --config "${BUILD}/CPackConfig.cmake" -G DEB -B "${WORK}")
file(GLOB packages "${WORK}/depthgrid_${VERSION}_*.deb")
list(LENGTH packages count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "cpack made ${count} packages depthgrid_${VERSION}_*.deb in ${WORK}")
endif()

run(dpkg-deb --contents "${packages}")
foreach(file IN ITEMS
    "/usr/bin/depthgrid\n" "/libdepthgrid_core\\." "/libdepthgrid_grid\\." "/libdepthgrid_files\\."
    "/usr/include/depthgrid/core/camera\\.hpp\n" "/usr/include/depthgrid/grid/evaluation\\.hpp\n"
    "/cmake/depthgrid/depthgridConfig\\.cmake\n")
  require_match("${output}" "${file}" "contents of the package")
endforeach()

run(dpkg-deb --info "${packages}")
require_match("${output}" "Version: ${VERSION}\n" "control file")
# Computed from what the command links, with versions.
require_match("${output}" "Depends: [^\n]*libc6 \\(>= [^\n]*libpng16-16" "dependencies of the package")
