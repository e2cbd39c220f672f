# Writes the source file FILE, which has the commit of the sources in FOLDER, unless it has that already.
execute_process(COMMAND git describe --always --dirty --abbrev=10 WORKING_DIRECTORY ${FOLDER}
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${FILE} @ONLY CONTENT [[
// Made by cmake/WriteCommit.cmake.
namespace relief::bench {
extern const char* const kCommit;
const char* const kCommit = "@commit@";
} // namespace relief::bench
]])
