# cmake -DCOMPILER= -DSOURCE= -DINCLUDES= -DMAX_LINES= -P check.cmake
#
# SOURCE must compile. With -DMISUSE it must be refused, in at most MAX_LINES lines. These must
# match every regular expression after "// refused: " in SOURCE.

set(ENV{LC_ALL} C)  # plain quotes in messages, on every machine
list(TRANSFORM INCLUDES PREPEND -isystem)

function(compile result message)
  execute_process(
    COMMAND ${COMPILER} -std=c++20 -fsyntax-only ${INCLUDES} ${ARGN} ${SOURCE}
    RESULT_VARIABLE status ERROR_VARIABLE stderr)
  set(${result} ${status} PARENT_SCOPE)
  set(${message} "${stderr}" PARENT_SCOPE)
endfunction()

compile(status message)
message("${message}")
if(NOT status EQUAL 0)
  message(FATAL_ERROR "the legal program does not compile")
endif()

compile(status message -DMISUSE)
message("${message}")
if(status EQUAL 0)
  message(FATAL_ERROR "the misuse compiles")
endif()

string(REGEX MATCHALL "\n" line_ends "${message}")
list(LENGTH line_ends lines)
if(lines GREATER MAX_LINES)
  message(FATAL_ERROR "the message has ${lines} lines, ${MAX_LINES} are allowed")
endif()

file(STRINGS ${SOURCE} expectations REGEX "^// refused: ")
if(NOT expectations)
  message(FATAL_ERROR "no line \"// refused: regex\" in the program")
endif()
foreach(expectation IN LISTS expectations)
  string(REPLACE "// refused: " "" regex "${expectation}")
  if(NOT message MATCHES "${regex}")
    message(FATAL_ERROR "the message does not match \"${regex}\"")
  endif()
endforeach()
