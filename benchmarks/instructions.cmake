find_path(VALGRIND_INCLUDE_DIR valgrind/callgrind.h)

# kreisel_count(<folder>): the program <folder>_count of benchmarks/<folder>, whose instructions
# tests/support/instructions.sh counts: optimised whatever the preset, for any processor of its family.
#
# Packed arithmetic of straight lines is off: g++ forms packs, and shuffles, that depend on the
# addresses of numbers.
function(kreisel_count folder)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmarks/${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/(kdl|simbody)\\.cpp$")
  add_executable(${folder}_count ${sources})
  target_include_directories(${folder}_count SYSTEM PRIVATE ${VALGRIND_INCLUDE_DIR})
  target_link_libraries(${folder}_count PRIVATE kreisel::dynamics kreisel_strict)
  target_compile_options(${folder}_count PRIVATE
    -O3 -DNDEBUG -fno-tree-slp-vectorize
    $<$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},x86_64>:-march=x86-64>)
  set_target_properties(${folder}_count PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endfunction()
