find_package(Boost 1.74 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)

# kreisel_stability(): the program build/<preset>/bin/stability, for the benchmarks, or for the
# tests with the same options
function(kreisel_stability)
  set(folder ${PROJECT_SOURCE_DIR}/benchmarks)
  file(GLOB cases CONFIGURE_DEPENDS ${folder}/stability/*.cpp)
  add_executable(stability
    ${folder}/stability.cpp ${cases} ${folder}/work_precision/references.cpp)
  target_link_libraries(stability PRIVATE
    kreisel::gsl Boost::headers fmt::fmt nlohmann_json::nlohmann_json
    kreisel_strict)
  if(TARGET kreisel_top_truth)
    target_link_libraries(stability PRIVATE kreisel_top_truth)
    target_precompile_headers(stability REUSE_FROM kreisel_test_support)
  else()
    target_sources(stability PRIVATE ${PROJECT_SOURCE_DIR}/tests/support/top_truth.cpp)
    target_include_directories(stability PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(stability PRIVATE KREISEL_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  endif()
  set_target_properties(stability PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endfunction()
