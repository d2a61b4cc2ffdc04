# Validates FILE, which may include files of any room of ROOT, with the reference GLSL compiler as the shader library would hand it to the driver, with the
# file's own default definitions, and touches STAMP.
set(preamble "#version 310 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
precision highp isampler2D;
precision highp sampler2DArray;
precision highp usampler2DArray;
precision highp image2D;
precision highp uimage2D;
")
get_filename_component(extension ${FILE} LAST_EXT)
file(READ ${FILE} text)
# Includes nest at most a few levels deep.
foreach(level RANGE 8)
  if(NOT text MATCHES "#include \"([^\"]+)\"")
    break()
  endif()
  set(included ${CMAKE_MATCH_1})
  file(GLOB included_path ${ROOT}/*/${included})
  file(READ ${included_path} included_text)
  string(REPLACE "#include \"${included}\"" "${included_text}" text "${text}")
endforeach()
set(expanded ${STAMP}${extension})
file(WRITE ${expanded} "${preamble}${text}")
execute_process(COMMAND ${VALIDATOR} ${expanded} RESULT_VARIABLE status OUTPUT_VARIABLE log ERROR_VARIABLE log)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${FILE} is not valid GLSL ES 3.10 (line numbers are of ${expanded}):\n${log}")
endif()
file(TOUCH ${STAMP})
