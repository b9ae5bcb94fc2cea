# Every subcommand has a man page that says every option, groff reads each without a warning, and a new subcommand has
# one by itself.
cmake_policy(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")

# plain_page(FILE): as `man` shows it, without bold and lines of a width, in `page`. Warnings are errors.
function(plain_page file)
  run(gzip -dkf "${file}")
  string(REGEX REPLACE "\\.gz$" "" source "${file}")
  execute_process(COMMAND groff -man -ww -Tascii -P-cbou -rLL=1000n "${source}"
    RESULT_VARIABLE result OUTPUT_VARIABLE page ERROR_VARIABLE warnings)
  if(result OR warnings)
    message(FATAL_ERROR "groff of ${source} (${result}):\n${warnings}")
  endif()
  set(page "${page}" PARENT_SCOPE)
endfunction()

# require_pages(PROGRAM PAGE WORD...): of `PROGRAM WORD... --help` and all its subcommands, in WORK/pages.
function(require_pages program name)
  set(file "${WORK}/pages/${name}.1.gz")
  if(NOT EXISTS "${file}")
    message(FATAL_ERROR "no man page ${name}.1.gz")
  endif()
  plain_page("${file}")
  run("${program}" ${ARGN} --help)
  string(REPLACE ";" "," help "${output}")
  string(REPLACE ";" "," page "${page}")
  foreach(section IN ITEMS NAME SYNOPSIS OPTIONS "EXIT STATUS" "SEE ALSO")
    require_match("${page}" "\n${section}\n" "sections of ${name}")
  endforeach()
  string(REGEX MATCHALL "\n  --?[A-Za-z][-A-Za-z]*" options "${help}")
  if(NOT options)
    message(FATAL_ERROR "the help of ${name} has no options:\n${help}")
  endif()
  foreach(option IN LISTS options)
    string(STRIP "${option}" option)
    require_match("${page}" "\n +${option}[, \n]" "options of ${name}")
  endforeach()
  if(help MATCHES "\nSubcommands:\n(.*)")
    string(REGEX REPLACE "\n\n.*" "" subcommands "${CMAKE_MATCH_1}")
    string(REGEX MATCHALL "(^|\n)  [a-z][-a-z]*" subcommands "${subcommands}")
    foreach(subcommand IN LISTS subcommands)
      string(STRIP "${subcommand}" subcommand)
      require_match("${page}" "\n +${name}-${subcommand}\\(1\\)" "commands of ${name}")
      require_pages("${program}" "${name}-${subcommand}" ${ARGN} ${subcommand})
    endforeach()
  endif()
endfunction()

run("${SOURCE}/scripts/man-pages" "${COMMAND}" "${VERSION}" "${WORK}/pages")
require_pages("${COMMAND}" depthgrid)
file(GLOB pages "${WORK}/pages/*.gz")
list(LENGTH pages count)
if(count LESS 5)
  message(FATAL_ERROR "only ${count} man pages")
endif()
# As man finds and shows it where it is installed.
file(COPY ${pages} DESTINATION "${WORK}/man/man1")
run("${CMAKE_COMMAND}" -E env "MANPATH=${WORK}/man" "MANWIDTH=80" man depthgrid-demo)
require_match("${output}" "depthgrid-demo - .*depthgrid demo \\[OPTIONS\\].*--picture TEXT" "man depthgrid-demo")

# A command that nobody has written yet, with what is awkward for a man page: a leading dot and quote, a backslash.
file(WRITE "${WORK}/fake" [=[#!/bin/sh
case "$1" in
  robot) printf "%s\n" "what a robot is" "Usage: fake robot [OPTIONS] URDF" "" "Positionals:" \
    "  URDF TEXT REQUIRED              .urdf file" "" "Options:" "  -h,--help                       Print this help" \
    "  --package TEXT:{a,b}=C:\\dir     " "                                  'package://' is looked for here" "" \
    "Fine print:" "  --padding FLOAT=0.03            .03 m, say" "" "Example:" "  .hidden robot 'arm.urdf'" ;;
  *) printf "%s\n" "a command" "Usage: fake [OPTIONS] SUBCOMMAND" "" "Options:" "  -h,--help                       Print this help" \
    "" "Subcommands:" "  robot                           what a robot is" ;;
esac
]=])
file(CHMOD "${WORK}/fake" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
file(REMOVE_RECURSE "${WORK}/pages")
run("${SOURCE}/scripts/man-pages" "${WORK}/fake" 1.0 "${WORK}/pages")
require_pages("${WORK}/fake" fake)
plain_page("${WORK}/pages/fake-robot.1.gz")
foreach(text IN ITEMS "URDF TEXT \\(required\\)\n +\\.urdf file" "--package TEXT:{a,b}=C:\\\\dir\n +'package://' is looked for here"
    "Fine print\n +--padding FLOAT=0\\.03\n +\\.03 m, say" "\\.hidden robot 'arm\\.urdf'")
  require_match("${page}" "${text}" "page of a new subcommand")
endforeach()

# groff's warnings are seen indeed.
file(WRITE "${WORK}/bad.1" ".TH BAD 1\n.SH NAME\nbad \\- a page\n.nosuchrequest\n")
execute_process(COMMAND groff -man -ww -Tascii "${WORK}/bad.1" OUTPUT_QUIET ERROR_VARIABLE warnings)
require_match("${warnings}" "nosuchrequest" "warning of groff")

# A help without a line of use makes no page.
file(WRITE "${WORK}/mute" "#!/bin/sh\necho nothing\n")
file(CHMOD "${WORK}/mute" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
execute_process(COMMAND "${SOURCE}/scripts/man-pages" "${WORK}/mute" 1.0 "${WORK}/mute_pages"
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0)
  message(FATAL_ERROR "a help without 'Usage:' made a page")
endif()
require_match("${output}" "man-pages: 'mute --help' has no line 'Usage: \\.\\.\\.'" "refusal of a help without use")
