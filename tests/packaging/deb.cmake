# cpack makes three Debian packages whose names, fields, files and links are as Debian wants them.
cmake_policy(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

# Without what computes the dependencies, a line says what installs it.
execute_process(COMMAND "${CMAKE_COMMAND}" -E env PATH=/absent "${CMAKE_COMMAND}" -DCPACK_GENERATOR=DEB
  -P "${SOURCE}/cmake/debian/finish.cmake" RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0)
  message(FATAL_ERROR "cmake/debian/finish.cmake goes on without dpkg-shlibdeps")
endif()
require_match("${output}" "no dpkg-shlibdeps here. scripts/install-packages package" "cpack without dpkg-dev")

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
get_filename_component(cmake_folder "${CMAKE_COMMAND}" DIRECTORY)
run("${cmake_folder}/cpack" --config "${BUILD}/CPackConfig.cmake" -G DEB -B "${WORK}")
file(GLOB packages RELATIVE "${WORK}" "${WORK}/*.deb")
string(REPLACE "." "\\." version "${VERSION}-1")
if(NOT packages MATCHES "^depthgrid-doc_${version}_all\\.deb;depthgrid_${version}_([a-z0-9]+)\\.deb;libdepthgrid-dev_${version}_([a-z0-9]+)\\.deb$")
  message(FATAL_ERROR "cpack made other packages than depthgrid, libdepthgrid-dev and depthgrid-doc: ${packages}")
endif()
set(architecture "${CMAKE_MATCH_1}")

# require_package(NAME ARCHITECTURE SECTION LINES... FILES...): lines of the control file, files below /usr, as expressions.
function(require_package name architecture)
  cmake_parse_arguments(ARG "" "SECTION" "LINES;FILES" ${ARGN})
  set(file "${WORK}/${name}_${VERSION}-1_${architecture}.deb")
  run(dpkg-deb --field "${file}")
  foreach(line IN LISTS ARG_LINES ITEMS "Version: ${version}" "Section: ${ARG_SECTION}" "Priority: optional"
      "Maintainer: The depthgrid authors <[^ @]+@[^ @]+>" "Description: distances from a robot to what depth cameras see")
    require_match("\n${output}" "\n${line}" "control file of ${name}")
  endforeach()
  run(dpkg-deb --contents "${file}")
  foreach(path IN LISTS ARG_FILES ITEMS share/doc/${name}/copyright share/doc/${name}/changelog\\.Debian\\.gz
      share/doc/${name}/changelog\\.gz)
    require_match("${output}" "rw-r--r-- root/root [^\n]* \\./usr/${path}\n|rwxr-xr-x root/root [^\n]* \\./usr/${path}\n"
      "files of ${name}")
  endforeach()
  run(dpkg-deb --extract "${file}" "${WORK}/${name}")
endfunction()
# What the command links, with versions; the order is the alphabet's.
require_package(depthgrid ${architecture} SECTION science
  LINES "Depends: [^\n]*libc6 \\(>= [^\n]*libcairo2 \\(>= [^\n]*libhwy1[^\n]*libpng16-16[^\n]*zlib1g"
  FILES bin/depthgrid share/man/man1/depthgrid\\.1\\.gz share/man/man1/depthgrid-demo\\.1\\.gz
        share/depthgrid/robots/kuka_lwr4\\.urdf)
require_package(libdepthgrid-dev ${architecture} SECTION libdevel
  LINES "Depends: depthgrid \\(= ${version}\\), libeigen3-dev, libhwy-dev, zlib1g-dev, libpng-dev, liblz4-dev, libzstd-dev, libpugixml-dev, cyclonedds-dev, libyaml-cpp-dev\n"
  FILES lib/libdepthgrid_core\\.a lib/libdepthgrid_avoidance\\.a lib/cmake/depthgrid/depthgridConfig\\.cmake
        lib/pkgconfig/depthgrid_search\\.pc include/depthgrid/core/camera\\.hpp include/depthgrid/grid/evaluation\\.hpp
        share/doc/libdepthgrid-dev/examples/consumer/CMakeLists\\.txt)
require_package(depthgrid-doc all SECTION doc
  LINES
  FILES share/doc/depthgrid/README\\.md share/doc/depthgrid/docs/search\\.md share/doc/depthgrid/docs/images/demo\\.png
        share/doc/depthgrid/examples/quickstart\\.cpp)

# Nothing of one package lies in another: dpkg would refuse the second.
set(seen "")
foreach(name IN ITEMS depthgrid libdepthgrid-dev depthgrid-doc)
  file(GLOB_RECURSE files RELATIVE "${WORK}/${name}" "${WORK}/${name}/*")
  foreach(file IN LISTS files)
    if(file IN_LIST seen)
      message(FATAL_ERROR "${file} lies in two packages")
    endif()
  endforeach()
  list(APPEND seen ${files})
endforeach()

# The changelog is one that Debian's tools read; the command is stripped, its tables of addresses are read-only, and its
# functions that read what others wrote are guarded.
file(MAKE_DIRECTORY "${WORK}/changelog")
run(cp "${WORK}/depthgrid/usr/share/doc/depthgrid/changelog.Debian.gz" "${WORK}/changelog/changelog.gz")
run(gzip -d "${WORK}/changelog/changelog.gz")
run(dpkg-parsechangelog --file "${WORK}/changelog/changelog")
require_match("${output}" "Source: depthgrid\nVersion: ${version}\n" "changelog")
run(file "${WORK}/depthgrid/usr/bin/depthgrid")
require_match("${output}" "pie executable.*, stripped" "the command")
run(readelf --dynamic --program-headers --dyn-syms --wide "${WORK}/depthgrid/usr/bin/depthgrid")
foreach(sign IN ITEMS "BIND_NOW|FLAGS.*NOW" "GNU_RELRO" "__stack_chk_fail" "_chk@")
  require_match("${output}" "${sign}" "hardening of the command")
endforeach()
if(output MATCHES "RUNPATH|RPATH")
  message(FATAL_ERROR "the command looks for libraries beside itself, although it has none of its own")
endif()

# Links of the documents lead to files of the package, not to sources that it does not have.
set(doc "${WORK}/depthgrid-doc/usr/share/doc/depthgrid")
file(GLOB_RECURSE pages "${doc}/*.md")
set(links 0)
foreach(page IN LISTS pages)
  get_filename_component(folder "${page}" DIRECTORY)
  file(STRINGS "${page}" lines REGEX "\\]\\([^)]+\\)")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "`[^`]*`" "" line "${line}")
    string(REGEX MATCHALL "\\]\\([^) ]+\\)" targets "${line}")
    foreach(target IN LISTS targets)
      string(REGEX REPLACE "^..([^)#]*).*" "\\1" target "${target}")
      if(target AND NOT target MATCHES "^[a-z]+:")
        math(EXPR links "${links} + 1")
        if(NOT EXISTS "${folder}/${target}")
          message(FATAL_ERROR "${page} links to ${target}, which is in no package")
        endif()
      endif()
    endforeach()
  endforeach()
endforeach()
if(links LESS 100)
  message(FATAL_ERROR "only ${links} links were found in the documents")
endif()
