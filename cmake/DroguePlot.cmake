# drogue-plot is a Python package; its launcher in <build>/bin finds it and an interpreter.

configure_file("${PROJECT_SOURCE_DIR}/cmake/drogue-plot.in" "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/drogue-plot" @ONLY
  FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
install(PROGRAMS "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/drogue-plot" DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/scripts/plot" DESTINATION "${CMAKE_INSTALL_DATADIR}/drogue"
  PATTERN "__pycache__" EXCLUDE)
