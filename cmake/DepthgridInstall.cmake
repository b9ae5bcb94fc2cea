# Install rules: components runtime (the command and what a program needs to run), dev (what is needed to build against the
# libraries) and doc, and the packages that find_package(depthgrid) and pkg-config find.
include(CMakePackageConfigHelpers)

set(depthgrid_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/depthgrid")
get_property(depthgrid_libraries GLOBAL PROPERTY DEPTHGRID_LIBRARIES)

install(TARGETS ${depthgrid_libraries} EXPORT depthgridTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT dev
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(EXPORT depthgridTargets NAMESPACE depthgrid:: DESTINATION ${depthgrid_package_dir} COMPONENT dev)

# What a program that links a library has to find itself: everything in the library's link interface, which for a
# static library includes what it uses privately. A new dependency gets its three lines here: what find_package takes,
# pkg-config's module or a flag, and the Debian package.
set(depthgrid_package_of_Eigen3::Eigen "Eigen3 3.3 NO_MODULE")
set(depthgrid_module_of_Eigen3::Eigen eigen3)
set(depthgrid_debian_of_Eigen3::Eigen libeigen3-dev)
set(depthgrid_package_of_Threads::Threads Threads)
set(depthgrid_module_of_Threads::Threads -pthread)
set(depthgrid_debian_of_Threads::Threads "")
set(depthgrid_package_of_ZLIB::ZLIB ZLIB)
set(depthgrid_module_of_ZLIB::ZLIB zlib)
set(depthgrid_debian_of_ZLIB::ZLIB zlib1g-dev)
set(depthgrid_package_of_PNG::PNG PNG)
set(depthgrid_module_of_PNG::PNG libpng)
set(depthgrid_debian_of_PNG::PNG libpng-dev)
set(depthgrid_package_of_LZ4::LZ4 LZ4)
set(depthgrid_module_of_LZ4::LZ4 liblz4)
set(depthgrid_debian_of_LZ4::LZ4 liblz4-dev)
set(depthgrid_package_of_zstd::libzstd_shared zstd)
set(depthgrid_module_of_zstd::libzstd_shared libzstd)
set(depthgrid_debian_of_zstd::libzstd_shared libzstd-dev)
set(depthgrid_package_of_hwy::hwy hwy)
set(depthgrid_module_of_hwy::hwy libhwy)
set(depthgrid_debian_of_hwy::hwy libhwy-dev)
set(depthgrid_package_of_pugixml::pugixml pugixml)
set(depthgrid_module_of_pugixml::pugixml pugixml)
set(depthgrid_debian_of_pugixml::pugixml libpugixml-dev)
set(depthgrid_package_of_CycloneDDS::ddsc CycloneDDS)
set(depthgrid_module_of_CycloneDDS::ddsc CycloneDDS)
set(depthgrid_debian_of_CycloneDDS::ddsc cyclonedds-dev)
set(depthgrid_package_of_yaml-cpp yaml-cpp)
set(depthgrid_module_of_yaml-cpp yaml-cpp)
set(depthgrid_debian_of_yaml-cpp libyaml-cpp-dev)

file(RELATIVE_PATH pkgconfig_up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" pkgconfig_up "${pkgconfig_up}")
set(depthgrid_components "")
set(depthgrid_component_packages "")
set(depthgrid_debian_packages "")
foreach(library IN LISTS depthgrid_libraries)  # in the order of the rooms: those below are done already
  get_target_property(component ${library} EXPORT_NAME)
  get_target_property(links ${library} INTERFACE_LINK_LIBRARIES)
  set(packages_of_${component} "")
  set(pkgconfig_requires "")
  set(pkgconfig_libs "-L\${libdir} -l${library}")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
    if(link MATCHES "^depthgrid(::|_)(.+)$")
      list(APPEND pkgconfig_requires "depthgrid_${CMAKE_MATCH_2} = ${PROJECT_VERSION}")
      list(APPEND packages_of_${component} ${packages_of_${CMAKE_MATCH_2}})
    elseif(DEFINED depthgrid_package_of_${link})
      list(APPEND packages_of_${component} "${depthgrid_package_of_${link}}")
      list(APPEND depthgrid_debian_packages ${depthgrid_debian_of_${link}})
      if(depthgrid_module_of_${link} MATCHES "^-")
        string(APPEND pkgconfig_libs " ${depthgrid_module_of_${link}}")
      else()
        list(APPEND pkgconfig_requires ${depthgrid_module_of_${link}})
      endif()
    elseif(link)
      message(FATAL_ERROR "${library} links ${link}: say in ${CMAKE_CURRENT_LIST_FILE} which package provides it")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages_of_${component})
  list(APPEND depthgrid_components ${component})
  string(APPEND depthgrid_component_packages "set(_depthgrid_packages_of_${component} \"${packages_of_${component}}\")\n")
  # What the library passes on by its flags; of core, because every other component stands on it.
  get_target_property(definitions ${library} INTERFACE_COMPILE_DEFINITIONS)
  set(pkgconfig_cflags "-I\${includedir}")
  if(definitions)
    list(TRANSFORM definitions PREPEND " -D" OUTPUT_VARIABLE flags)
    string(APPEND pkgconfig_cflags ${flags})
  endif()
  list(JOIN pkgconfig_requires ", " pkgconfig_requires)
  configure_file("${PROJECT_SOURCE_DIR}/cmake/depthgrid.pc.in" "${PROJECT_BINARY_DIR}/pkgconfig/${library}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/pkgconfig/${library}.pc" DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endforeach()
list(REMOVE_DUPLICATES depthgrid_debian_packages)

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/depthgridConfig.cmake.in" "${PROJECT_BINARY_DIR}/depthgridConfig.cmake"
  INSTALL_DESTINATION ${depthgrid_package_dir})
# Before 1.0 a minor version may change the interface, so a program gets the minor version it asked for.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/depthgridConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/depthgridConfig.cmake" "${PROJECT_BINARY_DIR}/depthgridConfigVersion.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/FindLZ4.cmake"
  DESTINATION ${depthgrid_package_dir} COMPONENT dev)

set(depthgrid_command "")
if(TARGET depthgrid)
  set(depthgrid_command depthgrid)
  if(BUILD_SHARED_LIBS)
    # Finds shared libraries installed beside it wherever the prefix is moved to.
    set_target_properties(depthgrid PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  endif()
  install(TARGETS depthgrid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
endif()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

# Documents and examples, and the command's man pages, are made while building (both want bash).
find_program(DEPTHGRID_BASH bash)
mark_as_advanced(DEPTHGRID_BASH)
set(depthgrid_installed_files "")
if(DEPTHGRID_BASH)
  set(depthgrid_doc_pages "${PROJECT_BINARY_DIR}/doc_pages")
  file(GLOB_RECURSE depthgrid_documents CONFIGURE_DEPENDS
    "${PROJECT_SOURCE_DIR}/docs/*" "${PROJECT_SOURCE_DIR}/examples/*")
  foreach(page README.md BENCHMARK.md CHANGELOG.md CITATION.cff)
    list(APPEND depthgrid_documents "${PROJECT_SOURCE_DIR}/${page}")
  endforeach()
  add_custom_command(OUTPUT "${depthgrid_doc_pages}.stamp"
    COMMAND "${DEPTHGRID_BASH}" "${PROJECT_SOURCE_DIR}/scripts/doc-pages" "${depthgrid_doc_pages}"
    COMMAND "${CMAKE_COMMAND}" -E touch "${depthgrid_doc_pages}.stamp"
    DEPENDS "${PROJECT_SOURCE_DIR}/scripts/doc-pages" ${depthgrid_documents}
    COMMENT "Copying documents and examples" VERBATIM)
  list(APPEND depthgrid_installed_files "${depthgrid_doc_pages}.stamp")
  install(DIRECTORY "${depthgrid_doc_pages}/" DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
endif()
# They are what the command says with --help, so it has to run here.
if(DEPTHGRID_BASH AND TARGET depthgrid AND (CMAKE_CROSSCOMPILING_EMULATOR OR NOT CMAKE_CROSSCOMPILING))
  set(depthgrid_man_pages "${PROJECT_BINARY_DIR}/man_pages")
  add_custom_command(OUTPUT "${depthgrid_man_pages}.stamp"
    COMMAND "${DEPTHGRID_BASH}" "${PROJECT_SOURCE_DIR}/scripts/man-pages" "$<TARGET_FILE:depthgrid>" "${PROJECT_VERSION}"
      "${depthgrid_man_pages}"
    COMMAND "${CMAKE_COMMAND}" -E touch "${depthgrid_man_pages}.stamp"
    DEPENDS "${PROJECT_SOURCE_DIR}/scripts/man-pages" depthgrid
    COMMENT "Writing man pages" VERBATIM)
  list(APPEND depthgrid_installed_files "${depthgrid_man_pages}.stamp")
  install(DIRECTORY "${depthgrid_man_pages}/" DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
endif()

depthgrid_build_before_install(
  TARGETS ${depthgrid_libraries} ${depthgrid_command} FILES ${depthgrid_installed_files})
