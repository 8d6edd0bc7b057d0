# Tests that README shows examples/parts_of_a_force.cpp and its output.
#
# cmake -D README=<file> -D SOURCE=<file> -D PROGRAM=<executable> -P readme.cmake

file(READ ${README} readme)
file(READ ${SOURCE} source)
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)

string(FIND "${source}" "#include" start) # without the comment above it
string(SUBSTRING "${source}" ${start} -1 source)
string(REGEX REPLACE "\n\n(#include|using)" "\n\\1" source "${source}") # without the blank lines
string(REGEX REPLACE "([^\n]+)\n" "    \\1\n" output "${output}")

foreach(part source output)
  string(FIND "${readme}" "${${part}}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "README does not show this ${part}:\n${${part}}")
  endif()
endforeach()
