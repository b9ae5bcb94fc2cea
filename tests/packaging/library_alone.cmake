# Builds the libraries, shared, with nothing to be found but the packages that they link, and uses them from outside the tree.
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

# What the command, the lab and the tests use besides.
set(options "")
foreach(package IN ITEMS CLI11 GTest embree fcl nlohmann_json)
  list(APPEND options "-DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON")
endforeach()
list(APPEND options -G Ninja ${tree_type} -DBUILD_SHARED_LIBS=ON
  "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12
  # As the tree under test has it: then a compiler cache has the objects already.
  "-DDEPTHGRID_WARNINGS_AS_ERRORS=${WARNINGS_AS_ERRORS}"
  -DDEPTHGRID_BUILD_APP=OFF -DDEPTHGRID_BUILD_LAB=OFF -DDEPTHGRID_BUILD_TESTS=OFF)

# They are hidden indeed: what needs them is refused, and it is said what is missing.
function(require_refusal part missing)
  file(REMOVE_RECURSE "${WORK}/refused")
  execute_process(COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/refused" ${options} -DDEPTHGRID_BUILD_${part}=ON
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(result EQUAL 0)
    message(FATAL_ERROR "DEPTHGRID_BUILD_${part} found what this test hides")
  endif()
  require_match("${output}" "${missing}" "refusal of DEPTHGRID_BUILD_${part}")
endfunction()
require_refusal(LAB "CMAKE_DISABLE_FIND_PACKAGE_embree")
require_refusal(TESTS "CMAKE_DISABLE_FIND_PACKAGE_GTest")
# pkg-config, which finds cairo, looks into a folder that does not exist.
set(ENV{PKG_CONFIG_LIBDIR} "${WORK}/nothing")
set(ENV{PKG_CONFIG_PATH} "${WORK}/nothing")
require_refusal(APP "'cairo'")

file(REMOVE_RECURSE "${WORK}/prefix" "${WORK}/consumer")
run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/build" ${options})
run("${CMAKE_COMMAND}" --build "${WORK}/build")

# Their headers lie in the compiler's own folders, where nothing hides them: no source may have read one.
find_program(ninja ninja REQUIRED)
run("${ninja}" -C "${WORK}/build" -t deps)
require_match("${output}" "eigen3/Eigen/Core\n" "headers that were read")
string(REGEX MATCH "[^\n ]*/(embree[0-9]*|fcl|nlohmann|cairo|CLI|gtest|gmock)/[^\n]*|[^\n ]*/glpk\\.h" read "${output}")
if(read)
  message(FATAL_ERROR "the library reads ${read}")
endif()

run("${CMAKE_COMMAND}" --install "${WORK}/build" --prefix "${WORK}/prefix")
build_and_run_consumer("${WORK}/prefix")

# The program is bound to the minor version: libdepthgrid_core.so.0.1, not .so.0 and not .so.0.1.0.
string(REGEX MATCH "^[0-9]+\\.[0-9]+" minor "${VERSION}")
run(ldd "${WORK}/consumer/consumer")
require_match("${output}" "libdepthgrid_core\\.so\\.${minor} => " "libraries of the consumer")
