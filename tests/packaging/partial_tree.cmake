# The README's two lines, cmake --install and cpack, in a tree of which only the command is built, as scripts/demo leaves it.
cmake_policy(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

set(tree "${WORK}/tree")
file(REMOVE_RECURSE "${WORK}/prefix" "${WORK}/packages" "${tree}/lib" "${tree}/depthgrid_installed.stamp")
run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${tree}" -G Ninja ${tree_type}
  "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 "-DDEPTHGRID_WARNINGS_AS_ERRORS=${WARNINGS_AS_ERRORS}"
  -DDEPTHGRID_BUILD_TESTS=OFF -DDEPTHGRID_BUILD_LAB=OFF)
run("${CMAKE_COMMAND}" --build "${tree}" --target depthgrid)
# The command uses all libraries by now: one that is missing stands for those that a smaller program would leave out.
if(NOT EXISTS "${tree}/lib/libdepthgrid_avoidance.a")
  message(FATAL_ERROR "the command was built without a library that it uses")
endif()
file(REMOVE "${tree}/lib/libdepthgrid_avoidance.a")

# What cannot be built is said, and nothing is installed.
file(RENAME "${tree}/build.ninja" "${tree}/hidden.ninja")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${tree}" --prefix "${WORK}/prefix"
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
file(RENAME "${tree}/hidden.ninja" "${tree}/build.ninja")
if(result EQUAL 0 OR EXISTS "${WORK}/prefix")
  message(FATAL_ERROR "a tree that cannot be built was installed (${result}):\n${output}")
endif()
require_match("${output}" "nothing was installed: .*--target[ \n]*depthgrid_installed" "an installation without its parts")

set(building "Building first what is missing or older than the rest: ")
run("${CMAKE_COMMAND}" --install "${tree}" --prefix "${WORK}/prefix")
require_match("${output}" "${building}[^\n]*libdepthgrid_avoidance\\.a" "cmake --install of the command's tree")
foreach(file IN ITEMS bin/depthgrid lib/libdepthgrid_avoidance.a lib/libdepthgrid_core.a lib/pkgconfig/depthgrid_search.pc
    lib/cmake/depthgrid/depthgridConfig.cmake include/depthgrid/search/search.hpp share/man/man1/depthgrid.1.gz
    share/depthgrid/robots/kuka_lwr4.urdf share/doc/depthgrid/LICENSE share/doc/depthgrid/docs/images/demo.png)
  if(NOT EXISTS "${WORK}/prefix/${file}")
    message(FATAL_ERROR "cmake --install left out ${file}")
  endif()
endforeach()

# All is there now.
run("${CMAKE_COMMAND}" --install "${tree}" --prefix "${WORK}/prefix")
if(output MATCHES "${building}")
  message(FATAL_ERROR "a second installation builds again:\n${output}")
endif()
# The target `install` builds by itself, and starts no build within its own.
run("${CMAKE_COMMAND}" -E env "DESTDIR=${WORK}/packages" "${CMAKE_COMMAND}" --build "${tree}" --target install)
if(output MATCHES "${building}")
  message(FATAL_ERROR "the target install builds within its build:\n${output}")
endif()
# A library made anew without the others, whose sources may have changed, too.
run("${CMAKE_COMMAND}" -E touch "${tree}/lib/libdepthgrid_core.a")
run("${CMAKE_COMMAND}" --install "${tree}" --prefix "${WORK}/prefix")
require_match("${output}" "${building}libdepthgrid_core\\.a\n" "cmake --install of a mixed tree")

file(REMOVE "${tree}/lib/libdepthgrid_avoidance.a")
file(REMOVE_RECURSE "${WORK}/packages")
get_filename_component(cmake_folder "${CMAKE_COMMAND}" DIRECTORY)
run("${cmake_folder}/cpack" --config "${tree}/CPackConfig.cmake" -G DEB -B "${WORK}/packages")
foreach(package IN ITEMS depthgrid libdepthgrid-dev depthgrid-doc)
  file(GLOB file "${WORK}/packages/${package}_${VERSION}-1_*.deb")
  if(NOT file)
    message(FATAL_ERROR "cpack made no ${package} of the command's tree")
  endif()
endforeach()
file(GLOB file "${WORK}/packages/libdepthgrid-dev_*.deb")
run(dpkg-deb --contents "${file}")
require_match("${output}" "/libdepthgrid_avoidance\\.a\n" "package of a tree without a library")
