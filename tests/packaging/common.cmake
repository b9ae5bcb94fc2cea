# Helpers of the scripts here.

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# How a tree of its own is compiled where no compiler cache has the objects of the tree under test: quickly, since its
# programs are hardly run.
set(tree_type -DCMAKE_BUILD_TYPE=Release)
if(NOT LAUNCHER)
  set(tree_type -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -DHWY_COMPILE_ONLY_STATIC")
endif()

function(require_match text regex what)
  if(NOT "${text}" MATCHES "${regex}")
    message(FATAL_ERROR "${what}: nothing matches '${regex}' in\n${text}")
  endif()
endfunction()

# Builds examples/consumer against the package below `prefix` and runs it.
function(build_and_run_consumer prefix)
  run("${CMAKE_COMMAND}" -S "${SOURCE}/examples/consumer" -B "${WORK}/consumer" -G Ninja
    "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
  run("${CMAKE_COMMAND}" --build "${WORK}/consumer")
  run("${WORK}/consumer/consumer")
  require_match("${output}" "wrist: 0\\.(19[0-9]*|2) m, measured" "answer of examples/consumer")
  set(output "${output}" PARENT_SCOPE)
endfunction()
