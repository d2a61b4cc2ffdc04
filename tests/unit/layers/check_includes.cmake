# Refuses includes that run against the layers of the tree at ROOT:
#   rig_firmware, host_app and calib_tools see common and never each other; common sees none of them;
#   inside common, base, image and geometry know no OpenGL, and gl knows nothing of rigs, wires or stages.
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
if(checked EQUAL 0)
  message(FATAL_ERROR "no sources found under ${ROOT}")
endif()
if(faults)
  list(JOIN faults "\n  " text)
  message(FATAL_ERROR "includes against the layers:\n  ${text}")
endif()
message(STATUS "${checked} files keep to their layers")
