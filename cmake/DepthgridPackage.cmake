# cpack -G DEB: one Debian package with the command, the libraries and what is needed to build against them.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

set(CPACK_PACKAGE_NAME depthgrid)
set(CPACK_PACKAGE_VENDOR "The depthgrid authors")
set(CPACK_PACKAGE_CONTACT "The depthgrid authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Distances from robot control points to obstacles in several depth cameras")
set(CPACK_PACKAGE_DESCRIPTION "Computes, from the depth images of one or more calibrated cameras, a lower bound of
 the distance from points on a robot to space that no camera has seen free, under stated assumptions. Contains the
 depthgrid command, the libraries and their headers.")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# What find_package(depthgrid) looks for behind the static libraries.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libeigen3-dev, libhwy-dev, libpng-dev, zlib1g-dev, libpugixml-dev")
find_program(DEPTHGRID_SHLIBDEPS dpkg-shlibdeps)
mark_as_advanced(DEPTHGRID_SHLIBDEPS)
if(DEPTHGRID_SHLIBDEPS)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
endif()
include(CPack)
