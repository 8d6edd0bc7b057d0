# cmake -D CPACK=<program> -D CONFIG=<CPackConfig.cmake> -D LIBDIR=<folder> -D SITE=<folder> -D OUT=<folder> -P deb.cmake
#
# Makes a .deb of the installation in TREE, checks its metadata and contents, unpacks it into
# OUT/root.

file(REMOVE_RECURSE ${OUT})
file(MAKE_DIRECTORY ${OUT})
execute_process(COMMAND ${CPACK} -G DEB --config ${CONFIG} -B ${OUT}
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# check(<package> DEPENDS <pattern> HOLDS <path below usr>...)
function(check name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "DEPENDS" "HOLDS")
  file(GLOB package ${OUT}/${name}_*.deb)
  if(NOT package)
    message(SEND_ERROR "there is no package ${name}")
    return()
  endif()
  execute_process(COMMAND dpkg-deb --field ${package} Depends
    OUTPUT_VARIABLE depends COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND dpkg-deb --extract ${package} ${OUT}/${name} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND dpkg-deb --extract ${package} ${OUT}/root COMMAND_ERROR_IS_FATAL ANY)
  if(NOT depends MATCHES "${arg_DEPENDS}")
    message(SEND_ERROR "${name} depends on ${depends}, not on ${arg_DEPENDS}")
  endif()
  if(depends MATCHES "gsl")
    message(SEND_ERROR "${name} depends on GSL, which is GPL-3: ${depends}")
  endif()
  foreach(path IN LISTS arg_HOLDS)
    file(GLOB found ${OUT}/${name}/usr/${path})
    if(NOT found)
      message(SEND_ERROR "${name} lacks ${path}")
    endif()
  endforeach()
endfunction()

file(GLOB runtime ${OUT}/libkreisel[0-9]*.deb)
cmake_path(GET runtime FILENAME runtime)
string(REGEX REPLACE "_.*" "" runtime ${runtime})
check(${runtime} DEPENDS "libstdc\\+\\+6" HOLDS ${LIBDIR}/libkreisel.so.* share/doc/${runtime}/copyright)
check(libkreisel-dev DEPENDS "${runtime}.*libeigen3-dev \\(>= 3\\.4\\)"
  HOLDS include/kreisel/motor/motor.hpp include/kreisel/dynamics/solve/solve.hpp
    ${LIBDIR}/cmake/kreisel/kreisel-config.cmake ${LIBDIR}/pkgconfig/kreisel-dynamics.pc
    ${LIBDIR}/libkreisel.a ${LIBDIR}/libkreisel.so)
check(kreisel DEPENDS "libstdc\\+\\+6"
  HOLDS bin/kreisel libexec/kreisel/simulate share/man/man1/kreisel-simulate.1.gz
    share/bash-completion/completions/kreisel share/doc/kreisel/README.md share/doc/kreisel/docs/site/pictures/deviation.svg
    share/doc/kreisel/examples/scenes/gyrocompass.toml)

# The runtime package holds nothing that a second version of it would overwrite.
file(GLOB_RECURSE held RELATIVE ${OUT}/${runtime} ${OUT}/${runtime}/*)
list(FILTER held EXCLUDE REGEX "/libkreisel\\.so\\.[0-9.]+$|^usr/share/doc/${runtime}/")
if(held)
  message(SEND_ERROR "${runtime} also holds ${held}")
endif()

# The site is in its package if it was built before.
if(EXISTS ${SITE}/index.html)
  check(kreisel-doc DEPENDS "" HOLDS share/doc/kreisel-doc/html/index.html)
endif()

file(GLOB python ${OUT}/python3-kreisel_*.deb)
if(python)
  check(python3-kreisel DEPENDS "python3 \\(>= 3\\.[0-9]+\\)"
    HOLDS lib/python3/dist-packages/kreisel/__init__.py
      lib/python3/dist-packages/kreisel/_kreisel*.so lib/python3/dist-packages/kreisel/py.typed)
endif()

# The command finds its programs wherever the package is.
execute_process(COMMAND ${OUT}/root/usr/bin/kreisel simulate --version
  OUTPUT_VARIABLE version COMMAND_ERROR_IS_FATAL ANY)
if(NOT version MATCHES "^kreisel simulate [0-9.]+\n$")
  message(SEND_ERROR "kreisel simulate --version prints ${version}")
endif()
