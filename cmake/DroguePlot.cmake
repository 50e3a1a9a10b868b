# drogue-plot is a Python package; the launcher in <build>/bin finds it and the interpreter of scripts/setup.sh.

set(DROGUE_PLOT_ROOT "${PROJECT_SOURCE_DIR}/scripts")
configure_file("${PROJECT_SOURCE_DIR}/cmake/drogue-plot.in" "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/drogue-plot" @ONLY
  FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
