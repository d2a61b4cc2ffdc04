# Refuses includes that run against the layers of the tree at ROOT:
#   rig_firmware, host_app and calib_tools see common and never each other; common sees none of them;
#   inside common, base, image and geometry know no OpenGL, and gl knows nothing of rigs, wires or stages.
#   inside host_app, a room includes rooms of lower layers and of its own, never of higher ones.
# Includes are rooted at the repository, so a path says its layer.
set(common_rule "rig_firmware|host_app|calib_tools")
set(no_gl_rule "common/gl|common/wire|common/config|common/virtual_stage")
set(rules
  "common|${common_rule}"
  "rig_firmware|host_app|calib_tools"
  "host_app|rig_firmware|calib_tools"
  "calib_tools|rig_firmware|host_app"
  "common/base|${no_gl_rule}|common/image|common/geometry"
  "common/image|${no_gl_rule}|common/geometry"
  "common/geometry|${no_gl_rule}"
  "common/gl|common/geometry|common/wire|common/config|common/virtual_stage")

set(faults "")
set(checked 0)
foreach(rule ${rules})
  string(REGEX MATCH "^([^|]*)\\|(.*)$" whole "${rule}")
  set(folder ${CMAKE_MATCH_1})
  set(forbidden ${CMAKE_MATCH_2})
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.cpp)
  foreach(file ${files})
    math(EXPR checked "${checked} + 1")
    file(STRINGS ${ROOT}/${file} includes REGEX "^[ \t]*#[ \t]*include[ \t]*[\"<](${forbidden}|\\.\\.)/")
    foreach(line ${includes})
      list(APPEND faults "${file}: ${line}")
    endforeach()
  endforeach()
endforeach()
# The layers of host_app, lowest first; rooms that are joined by "+" share a layer. The desk's feed is fed by the session.
set(layers
  frames replay flight ltc views surfaces background refine foreground pipeline baked synthesis points+fused+gallery output sound
  control camera_paths takes view_sets programme exports desk session+desk/feed+metrics+web setup relay commands)
set(layer_count 0)
foreach(layer ${layers})
  string(REPLACE "+" ";" layer_rooms "${layer}")
  foreach(room ${layer_rooms})
    set(layer_of_${room} ${layer_count})
  endforeach()
  math(EXPR layer_count "${layer_count} + 1")
endforeach()

function(host_layer path result)
  string(REGEX MATCH "^host_app/(desk/feed|[a-z0-9_]+)/" whole "${path}")
  set(${result} "${layer_of_${CMAKE_MATCH_1}}" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/host_app/*/*.h ${ROOT}/host_app/*/*.cpp)
foreach(file ${files})
  math(EXPR checked "${checked} + 1")
  host_layer(${file} own)
  if("${own}" STREQUAL "")
    list(APPEND faults "${file}: its room has no layer in tests/unit/layers/check_includes.cmake")
    continue()
  endif()
  file(STRINGS ${ROOT}/${file} includes REGEX "^[ \t]*#[ \t]*include[ \t]*\"host_app/[^\"]*/[^\"/]*\"")
  foreach(line ${includes})
    string(REGEX MATCH "host_app/[^\"]*" included "${line}")
    host_layer(${included} other)
    if("${other}" STREQUAL "" OR other GREATER own)
      list(APPEND faults "${file}: ${line}")
    endif()
  endforeach()
endforeach()

if(checked EQUAL 0)
  message(FATAL_ERROR "no sources found under ${ROOT}")
endif()
if(faults)
  list(JOIN faults "\n  " text)
  message(FATAL_ERROR "includes against the layers:\n  ${text}")
endif()
message(STATUS "${checked} files keep to their layers")
