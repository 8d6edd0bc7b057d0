# cmake -D PROGRAM=<executable> -D EXPECTED=<file> -P compare.cmake

file(READ ${EXPECTED} expected)
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "The page says\n${expected}\nand the program\n${output}")
endif()
