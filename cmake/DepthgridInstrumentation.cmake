# Whole-tree compiler instrumentation and the compiler cache. Empty in the default build, which has no machine
# option: it runs on every x86-64 and builds on other processors as well.

if(DEPTHGRID_SANITIZE)
  # A report ends the program, so that the test that caused it fails.
  add_compile_options(-fsanitize=${DEPTHGRID_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${DEPTHGRID_SANITIZE})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  if(DEPTHGRID_SANITIZE MATCHES "thread|fuzzer")
    # Vectorised code for the baseline alone: neither threads nor files see the width of lanes.
    add_compile_definitions(HWY_COMPILE_ONLY_STATIC)
  else()
    # Of the instruction sets that vectorised code is compiled for on x86-64 the baseline and those with lanes of 8 and 16
    # floats: a read beyond an end is found with these, and compiling for more takes minutes.
    add_compile_definitions("HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4)")
  endif()
  # These checks take more than half of the compiler's time together, and tell little that the address sanitizer does not;
  # the fuzzers' build, with clang, has them all.
  if(DEPTHGRID_SANITIZE MATCHES "undefined" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fno-sanitize=alignment,nonnull-attribute,null,object-size,pointer-overflow,returns-nonnull-attribute,vptr)
  endif()
  # GCC's manual: sanitizers make it warn of uninitialised values that are none. The plain build has the warning.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-maybe-uninitialized)
  endif()
endif()

if(DEPTHGRID_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

# A tenth of the time goes into the compiler's tidying of its memory, which 1 GB a source makes needless.
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-heapsize=1000000)
endif()

# Used when it is there, never required; a caller's own choice wins.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(DEPTHGRID_CCACHE ccache)
  mark_as_advanced(DEPTHGRID_CCACHE)
  if(DEPTHGRID_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${DEPTHGRID_CCACHE}")
  endif()
endif()
