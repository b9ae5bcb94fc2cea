# Install rules: components lib (what a program needs to run), dev (what is needed to build against it) and app
# (the command), and the package that find_package(depthgrid) finds.
include(CMakePackageConfigHelpers)

set(depthgrid_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/depthgrid")
get_property(depthgrid_libraries GLOBAL PROPERTY DEPTHGRID_LIBRARIES)

install(TARGETS ${depthgrid_libraries} EXPORT depthgridTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT lib NAMELINK_COMPONENT dev
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(EXPORT depthgridTargets NAMESPACE depthgrid:: DESTINATION ${depthgrid_package_dir} COMPONENT dev)

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/depthgridConfig.cmake.in" "${PROJECT_BINARY_DIR}/depthgridConfig.cmake"
  INSTALL_DESTINATION ${depthgrid_package_dir})
# Before 1.0 a minor version may change the interface, so a program gets the minor version it asked for.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/depthgridConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/depthgridConfig.cmake" "${PROJECT_BINARY_DIR}/depthgridConfigVersion.cmake"
  DESTINATION ${depthgrid_package_dir} COMPONENT dev)

if(TARGET depthgrid)
  # Finds shared libraries installed beside it wherever the prefix is moved to.
  set_target_properties(depthgrid PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS depthgrid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT app)
endif()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md"
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT lib)
