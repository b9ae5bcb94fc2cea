# Whole-tree compiler instrumentation and the compiler cache. Empty in the default build, which has no machine
# option: it runs on every x86-64 and builds on other processors as well.

if(DEPTHGRID_SANITIZE)
  # A report ends the program, so that the test that caused it fails.
  add_compile_options(-fsanitize=${DEPTHGRID_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${DEPTHGRID_SANITIZE})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()

if(DEPTHGRID_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

# Used when it is there, never required; a caller's own choice wins.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(DEPTHGRID_CCACHE ccache)
  mark_as_advanced(DEPTHGRID_CCACHE)
  if(DEPTHGRID_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${DEPTHGRID_CCACHE}")
  endif()
endif()
