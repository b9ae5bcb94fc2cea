# Builds the libraries shared, without the command, and uses them from outside the tree.
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

file(REMOVE_RECURSE "${WORK}/prefix" "${WORK}/consumer")
run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON
  "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" -DDEPTHGRID_BUILD_APP=OFF
  -DDEPTHGRID_BUILD_TESTS=OFF
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12
  # As the tree under test has it: then a compiler cache has the objects already.
  "-DDEPTHGRID_WARNINGS_AS_ERRORS=${WARNINGS_AS_ERRORS}")
run("${CMAKE_COMMAND}" --build "${WORK}/build")
run("${CMAKE_COMMAND}" --install "${WORK}/build" --prefix "${WORK}/prefix")
build_and_run_consumer("${WORK}/prefix")

# The program is bound to the minor version: libdepthgrid_core.so.0.1, not .so.0 and not .so.0.1.0.
string(REGEX MATCH "^[0-9]+\\.[0-9]+" minor "${VERSION}")
run(ldd "${WORK}/consumer/consumer")
require_match("${output}" "libdepthgrid_core\\.so\\.${minor} => " "libraries of the consumer")
