# What the library computes does not depend on the flags of the program that uses it: the numbers of the programs made
# from user_flags.cpp are the same, and the library has no function that a program's copy could take the place of.
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

run("${PLAIN}")
require_match("${output}" "^search [0-9a-f]+\nletter [0-9a-f]+\ncorrected [0-9a-f]+\nkinematics [0-9a-f]+\nloop [0-9a-f]+\n$"
  "output of ${PLAIN}")
set(plain "${output}")
run("${NATIVE}")
if(NOT output STREQUAL plain)
  message(FATAL_ERROR "with -march=native the library computes other numbers:\n${output}instead of\n${plain}")
endif()

if(NOT GNU_LD OR SHARED)
  return()
endif()
# The program without optimisation does have functions of its own that the library uses, too.
run(nm --demangle "${NATIVE}")
foreach(function IN ITEMS "Eigen::AngleAxis<double>::toRotationMatrix\\(\\) const" "depthgrid::led_direction\\(")
  require_match("${output}" " [WV] ${function}" "functions of ${NATIVE}")
endforeach()
foreach(room IN ITEMS core views memory files grid search robot control avoidance simulation cell sensors network monitor)
  list(APPEND libraries "${LIBRARY_FOLDER}/libdepthgrid_${room}.a")
endforeach()
run(nm --demangle --defined-only ${libraries})
string(REGEX MATCHALL "[0-9a-f]+ [Wu] [^\n]*" weak "${output}")
if(weak)
  list(GET weak 0 example)
  list(LENGTH weak count)
  message(FATAL_ERROR "${count} functions of the library give way to a program's copy, for instance ${example}")
endif()
