# Install rules: components lib (what a program needs to run), dev (what is needed to build against it) and app
# (the command), and the package that find_package(depthgrid) finds.
include(CMakePackageConfigHelpers)

set(depthgrid_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/depthgrid")
get_property(depthgrid_libraries GLOBAL PROPERTY DEPTHGRID_LIBRARIES)

install(TARGETS ${depthgrid_libraries} EXPORT depthgridTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT lib NAMELINK_COMPONENT dev
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(EXPORT depthgridTargets NAMESPACE depthgrid:: DESTINATION ${depthgrid_package_dir} COMPONENT dev)

# What a program that links a library has to find itself: everything in the library's link interface, which for a
# static library includes what it uses privately. A new dependency gets a line here.
set(depthgrid_package_of_Eigen3::Eigen "Eigen3 3.3 NO_MODULE")
set(depthgrid_package_of_Threads::Threads Threads)
set(depthgrid_package_of_ZLIB::ZLIB ZLIB)
set(depthgrid_package_of_PNG::PNG PNG)
set(depthgrid_package_of_hwy::hwy hwy)
set(depthgrid_package_of_pugixml::pugixml pugixml)

set(depthgrid_components "")
set(depthgrid_component_packages "")
foreach(library IN LISTS depthgrid_libraries)  # in the order of the rooms: those below are done already
  get_target_property(component ${library} EXPORT_NAME)
  get_target_property(links ${library} INTERFACE_LINK_LIBRARIES)
  set(packages_of_${component} "")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
    if(link MATCHES "^depthgrid(::|_)(.+)$")
      list(APPEND packages_of_${component} ${packages_of_${CMAKE_MATCH_2}})
    elseif(DEFINED depthgrid_package_of_${link})
      list(APPEND packages_of_${component} "${depthgrid_package_of_${link}}")
    elseif(link)
      message(FATAL_ERROR "${library} links ${link}: say in ${CMAKE_CURRENT_LIST_FILE} which package provides it")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages_of_${component})
  list(APPEND depthgrid_components ${component})
  string(APPEND depthgrid_component_packages "set(_depthgrid_packages_of_${component} \"${packages_of_${component}}\")\n")
endforeach()

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/depthgridConfig.cmake.in" "${PROJECT_BINARY_DIR}/depthgridConfig.cmake"
  INSTALL_DESTINATION ${depthgrid_package_dir})
# Before 1.0 a minor version may change the interface, so a program gets the minor version it asked for.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/depthgridConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/depthgridConfig.cmake" "${PROJECT_BINARY_DIR}/depthgridConfigVersion.cmake"
  DESTINATION ${depthgrid_package_dir} COMPONENT dev)

# Everything that an installation copies out of the build.
add_custom_target(depthgrid_installed)
add_dependencies(depthgrid_installed ${depthgrid_libraries})
if(TARGET depthgrid)
  add_dependencies(depthgrid_installed depthgrid)
  # Finds shared libraries installed beside it wherever the prefix is moved to.
  set_target_properties(depthgrid PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS depthgrid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT app)
endif()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md"
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT lib)
