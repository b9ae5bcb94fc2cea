# cpack -G DEB: three Debian packages, one an installation component. depthgrid: the command, its man pages and robots;
# libdepthgrid-dev: what a program is built with; depthgrid-doc: the documents. docs/packages.md says more.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

set(CPACK_PACKAGE_NAME depthgrid)
set(CPACK_PACKAGE_VENDOR "The depthgrid authors")
set(CPACK_PACKAGE_CONTACT "The depthgrid authors <maintainers@users.noreply.h-seed-c1be7fd3.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS  # whatever umask says
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL runtime dev doc)
if(NOT TARGET depthgrid AND NOT BUILD_SHARED_LIBS)
  message(STATUS "cpack makes no complete package `depthgrid` of this tree, which has no command (DEPTHGRID_BUILD_APP)")
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(depthgrid_what "depthgrid computes, from the depth images of one or more calibrated cameras, a
lower bound of the distance from points on a robot to space that no camera has
seen free, under stated assumptions.
")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME depthgrid)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS depthgrid-doc)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "distances from a robot to what depth cameras see and cannot see
${depthgrid_what}
This package contains the command, which answers for recordings, and robot
descriptions.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libdepthgrid-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
list(JOIN depthgrid_debian_packages ", " depthgrid_dev_depends)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "depthgrid (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), ${depthgrid_dev_depends}")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "cmake, depthgrid-doc, pkg-config")
set(CPACK_DEBIAN_DEV_DESCRIPTION "distances from a robot to what depth cameras see (development)
${depthgrid_what}
This package contains the libraries, their headers, what CMake and pkg-config
find them with, and examples.")

set(CPACK_DEBIAN_DOC_PACKAGE_NAME depthgrid-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_DESCRIPTION "distances from a robot to what depth cameras see (documents)
${depthgrid_what}
This package contains the documents, as Markdown with pictures, and examples.")

# Not a cache entry: cpack sees this tree only.
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/debian/finish.cmake")
set(CPACK_DEPTHGRID_SOURCE "${PROJECT_SOURCE_DIR}")
set(CPACK_DEPTHGRID_STRIP "${CMAKE_STRIP}")
include(CPack)
