# The reader of datagrams, in C, against the header as it is installed; it hears the command run the example's cell.
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

file(REMOVE_RECURSE "${WORK}")
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}/prefix")
find_program(c_compiler NAMES cc gcc clang REQUIRED)
run("${c_compiler}" -std=c99 -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Werror -O2
  "-I${WORK}/prefix/include" "${SOURCE}/examples/datagram_reader.c" -o "${WORK}/reader")

# Another port than the example's: several trees may be tested at a time.
string(RANDOM LENGTH 3 ALPHABET 0123456789 digits)
file(READ "${SOURCE}/examples/simulated_cell.yaml" cell)
string(REPLACE "port: 47000" "port: 48${digits}" cell "${cell}")
file(WRITE "${WORK}/cell.yaml" "${cell}")
# Two commands at once, as in a pipe; the reader does not read what the other prints, and stays until it has.
execute_process(COMMAND "${COMMAND}" run "${WORK}/cell.yaml" --seconds 5 COMMAND "${WORK}/reader" 48${digits} 9
  RESULTS_VARIABLE results OUTPUT_VARIABLE output ERROR_VARIABLE log)
if(NOT results STREQUAL "0;0")
  message(FATAL_ERROR "the command and the reader end with ${results}:\n${output}\n${log}")
endif()
require_match("${output}" "[1-9][0-9]* answers, [0-9]+ of them stop; [0-9]+ missed, 0 refused, " "what the reader heard")
