# vantage_program(vantage-rig COMMANDS vantage_rig_commands LIBRARIES "libgpiod 2.1, ZeroMQ 4.3.4")
# A program of main.cpp of the current folder: what --version says of it, and beside it in bin/ its man page and its
# completion for bash, which it prints itself.
function(vantage_program name)
  cmake_parse_arguments(ARG "" "COMMANDS;LIBRARIES" "" ${ARGN})
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_COMMANDS} vantage_commit)
  target_compile_definitions(${name} PRIVATE VANTAGE_LIBRARIES="${ARG_LIBRARIES}")
  # Built for tests with a sanitizer, or for fuzzing, it goes into no package.
  if(VANTAGE_SANITIZE OR VANTAGE_FUZZ)
    return()
  endif()
  add_custom_command(TARGET ${name} POST_BUILD VERBATIM
    COMMAND ${name} --man-page > $<TARGET_FILE:${name}>.1
    COMMAND ${name} --bash-completion > $<TARGET_FILE:${name}>.bash)
endfunction()

# The commit of the sources, looked up at every build and compiled in only where it has changed.
set(commit_source ${CMAKE_BINARY_DIR}/commit.cpp)
add_custom_target(vantage_find_commit BYPRODUCTS ${commit_source}
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_SOURCE_DIR} -DOUTPUT=${commit_source}
    -P ${CMAKE_CURRENT_LIST_DIR}/find_commit.cmake VERBATIM)
add_library(vantage_commit STATIC ${commit_source})
add_dependencies(vantage_commit vantage_find_commit)
