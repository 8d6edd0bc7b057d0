# cmake -D CPACK=<program> -D CONFIG=<CPackConfig.cmake> -D TREE=<installed> -D LIBDIR=<folder>
#   -D OUT=<folder> -P deb.cmake
#
# Makes a .deb of what is installed in TREE, looks at what it says and holds, unpacks it into OUT/root.

file(REMOVE_RECURSE ${OUT})
file(MAKE_DIRECTORY ${OUT})
execute_process(
  COMMAND ${CPACK} -G DEB --config ${CONFIG} -B ${OUT}
    -D CPACK_INSTALL_CMAKE_PROJECTS= -D "CPACK_INSTALLED_DIRECTORIES=${TREE};/usr"
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(GLOB package ${OUT}/*.deb)
execute_process(COMMAND dpkg-deb --field ${package} Depends
  OUTPUT_VARIABLE depends COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND dpkg-deb --extract ${package} ${OUT}/root COMMAND_ERROR_IS_FATAL ANY)

if(NOT depends MATCHES "libeigen3-dev \\(>= 3\\.4\\)")
  message(SEND_ERROR "the package does not ask for Eigen, but for: ${depends}")
endif()
if(depends MATCHES "gsl")
  message(SEND_ERROR "the package asks for GSL, which is GPL-3: ${depends}")
endif()
if(EXISTS ${TREE}/bin/simulate AND NOT depends MATCHES "libstdc\\+\\+6.*|libgeographic.*")
  message(SEND_ERROR "the package does not ask for what its programs are linked to: ${depends}")
endif()
foreach(path IN ITEMS include/kreisel/motor/motor.hpp include/kreisel/dynamics/solve/solve.hpp
    ${LIBDIR}/cmake/kreisel/kreisel-config.cmake ${LIBDIR}/pkgconfig/kreisel-dynamics.pc
    ${LIBDIR}/libkreisel.a ${LIBDIR}/libkreisel.so
    share/doc/kreisel/README.md share/doc/kreisel/docs/site/pictures/deviation.svg
    share/doc/kreisel/examples/scenes/gyrocompass.toml)
  if(NOT EXISTS ${OUT}/root/usr/${path})
    message(SEND_ERROR "the package lacks ${path}")
  endif()
endforeach()
