# Run after a static library was made: functions that it has from headers, Eigen's and ours, become its own. A program brings
# the same functions, and a linker takes one copy for both, the program's: compiled with its flags, so with other last bits
# (-march=native) or slow (-O0). Variables and types stay common. Variables: LIBRARY, LINKER, NM, OBJCOPY, AR.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    file(REMOVE "${LIBRARY}")
    message(FATAL_ERROR "failed (${result}): ${command}\n${error}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# One object of all, without the groups by which a linker recognises copies. Then no name of a function of which others may
# have a copy (nm's W) leaves it, and variables that exist once in a program (u, V) still give way to each other.
set(object "${LIBRARY}.o")
run("${LINKER}" --relocatable --force-group-allocation -o "${object}" --whole-archive "${LIBRARY}")
run("${NM}" --defined-only "${object}")
foreach(kind W u)
  string(REGEX MATCHALL "[0-9a-f]+ ${kind} [^\n]+" symbols "${output}")
  list(TRANSFORM symbols REPLACE "^[0-9a-f]+ . " "")
  list(JOIN symbols "\n" symbols)
  file(WRITE "${object}.${kind}" "${symbols}\n")
endforeach()
run("${OBJCOPY}" "--localize-symbols=${object}.W" "--weaken-symbols=${object}.u" "${object}")
file(REMOVE "${LIBRARY}")
run("${AR}" qcsD "${LIBRARY}" "${object}")
file(REMOVE "${object}" "${object}.W" "${object}.u")
