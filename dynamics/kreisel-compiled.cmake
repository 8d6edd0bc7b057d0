# kreisel::compiled: what is no template, compiled once (dynamics/compiled.hpp) in the project of
# whoever links it, and with its flags. Part of our own build and, installed, of the CMake package.
if(NOT TARGET kreisel_compiled)
  add_library(kreisel_compiled STATIC EXCLUDE_FROM_ALL
    ${CMAKE_CURRENT_LIST_DIR}/compiled/any_field.cpp
    ${CMAKE_CURRENT_LIST_DIR}/compiled/body.cpp
    ${CMAKE_CURRENT_LIST_DIR}/compiled/closed_form.cpp
    ${CMAKE_CURRENT_LIST_DIR}/compiled/decompositions.cpp
    ${CMAKE_CURRENT_LIST_DIR}/compiled/precession.cpp
    ${CMAKE_CURRENT_LIST_DIR}/compiled/solve.cpp)
  add_library(kreisel::compiled ALIAS kreisel_compiled)
  target_compile_definitions(kreisel_compiled PUBLIC KREISEL_COMPILED)
  target_link_libraries(kreisel_compiled PUBLIC kreisel::dynamics)
endif()
