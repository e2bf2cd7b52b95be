# Writes OUTPUT (a header with GFP_COMMIT) anew only when the commit changed. Run in script mode at every build.
cmake_policy(VERSION 3.25)
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define GFP_COMMIT \"@commit@\"\n" @ONLY)
