# How every target of Vantage is built: language level, warnings, sanitizers, and five helpers.
#   vantage_library(NAME IN ... ROOMS ... DEPENDS ...)  a static library of all *.cpp of the folder IN, by default the current
#                                          one, and of its subfolders ROOMS
#   vantage_command_library(NAME ...)      the same of a program's subcommands
#   vantage_registry(TARGET ...)           gathers backends by file name, so that adding one touches no other file
#   vantage_embed_texts(TARGET ...)        builds files in
#   vantage_unit_test(NAME DEPENDS ...)    one GoogleTest program of all *_test.cpp of the current folder

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # base_dir lets several checkouts of Vantage share one cache; ccache takes precompiled headers if told so.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=true
    CCACHE_SLOPPINESS=pch_defines,time_macros)
  # It does not know a base_dir with spaces again in the lists of what was included, and would give other checkouts this
  # one's files to watch: such a checkout takes from the cache and puts nothing in.
  if(CMAKE_SOURCE_DIR MATCHES " ")
    list(APPEND CMAKE_CXX_COMPILER_LAUNCHER CCACHE_READONLY=true)
  endif()
  list(APPEND CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(vantage_options INTERFACE)
target_include_directories(vantage_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(vantage_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  -Woverloaded-virtual $<$<BOOL:${VANTAGE_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms of GCC's flow analysis inside the standard library and OpenCV at -O2.
  target_compile_options(vantage_options INTERFACE -Wno-maybe-uninitialized -Wno-stringop-overflow
    -Wno-stringop-overread -Wno-array-bounds -Wno-restrict -Wno-dangling-reference)
  # A class's hidden part may hold what an unnamed namespace has: nobody else sees either.
  target_compile_options(vantage_options INTERFACE -Wno-subobject-linkage)
  # The compiler collects garbage each time its memory has grown, and reads all precompiled headers to do so. Up to 1.5 GB
  # it no longer does: a source of tests takes 17 instead of 25 s, one of control 31 instead of 41 s. A job needs up to
  # 1.6 GB instead of 1.3, and a small computer keeps GCC's own limit.
  cmake_host_system_information(RESULT memory_mb QUERY TOTAL_PHYSICAL_MEMORY)
  if(memory_mb GREATER 6000)
    add_compile_options("SHELL:--param ggc-min-heapsize=1500000")
  endif()
endif()
if(VANTAGE_SANITIZE)
  add_compile_options(-fsanitize=${VANTAGE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${VANTAGE_SANITIZE})
endif()
if(VANTAGE_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Lets a library stand before its first source file does.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/empty.cpp CONTENT "")

# The headers that most sources come to include take most of the time to compile them: they are read once for the
# libraries, once, with CLI11, for the commands and once, with GoogleTest, for the tests.
function(vantage_precompiled name)
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/empty.cpp)
  target_link_libraries(${name} PRIVATE vantage_options fmt::fmt nlohmann_json::nlohmann_json Eigen3::Eigen
    vantage_opencv Threads::Threads)
  target_precompile_headers(${name} PRIVATE <algorithm> <array> <chrono> <filesystem> <functional> <map> <memory>
    <mutex> <optional> <span> <string> <thread> <vector> <fmt/format.h> <nlohmann/json.hpp> <Eigen/Geometry>
    <opencv2/core.hpp> ${ARGN})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${name} PRIVATE -fpch-preprocess)
  endif()
endfunction()
function(vantage_use_precompiled name headers)
  if(TARGET ${headers})
    target_precompile_headers(${name} REUSE_FROM ${headers})
  endif()
endfunction()

# Most of the time to compile a source goes into the headers that it shares with its neighbours, so those of a module are
# compiled as one (measured: 23 sources in 11 s of a processor, six at a time in 22): what stands in an unnamed namespace
# has a name of its own within its module. Backends, which are alike on purpose, are compiled alone, and so is what a
# module names after APART.
option(VANTAGE_UNITY "Compile the sources of a module as one" ON)
function(vantage_compile_together name)
  if(VANTAGE_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# vantage_embed_texts(TARGET lib FUNCTION texts HEADER declares.h FILES ...)
# Defines `std::span<const EmbeddedText> texts();`, files as they are when this is configured.
function(vantage_embed_texts)
  cmake_parse_arguments(ARG "" "TARGET;FUNCTION;HEADER" "FILES" ${ARGN})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARG_FILES})
  set(entries "")
  foreach(file ${ARG_FILES})
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"~toml~(${text})~toml~\"},\n")
  endforeach()
  # Its name is no source's, which would be the same object.
  set(embedded ${CMAKE_CURRENT_BINARY_DIR}/embedded_${ARG_FUNCTION}.cpp)
  file(CONFIGURE OUTPUT ${embedded} @ONLY CONTENT "#include \"${ARG_HEADER}\"

namespace vantage {
std::span<const EmbeddedText> ${ARG_FUNCTION}() {
    static constexpr EmbeddedText texts[] = {
@entries@};
    return texts;
}
}  // namespace vantage
")
  target_sources(${ARG_TARGET} PRIVATE ${embedded})
endfunction()

# Sets RESULT to all *.cpp of the FOLDER below the current one and of its subfolders ROOMS.
function(vantage_room_sources result folder)
  set(patterns *.cpp)
  foreach(room ${ARGN})
    list(APPEND patterns ${room}/*.cpp)
  endforeach()
  list(TRANSFORM patterns PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/)
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  set(${result} ${sources} PARENT_SCOPE)
endfunction()

function(vantage_library name)
  cmake_parse_arguments(ARG "" "IN" "ROOMS;APART;DEPENDS" ${ARGN})
  vantage_room_sources(sources "${ARG_IN}" ${ARG_ROOMS})
  list(TRANSFORM ARG_APART PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_IN}/)
  add_library(${name} STATIC ${sources} ${CMAKE_BINARY_DIR}/empty.cpp)
  target_link_libraries(${name} PUBLIC vantage_options ${ARG_DEPENDS})
  vantage_use_precompiled(${name} vantage_headers)
  vantage_compile_together(${name} ${ARG_APART})
endfunction()

# What reads a command line or checks a result spends its time elsewhere: optimising it further takes longer to compile
# than it ever saves.
function(vantage_optimise_little name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# vantage_command_library(vantage_host_commands FUNCTION host_commands DEPENDS ...)
# The subcommands of a program: every file x_command.cpp of the current folder defines `CommandEntry x_command_entry();`.
function(vantage_command_library name)
  cmake_parse_arguments(ARG "" "IN;FUNCTION" "ROOMS;DEPENDS" ${ARGN})
  vantage_room_sources(commands "${ARG_IN}" ${ARG_ROOMS})
  add_library(${name} STATIC ${commands})
  target_link_libraries(${name} PUBLIC vantage_options ${ARG_DEPENDS})
  vantage_optimise_little(${name})
  vantage_use_precompiled(${name} vantage_command_headers)
  vantage_compile_together(${name})
  vantage_registry(TOGETHER TARGET ${name} TYPE CommandEntry FUNCTION ${ARG_FUNCTION}
    HEADER common/base/cli/command.h SUFFIX command FILES ${commands})
  # All at once would be one long job at the end of a build.
  set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 12)
endfunction()

# vantage_registry(TARGET vantage_rig_stereo TYPE MatcherEntry FUNCTION matcher_entries
#                  HEADER rig_firmware/stereo/matcher.h SUFFIX matcher FILES a_matcher.cpp b_matcher.cpp)
# Every file x_SUFFIX.cpp defines `TYPE x_SUFFIX_entry();` in namespace vantage; the generated FUNCTION
# returns all of them in the order of their file names. Static self-registration would be dropped by the linker. Backends
# are compiled alone, unless they have names of their own (TOGETHER).
function(vantage_registry)
  cmake_parse_arguments(ARG "TOGETHER" "TARGET;TYPE;FUNCTION;HEADER;SUFFIX" "FILES" ${ARGN})
  set(declarations "")
  set(calls "")
  list(SORT ARG_FILES)
  foreach(file ${ARG_FILES})
    get_filename_component(stem ${file} NAME_WE)
    if(stem MATCHES "_${ARG_SUFFIX}$")
      if(NOT ARG_TOGETHER)
        set_source_files_properties(${file} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
      string(APPEND declarations "${ARG_TYPE} ${stem}_entry();\n")
      string(APPEND calls "    entries.push_back(${stem}_entry());\n")
    endif()
  endforeach()
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/${ARG_FUNCTION}.cpp)
  file(CONFIGURE OUTPUT ${generated} CONTENT
"#include \"${ARG_HEADER}\"

#include <vector>

namespace vantage {
${declarations}
std::vector<${ARG_TYPE}> ${ARG_FUNCTION}() {
    std::vector<${ARG_TYPE}> entries;
${calls}    return entries;
}
}  // namespace vantage
")
  target_sources(${ARG_TARGET} PRIVATE ${generated})
endfunction()

# The unit tests without those of faults, and those of faults. Then parts of both: what tools/sanitize.sh builds, which is
# the tests of code that reads bytes from outside and of code that shares data between threads, and what tools/arm64.sh does.
add_custom_target(vantage_unit_tests)
add_custom_target(vantage_fault_tests)
add_custom_target(vantage_bytes_tests)
add_custom_target(vantage_thread_tests)
add_custom_target(vantage_arm64_tests)
add_custom_target(vantage_gl_tests)
file(WRITE ${CMAKE_BINARY_DIR}/gl_tests "")

# vantage_unit_test(wire_test LABELS threads DEPENDS vantage_wire)
# Every test carries the label `unit`; `bytes` marks those that AddressSanitizer runs too, `threads` those that
# ThreadSanitizer does, `arm64` those that an emulated arm64 does, of what a rig's package has in it, `e2e` those that run
# one at a time, `faults` those that ./test leaves to ./test --all, `gl` those that draw: tests/bench/gpu_day.sh runs them
# on a GPU, by the names in build/PRESET/gl_tests. A program is one process and one test of CTest, since the start of a
# process, its GPU driver and its shaders take longer than most tests; one of SHARDS n is n of them. Tests that start
# programs themselves (e2e, faults) are a process each.
# Files after APART are compiled alone.
function(vantage_unit_test name)
  cmake_parse_arguments(ARG "" "SHARDS" "LABELS;DEPENDS;APART" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} vantage_test_support GTest::gtest_main)
  vantage_optimise_little(${name})
  vantage_use_precompiled(${name} vantage_test_headers)
  vantage_compile_together(${name} ${ARG_APART})
  # What a file has at its top may be the name of something within another.
  set_target_properties(${name} PROPERTIES UNITY_BUILD_CODE_BEFORE_INCLUDE
    "#pragma GCC diagnostic ignored \"-Wshadow\"")
  if("faults" IN_LIST ARG_LABELS)
    add_dependencies(vantage_fault_tests ${name})
  else()
    add_dependencies(vantage_unit_tests ${name})
  endif()
  if("bytes" IN_LIST ARG_LABELS)
    add_dependencies(vantage_bytes_tests ${name})
  endif()
  if("threads" IN_LIST ARG_LABELS)
    add_dependencies(vantage_thread_tests ${name})
  endif()
  if("arm64" IN_LIST ARG_LABELS)
    add_dependencies(vantage_arm64_tests ${name})
  endif()
  if("gl" IN_LIST ARG_LABELS)
    add_dependencies(vantage_gl_tests ${name})
    file(APPEND ${CMAKE_BINARY_DIR}/gl_tests ${name}\n)
  endif()
  # One word, since test discovery takes no list; ctest -L matches parts: `unit` finds all, `threads` these.
  string(JOIN "-" labels unit ${ARG_LABELS})
  set(properties LABELS "${labels}" ENVIRONMENT "MESA_GLES_VERSION_OVERRIDE=3.1")
  if(NOT ARG_LABELS MATCHES "e2e|faults")
    vantage_test_program(${name} "${ARG_SHARDS}" ${properties})
    if("gl" IN_LIST ARG_LABELS AND "threads" IN_LIST ARG_LABELS)
      # Mesa's driver is unloaded with the last context: of what it keeps nothing says any more that it is Mesa's.
      set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0")
    endif()
    return()
  endif()
  # Several processes each, which mostly wait: one show at a time beside tests that compute, and begun early. What is
  # measured in time as faults go by, or may lose no frame (`alone`), runs beside nothing.
  list(APPEND properties TIMEOUT 300)
  if("e2e" IN_LIST ARG_LABELS AND ARG_LABELS MATCHES "faults|alone")
    list(APPEND properties RUN_SERIAL TRUE)
  elseif("e2e" IN_LIST ARG_LABELS)
    list(APPEND properties RESOURCE_LOCK show COST 1200)
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
endfunction()

# The tests of a program in one process, or in as many as it has shards, which are begun first.
function(vantage_test_program name shards)
  set(properties TIMEOUT 900 ${ARGN})
  if(NOT shards)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES ${properties})
    return()
  endif()
  math(EXPR last "${shards} - 1")
  foreach(shard RANGE ${last})
    set(test ${name}/${shard})
    add_test(NAME ${test} COMMAND ${name})
    set_tests_properties(${test} PROPERTIES ${properties} COST 1000)
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT GTEST_TOTAL_SHARDS=${shards} GTEST_SHARD_INDEX=${shard})
  endforeach()
endfunction()
