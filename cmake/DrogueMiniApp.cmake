# drogue_add_mini_app(<name>): the scene-driven program drogue-<name> from the sources of the current folder. Everything but
# main.cpp becomes the library drogue_<name>_app, which tests link. scenes/ is installed beside the program; for one that is neither
# installed nor bundled, the sources find it as DROGUE_<NAME>_SCENES.
function(drogue_add_mini_app name)
  file(GLOB_RECURSE _sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  list(REMOVE_ITEM _sources "${CMAKE_CURRENT_SOURCE_DIR}/main.cpp")
  string(TOUPPER "${name}" _upper)
  set(_folder DROGUE_${_upper}_SCENES="${CMAKE_CURRENT_SOURCE_DIR}/scenes")
  set(_libraries drogue_framework drogue_reference)
  if(_sources)
    set(_library drogue_${name}_app)
    drogue_unite(_sources ${name})
    add_library(${_library} STATIC ${_sources})
    drogue_optimise_little(${_library})
    drogue_share_standard(${_library} drogue_framework)
    target_link_libraries(${_library} PUBLIC ${_libraries})
    target_compile_definitions(${_library} PRIVATE ${_folder})
    set(_libraries ${_library})
  endif()

  drogue_add_program(drogue-${name} SOURCES main.cpp LIBRARIES ${_libraries})
  target_compile_definitions(drogue-${name} PRIVATE ${_folder})
  install(DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/scenes/"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/drogue/scenes/${name}" FILES_MATCHING PATTERN "*.toml")
endfunction()
