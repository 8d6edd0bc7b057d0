# The command kreisel, its pages of the manual and its completion in bash.

# kreisel_command(<file> <folder of the programs, relative to the file>)
function(kreisel_command file programs)
  configure_file(kreisel.in ${file} @ONLY
    FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
      WORLD_EXECUTE)
endfunction()
file(RELATIVE_PATH up /${CMAKE_INSTALL_BINDIR} /${programs_dir})
kreisel_command(${PROJECT_BINARY_DIR}/bin/kreisel .)
kreisel_command(${CMAKE_CURRENT_BINARY_DIR}/kreisel ${up})
install(PROGRAMS ${CMAKE_CURRENT_BINARY_DIR}/kreisel TYPE BIN COMPONENT programs)
install(FILES completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME kreisel COMPONENT programs)

# kreisel_manual_page(<name> <command> <about>): a page of the output of `<command> --help`
function(kreisel_manual_page name command about)
  set(page ${CMAKE_CURRENT_BINARY_DIR}/${name}.1.gz)
  add_custom_command(OUTPUT ${page}
    COMMAND ${command} --help | awk -f ${CMAKE_CURRENT_SOURCE_DIR}/man.awk -v name=${name}
      -v about=${about} -v version=${PROJECT_VERSION} | gzip -n -9 > ${page}
    DEPENDS ${command} man.awk
    VERBATIM)
  set_property(TARGET manual APPEND PROPERTY SOURCES ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs OPTIONAL)
endfunction()
add_custom_target(manual ALL)
kreisel_manual_page(kreisel ${PROJECT_BINARY_DIR}/bin/kreisel "rigid bodies seen from a moving frame")
kreisel_manual_page(kreisel-simulate simulate "the motion of a scene file, with its error")
kreisel_manual_page(kreisel-analyze analyze "equilibria, roots and stability of a scene file")
kreisel_manual_page(kreisel-ensemble ensemble "a scene file many times, with varied numbers")
kreisel_manual_page(kreisel-deviation pendulum_deviation "deviation of pendulums from the vertical")
